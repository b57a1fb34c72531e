"""A person pushes a robot over the tape, to and fro, so that each diode meets it."""

import math
from collections.abc import Iterator
from contextlib import contextmanager

from robot.simulated.robot import SimulatedRobot
from robot.simulated.start import Pose

HALF_WAY_MM = 40.0
SHOVE_MM, SHOVE_EVERY_S = 10.0, 0.03


@contextmanager
def pushed_over_the_tape(robot: SimulatedRobot) -> Iterator[None]:
    """Turn it across the tape that it stands on, shove it while the world goes on, and put it back in the end."""
    stood = robot.pose
    across_rad = stood.heading_rad + math.pi / 2
    back_m = (robot.body.pins.mount.lead_mm + HALF_WAY_MM) / 1000
    x_m, y_m = stood.x_m - back_m * math.cos(across_rad), stood.y_m - back_m * math.sin(across_rad)
    robot.place(Pose(x_m, y_m, across_rad))
    hands = _Hands(robot)
    robot.before_steps.append(hands.shove)
    try:
        yield
    finally:
        robot.before_steps.remove(hands.shove)
        robot.place(stood)


class _Hands:
    def __init__(self, robot: SimulatedRobot) -> None:
        self._robot, self._shoved_s, self._way_mm, self._sign = robot, robot.now, 0.0, 1

    def shove(self) -> None:
        """Called between two steps of the world."""
        if self._robot.now - self._shoved_s < SHOVE_EVERY_S:
            return
        self._shoved_s = self._robot.now
        self._robot.push(self._sign * SHOVE_MM)
        self._way_mm += SHOVE_MM
        if self._way_mm >= 2 * HALF_WAY_MM:
            self._way_mm, self._sign = 0.0, -self._sign
