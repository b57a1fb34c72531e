"""Arrivals of orders that are not planned yet: drawn from how long their parts have lately taken.

How long until it is fetched depends on the orders before it and on the robots there; then it is handed over and driven,
corridor by corridor. What a plan is known of is forecast by `fleet.eta.forecast` instead.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from datetime import datetime, tzinfo
from functools import cached_property, reduce
from itertools import pairwise
from math import inf, isfinite
from operator import add
from random import Random
from statistics import fmean
from typing import Final, NamedTuple

from fleet.eta.calibration import Basis
from fleet.eta.durations import SHORTEST_ASSUMED_S, Durations, Kind, Thing
from fleet.eta.intervals import MIDDLE, Interval, interval_of
from fleet.eta.promised import Told
from maps.ways import Ways

DRAWS: Final = 200
WORTH_DRAWING: Final = 0.02
"""By so much more has to have been seen before anything is drawn again, which takes milliseconds."""
ENOUGH: Final = 10
"""So many orders fetched, and corridors driven, before anybody is told what was learned of them."""
USUAL_OFFICE_HOURS: Final = range(8, 18)
WORKDAYS: Final = range(5)
HOURS: Final = ("office hours", "other hours")
LONGEST_QUEUE: Final = 4
"""Orders waiting per robot: with more it is no other kind of day."""
SETS_OUT_S: Final = 60.0
"""Assumed, until a robot that is free sets out, and for what keeps it on its way."""
SPREAD: Final = 2.0
"""The far end of a window by lengths alone: everything takes up to this much longer."""


@dataclass(frozen=True)
class Ahead:
    """Orders that are not fetched yet, and robots that can be reached. `reason`: why none of them can come now."""

    orders: int = 0
    robots: int = 1
    reason: str | None = None

    @property
    def per_robot(self) -> float:
        return self.orders / max(1, self.robots)


class FreeRobot(NamedTuple):
    """When and where a robot has nothing more to do, once it has brought its share of the orders that wait now."""

    at: datetime
    post: str


@dataclass(frozen=True)
class Promise:
    """A promise: what was worked out (`raw`), what people are told, what the lengths on the map say; seconds from the
    beginning.

    `assumed`: nothing was learned yet, so that people are told what the map says.
    """

    raw: Interval
    told: Interval
    by_map: Interval
    fetch: Thing
    assumed: bool


@dataclass
class Estimates:
    """The durations that were learned on one campus. In memory: the observations are in the database
    (`app.eta.learning`)."""

    ways: Ways
    speed_m_s: float
    handover_s: float
    zone: tzinfo | None = None
    office_hours: range = USUAL_OFFICE_HOURS
    durations: Durations = field(default_factory=Durations)
    told: dict[Basis, Told] = field(default_factory=lambda: {basis: Told() for basis in Basis})
    ahead: Ahead = Ahead()
    free: Sequence[FreeRobot] = ()
    """While orders wait for robots, as dispatch expects it: it looks anew at each change. Else empty."""
    _rng: Random = field(default_factory=lambda: Random(0))
    _ratios: dict[tuple[Kind, str], list[float]] = field(default_factory=dict)
    _ways_s: dict[tuple[str, str], list[float]] = field(default_factory=dict)
    _drawn_at: int = -1

    # What is told.

    def promise(self, from_post: str, to_post: str, begins_at: datetime) -> Promise:
        """For mail that may be fetched from then on. Raises the map's UnknownPost and NoRoute."""
        fetch, by_map = self.fetching(from_post, begins_at), self._by_map(from_post, to_post)
        hours = self.hours(begins_at)
        raw = self._draws(fetch, from_post, to_post, hours)
        told = by_map if self.is_assumed else self.told[Basis.PLACED].corrected(raw)
        return Promise(raw, told, by_map, fetch, self.is_assumed)

    @property
    def is_assumed(self) -> bool:
        """Tell if too little was seen, so that people are told what the lengths on the map say."""
        return min(self.durations.seen(Kind.FETCH), self.durations.seen(Kind.CORRIDOR)) < ENOUGH

    def by_map_under_way(self, from_post: str, to_post: str, *, is_aboard: bool) -> Interval:
        """Return the interval by the lengths on the map for mail that a robot has. Raises the map's UnknownPost and
        NoRoute."""
        if not is_aboard:
            return self._by_map(from_post, to_post)
        way_s = self._length_m(from_post, to_post) / self.speed_m_s
        return Interval(way_s, (1 + SPREAD) / 2 * way_s, SPREAD * way_s)

    # The things that take time.

    def corridor(self, from_post: str, to_post: str) -> Thing | None:
        """One corridor in one direction; None if the map has none between these posts. Raises the map's UnknownPost."""
        self.ways.campus.post(from_post)
        return self._of_corridors.get((from_post, to_post))

    @cached_property
    def _of_corridors(self) -> Mapping[tuple[str, str], Thing]:
        campus = self.ways.campus
        joined = [(here, post.name, way.length_m) for here in campus.posts for post, way in campus.neighbours(here)]
        return {
            (here, there): Thing(Kind.CORRIDOR, f"{here} {there}", length_m / self.speed_m_s)
            for here, there, length_m in joined
        }

    def usual_s(self, from_post: str, to_post: str) -> float | None:
        """Return the median time of a corridor; None if too few were driven to say."""
        thing = self.corridor(from_post, to_post)
        if thing is None or self.durations.seen(Kind.CORRIDOR) < ENOUGH:
            return None
        return self.durations.quantile_s(thing, MIDDLE)

    def stop(self, kind: Kind, at: datetime) -> Thing:
        """A hand-over at this time: people come sooner in their hours."""
        return Thing(kind, self.hours(at), self.handover_s)

    def hours(self, at: datetime) -> str:
        local = at.astimezone(self.zone)
        return HOURS[0] if local.weekday() in WORKDAYS and local.hour in self.office_hours else HOURS[1]

    def fetching(self, from_post: str, begins_at: datetime) -> Thing:
        """The wait for a robot: while others wait, too, for the one that can be there first."""
        queue = min(int(self.ahead.per_robot), LONGEST_QUEUE)
        if (comes_s := self._first_comes_s(from_post, begins_at)) < inf:
            return Thing(Kind.FETCH, f"planned, queue {queue}", comes_s + SETS_OUT_S)
        busy_s = self.ahead.per_robot * 2 * (self._usual_way_s + self.handover_s)
        return Thing(Kind.FETCH, f"queue {queue}", self._coming_s(from_post) + busy_s)

    def _first_comes_s(self, from_post: str, begins_at: datetime) -> float:
        ways_m = self.ways.length_m
        return min(
            (
                max(0.0, (robot.at - begins_at).total_seconds()) + ways_m(robot.post, from_post) / self.speed_m_s
                for robot in self.free
            ),
            default=inf,
        )

    def things(self) -> list[Thing]:
        """Everything that was seen: corridors as the map has them, then stops."""
        campus = self.ways.campus
        ways = [(one, post.name) for one in campus.posts for post, _ in campus.neighbours(one)]
        corridors = [thing for here, there in ways if (thing := self.corridor(here, there)) is not None]
        stops = [Thing(kind, hours, self.handover_s) for kind in (Kind.LOAD, Kind.RECEIVE) for hours in HOURS]
        return [thing for thing in (*corridors, *stops) if self.durations.seen(thing.kind, thing.name)]

    # How it is done.

    def _draws(self, fetch: Thing, from_post: str, to_post: str, hours: str) -> Interval:
        """The parts are drawn anew when enough was learned to change them."""
        if self.durations.version > self._drawn_at * (1 + WORTH_DRAWING):
            self._ratios, self._ways_s, self._drawn_at = {}, {}, self.durations.version
        fetched_s, loaded_s = map(self._part_s, (fetch, Thing(Kind.LOAD, hours, self.handover_s)))
        return interval_of(_together(fetched_s, loaded_s, self._way_s(from_post, to_post)))

    def _part_s(self, part: Thing) -> list[float]:
        """The draws of one part, which many ways have in common: no way has the same part twice. They are drawn as
        ratios, since what is assumed of a fetch changes with the queue."""
        assumed_s = max(part.assumed_s, SHORTEST_ASSUMED_S)
        if part[:2] not in self._ratios:
            self._ratios[part[:2]] = self.durations.draws_s(Thing(part.kind, part.name, 1.0), self._rng, DRAWS)
        return [ratio * assumed_s for ratio in self._ratios[part[:2]]]

    def _way_s(self, from_post: str, to_post: str) -> list[float]:
        """The draws of all its corridors together."""
        if (from_post, to_post) not in self._ways_s:
            parts_s = map(self._part_s, self._corridors(from_post, to_post))
            self._ways_s[from_post, to_post] = _together([0.0] * DRAWS, *parts_s)
        return self._ways_s[from_post, to_post]

    def _corridors(self, from_post: str, to_post: str) -> list[Thing]:
        posts = self.ways.route(from_post, to_post).posts
        found = (self.corridor(here, there) for here, there in pairwise(posts))
        return [thing for thing in found if thing is not None]

    def _by_map(self, from_post: str, to_post: str) -> Interval:
        """The robot is assumed to come from the farthest dock: a late estimate disappoints less than an early one."""
        way_m = self._length_m(from_post, to_post)
        coming_m = max((self._length_m(dock.name, from_post) for dock in self.ways.campus.docks()), default=0.0)
        earliest_s = way_m / self.speed_m_s + self.handover_s
        latest_s = SPREAD * ((way_m + coming_m) / self.speed_m_s + self.handover_s)
        return Interval(earliest_s, (earliest_s + latest_s) / 2, latest_s)

    def _length_m(self, from_post: str, to_post: str) -> float:
        length_m = self.ways.length_m(from_post, to_post)
        return length_m if isfinite(length_m) else self.ways.route(from_post, to_post).length_m

    def _coming_s(self, from_post: str) -> float:
        docks = [dock.name for dock in self.ways.campus.docks()]
        return fmean(self._length_m(dock, from_post) for dock in docks) / self.speed_m_s if docks else 0.0

    @cached_property
    def _usual_way_s(self) -> float:
        """From one post to another, on the mean."""
        posts = list(self.ways.campus.posts)
        lengths = (self.ways.length_m(here, there) for here in posts for there in posts if here != there)
        found = [length_m for length_m in lengths if length_m < float("inf")]
        return fmean(found) / self.speed_m_s if found else 0.0


def _together(first_s: list[float], *others_s: list[float]) -> list[float]:
    """Draw by draw the sums of parts."""
    return reduce(lambda sums, part: list(map(add, sums, part)), others_s, first_s)
