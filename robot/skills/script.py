"""Skills written as scripts: a generator yields what to do until the next tick and is sent the next view.

def script(self, view):
    view = yield from roll(view, 300.0, WheelSpeeds(-100, -100))
    return Done()
"""

import math
from collections.abc import Callable, Generator
from typing import ClassVar

from robot.drivers.interfaces import STOP, BodyShape, WheelSpeeds
from robot.skills.interfaces import Outcome, Running, Step, View

Script = Generator[Running, View, Outcome]
Part = Generator[Running, View, View]
"""A piece of a script: returns the view at its end."""

STAND_S = 0.25
"""Four time constants of the wheels (60 ms each): after that they stand."""
STAND_FROM_SLOW_S = 0.14
"""After the slow end of a turn: less than half a millimetre is left to roll."""
SLOW_TURN_MM_S = 35.0
TURN_LAG_S = 0.07
SLOW_BELOW_RAD = 0.28


class Scripted:
    """A skill whose `script` says in reading order what it does."""

    name: ClassVar[str]
    moves: ClassVar[bool] = True
    on_timeout: ClassVar[str] = "timeout"
    limit_s: float = 60.0

    def script(self, view: View) -> Script:
        """Return the steps, from the first view on."""
        raise NotImplementedError

    def start(self, view: View, now: float) -> None:
        """See `interfaces.Skill.start`."""
        self._script = self.script(view)
        self._begun = False

    def step(self, view: View, now: float) -> Step:
        """See `interfaces.Skill.step`."""
        try:
            if self._begun:
                return self._script.send(view)
            self._begun = True
            return next(self._script)
        except StopIteration as end:
            outcome: Outcome = end.value
            return outcome


def stand(view: View, for_s: float = STAND_S) -> Part:
    """Keep the wheels still for so long."""
    until_s = view.at_s + for_s
    while view.at_s < until_s:
        view = yield Running(STOP)
    return view


def roll(view: View, distance_mm: float, speeds: WheelSpeeds, until: Callable[[View], bool] = lambda _: False) -> Part:
    """Drive so far, forwards or backwards, then stand; `until` ends it sooner."""
    from_mm = view.odometry.travelled_mm
    while view.odometry.travelled_mm - from_mm < distance_mm and not until(view):
        view = yield Running(speeds)
    return (yield from stand(view))


def turn_by(
    view: View, angle_rad: float, speed_mm_s: float, shape: BodyShape, until: Callable[[View], bool] = lambda _: False
) -> Part:
    """Turn on the spot (left is positive) by the encoders, slower towards the end, then stand."""
    goal_rad = view.odometry.heading_rad + angle_rad
    side = math.copysign(1.0, angle_rad)
    speed = 0.0
    while (left_rad := side * (goal_rad - view.odometry.heading_rad)) > 0 and not until(view):
        speed = speed_mm_s if left_rad > SLOW_BELOW_RAD else max(SLOW_TURN_MM_S, speed_mm_s * left_rad / SLOW_BELOW_RAD)
        if left_rad < speed * 2 / shape.wheel_base_mm * TURN_LAG_S:
            break
        view = yield Running(WheelSpeeds(-side * speed, side * speed))
    return (yield from stand(view, STAND_FROM_SLOW_S if speed <= SLOW_TURN_MM_S else STAND_S))
