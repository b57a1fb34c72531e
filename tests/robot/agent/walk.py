"""A navigator that is led through the map by hand."""

import math
from datetime import UTC, datetime, timedelta

from maps import CampusMap
from robot.agent.navigator import Navigator
from robot.mission.memory import Memory
from robot.mission.mission import MissionManager
from robot.mission.outbox import Outbox
from robot.mission.store import Store
from tests.plain_maps import plain_map
from tests.robot.fake_body import FakeBody

CAMPUS = plain_map("test_track")


class Walk:
    """A navigator with a body that is led through the map by hand."""

    def __init__(
        self,
        store: Store,
        home: str | None = "post5",
        since_midnight_s: float = 0.0,
        campus: CampusMap = CAMPUS,
    ) -> None:
        utc = datetime(2026, 1, 5, tzinfo=UTC) + timedelta(seconds=since_midnight_s)
        self.missions = MissionManager(store, Memory(store), Outbox(store), lambda: utc)
        self.now = 0.0
        self.navigator = Navigator(campus, home, self.missions, self.now)
        self.body = FakeBody()

    def look(self) -> None:
        self.now += 0.1
        self.body.passes_time(self.now)
        self.navigator.look(self.body.view)

    def drives_to(self, post: str) -> None:
        """Off along the line, the marker abreast, the post under the axle."""
        self.navigator.leave()
        way_mm = 1000 * self.navigator.ahead_m if self.navigator.corridor else 2000.0
        self.body.rolls(way_mm - 300.0)
        self.look()
        self.body.sees(post)
        self.look()
        self.body.rolls(300.0)
        self.look()

    def turns_round(self) -> None:
        """Between two posts."""
        self.navigator.begin_turn()
        self.body.turns(math.pi)
        self.look()
        self.navigator.turned()

    def turns(self, way: str) -> None:
        self.body.turns(self.navigator.turn_rad(way))
        self.look()
        self.navigator.turned()
