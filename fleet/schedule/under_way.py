"""Where a robot is that was let into corridors: as the start of whatever it does next, at the end of all of them."""

from dataclasses import replace
from typing import Final

from fleet.schedule.journey import Start, Through
from fleet.schedule.network import Lane

LATE_S: Final = 5.0
"""A robot that should have arrived is expected so much later, again and again."""


def further(start: Start, lane: Lane, *, at_home: bool, now_s: float) -> Start:
    """Let into one more corridor: all that it has is its own from now until it is through."""
    before = start.before
    if start.lane is not None:
        before = (*before, Through(start.lane, start.post, start.arrives_s, start.at_home))
    arrives_s = max(now_s, start.arrives_s) + lane.travel_s
    return Start(lane.end, at_home, arrives_s, now_s, lane, arrives_s, before)


def through(start: Start, lane: Lane, now_s: float) -> Start:
    """Out of this corridor, which is not its last: what lies behind it is free."""
    at = next(number for number, one in enumerate(start.before) if one.lane == lane)
    here, *ahead = start.before[at:]
    left = replace(start, before=(here._replace(lane=None, arrives_s=now_s), *ahead))
    return _in_time(left, now_s)


def expected(start: Start, now_s: float) -> Start:
    """Somewhat later than now, if it should have been out of its corridor before; and so much later at the end."""
    passages = [one.arrives_s for one in start.before if one.lane is not None]
    first_s = passages[0] if passages else start.arrives_s
    return start if first_s > now_s else _in_time(start, now_s + LATE_S, first=True)


def _in_time(start: Start, now_s: float, *, first: bool = False) -> Start:
    """Each corridor after the one before it; `first`: it is out of the first at this time, else it enters it."""
    assert start.lane is not None  # noqa: S101  # only those in corridors are expected anywhere
    at_s, before = now_s, []
    for one in (*start.before, Through(start.lane, start.post, start.arrives_s)):
        if one.lane is not None:
            at_s, first = at_s if first else at_s + one.lane.travel_s, False
        before.append(one if one.lane is None else one._replace(arrives_s=at_s))
    return replace(start, arrives_s=at_s, ready_s=at_s, before=tuple(before[:-1]))


def all_held(start: Start) -> tuple[Start, ...]:
    return (*start.on_the_way(), start)
