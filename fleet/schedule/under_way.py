"""Where a robot is that was let into corridors or onto crossings: as the start of whatever it does next."""

from collections.abc import Iterable
from dataclasses import replace
from math import inf, nextafter
from typing import Final

from fleet.schedule.journey import Start, Through
from fleet.schedule.network import Lane

LATE_S: Final = 5.0
"""A robot that should have arrived is expected so much later, again and again."""


def placed(post: int, *, at_home: bool, now_s: float, entered_s: float | None = None) -> Start:
    """In a bay, or at home, and ready."""
    return Start(post, at_home, now_s, now_s if entered_s is None else entered_s)


def is_on(start: Start, over_s: float, now_s: float) -> Start:
    """Let onto the crossing of its post, on its way to its bay or home place there."""
    return replace(start, crosses=True, arrives_s=now_s, ready_s=now_s + over_s) if over_s else start


def further(start: Start, lane: Lane, *, at_home: bool, now_s: float, over_s: float = 0.0) -> Start:
    """Let into one more corridor: all that it has is its own from now until it is through. `over_s`: for the crossing
    before the corridor; with it, what the robot leaves stays its own until it is over."""
    before, begins_s = start.before, max(now_s, start.arrives_s)
    if start.lane is not None or over_s:
        before = (*before, Through(start.lane, start.post, begins_s, start.at_home, over_s, start.entered_s))
    arrives_s = begins_s + over_s + lane.travel_s
    return Start(lane.end, at_home, arrives_s, now_s, lane, arrives_s, before)


def aside(start: Start, over_s: float, now_s: float) -> Start:
    """Let from its bay over the crossing to its home place at the same post."""
    if not over_s:
        return placed(start.post, at_home=True, now_s=now_s)
    leaves = Through(None, start.post, now_s, start.at_home, over_s, start.entered_s)
    return Start(start.post, True, now_s + over_s, now_s, None, now_s, (leaves,), crosses=True)


def turned(start: Start, back: Lane, *, at_home: bool, now_s: float) -> Start:
    """The same robot in the same corridor on its way back to where it came from: it is as far from there as it came.
    Where it still holds a place there, that is the one it comes back to."""
    ends_s = now_s + min(back.travel_s, max(0.0, now_s - start.entered_s))
    before = start.before
    if before:
        before = (*before[:-1], before[-1]._replace(at_home=True))
        ends_s = max(now_s, start.arrives_s) + back.travel_s
    return Start(back.end, at_home, ends_s, now_s, back, ends_s, before)


def let_in_after(start: Start, others: Iterable[Start]) -> Start:
    """The same, behind others that are known to be in its corridor."""
    if start.lane is None or start.lane.following_s is None:
        return start
    ahead = [other for other in others if other.lane == start.lane]
    entered_s = max((nextafter(other.entered_s, inf) for other in ahead), default=-inf)
    return replace(start, entered_s=max(start.entered_s, entered_s))


def through(start: Start, lane: Lane, now_s: float) -> Start:
    """Out of this corridor, which is not its last: what lies behind it is free."""
    at = next(number for number, one in enumerate(start.before) if one.lane == lane)
    here, *ahead = start.before[at:]
    left = _shifted(replace(start, before=tuple(ahead)), now_s - here.arrives_s)
    return replace(left, before=(here._replace(lane=None, arrives_s=now_s), *left.before))


def out_of(start: Start, over_s: float, now_s: float) -> Start:
    """Out of its last corridor, and on the crossing at its end, if that takes time; else it stands."""
    if over_s:
        return replace(start, lane=None, arrives_s=now_s, ready_s=now_s + over_s, before=(), crosses=True)
    return _standing(start, now_s)


def crossed(start: Start, post: int, now_s: float) -> Start:
    """Wholly in what lies behind the crossing of this post; nothing has changed if that is not its own."""
    if start.crosses and start.post == post:
        return _standing(start, now_s)
    if start.before and start.before[0].lane is None and start.before[0].over_s and start.before[0].post == post:
        left, *ahead = start.before
        return _shifted(replace(start, before=tuple(ahead)), now_s - left.over_by_s)
    return start


def expected(start: Start, now_s: float) -> Start:
    """Somewhat later than now, if it should have come to its next report before; and so much later at the end."""
    due_s = _next_report_s(start)
    return start if due_s > now_s else _shifted(start, now_s + LATE_S - due_s)


def all_held(start: Start) -> tuple[Start, ...]:
    return (*start.on_the_way(), start)


def _next_report_s(start: Start) -> float:
    """When it leaves the crossing or the corridor that it is on or in."""
    for one in start.before:
        if one.lane is not None:
            return one.arrives_s
        if one.over_s:
            return one.over_by_s
    return start.ready_s if start.lane is None else start.arrives_s


def _standing(start: Start, now_s: float) -> Start:
    return replace(start, lane=None, arrives_s=-inf, ready_s=now_s, before=(), crosses=False)


def _shifted(start: Start, by_s: float) -> Start:
    """All that is before it so much later."""
    before = tuple(one._replace(arrives_s=one.arrives_s + by_s) for one in start.before)
    return replace(start, arrives_s=start.arrives_s + by_s, ready_s=start.ready_s + by_s, before=before)
