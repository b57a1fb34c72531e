"""Actions over a fake body, for the tests of this folder."""

from dataclasses import dataclass, field
from datetime import UTC, datetime

from bdi import parse_term
from protocol.parts import Leg, Stop, StopAction
from protocol.to_robot import Mission
from robot.agent.actions.actions import Actions, table_for
from robot.agent.actions.hands import Hands
from robot.agent.navigator import Navigator
from robot.core.config import PerceptMode
from robot.mission.memory import Incoming, Memory
from robot.mission.mission import MissionManager
from robot.mission.outbox import Outbox
from robot.mission.store import Store
from tests.plain_maps import plain_map
from tests.robot.fake_body import FakeBody

NOW = datetime(2026, 1, 5, 9, tzinfo=UTC)
MISSION = Mission(
    id="m1",
    update=1,
    stops=(
        Stop(id="s1", post="post1", action=StopAction.LOAD, order_id="o1"),
        Stop(id="s2", post="post4", action=StopAction.RECEIVE, order_id="o1"),
    ),
)


TO_POST1 = Leg(from_post="post2", to_post="post1")
TO_POST3, TO_POST4 = Leg(from_post="post2", to_post="post3"), Leg(from_post="post3", to_post="post4")


@dataclass
class SilentServer:
    """It grants nothing, and is never asked for anything else here."""

    online: bool = True

    def incoming(self) -> list[Incoming]:
        return []

    def wake(self) -> None:
        pass


@dataclass
class Bench:
    """Actions over a fake body, with real duties in a file."""

    store: Store
    mode: PerceptMode = PerceptMode.LATEST
    body: FakeBody = field(default_factory=FakeBody)
    noted: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.missions = MissionManager(self.store, Memory(self.store), Outbox(self.store), lambda: NOW)
        self.navigator = Navigator(plain_map("test_track"), "post5", self.missions, now=0.0)
        self.hands = Hands(self.body, self.navigator, self.missions, noted=self.noted.append)
        self.actions = Actions(self.hands, table_for(self.mode))
        self._next = 0

    def ask(self, text: str, now: float = 0.0) -> int:
        self._next += 1
        self.actions.begin(self._next, parse_term(text), now)
        return self._next

    def result(self, text: str, now: float = 0.0) -> str | None:
        """Why it failed at once; None for done."""
        id_ = self.ask(text, now)
        return dict(self.actions.finished(now))[id_]

    def told(self) -> list[str]:
        return [kept.message.model_dump_json() for kept in self.missions.outbox.pending()]


def with_server(bench: Bench, *granted: Leg, online: bool = True) -> SilentServer:
    server = SilentServer(online)
    bench.missions.join(server)
    bench.missions.memory.grant(granted)
    bench.missions.seen("post2")
    bench.navigator.place("post2", "post3")
    return server
