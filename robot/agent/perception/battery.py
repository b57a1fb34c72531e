"""The battery as the agent perceives it: low, ok or full, with hysteresis so that it does not flicker."""

from dataclasses import dataclass, replace
from enum import StrEnum

from robot.core.config import BatterySettings
from robot.drivers.interfaces import BaseState, ChargingState


class BatteryLevel(StrEnum):
    """The paper's words."""

    LOW = "low"
    OK = "ok"
    FULL = "full"


_CHARGER_IS_DONE = frozenset({ChargingState.TRICKLE, ChargingState.WAITING})


@dataclass(frozen=True)
class BatterySense:
    """The word believed now. `done_since_s` is when the charger on the dock began to say that it is done."""

    word: BatteryLevel = BatteryLevel.OK
    ratio: float | None = None
    done_since_s: float | None = None
    weak: bool = False
    """Less charge than work is begun with."""

    def has(self, ratio: float) -> bool:
        """So much charge, or as much as the charger gives it."""
        return self.word is BatteryLevel.FULL or (self.ratio is not None and self.ratio >= ratio)

    def seen(self, base: BaseState, settings: BatterySettings, now: float) -> "BatterySense":
        """After one more frame of the base. A base that does not know its capacity yet changes nothing.

        A worn pack never reaches 0.99, and a computer fed from the battery drains it under trickle charge: so a charger
        that says "done" for a minute counts as full as well (facts of the Create 2: trap 1).
        """
        done = base.docked and base.charging_state in _CHARGER_IS_DONE
        since_s = (now if self.done_since_s is None else self.done_since_s) if done else None
        ratio = base.battery_ratio
        if ratio is None:
            return replace(self, done_since_s=since_s)
        charger_done = since_s is not None and now - since_s >= settings.full_after_s
        word = _word(self.word, ratio, charger_done, settings)
        enough = settings.start_ratio + (settings.hysteresis_ratio if self.weak else 0.0)
        return BatterySense(word, ratio, since_s, weak=ratio < enough and word is not BatteryLevel.FULL)


def _word(before: BatteryLevel, ratio: float, charger_done: bool, settings: BatterySettings) -> BatteryLevel:
    if ratio >= settings.full_ratio or charger_done:
        return BatteryLevel.FULL
    until = settings.low_ratio + (settings.hysteresis_ratio if before is BatteryLevel.LOW else 0.0)
    return BatteryLevel.LOW if ratio < until else BatteryLevel.OK
