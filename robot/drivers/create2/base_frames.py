"""One frame of the base as a state with names and units, and what must not get lost between two looks at it."""

from collections.abc import Mapping
from dataclasses import replace

from robot.drivers.interfaces import BaseState, ChargingState, Mode

PRESSED_FOR_S = 0.3
"""A press of a button is shown at least so long: a loop that looks ten times a second must see it."""
BUTTONS = 0b111


def state_of(raw: Mapping[str, int], counts: tuple[int, int], mode: Mode, now: float) -> BaseState:
    """`raw` has the fields of `open_interface.STREAMED`; counts and mode have been judged before."""
    bumps, chargers = raw["bumps_and_drops"], raw["chargers"]
    return BaseState(
        at_s=now,
        left_count=counts[0],
        right_count=counts[1],
        bump_left=bool(bumps & 2),
        bump_right=bool(bumps & 1),
        wheel_drop_left=bool(bumps & 8),
        wheel_drop_right=bool(bumps & 4),
        cliff_left=bool(raw["cliff_left"]),
        cliff_front_left=bool(raw["cliff_front_left"]),
        cliff_front_right=bool(raw["cliff_front_right"]),
        cliff_right=bool(raw["cliff_right"]),
        over_currents=raw["over_currents"],
        buttons=raw["buttons"],
        light_bumpers=raw["light_bumpers"],
        charging_state=_charging_state(raw["charging_state"]),
        home_base=bool(chargers & 2),
        internal_charger=bool(chargers & 1),
        mode=mode,
        song_playing=bool(raw["song_playing"]),
        voltage_mv=raw["voltage_mv"],
        current_ma=raw["current_ma"],
        temperature_c=raw["temperature_c"],
        charge_mah=raw["charge_mah"],
        capacity_mah=raw["capacity_mah"],
        ir_omni=raw["ir_omni"],
        ir_left=raw["ir_left"],
        ir_right=raw["ir_right"],
        left_motor_ma=raw["left_motor_ma"],
        right_motor_ma=raw["right_motor_ma"],
        stasis=raw["stasis"],
    )


def together(earlier: BaseState | None, later: BaseState) -> BaseState:
    """The later state, with the touches and buttons of an earlier one that was never read."""
    if earlier is None:
        return later
    return replace(
        later,
        bump_left=earlier.bump_left or later.bump_left,
        bump_right=earlier.bump_right or later.bump_right,
        wheel_drop_left=earlier.wheel_drop_left or later.wheel_drop_left,
        wheel_drop_right=earlier.wheel_drop_right or later.wheel_drop_right,
        cliff_left=earlier.cliff_left or later.cliff_left,
        cliff_front_left=earlier.cliff_front_left or later.cliff_front_left,
        cliff_front_right=earlier.cliff_front_right or later.cliff_front_right,
        cliff_right=earlier.cliff_right or later.cliff_right,
        buttons=earlier.buttons | later.buttons,
    )


class HeldButtons:
    """Clean, Spot and Dock, each shown long enough to be seen."""

    def __init__(self) -> None:
        self._until_s = dict.fromkeys((1, 2, 4), 0.0)
        self._down = 0

    def seen(self, buttons: int, now: float) -> int:
        """Bits 0 to 2, held for a while after they went down; the other buttons are not on a Create 2's top."""
        pressed, self._down = buttons & ~self._down, buttons
        held = buttons & BUTTONS
        for bit, until_s in self._until_s.items():
            if pressed & bit:
                self._until_s[bit] = now + PRESSED_FOR_S
            elif now < until_s:
                held |= bit
        return held


def _charging_state(number: int) -> ChargingState:
    return ChargingState(number) if number <= ChargingState.FAULT else ChargingState.FAULT
