"""Robots in corridors at whose ends they cannot come in, since one stands still on the crossing there."""

from collections.abc import Mapping
from dataclasses import replace
from math import inf, nextafter

from fleet.schedule.journey import Start
from fleet.schedule.network import Lane, Network
from fleet.schedule.participant import Participant, is_full
from fleet.schedule.under_way import turned


def turn_round(whole: Network, robots: Mapping[str, Participant], now_s: float) -> None:
    """Have them go back to where they came from, if there is room for them; else they are shut in, and so are those
    ahead of them. The one that is let back first is the one that went in last."""
    stuck = {post for one in robots.values() if one.frozen for post, _ in one.start.crossings()}
    for one in robots.values():
        one.is_shut_in = False
    shut_in: set[tuple[int, int]] = set()
    went_back: dict[tuple[int, int], Start] = {}
    for one in sorted(robots.values(), key=lambda one: (-one.start.entered_s, -one.start.arrives_s)):
        lane = one.start.lane
        if one.frozen or lane is None or lane.end not in stuck or one.start.crosses:
            continue
        way = lane.corridor, lane.backwards
        if way in shut_in or lane.start in stuck or not _has_room_behind(whole, robots, one):
            one.is_shut_in = True
            shut_in.add(way)
            continue
        # It may not know yet: until it is out no other comes in behind it.
        back = _back(whole, lane)._replace(following_s=None)
        start = turned(one.start, back, at_home=_at_home_behind(one), now_s=now_s)
        one.start = went_back[way] = _behind(start, went_back.get(way), lane.following_s or 0.0)
        one.turns, one.claim, one.asks_in = True, None, False  # what it asked for was at the other end


def _behind(start: Start, other: Start | None, following_s: float) -> Start:
    """The same behind another that goes back through the corridor."""
    if other is None:
        return start
    arrives_s = max(start.arrives_s, other.arrives_s + following_s)
    return replace(start, entered_s=nextafter(other.entered_s, inf), arrives_s=arrives_s, ready_s=arrives_s)


def _has_room_behind(whole: Network, robots: Mapping[str, Participant], one: Participant) -> bool:
    """Tell if it has a bay where it came from: still, a free one, or its home place."""
    lane = one.start.lane
    assert lane is not None  # noqa: S101  # only those in corridors turn round
    return bool(one.start.before) or lane.start == one.home or not is_full(whole, lane.start, robots.values())


def _at_home_behind(one: Participant) -> bool:
    if one.start.before:
        return one.start.before[-1].at_home
    return one.start.lane is not None and one.start.lane.start == one.home


def _back(whole: Network, lane: Lane) -> Lane:
    return next(back for back in whole.lanes[lane.end] if back.corridor == lane.corridor)
