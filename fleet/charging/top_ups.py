"""Top-ups: idle robots charge, lowest first, wherever a dock is free.

Charge that is taken in quiet hours is not missing in busy ones, and a dock that stands empty is lost for ever. A robot
in a dock can be called any time; so only two things speak against it: the way there, and others who need it more.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from fleet.charging.docks import DockPlan, Need
from fleet.charging.levels import Level, Thresholds

WORTH: Final = 0.05
"""A way to a dock is for more than this."""
NEEDS_IT_MORE: Final = 0.25
"""A robot leaves its dock to one that has so much less."""
EARLY_S: Final = 1800.0
"""Who must charge by a certain time is sent so much earlier."""
TURN_S: Final = 300.0
"""And a dock that it waits for need not be free before it sets out, but when it comes."""


@dataclass(frozen=True, slots=True)
class Move:
    """To a dock, which the robot that stands in it leaves when this one comes."""

    robot: str
    dock: str


@dataclass(frozen=True, slots=True)
class TopUpPolicy:
    """`is_quiet`: everybody fills up; else only to where charging gets slow, and `wanted` robots with `ready` or more
    stay where they are."""

    is_quiet: bool
    wanted: int = 0
    ready: float = 0.5


def top_ups(
    resting: Sequence[Need],
    plan: DockPlan,
    taken: Mapping[str, str | None],
    thresholds: Thresholds,
    policy: TopUpPolicy,
    now_s: float,
) -> list[Move]:
    """Assign idle robots to docks. `taken`: docks that a robot stands in or is on its way to,
    with the name of the robot that would make room."""
    docked = {need.dock: need for need in resting if need.dock is not None}
    coming = sorted((need for need in resting if need.dock is None), key=lambda one: (one.charge.ratio, one.robot))
    moves: list[Move] = []
    for need in _in_need_or_to_spare(coming, plan, thresholds, policy, now_s):
        dock = _dock_for(need, docked, plan, {**taken, **{move.dock: None for move in moves}}, thresholds, now_s)
        if dock is not None:
            moves.append(Move(need.robot, dock))
    return moves


def _dock_for(
    need: Need,
    docked: Mapping[str, Need],
    plan: DockPlan,
    taken: Mapping[str, str | None],
    thresholds: Thresholds,
    now_s: float,
) -> str | None:
    free = [dock for dock in need.ways if dock not in taken]
    full = [
        dock for dock, other in docked.items() if taken.get(dock) == other.robot and makes_room(other, need, thresholds)
    ]
    found = nearest(need, free, thresholds) or nearest(need, full, thresholds)
    if found is None and need.robot in plan.stays and _is_due(need, plan, now_s):
        return plan.stays[need.robot].dock  # to stand there is no worse than to stand here
    return found


def nearest(need: Need, docks: Sequence[str], thresholds: Thresholds) -> str | None:
    """Of these the one that costs least to get to, and that it gets to with a reserve."""
    cost = {dock: need.charge.rates.at_most(use) for dock, use in need.ways.items() if dock in docks}
    able = {dock: most for dock, most in cost.items() if need.charge.ratio - most >= thresholds.critical}
    return min(able, key=lambda dock: (able[dock], dock), default=None)


def _in_need_or_to_spare(
    coming: Sequence[Need], plan: DockPlan, thresholds: Thresholds, policy: TopUpPolicy, now_s: float
) -> list[Need]:
    until = thresholds.full if policy.is_quiet else thresholds.sufficient
    able = sum(need.charge.ratio >= policy.ready for need in coming)
    kept = 0 if policy.is_quiet else policy.wanted
    going = []
    for need in coming:
        is_due = _is_due(need, plan, now_s)
        if not is_due and need.charge.ratio >= until - WORTH:
            continue
        if not is_due and need.charge.ratio >= policy.ready:
            if able <= kept:
                continue
            able -= 1
        going.append(need)
    return going


def _is_due(need: Need, plan: DockPlan, now_s: float) -> bool:
    """It must go soon, or it is its turn and others who come after it must."""
    stay = plan.stays.get(need.robot)
    if stay is None:
        return True
    way_s = need.ways[stay.dock].time_s
    is_its_turn = stay.from_s - way_s <= now_s + TURN_S and plan.slack_s(stay) <= EARLY_S
    return is_its_turn or stay.due_s - way_s - EARLY_S <= now_s


def makes_room(other: Need, need: Need, thresholds: Thresholds) -> bool:
    """The one in the dock can come again later: it has enough for a while, and clearly more than the other."""
    more = other.charge.ratio - need.charge.ratio
    is_sufficient = thresholds.level(other.charge.ratio) >= Level.SUFFICIENT
    return is_sufficient and more >= NEEDS_IT_MORE
