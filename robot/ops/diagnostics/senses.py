"""The body as a person looks at it: what is pressed, hangs, is near; where the line is; how punctual the loops are."""

from collections.abc import Mapping
from typing import Final

from protocol.diagnostics import Bump, Drop, Light, LoopTiming, Sensors
from robot.drivers.interfaces import BaseState
from robot.ops.runners import Lag
from robot.skills.interfaces import View

LIGHTS: Final[tuple[Light, ...]] = ("left", "front_left", "centre_left", "centre_right", "front_right", "right")
DROPS: Final[tuple[Drop, ...]] = (
    *("wheel_left", "wheel_right", "cliff_left", "cliff_front_left", "cliff_front_right", "cliff_right"),
)
NOTHING_HEARD: Final = BaseState(at_s=0.0)


def sensors(view: View) -> Sensors:
    """From the newest view; of a base that has never spoken nothing is claimed."""
    base, heard = view.base or NOTHING_HEARD, view.base is not None
    return Sensors(
        mode=base.mode.name.lower() if heard else None,
        docked=base.docked,
        charging_state=base.charging_state.name.lower() if heard else None,
        voltage_mv=base.voltage_mv if heard else None,
        current_ma=base.current_ma if heard else None,
        temperature_c=base.temperature_c if heard else None,
        base_age_s=round(view.at_s - base.at_s, 2) if heard else None,
        camera_age_s=round(view.camera_age_s, 2) if view.camera_age_s < 1e6 else None,
        bumps=_bumps(base),
        drops=_drops(base),
        light_bumpers=tuple(name for bit, name in enumerate(LIGHTS) if base.light_bumpers & 1 << bit),
        line=(bool(view.reading.left), bool(view.reading.centre), bool(view.reading.right)),
        line_word=str(view.line),
        wheels_mm_s=(round(view.sent.left_mm_s, 1), round(view.sent.right_mm_s, 1)),
        skill=view.motion,
        faults=tuple(sorted(view.faults)),
    )


def _bumps(base: BaseState) -> tuple[Bump, ...]:
    return (*(("left",) if base.bump_left else ()), *(("right",) if base.bump_right else ()))


def _drops(base: BaseState) -> tuple[Drop, ...]:
    wheels = (base.wheel_drop_left, base.wheel_drop_right)
    felt = (*wheels, base.cliff_left, base.cliff_front_left, base.cliff_front_right, base.cliff_right)
    return tuple(name for name, is_felt in zip(DROPS, felt, strict=True) if is_felt)


def timings(lags: Mapping[str, Lag]) -> tuple[LoopTiming, ...]:
    """Each loop's punctuality."""
    return tuple(
        LoopTiming(
            name=name,
            ticks=lag.ticks,
            late_p50_ms=round(1000 * lag.share_s(0.5), 2),
            late_p99_ms=round(1000 * lag.share_s(0.99), 2),
            late_worst_ms=round(1000 * lag.worst_s, 2),
        )
        for name, lag in lags.items()
    )
