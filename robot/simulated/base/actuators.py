"""Actuators of the base: wheels, brushes, lamps, digits, songs. Each method takes a command's data bytes.

Source [S] unless marked [A] (assumption).
"""

from collections.abc import Callable
from struct import unpack

from robot.simulated.base.drive_base import TOP_SPEED_MM_S, WHEEL_BASE_MM
from robot.simulated.base.packets import Readings
from robot.simulated.base.songs import SongBook

STRAIGHT = (0x7FFF, -0x8000)
TURN_RADIUS_OF_CLIFF_MM = 165
PWM_TOP = 255
BRUSH_MA = 300  # at full power [A]


class Actuators:
    """The wheels keep their speeds until told otherwise: there is no dead-man timer in the interface."""

    def __init__(self, readings: Readings) -> None:
        self.left_mm_s = 0.0
        self.right_mm_s = 0.0
        self.brushes: tuple[int, int, int] = (0, 0, 0)
        self.leds: tuple[int, int, int] = (0, 0, 0)
        self.digits = b"    "
        self.songs = SongBook()
        self._readings = readings

    def stop(self) -> None:
        self.roll(0, 0)
        self._brush(0, 0, 0)

    def roll(self, left_mm_s: float, right_mm_s: float) -> None:
        """Speeds beyond the range are cut to it [A]."""
        self.left_mm_s = min(max(left_mm_s, -TOP_SPEED_MM_S), TOP_SPEED_MM_S)
        self.right_mm_s = min(max(right_mm_s, -TOP_SPEED_MM_S), TOP_SPEED_MM_S)
        told = self._readings
        told.left_velocity_mm_s, told.right_velocity_mm_s = round(self.left_mm_s), round(self.right_mm_s)
        told.velocity_mm_s, told.radius_mm = 0, 0

    @property
    def cliff_counts(self) -> bool:
        """Return whether a cliff stops this movement: forward, or backward in a turn tighter than the robot itself."""
        left, right = self.left_mm_s, self.right_mm_s
        if not left and not right:
            return False
        if left + right > 0 or left == right:
            return left + right > 0
        radius_mm = WHEEL_BASE_MM / 2 * abs((right + left) / (right - left))
        return radius_mm < TURN_RADIUS_OF_CLIFF_MM

    def drive(self, data: bytes) -> None:
        velocity, radius = unpack(">hh", data)
        if radius in STRAIGHT or radius == 0:
            self.roll(velocity, velocity)
        elif abs(radius) == 1:
            self.roll(-radius * velocity, radius * velocity)
        else:
            share = WHEEL_BASE_MM / 2 / min(max(radius, -2000), 2000)
            self.roll(velocity * (1 - share), velocity * (1 + share))
        self._readings.velocity_mm_s = min(max(velocity, -TOP_SPEED_MM_S), TOP_SPEED_MM_S)
        self._readings.radius_mm = radius

    def drive_direct(self, data: bytes) -> None:
        right, left = unpack(">hh", data)
        self.roll(left, right)

    def drive_pwm(self, data: bytes) -> None:
        right, left = unpack(">hh", data)
        self.roll(left * TOP_SPEED_MM_S / PWM_TOP, right * TOP_SPEED_MM_S / PWM_TOP)

    def motors(self, data: bytes) -> None:
        bits = data[0]
        side = 127 if bits & 1 else 0
        main = 127 if bits & 4 else 0
        self._brush(-main if bits & 16 else main, -side if bits & 8 else side, 127 if bits & 2 else 0)

    def pwm_motors(self, data: bytes) -> None:
        self._brush(*unpack(">bbb", data))

    def _brush(self, main: int, side: int, vacuum: int) -> None:
        self.brushes = (main, side, vacuum)
        told = self._readings
        told.main_brush_ma, told.side_brush_ma = (round(abs(pwm) / 127 * BRUSH_MA) for pwm in (main, side))

    def set_leds(self, data: bytes) -> None:
        self.leds = (data[0], data[1], data[2])

    def set_digits(self, data: bytes) -> None:
        self.digits = data

    def song(self, data: bytes) -> None:
        self.songs.define(data[0], tuple(zip(data[2::2], data[3::2], strict=True)))

    def keep(self, _: bytes) -> None:
        """Scheduling lights and raw digits: taken, without an effect on a Create 2."""


ACTUATORS: dict[int, Callable[[Actuators, bytes], None]] = {
    137: Actuators.drive,
    138: Actuators.motors,
    139: Actuators.set_leds,
    140: Actuators.song,
    144: Actuators.pwm_motors,
    145: Actuators.drive_direct,
    146: Actuators.drive_pwm,
    162: Actuators.keep,
    163: Actuators.keep,
    164: Actuators.set_digits,
}
