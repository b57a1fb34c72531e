"""The line sensor's pins: gpiozero's own mock pins, driven by what lies under three diodes.

Three photodiodes in a row, left to right; a pin is low over the tape (prototype: LTH1550-01, GPIO14, 15, 18 on header
pins 8, 10, 12 for right, centre, left). Spacing and lead are the technician's settings.
"""

import math
from dataclasses import dataclass
from random import Random

from gpiozero.pins.mock import MockFactory, MockPin

from robot.simulated.faults import Faults
from robot.simulated.floor import TAPE_WIDTH_M, Floor, distance_to_tape_m

KEPT_STATES = 1000


@dataclass(frozen=True)
class DiodeMount:
    """Where the diodes are: `lead_mm` ahead of the axle, `spacing_mm` from one to the next."""

    lead_mm: float = 60.0
    spacing_mm: float = 18.0
    left_pin: int = 18
    centre_pin: int = 15
    right_pin: int = 14


class DiodePin(MockPin):  # type: ignore[misc]  # gpiozero has no types
    """A mock pin that does not keep its whole history: a robot drives for days."""

    def _change_state(self, value: bool) -> bool:
        changed: bool = super()._change_state(value)
        if len(self.states) > KEPT_STATES:
            self.clear_states()
        return changed


class LinePins:
    """`factory` goes into every gpiozero device by name; it is never the global one."""

    def __init__(self, floor: Floor, mount: DiodeMount, faults: Faults, random: Random) -> None:
        self.factory = MockFactory(pin_class=DiodePin)
        self.mount = mount
        self._pins = tuple(self.factory.pin(pin) for pin in (mount.left_pin, mount.centre_pin, mount.right_pin))
        self._sides_m = tuple(side * mount.spacing_mm / 1000 for side in (1, 0, -1))
        self._floor = floor
        self._faults = faults
        self._random = random

    def drive(self, x_m: float, y_m: float, heading_rad: float) -> None:
        """Set the three pins for a robot at this pose."""
        if self._faults.pins_stuck:
            return
        for pin, reading in zip(self._pins, self.readings(x_m, y_m, heading_rad), strict=True):
            if pin.function == "input":
                pin.drive_high() if reading else pin.drive_low()

    def readings(self, x_m: float, y_m: float, heading_rad: float) -> list[int]:
        """Left, centre, right: 0 over the tape, 1 beside it."""
        along, across = math.cos(heading_rad), math.sin(heading_rad)
        lead_m = self.mount.lead_mm / 1000
        middle_x, middle_y = x_m + lead_m * along, y_m + lead_m * across
        tape = self._floor.near(middle_x, middle_y)
        if not tape and not self._faults.floor_flip:
            return [1, 1, 1]
        return [
            self._reading(distance_to_tape_m(tape, middle_x - side * across, middle_y + side * along))
            for side in self._sides_m
        ]

    def _reading(self, distance_m: float) -> int:
        beyond_mm = 1000 * (distance_m - TAPE_WIDTH_M / 2)
        reading = int(beyond_mm > 0)
        faults = self._faults
        if faults.floor_edge_mm and abs(beyond_mm) < faults.floor_edge_mm / 2:
            reading = int(self._random.random() < 0.5)
        if faults.floor_flip and self._random.random() < faults.floor_flip:
            reading = 1 - reading
        return reading

    def close(self) -> None:
        self.factory.close()
