"""From logs to figures: what became of the missions, and how often each plan and action was used."""

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from statistics import mean, median
from typing import Any

from benchmarks.paper.logged_run import Log
from benchmarks.paper.stages import Stage

DAEMON_TICK_MS = 100.0


def figures_of(logs: Sequence[Log]) -> dict[str, Any]:
    """Return the figures of one contender's runs. Times of missions are of those that were delivered."""
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


def real_time_figures(samples: Mapping[str, Sequence[float]], duration_s: float) -> dict[str, Any]:
    """Quantiles of all samples: unlike in the paper no outliers are removed, start-up and end are not measured. What
    would wait in a queue is said by how many it becomes more each second."""
    times = {name: quantiles(values) for name, values in samples.items() if name.endswith("_ms")}
    would_wait = samples["would_wait"]
    grows = (would_wait[-1] - would_wait[0]) / duration_s if would_wait else 0.0
    return {**times, "queue_would_grow_per_s": grows}


def most_stages(logs: Sequence[Log]) -> list[Stage]:
    """Those of the first run that came furthest through the paper's Figure 6."""
    return max(logs, key=lambda log: len(log.stages)).stages


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
