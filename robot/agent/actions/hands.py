"""The parts of the robot that actions work with."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Final

from maps import CampusMapError
from protocol.to_server import Step
from robot.agent.navigator import Navigator
from robot.drivers.interfaces import BodyShape
from robot.mission.mission import MissionManager
from robot.skills.interfaces import Body, View

PLACE_UNKNOWN: Final = "place_unknown"
"""The fault of a robot that cannot tell where it is, and the reason for which its actions fail meanwhile."""


@dataclass
class Hands:
    """The body, the map in the robot's head, and its duties. `view` is what the mind's present tick goes by."""

    body: Body
    navigator: Navigator
    missions: MissionManager
    cruise_mm_s: float = 120.0
    turn_mm_s: float = 80.0
    shape: BodyShape = field(default_factory=BodyShape)
    view: View = field(default_factory=View)
    noted: Callable[[str], None] = lambda _: None
    """Told what is worth a line for the person who watches."""

    @property
    def place(self) -> str | None:
        """The post to name in a report: where the robot stands, or the last one it has seen; of a bay its post."""
        here = self.navigator.here
        return None if here is None else self.navigator.campus.address_of(here)

    def lose_place(self, error: CampusMapError) -> None:
        """An error of the map that was not foreseen: where the robot believed to be cannot be."""
        self.navigator.lose_place(self.view)
        self.missions.report_fault(PLACE_UNKNOWN, f"The robot has lost its place on the map: {error}", None)

    def report(self, step: Step, stop_id: str, reason: str | None = None) -> None:
        self.missions.report(step, stop_id, self.place, reason)
