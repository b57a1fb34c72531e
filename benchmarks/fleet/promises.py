"""What people are told in a simulation, and what came of it: as `app/estimates/learning.py` keeps it."""

from dataclasses import dataclass, field
from random import Random

from app.estimates.calibration import Basis, Calibrations
from app.estimates.durations import Durations, Kind, Thing
from app.estimates.forecast import Chance, Handling
from app.estimates.intervals import Interval
from app.estimates.score import Truth
from app.traffic.network import Lane


@dataclass(frozen=True)
class Promise:
    """`placed_s`: when it was made."""

    placed_s: float
    basis: Basis
    raw: Interval
    told: Interval
    by_map: Interval


@dataclass
class Promises:
    """`scored`: each truth that came, beside what was told of it; `raw`: beside what was worked out."""

    durations: Durations = field(default_factory=Durations)
    calibrations: Calibrations = field(default_factory=Calibrations)
    scored: list[Truth] = field(default_factory=list)
    raw: list[Truth] = field(default_factory=list)
    _open: dict[str, Promise] = field(default_factory=dict)

    def drove(self, lane: Lane, seconds: float) -> None:
        self.durations.observe(corridor(lane), seconds)

    def make(self, key: str, now_s: float, basis: Basis, raw: Interval, by_map: Interval) -> None:
        told = self.calibrations.of[basis].corrected(raw)
        self._open[key] = Promise(now_s, basis, raw, told, by_map)

    def came(self, key: str, now_s: float) -> None:
        """A robot is at its recipient's with this mail."""
        promise = self._open.pop(key, None)
        if promise is None:
            return
        truth_s = now_s - promise.placed_s
        self.calibrations.of[promise.basis].learn(promise.raw, promise.told, truth_s)
        self.scored.append(Truth(promise.told, promise.by_map, truth_s))
        self.raw.append(Truth(promise.raw, promise.by_map, truth_s))

    def chance(self, rng: Random, now_s: float, handling_s: Handling) -> Chance:
        """Corridors as they have lately been."""
        durations = self.durations
        return Chance(
            lambda _, lane: durations.draw_s(corridor(lane), rng),
            handling_s,
            lambda _, lane, entered_s: entered_s + durations.draw_s(corridor(lane), rng, now_s - entered_s),
        )


def corridor(lane: Lane) -> Thing:
    return Thing(Kind.CORRIDOR, f"{lane.start} {lane.end}", lane.travel_s)


def handling(kind: Kind, *, is_attended: bool, assumed_s: float) -> Thing:
    return Thing(kind, "attended" if is_attended else "not attended", assumed_s)
