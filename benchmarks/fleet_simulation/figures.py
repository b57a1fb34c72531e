"""The figures of a run, as plain JSON."""

from collections.abc import Iterable
from typing import Any, Final

from app.eta.schemas import PromiseQuality
from benchmarks.fleet_simulation.judge import Meeting
from benchmarks.fleet_simulation.people import WITH_RECIPIENT, People
from benchmarks.fleet_simulation.simulation import Seen
from fleet.eta.intervals import quantile

AGE_LIMIT_S: Final = 6 * 3600.0
"""The service's (`app.dispatch.assignment_problem`): an order that has waited so long is fetched next."""
ALLOWANCE_S: Final = 3 * 3600.0
"""On top of it for the robot that comes: an empty pack's charge. It depends on no run."""


def figures(seen: Seen, robots: int) -> dict[str, Any]:
    """`stuck`: robots that waited for a corridor for two hours; `too_old`: orders fetched after age limit and
    allowance, or still waiting then."""
    judge, robot_hours = seen.judge, robots * seen.hours
    delivered = sum(place == WITH_RECIPIENT for place in seen.people.letters.values())
    return {
        "robot_hours": round(robot_hours, 1),
        "orders": len(seen.people.letters),
        "delivered": delivered,
        "delivered_an_hour": round(delivered / seen.hours, 3),
        "states": dict(sorted(seen.states.items())),
        "met": dict(sorted(judge.met.items())),
        "meetings": [_in_words(one) for one in judge.meetings],
        "arrivals": judge.arrivals,
        "in_the_way": len(judge.in_the_way),
        "stood_on_crossing": [
            f"{robot} on {place} until {until_s:.0f} s" for robot, place, until_s in judge.in_the_way[:20]
        ],
        "stuck": len(judge.stuck),
        "stuck_robots": [f"{robot} until {until_s:.0f} s" for robot, until_s in judge.stuck[:20]],
        "too_old": sum(age_s > AGE_LIMIT_S + ALLOWANCE_S for age_s in _ages_s(seen.people, seen.hours * 3600.0)),
        "astray": seen.astray,
        "waited_for_corridor_s": _spread(judge.waits_s),
        "order_to_loaded_s": _spread(_since_placed(seen.people, seen.people.loaded_s)),
        "order_to_delivered_s": _spread(_since_placed(seen.people, seen.people.ended_s)),
        "estimates": {"placed": _score(seen.estimates.placed), "under_way": _score(seen.estimates.under_way)},
        "befallen": dict(sorted(seen.befallen.items())),
        "stranded": seen.stranded,
        "driven_km": round(seen.driven_m / 1000, 2),
        "processor_s": round(seen.took_s, 1),
        "robot_hours_a_processor_minute": round(60 * robot_hours / seen.took_s, 1),
    }


def _in_words(one: Meeting) -> str:
    whose = ", put there by a person" if one.by_person else ""
    return f"{one.at_s:.0f} s: {' and '.join(one.robots)} in {one.place}{whose}"


def _ages_s(people: People, end_s: float) -> Iterable[float]:
    for order, placed_s in people.placed_s.items():
        yield people.loaded_s.get(order, end_s) - placed_s


def _since_placed(people: People, at_s: dict[str, float]) -> list[float]:
    return [then_s - people.placed_s[order] for order, then_s in at_s.items()]


def _spread(values: list[float]) -> dict[str, float]:
    if not values:
        return {"count": 0}
    ordered = sorted(values)
    shares = {"p50": 0.5, "p95": 0.95, "p99": 0.99}
    found = {name: round(quantile(ordered, share), 1) for name, share in shares.items()}
    return {
        "count": len(values),
        "mean": round(sum(values) / len(values), 1),
        **found,
        "longest": round(ordered[-1], 1),
    }


def _score(quality: PromiseQuality) -> dict[str, Any]:
    error = quality.told.median_error_ratio if quality.told else None
    return {"scored": quality.scored, "inside": quality.inside_ratio, "median_error": error}
