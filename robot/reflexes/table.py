"""The fault table: what is wrong, what the body does at once, what clears it, and what people are told.

The agent perceives each as `fault(name)`, and `halted` while one of those with `halts` lasts. A test compares the table
with docs/reference/faults.md.
"""

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from typing import Final

from robot.drivers.interfaces import BaseState
from robot.reflexes.senses import Senses

SILENCE_S = 1.0
BASE_SILENT_S = 0.5
CAMERA_STALE_S = 1.0
CAMERA_FROZEN_S = 1.0
CAMERA_LOST_S = 60.0
"""Opening it again (once a second) would have helped by then: what hangs for a minute needs a hand."""
OFFLINE_S = 10.0
SLIPPING_S = 2.0
CONSTANT_MM = 3000.0
"""No robot drives so straight: the true size of the wheels alone carries the diodes over an edge of the tape before."""
BLIND_MM = 15_000.0
"""No line at all for so long: all the rungs of a search together are half as long."""
IMPOSSIBLE_MM = 300.0
CRITICAL_RATIO, CRITICAL_MV = 0.10, 12_500
"""create2.md section 8, after field reports; it counts as critical until 3 % and 0.7 V above that."""
RECOVERED_RATIO, RECOVERED_MV = 0.13, 13_200


class Response(Enum):
    """The effect on the wheels."""

    STOP = "stand"
    BACK_OFF = "stand, go back 80 mm with a beep, stand"
    REFUSE_FORWARD = "nothing forward; turning and going back are possible"
    NOTHING = "go on"


def _never(_: Senses) -> bool:
    return False


@dataclass(frozen=True, slots=True)
class Fault:
    """One line of the table."""

    name: str
    """Also the percept: `fault(name)`."""
    present: Callable[[Senses], bool]
    response: Response
    after_s: float
    """It must last so long before it counts."""
    clears_s: float | None
    """It clears so long after the cause has gone; None: only when a person re-arms the robot."""
    stands_within_s: float | None
    """The wheels stand so long after the cause at the latest, run-down included; None: they go on."""
    cleared_by: str
    """What ends it, in words."""
    told: str
    """What people are told."""
    halts: bool = False
    """A plan cannot drive out of it: a technician has to see to the robot."""
    from_firmware: bool = False
    """It also takes the wheels from the firmware when that docks by itself."""
    stays: Callable[[Senses], bool] = _never
    """Once active, this keeps it so: hysteresis."""


def _on_the_floor(senses: Senses) -> BaseState | None:
    """The base, unless a charger feeds it."""
    base = senses.base
    return None if base is None or base.docked or base.internal_charger else base


def _below(base: BaseState, ratio: float, voltage_mv: int) -> bool:
    """A capacity of 0 and a voltage of 0 are what a base says that does not know them yet."""
    charge = base.battery_ratio
    return (charge is not None and charge < ratio) or 0 < base.voltage_mv < voltage_mv


def _battery_critical(senses: Senses) -> bool:
    base = _on_the_floor(senses)
    return base is not None and _below(base, CRITICAL_RATIO, CRITICAL_MV)


def _battery_still_critical(senses: Senses) -> bool:
    base = _on_the_floor(senses)
    return base is not None and _below(base, RECOVERED_RATIO, RECOVERED_MV)


def _camera_lost(senses: Senses) -> bool:
    return senses.camera_age_s + senses.camera_frozen_s > CAMERA_LOST_S


def _line_sensor(senses: Senses) -> bool:
    if senses.diodes_broken or senses.impossible_mm > IMPOSSIBLE_MM:
        return True
    return senses.constant_mm > (CONSTANT_MM if senses.sees_line else BLIND_MM)


