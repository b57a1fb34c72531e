"""The pure function that reads the table: what was felt and remembered in, what may be driven out."""

from collections.abc import Container
from dataclasses import dataclass, replace

from robot.drivers.interfaces import STOP, WheelSpeeds
from robot.reflexes.senses import Senses
from robot.reflexes.table import FAULTS, LATCHED, Fault, Response

BUMP_STAND_S = 0.2
BACK_OFF = WheelSpeeds(-80, -80)
BACK_OFF_S = 1.0


@dataclass(frozen=True, slots=True)
class FaultMemory:
    """One fault through time, in seconds; None: not so at present."""

    present_since_s: float | None = None
    active_since_s: float | None = None
    last_present_s: float = 0.0


_FORGOTTEN = FaultMemory()


@dataclass(frozen=True, slots=True)
class ReflexState:
    """State that the reflexes keep from tick to tick, one entry for each line of the table."""

    memories: tuple[FaultMemory, ...] = (_FORGOTTEN,) * len(FAULTS)

    @classmethod
    def woken(cls, faults: Container[str], now: float) -> "ReflexState":
        """After a restart: those of `faults` that were latched before it still are."""
        latched = FaultMemory(active_since_s=now, last_present_s=now)
        return cls(tuple(latched if one.name in LATCHED and one.name in faults else _FORGOTTEN for one in FAULTS))


@dataclass(frozen=True, slots=True)
class Decision:
    """The permitted speeds, which faults are active, which of them hold the wheels, and what to remember."""

    allowed: WheelSpeeds
    faults: frozenset[str]
    stopping: frozenset[str]
    """Those that let nothing turn, neither our wheels nor the firmware's."""
    state: ReflexState


_NO_FAULT: frozenset[str] = frozenset()
_UNTROUBLED = ReflexState()


def decide(state: ReflexState, senses: Senses, wanted: WheelSpeeds, now: float) -> Decision:
    """Speeds that may be driven now. Stop wins over back off, back off over a wall, a wall over what is wanted."""
    if state is _UNTROUBLED and not any(fault.present(senses) for fault in FAULTS):
        return Decision(wanted, _NO_FAULT, _NO_FAULT, _UNTROUBLED)
    memories = tuple(
        _remember(fault, memory, senses, now) for fault, memory in zip(FAULTS, state.memories, strict=True)
    )
    active = [
        (fault, memory) for fault, memory in zip(FAULTS, memories, strict=True) if memory.active_since_s is not None
    ]
    kept = _UNTROUBLED if memories == _UNTROUBLED.memories else ReflexState(memories)
    if not active:
        return Decision(wanted, _NO_FAULT, _NO_FAULT, kept)
    # While the firmware drives, what concerns our own driving alone is told and stops nothing.
    acting = [(fault, memory) for fault, memory in active if senses.own_wheels or fault.from_firmware]
    names = frozenset(fault.name for fault, _ in active)
    stopping = frozenset(fault.name for fault, _ in acting if fault.response is Response.STOP)
    return Decision(_allowed(acting, wanted, now), names, stopping, kept)


def _remember(fault: Fault, memory: FaultMemory, senses: Senses, now: float) -> FaultMemory:
    active_s = memory.active_since_s
    if fault.present(senses) or (active_s is not None and fault.stays(senses)):
        since_s = now if memory.present_since_s is None else memory.present_since_s
        if active_s is None and now - since_s >= fault.after_s:
            active_s = now
        return FaultMemory(since_s, active_s, now)
    if active_s is None:
        return _FORGOTTEN
    cleared = senses.rearm if fault.clears_s is None else now - memory.last_present_s >= fault.clears_s
    return _FORGOTTEN if cleared else replace(memory, present_since_s=None)


def _allowed(acting: list[tuple[Fault, FaultMemory]], wanted: WheelSpeeds, now: float) -> WheelSpeeds:
    responses = {fault.response for fault, _ in acting}
    if Response.STOP in responses:
        return STOP
    if Response.BACK_OFF in responses:
        since_s = max(m.active_since_s or 0.0 for fault, m in acting if fault.response is Response.BACK_OFF)
        backing = BUMP_STAND_S <= now - since_s < BUMP_STAND_S + BACK_OFF_S
        return BACK_OFF if backing else STOP
    if Response.REFUSE_FORWARD in responses and wanted.left_mm_s + wanted.right_mm_s > 0:
        return STOP
    return wanted
