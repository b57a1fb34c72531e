"""From logs to figures: what became of the missions, and how often each plan and action was used."""

from collections import Counter
from collections.abc import Iterable, Sequence
from statistics import mean, median
from typing import Any

from benchmarks.paper.logged_run import Log

DAEMON_TICK_MS = 100.0


def figures_of(logs: Sequence[Log]) -> dict[str, Any]:
    """All runs of one contender. Times of missions are of those that were delivered."""
    delivered = [log for log in logs if log.delivered]
    driving_s = sum(log.driving_s for log in logs)
    cycles_ms = sorted(ms for log in logs for ms in log.cycle_ms)
    return {
        "runs": len(logs),
        "missions_lost": len(logs) - len(delivered),
        "lost_because": dict(Counter(log.reason for log in logs if log.reason)),
        "mission_s": _spread(log.time_s for log in delivered),
        "mission_without_charging_s": _spread(log.time_s - log.docked_s for log in delivered),
        "looking_for_line_s": _spread(log.looking_s for log in logs),
        "looking_for_line_share": sum(log.looking_s for log in logs) / driving_s if driving_s else 0.0,
        "driven_m": _spread(log.driven_m for log in logs),
        "cycle_compute_ms": quantiles(cycles_ms),
        "cycle_wait_ms": DAEMON_TICK_MS,
        "plans": shares(sum((log.plans for log in logs), Counter())),
        "actions": shares(sum((log.actions for log in logs), Counter())),
    }


def shares(counted: Counter[str]) -> dict[str, dict[str, float]]:
    """Most used first."""
    total = counted.total()
    return {name: {"count": count, "share": count / total} for name, count in counted.most_common()}


def quantiles(values: Iterable[float]) -> dict[str, float]:
    """Median, 95th and 99th percentile and the greatest; empty without values."""
    ordered = sorted(values)
    if not ordered:
        return {}
    at = {"p50": 0.5, "p95": 0.95, "p99": 0.99}
    return {name: ordered[int(share * (len(ordered) - 1))] for name, share in at.items()} | {"greatest": ordered[-1]}


def _spread(values: Iterable[float]) -> dict[str, float] | None:
    listed = list(values)
    if not listed:
        return None
    return {"mean": mean(listed), "median": median(listed), "least": min(listed), "greatest": max(listed)}