FAULTS: Final[tuple[Fault, ...]] = (
    Fault(
        "emergency_stop",
        lambda s: s.stop_asked or (s.base is not None and s.base.clean_pressed),
        Response.STOP,
        after_s=0.0,
        clears_s=None,
        stands_within_s=0.5,
        cleared_by="a person re-arms the robot",
        told="A person stopped the robot. It goes on when it is re-armed.",
        halts=True,
        from_firmware=True,
    ),
    Fault(
        "wheel_drop",
        lambda s: s.base is not None and s.base.wheel_drop,
        Response.STOP,
        after_s=0.0,
        clears_s=None,
        stands_within_s=0.5,
        cleared_by="a person re-arms the robot",
        told="The robot was lifted, or a wheel hung in the air. It goes on when it is re-armed.",
        halts=True,
        from_firmware=True,
    ),
    Fault(
        "cliff",
        lambda s: s.base is not None and s.base.cliff,
        Response.STOP,
        after_s=0.0,
        clears_s=None,
        stands_within_s=0.5,
        cleared_by="a person re-arms the robot",
        told="The robot stands before a drop. Please put it back on the line and re-arm it.",
        halts=True,
        from_firmware=True,
    ),
    Fault(
        "base_silent",
        lambda s: s.base_age_s > BASE_SILENT_S,
        Response.STOP,
        after_s=0.0,
        clears_s=0.0,
        # It hears us or it does not: a base that is gone altogether goes on as it was told last.
        stands_within_s=1.0,
        cleared_by="the first word of the base",
        told="The drive base does not answer.",
        from_firmware=True,
    ),
    Fault(
        "agent_silent",
        lambda s: s.mind_age_s > SILENCE_S,
        Response.STOP,
        after_s=0.0,
        clears_s=0.0,
        stands_within_s=1.5,
        cleared_by="the next thought",
        told="The robot's reasoning has stopped, so it stands.",
        from_firmware=True,
    ),
    Fault(
        "over_current",
        lambda s: s.base is not None and s.base.wheel_over_current and s.own_wheels,
        Response.STOP,
        after_s=0.5,
        clears_s=2.0,
        stands_within_s=1.0,
        cleared_by="2 s without it",
        told="Something blocks a wheel.",
        halts=True,
    ),
    Fault(
        "stall",
        lambda s: s.standing and s.own_wheels,
        Response.STOP,
        after_s=1.0,
        clears_s=3.0,
        stands_within_s=1.5,
        cleared_by="3 s of standing; then it tries again",
        told="A wheel does not turn although it should.",
        halts=True,
    ),
    Fault(
        "stasis",
        lambda s: s.slipping_s > SLIPPING_S and s.own_wheels,
        Response.STOP,
        after_s=0.0,
        clears_s=3.0,
        stands_within_s=3.0,
        cleared_by="3 s of standing; then it tries again",
        told="The wheels turn, but the robot does not move.",
        halts=True,
    ),
    Fault(
        "bump",
        lambda s: s.base is not None and s.base.bump and s.own_wheels,
        Response.BACK_OFF,
        after_s=0.0,
        clears_s=3.0,
        # Once it has gone back 80 mm, whether or not the bumper was let go.
        stands_within_s=1.8,
        cleared_by="3 s without a touch",
        told="Something stands in the robot's way.",
    ),
    Fault(
        "virtual_wall",
        lambda s: s.base is not None and s.base.virtual_wall and s.own_wheels,
        Response.REFUSE_FORWARD,
        after_s=0.0,
        clears_s=1.0,
        stands_within_s=0.5,
        cleared_by="1 s without the beam",
        told="The robot came to a virtual wall and does not pass it.",
    ),
    Fault(
        "camera_stale",
        lambda s: s.camera_age_s > CAMERA_STALE_S and not _camera_lost(s),
        Response.STOP,
        after_s=0.0,
        clears_s=0.0,
        stands_within_s=1.7,
        cleared_by="the next picture",
        told="The camera delivers no pictures, so the robot stands.",
    ),
    Fault(
        "camera_frozen",
        lambda s: s.camera_frozen_s > CAMERA_FROZEN_S and not _camera_lost(s),
        Response.STOP,
        after_s=0.0,
        clears_s=0.0,
        stands_within_s=1.7,
        cleared_by="another picture",
        told="The camera delivers the same picture again and again, so the robot stands.",
    ),
    Fault(
        "camera_lost",
        _camera_lost,
        Response.STOP,
        after_s=0.0,
        clears_s=2.0,
        # It has stood since the fault that this one takes over from.
        stands_within_s=61.5,
        cleared_by="2 s of new pictures",
        told="The camera has delivered no new picture for a minute. The robot stands until its camera is seen to.",
        halts=True,
    ),
    Fault(
        "line_sensor",
        _line_sensor,
        Response.STOP,
        after_s=0.0,
        clears_s=0.0,
        # Three metres at the slowest that it follows a line; the check is one of travel, not of time. A sensor that
        # sees nothing at all sends the robot on its searches first.
        stands_within_s=60.0,
        cleared_by="a diode changes, or a person re-arms the robot",
        told="The line sensor does not change over metres of travel. Please look at its diodes and its plug.",
        halts=True,
    ),
    Fault(
        "battery_critical",
        _battery_critical,
        Response.STOP,
        after_s=3.0,
        clears_s=5.0,
        stands_within_s=3.5,
        cleared_by="a charger, or 13 % and 13.2 V",
        told="The robot's battery is nearly empty, so it stands. Please carry it to a dock.",
        halts=True,
        stays=_battery_still_critical,
    ),
    Fault(
        "under_voltage",
        lambda s: s.host.under_voltage,
        Response.STOP,
        after_s=2.0,
        clears_s=10.0,
        stands_within_s=4.0,
        cleared_by="10 s of good supply",
        told="The robot's computer gets too little voltage. It stands before the computer fails.",
        halts=True,
    ),
    Fault(
        "clock_jump",
        lambda s: s.host.clock_jumped,
        Response.NOTHING,
        after_s=0.0,
        clears_s=60.0,
        stands_within_s=None,
        cleared_by="a minute without another jump",
        told="The robot's clock has jumped. Times that it told before may be wrong.",
    ),
    Fault(
        "disk_low",
        lambda s: s.host.disk_low,
        Response.NOTHING,
        after_s=0.0,
        clears_s=10.0,
        stands_within_s=None,
        cleared_by="room on the disk",
        told="The robot's disk is nearly full. Please delete what is not needed.",
    ),
    Fault(
        "link_loss",
        lambda s: s.offline_s > OFFLINE_S,
        Response.NOTHING,
        after_s=0.0,
        clears_s=0.0,
        stands_within_s=None,
        cleared_by="the next connection",
        told="The robot is out of the network. It goes on with what it may do.",
    ),
)

TOLD: Final = {fault.name: fault.told for fault in FAULTS}
LATCHED: Final = frozenset(fault.name for fault in FAULTS if fault.clears_s is None)
"""Only a person ends these, not even a restart does."""
HALTING: Final = frozenset(fault.name for fault in FAULTS if fault.halts)
"""Faults that a plan cannot drive out of: a technician has to see to them."""
STOPPING: Final = frozenset(fault.name for fault in FAULTS if fault.response is Response.STOP)
REFUSING: Final = frozenset(fault.name for fault in FAULTS if fault.response is Response.REFUSE_FORWARD)
