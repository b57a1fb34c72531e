"""Where a robot is by its own report, as the start of what it does next."""

from collections.abc import Callable
from typing import NamedTuple

from fleet.schedule.journey import Start
from fleet.schedule.network import Network
from fleet.schedule.under_way import aside, further, is_on, placed


class Place(NamedTuple):
    """Where a robot says to be: see `TrafficController.joins`."""

    post: str
    at_home: bool = False
    towards: tuple[str, ...] = ()
    on_crossing: bool = False
    to_home: bool = False
    is_let_in: bool = False

    @property
    def rests(self) -> bool:
        return not (self.towards or self.on_crossing)

    @property
    def waits_before(self) -> str | None:
        """The post at the end of its corridor, over which it has no way on yet."""
        return self.towards[-1] if self.towards and not self.is_let_in else None


def start_at(whole: Network, place: Place, home: int | None, is_full: Callable[[int], bool], now_s: float) -> Start:
    """`is_full`: whether every bay of a post is a robot's; then it stands beside them."""
    first, *stops = (whole.number_of(one) for one in (place.post, *place.towards))
    over_s = whole.crossing_s[first] if place.on_crossing else 0.0
    at_home = place.at_home and (place.on_crossing or not stops)
    start = placed(first, at_home=at_home or is_full(first), now_s=now_s)
    if place.on_crossing and not stops:
        goes_home = place.to_home and not place.at_home
        start = aside(start, over_s, now_s) if goes_home else is_on(start, over_s, now_s)
    for end in stops:
        lane, is_kept = whole.lane(start.post, end), place.to_home and end == home
        start = further(start, lane, at_home=is_kept or is_full(end), now_s=now_s, over_s=over_s)
        over_s = whole.crossing_s[end]
    return is_on(start, over_s, now_s) if stops and place.is_let_in else start


def is_same(one: Start, other: Start) -> bool:
    """The same place, whatever the times."""
    if (one.post, one.lane, one.crosses) != (other.post, other.lane, other.crosses):
        return False
    on_the_way = [[(through.lane, through.post) for through in start.before] for start in (one, other)]
    return on_the_way[0] == on_the_way[1] and (not one.rests or one.at_home == other.at_home)
