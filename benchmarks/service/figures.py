"""Times as figures."""

from collections.abc import Sequence
from statistics import median
from typing import Any


def percentile(values: Sequence[float], share: float) -> float:
    """The value that `share` of them do not exceed."""
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(share * len(ordered)))]


def times(values_s: Sequence[float]) -> dict[str, Any]:
    """Milliseconds. Nothing measured gives no figures, which is judged as missed."""
    if not values_s:
        return {"count": 0}
    shares = {"p50_ms": 0.5, "p90_ms": 0.9, "p99_ms": 0.99}
    found = {name: round(percentile(values_s, share) * 1e3, 2) for name, share in shares.items()}
    return {"count": len(values_s), **found, "longest_ms": round(max(values_s) * 1e3, 2)}


def middle(values: Sequence[float]) -> float:
    return round(median(values), 4)
