"""Two wheels and where they take the robot.

Figures: wheel base 235.0 mm, wheel 72.0 mm, 508.8 counts per turn ([S], manual p. 30 ff.); lag and ripple [A] after the
field report that 1 s at 200 mm/s covers 185 to 190 mm.
"""

import math
from dataclasses import dataclass
from random import Random

WHEEL_BASE_MM = 235.0
MM_PER_COUNT = 0.44456
TOP_SPEED_MM_S = 500
STANDSTILL_MM_S = 0.5
RIPPLE_EVERY_STEPS = 3  # the control loop of the base runs every 15 ms


@dataclass(frozen=True)
class Motion:
    """The accuracy of this robot's wheels. All [A].

    `wheel_error` is the standard deviation of each wheel's true size against its nominal one: the encoders do not see
    it, the floor does.
    """

    lag_s: float = 0.060
    ripple_mm_s: float = 10.0
    wheel_error: float = 0.02
    encoder_start: int = 0


class Wheel:
    """`speed_mm_s` and `counts` are what the encoder sees; `scale` turns them into distance on the floor."""

    def __init__(self, motion: Motion, step_s: float, random: Random) -> None:
        self.speed_mm_s = 0.0
        self.counts = float(motion.encoder_start)
        self.scale = 1.0 + random.gauss(0.0, motion.wheel_error)
        self._gain = 1.0 - math.exp(-step_s / motion.lag_s)
        self._step_s = step_s
        self._ripple = motion.ripple_mm_s
        self._ripple_mm_s = 0.0
        self._direction = 1
        self._random = random
        self._steps = 0

    def step(self, target_mm_s: float) -> float:
        """One step towards the commanded speed; the way rolled over the floor in mm, forward positive."""
        speed = self.speed_mm_s
        if not target_mm_s and not speed:
            # Pushed by hand, a resting wheel counts up: the encoder knows no direction of its own [S].
            self._direction = 1
            return 0.0
        speed += (target_mm_s - speed) * self._gain
        if not target_mm_s and abs(speed) < STANDSTILL_MM_S:
            speed = 0.0
        self.speed_mm_s = speed
        rolled_mm = (speed + self._next_ripple(target_mm_s)) * self._step_s
        if target_mm_s:
            # The sign of the counts is that of the command, whatever the wheel still does [S]; while it runs down
            # after a stop it keeps the last one [A].
            self._direction = 1 if target_mm_s > 0 else -1
        self.counts += self._direction * abs(rolled_mm) / MM_PER_COUNT
        return rolled_mm * self.scale

    def _next_ripple(self, target_mm_s: float) -> float:
        if not target_mm_s:
            return 0.0
        self._steps += 1
        if self._steps % RIPPLE_EVERY_STEPS == 0:
            self._ripple_mm_s = (2 * self._random.random() - 1) * self._ripple
        return self._ripple_mm_s

    def push(self, distance_mm: float) -> None:
        """Turned by hand: whichever way, it counts in the direction of the last command, at rest up."""
        self.counts += self._direction * abs(distance_mm) / MM_PER_COUNT

    @property
    def encoder(self) -> int:
        """Packets 43 and 44: modulo 65536."""
        return math.floor(self.counts) & 0xFFFF


class DriveBase:
    """The pose is the middle between the wheels, in metres and radians of the map's frame."""

    def __init__(self, motion: Motion, step_s: float, random: Random) -> None:
        self.left = Wheel(motion, step_s, random)
        self.right = Wheel(motion, step_s, random)
        self.x_m = 0.0
        self.y_m = 0.0
        self.heading_rad = 0.0
        self.driven_mm = 0.0
        # For packets 19 and 20, which tell the way since they were last asked.
        self.untold_mm = 0.0
        self.untold_deg = 0.0

    def place(self, x_m: float, y_m: float, heading_rad: float) -> None:
        self.x_m, self.y_m, self.heading_rad = x_m, y_m, heading_rad

    def roll(self, left_mm_s: float, right_mm_s: float) -> tuple[float, float]:
        """One step of both wheels: (mm ahead, radians to the left) that the body would do if nothing held it."""
        left_mm, right_mm = self.left.step(left_mm_s), self.right.step(right_mm_s)
        return (left_mm + right_mm) / 2, (right_mm - left_mm) / WHEEL_BASE_MM

    def ahead(self, ahead_mm: float, turn_rad: float) -> tuple[float, float]:
        """Where the robot would be after this step."""
        middle = self.heading_rad + turn_rad / 2
        return self.x_m + ahead_mm / 1000 * math.cos(middle), self.y_m + ahead_mm / 1000 * math.sin(middle)

    def move(self, x_m: float, y_m: float, ahead_mm: float, turn_rad: float) -> None:
        self.x_m, self.y_m = x_m, y_m
        self.heading_rad = (self.heading_rad + turn_rad + math.pi) % math.tau - math.pi
        self.driven_mm += abs(ahead_mm)
        self.untold_mm += ahead_mm
        self.untold_deg += math.degrees(turn_rad)

    def push(self, ahead_mm: float) -> None:
        """A person shoves the robot along its heading."""
        self.left.push(ahead_mm)
        self.right.push(ahead_mm)
        self.move(*self.ahead(ahead_mm, 0.0), ahead_mm, 0.0)

    def jam(self) -> None:
        """Both wheels are held fast: they neither turn nor count."""
        self.left.speed_mm_s = self.right.speed_mm_s = 0.0

    @property
    def moving(self) -> bool:
        return bool(self.left.speed_mm_s or self.right.speed_mm_s)
