"""Cost of a plan, in seconds of one order: how long each waits until it is given, the oldest more than they do, and
driving; and by how much robots do what they have later than on empty corridors, since they wait for each other: so much
later is each order that waits for such a robot."""

from typing import Final

from fleet.assignment.problem import Rules

SLACK_S: Final = 1e-3
"""Sums of times are not exact."""


def latency_s(rules: Rules, weight: float, seconds: float) -> float:
    """Of an order that is given so long after it was placed."""
    return weight * (seconds + rules.late * max(0.0, seconds - rules.late_after_s))


def later_by_a_second_s(rules: Rules, weight: float, seconds: float) -> float:
    """By how much that grows if it is given a second later."""
    return weight * (1.0 + rules.late) if seconds > rules.late_after_s else weight
