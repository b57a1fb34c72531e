"""One frame of the base as a state with names and units."""

from collections.abc import Mapping

from .interfaces import BaseState, ChargingState, Mode


def state_of(raw: Mapping[str, int], mode: Mode, now: float) -> BaseState:
    """`raw` has the fields of `open_interface.STREAMED`; the mode is told apart, since firmwares disagree on it."""
    bumps, chargers = raw["bumps_and_drops"], raw["chargers"]
    return BaseState(
        at_s=now,
        left_count=raw["left_count"],
        right_count=raw["right_count"],
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


def _charging_state(number: int) -> ChargingState:
    return ChargingState(number) if number <= ChargingState.FAULT else ChargingState.FAULT
