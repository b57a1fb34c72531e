"""The plan of docks: which robot charges where and when, with fewer docks than robots.

**Every robot always has a dock that it comes to in time**, the one at work too. Work is accepted only together with
another such plan for all of them. A plan is ordered by who must charge first (earliest due first); no robot has to
keep to its times: who can charge earlier does.

Times are seconds of one clock.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple

from fleet.charging.curve import ChargeCurve
from fleet.charging.energy import Rates, Use
from fleet.charging.going_on import Charge
from fleet.charging.levels import Thresholds

_HOUR_S: Final = 3600.0


@dataclass(frozen=True, slots=True)
class Need:
    """A robot's need: `charge` at the least, at `ready_s` (now, or when its work is done), and the ways from there
    to the docks that it can get to. `dock` is the one that it stands in or is bound for, and `until` the charge with
    which it can be asked to leave again."""

    robot: str
    charge: Charge
    ready_s: float
    ways: Mapping[str, Use]
    dock: str | None = None
    until: float = 0.53


class Stay(NamedTuple):
    """From when a robot has a dock, and until when it cannot be asked to leave; `due_s`: when it must have come."""

    robot: str
    dock: str
    from_s: float
    until_s: float
    due_s: float

    @property
    def late_s(self) -> float:
        return max(0.0, self.from_s - self.due_s)


@dataclass(frozen=True, slots=True)
class DockPlan:
    """`homeless`: robots that no dock can be got to from."""

    stays: Mapping[str, Stay]
    homeless: tuple[str, ...] = ()

    @property
    def late_s(self) -> float:
        """Added up; 0: every robot comes to a dock in time."""
        return sum(stay.late_s for stay in self.stays.values())

    def slack_s(self, stay: Stay) -> float:
        """By so much it could begin later, and all that come to the same dock after it with it."""
        after = (one for one in self.stays.values() if one.dock == stay.dock and one.from_s >= stay.from_s)
        return min(one.due_s - one.from_s for one in after)


def plan_docks(
    needs: Sequence[Need], docks: Iterable[str], curve: ChargeCurve, thresholds: Thresholds, now_s: float
) -> DockPlan:
    """A dock for everybody, most urgent first; each at the dock where its stay begins earliest."""
    free_s = dict.fromkeys(docks, now_s)
    stays: dict[str, Stay] = {}
    for need in sorted(needs, key=_arrives_s):
        if need.dock is not None:
            has = _stay(need, need.dock, free_s.get(need.dock, now_s), curve, thresholds)
            stays[need.robot], free_s[need.dock] = has, has.until_s
    coming = [need for need in needs if need.dock is None]
    coming.sort(key=lambda one: (_last_due_s(one, thresholds), one.robot))
    # Mostly the first order is the best there is; but who is due first may be there last, and keep a dock empty.
    by_due = _coming(coming, stays, free_s, curve, thresholds)
    if by_due.late_s == 0.0:
        return by_due
    by_arrival = _coming(sorted(coming, key=lambda one: one.ready_s), stays, free_s, curve, thresholds)
    return min(by_due, by_arrival, key=lambda plan: plan.late_s)


def _coming(
    coming: Sequence[Need],
    docked: Mapping[str, Stay],
    free_from_s: Mapping[str, float],
    curve: ChargeCurve,
    thresholds: Thresholds,
) -> DockPlan:
    stays, free_s, homeless = dict(docked), dict(free_from_s), []
    for need in coming:
        stay = _best(need, free_s, curve, thresholds)
        if stay is None:
            homeless.append(need.robot)
        else:
            stays[need.robot], free_s[stay.dock] = stay, stay.until_s
    return DockPlan(stays, tuple(homeless))


def due_s(need: Need, way: Use, thresholds: Thresholds) -> float:
    """When it must be at a dock at the latest: before its own battery plan takes over, on the way there too."""
    rates = need.charge.rates
    spare = need.charge.ratio - thresholds.low - rates.at_most(way)
    return need.ready_s + way.time_s + spare / standing_per_s(rates)


def standing_per_s(rates: Rates) -> float:
    """Return the highest cost of a second of standing."""
    return rates.at_most(Use(0.0, _HOUR_S)) / _HOUR_S


def _arrives_s(need: Need) -> tuple[float, str]:
    way = need.ways.get(need.dock, Use()) if need.dock is not None else Use()
    return need.ready_s + way.time_s, need.robot


def _best(need: Need, free_s: Mapping[str, float], curve: ChargeCurve, thresholds: Thresholds) -> Stay | None:
    stays = [_stay(need, dock, free_s[dock], curve, thresholds) for dock in need.ways if dock in free_s]
    return min(stays, key=lambda stay: (stay.late_s, stay.from_s, stay.dock), default=None)


def _stay(need: Need, dock: str, free_s: float, curve: ChargeCurve, thresholds: Thresholds) -> Stay:
    rates, way = need.charge.rates, need.ways.get(dock, Use())
    arrives_s = need.ready_s + way.time_s
    from_s = max(free_s, arrives_s)
    ratio = need.charge.ratio - rates.at_most(way) - (from_s - arrives_s) * standing_per_s(rates)
    stay_s = curve.time_s(max(0.0, ratio), need.until)
    return Stay(need.robot, dock, from_s, from_s + stay_s, due_s(need, way, thresholds))


def _last_due_s(need: Need, thresholds: Thresholds) -> float:
    return max((due_s(need, way, thresholds) for way in need.ways.values()), default=need.ready_s)
