"""The stages of the paper's Figure 6 in a logged run: when each was reached, and where the robot truly was."""

import math
from dataclasses import dataclass, field
from typing import Final

from benchmarks.paper.contenders import SENDER, Contender
from robot.ops.assembly import Parts

COLLECTED: Final = "mail collected"
POST_POINT: Final = "post point detected"
TURNED: Final = "turned to continue"
INTERRUPTED: Final = "interrupted to charge"
CHARGING: Final = "charging"
PROCEEDING: Final = "on to the destination"
NAMES: Final = (COLLECTED, POST_POINT, TURNED, INTERRUPTED, CHARGING, PROCEEDING)
"""In the paper's order, which is not always that of a run: the battery is low 5 to 20 s after the mail is aboard."""
TURNED_RAD: Final = math.radians(60)
MOVED_ON_M: Final = 0.5
"""So far from where the stage before was reached, a robot has turned, or left the dock, for good."""
TRAIL_EVERY_M: Final = 0.02

Place = tuple[float, float, float]
"""Metres on the map and the heading in radians, as the simulated world knows it."""


@dataclass(frozen=True)
class Stage:
    """A stage as it was reached: after `time_s` simulated seconds, at `place`, by `trail` in metres until then."""

    name: str
    time_s: float
    place: Place
    trail: tuple[tuple[float, float], ...]


@dataclass
class Stages:
    """Watches one run; `reached` has each stage once, in the order of the run."""

    contender: Contender
    parts: Parts
    reached: list[Stage] = field(default_factory=list)
    _trail: list[tuple[float, float]] = field(default_factory=list)

    def look(self, now: float, low_battery: bool) -> None:
        """After a tick of the mind."""
        place = self._place()
        if not self._trail or math.dist(self._trail[-1], place[:2]) >= TRAIL_EVERY_M:
            self._trail.append(place[:2])
        for name in self._holding(place, low_battery):
            if name not in self._names:
                self.reached.append(Stage(name, now, place, tuple(self._trail)))

    @property
    def _names(self) -> set[str]:
        return {stage.name for stage in self.reached}

    def _moved_on(self, name: str, place: Place) -> bool:
        """Away from where this stage was reached, if it was."""
        return any(stage.name == name and math.dist(stage.place[:2], place[:2]) >= MOVED_ON_M for stage in self.reached)

    def _holding(self, place: Place, low_battery: bool) -> list[str]:
        """The stages that are reached by now; those before the mail is aboard do not count."""
        if not (COLLECTED in self._names or self.contender.has_collected(self.parts)):
            return []
        docked = self.parts.robot is not None and self.parts.robot.docked
        holds = {
            COLLECTED: True,
            POST_POINT: self.parts.navigator.visited[-1:] not in ([], [SENDER]),
            TURNED: self._has_turned(place),
            INTERRUPTED: low_battery,
            CHARGING: docked,
            PROCEEDING: self._moved_on(CHARGING, place),
        }
        return [name for name in NAMES if holds[name]]

    def _has_turned(self, place: Place) -> bool:
        """Away from the first post point on its way, looking elsewhere than when it was detected."""
        post = next((stage for stage in self.reached if stage.name == POST_POINT), None)
        if post is None or not self._moved_on(POST_POINT, place):
            return False
        return abs(math.remainder(place[2] - post.place[2], math.tau)) >= TURNED_RAD

    def _place(self) -> Place:
        assert self.parts.robot is not None
        pose = self.parts.robot.pose
        return pose.x_m, pose.y_m, pose.heading_rad
