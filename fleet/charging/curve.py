"""The charging curve: as fast as the charger can, and ever slower near full."""

from dataclasses import dataclass, replace
from math import exp, log
from typing import Final

KNEE: Final = 0.85
"""Up to here charge comes at full current [assumed; NiMH and Li-ion packs are alike in this]."""
FULL: Final = 0.99
_WEIGHT: Final = 0.2
_ODD: Final = 3.0
"""What takes so many times longer or shorter than expected was something else than charging."""
_KNOWS_FROM_S: Final = 600.0


@dataclass(frozen=True, slots=True)
class ChargeCurve:
    """One robot's. `fill_s`: from nothing to full."""

    fill_s: float

    @property
    def per_s(self) -> float:
        """At full current."""
        return (KNEE + (1 - KNEE) * log((1 - KNEE) / (1 - FULL))) / self.fill_s

    def time_s(self, ratio: float, wanted: float) -> float:
        """From one charge to another; nothing if it has that. No more than `FULL` is ever reached."""
        wanted = min(wanted, FULL)
        if wanted <= ratio:
            return 0.0
        even_s = max(0.0, min(wanted, KNEE) - ratio) / self.per_s
        from_left = 1 - max(ratio, KNEE)
        return even_s + (self._slow_s * log(from_left / (1 - wanted)) if wanted > KNEE else 0.0)

    def after(self, ratio: float, time_s: float) -> float:
        """The charge after so long in the dock."""
        even_s = max(0.0, KNEE - ratio) / self.per_s
        if time_s <= even_s:
            return ratio + time_s * self.per_s
        left = (1 - max(ratio, KNEE)) * exp(-(time_s - even_s) / self._slow_s)
        return max(ratio, min(FULL, 1 - left))

    def learned(self, ratio: float, reached: float, time_s: float) -> "ChargeCurve":
        """After it was seen to charge from the one to the other in so long."""
        expected_s = self.time_s(ratio, reached)
        if time_s < _KNOWS_FROM_S or not time_s / _ODD < expected_s < time_s * _ODD:
            return self
        return replace(self, fill_s=self.fill_s * (1 + _WEIGHT * (time_s / expected_s - 1)))

    @property
    def _slow_s(self) -> float:
        return (1 - KNEE) / self.per_s


ASSUMED: Final = ChargeCurve(10_800.0)
"""Three hours to fill a pack."""
