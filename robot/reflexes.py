"""What the body does without asking: one table, and one pure function that reads it.

It works when everything above is dead: it needs the newest frame of the base, two ages and the speeds that are wanted.
"""

from collections.abc import Callable, Container
from dataclasses import dataclass, replace
from enum import Enum, auto

from .drivers.interfaces import STOP, BaseState, WheelSpeeds

SILENCE_S = 1.0
BASE_SILENT_S = 0.5
CAMERA_STALE_S = 1.0
BUMP_STAND_S = 0.2
BACK_OFF = WheelSpeeds(-80, -80)
BACK_OFF_S = 1.0


@dataclass(frozen=True, slots=True)
class Senses:
    """What the reflexes judge by at one tick."""

    base: BaseState | None
    """Newest frame; None before the first."""
    base_age_s: float
    mind_age_s: float
    """Since the last heartbeat of the mind."""
    camera_age_s: float = 0.0
    stop_asked: bool = False
    """An emergency stop from the command line, the service or a person's page."""
    rearm: bool = False
    """Somebody has looked, and lets the robot go again."""
    own_wheels: bool = True
    """False while the firmware drives (docking touches the dock, which is no accident)."""


class Response(Enum):
    """What happens to the wheels."""

    STOP = auto()
    BACK_OFF = auto()
    """Stand, go back 80 mm, then stand until it clears."""
    NOTHING = auto()
    """Known and told, but the wheels go on."""


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
    """It clears so long after the cause has gone; None: only when somebody re-arms the robot."""
    told: str
    """What people are told."""


FAULTS: tuple[Fault, ...] = (
    Fault(
        "emergency_stop",
        lambda s: s.stop_asked or (s.base is not None and s.base.clean_pressed),
        Response.STOP,
        0.0,
        None,
        "Somebody stopped the robot. It goes on when it is re-armed.",
    ),
    Fault(
        "wheel_drop",
        lambda s: s.base is not None and s.base.wheel_drop,
        Response.STOP,
        0.0,
        None,
        "The robot was lifted, or a wheel hung in the air. It goes on when it is re-armed.",
    ),
    Fault(
        "cliff",
        lambda s: s.base is not None and s.base.cliff,
        Response.STOP,
        0.0,
        None,
        "The robot stands before a drop. Please put it back on the line and re-arm it.",
    ),
    Fault(
        "base_silent",
        lambda s: s.base is None or s.base_age_s > BASE_SILENT_S,
        Response.STOP,
        0.0,
        0.0,
        "The drive base does not answer.",
    ),
    Fault(
        "agent_silent",
        lambda s: s.mind_age_s > SILENCE_S,
        Response.STOP,
        0.0,
        0.0,
        "The robot's reasoning has stopped, so it stands.",
    ),
    Fault(
        "over_current",
        lambda s: s.base is not None and s.base.wheel_over_current and s.own_wheels,
        Response.STOP,
        0.5,
        2.0,
        "Something blocks a wheel.",
    ),
    Fault(
        "bump",
        lambda s: s.base is not None and s.base.bump and s.own_wheels,
        Response.BACK_OFF,
        0.0,
        3.0,
        "Something stands in the robot's way.",
    ),
    Fault(
        "camera_stale",
        lambda s: s.camera_age_s > CAMERA_STALE_S,
        Response.NOTHING,
        0.0,
        0.0,
        "The camera delivers no pictures.",
    ),
)


LATCHED = frozenset(fault.name for fault in FAULTS if fault.clears_s is None)
"""Only a person ends these, not even a restart does."""


@dataclass(frozen=True, slots=True)
class FaultMemory:
    """One fault through time, in seconds; None: not so at present."""

    present_since_s: float | None = None
    active_since_s: float | None = None
    last_present_s: float = 0.0


_FORGOTTEN = FaultMemory()


@dataclass(frozen=True, slots=True)
class ReflexState:
    """What the reflexes remember from tick to tick, one entry for each line of the table."""

    memories: tuple[FaultMemory, ...] = (_FORGOTTEN,) * len(FAULTS)

    @classmethod
    def woken(cls, faults: Container[str], now: float) -> "ReflexState":
        """After a restart: those of `faults` that were latched before it still are."""
        latched = FaultMemory(active_since_s=now, last_present_s=now)
        return cls(tuple(latched if one.name in LATCHED and one.name in faults else _FORGOTTEN for one in FAULTS))


@dataclass(frozen=True, slots=True)
class Decision:
    """What may be driven, which faults are active, and what to remember."""

    allowed: WheelSpeeds
    faults: frozenset[str]
    state: ReflexState


_NO_FAULT: frozenset[str] = frozenset()


def decide(state: ReflexState, senses: Senses, wanted: WheelSpeeds, now: float) -> Decision:
    """Speeds that may be driven now. Stop wins over back off, back off over what is wanted."""
    memories = tuple(
        _remember(fault, memory, senses, now) for fault, memory in zip(FAULTS, state.memories, strict=True)
    )
    active = [
        (fault, memory) for fault, memory in zip(FAULTS, memories, strict=True) if memory.active_since_s is not None
    ]
    if not active:
        return Decision(wanted, _NO_FAULT, ReflexState(memories))
    faults = frozenset(fault.name for fault, _ in active)
    return Decision(_allowed(active, wanted, now), faults, ReflexState(memories))


def _remember(fault: Fault, memory: FaultMemory, senses: Senses, now: float) -> FaultMemory:
    if fault.present(senses):
        since_s = now if memory.present_since_s is None else memory.present_since_s
        active_s = memory.active_since_s
        if active_s is None and now - since_s >= fault.after_s:
            active_s = now
        return FaultMemory(since_s, active_s, now)
    if memory.active_since_s is None:
        return _FORGOTTEN
    cleared = senses.rearm if fault.clears_s is None else now - memory.last_present_s >= fault.clears_s
    return _FORGOTTEN if cleared else replace(memory, present_since_s=None)


def _allowed(active: list[tuple[Fault, FaultMemory]], wanted: WheelSpeeds, now: float) -> WheelSpeeds:
    responses = {fault.response for fault, _ in active}
    if Response.STOP in responses:
        return STOP
    if Response.BACK_OFF in responses:
        since_s = max(m.active_since_s or 0.0 for fault, m in active if fault.response is Response.BACK_OFF)
        backing = BUMP_STAND_S <= now - since_s < BUMP_STAND_S + BACK_OFF_S
        return BACK_OFF if backing else STOP
    return wanted
