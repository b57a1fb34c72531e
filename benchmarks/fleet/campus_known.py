"""The simulated service's knowledge of each robot, from its messages: as `app/robots` has it in the database."""

from dataclasses import dataclass, field
from datetime import datetime

from benchmarks.fleet.campus_link import Link
from fleet.schedule.network import Lane
from protocol.parts import Activity, Battery, Leg, Position, Stop
from protocol.to_robot import Mission
from protocol.to_server import Claim


@dataclass
class Known:
    """`claim` waits, for `lane` or for another way that the schedule leads. `held`: corridors that it may be in, with
    the times of their grants; `moved_s`: of the last, `asked_s`: of the first claim after it. `planned`: orders that
    were known to be more than one charge."""

    name: str
    home: str
    link: Link
    post: str = ""
    heard_s: float = 0.0
    moved_s: float = 0.0
    asked_s: float = 0.0
    ratio: float = 1.0
    docked: bool = True
    charging: bool = False
    recharging: bool = False
    stopped: bool = False
    bound_for: str | None = None
    claim: Claim | None = None
    lane: Lane | None = None
    held: dict[Leg, float] = field(default_factory=dict)
    mission: Mission | None = None
    frozen: bool = False
    passed: tuple[str, datetime] | None = None
    arrived: dict[str, datetime] = field(default_factory=dict)
    planned: set[str] = field(default_factory=set)

    @property
    def is_heard(self) -> bool:
        return self.link.up

    def note(self, position: Position, battery: Battery, activity: Activity | None = None) -> None:
        if not self.held and position.post is not None:
            self.post = position.post
        self.ratio, self.charging = battery.ratio, battery.charging
        self.docked = bool(battery.docked)
        if activity is not None:
            self.stopped = activity is Activity.STOPPED

    def tell_mission(self, stops: tuple[Stop, ...]) -> bool:
        """False if it has been told that already."""
        if stops == (() if self.mission is None else self.mission.stops):
            return False
        update = 1 if self.mission is None else self.mission.update + 1
        self.mission = Mission(id=f"{self.name}-mission", update=update, stops=stops)
        self.link.to_robot(self.mission)
        return True

    def without_stop(self, stop_id: str) -> None:
        """It is behind it: what is told next begins with the one after it."""
        if self.mission is not None:
            left = tuple(stop for stop in self.mission.stops if stop.id != stop_id)
            self.mission = self.mission.model_copy(update={"stops": left})


def known_robots(links: dict[str, Link], homes: dict[str, str]) -> dict[str, Known]:
    return {name: Known(name, home, links[name], home) for name, home in homes.items()}
