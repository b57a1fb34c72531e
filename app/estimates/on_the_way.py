"""When a robot comes to each of its stops where no timetable says so: by the shortest way, with nobody in it."""

from collections.abc import Callable, Sequence
from datetime import datetime
from itertools import pairwise
from random import Random
from typing import Final, NamedTuple

from app.estimates.arrivals import Estimates
from app.estimates.durations import Kind, Thing
from app.estimates.intervals import Interval, interval_of
from maps import CampusMapError, shortest_route

DRAWS: Final = 60


class Ahead(NamedTuple):
    """A stop of a robot. `kind`: None where nothing is handed over; `arrived_at`: if the robot stands there."""

    key: str
    post: str
    kind: Kind | None
    arrived_at: datetime | None


class Place(NamedTuple):
    """The post that saw a robot last, the next one if it is on its way there, and since when."""

    post: str
    towards: str | None
    since: datetime | None


def on_the_way(
    estimates: Estimates, place: Place, stops: Sequence[Ahead], now: datetime, rng: Random
) -> dict[str, Interval]:
    """In how many seconds it is at each stop, by the stop's key; empty where the map knows no way."""
    try:
        parts = list(_parts(estimates, place, stops, now, rng))
    except CampusMapError:  # a robot with another map than ours
        return {}
    reached: dict[str, list[float]] = {}
    for _ in range(DRAWS):
        at_s = 0.0
        for key, before, handling in parts:
            at_s += sum(draw() for draw in before)
            reached.setdefault(key, []).append(at_s)
            at_s += handling()
    return {key: interval_of(times) for key, times in reached.items()}


Draw = Callable[[], float]


def _parts(
    estimates: Estimates, place: Place, stops: Sequence[Ahead], now: datetime, rng: Random
) -> Sequence[tuple[str, Sequence[Draw], Draw]]:
    """For each stop its key, the corridors before it, and what is done there."""

    def draw(thing: Thing | None, since: datetime | None = None) -> Draw:
        over_s = max(0.0, (now - since).total_seconds()) if since else 0.0
        return lambda: 0.0 if thing is None else estimates.durations.draw_s(thing, rng, over_s) - over_s

    first = [] if place.towards is None else [draw(estimates.corridor(place.post, place.towards), place.since)]
    here, parts = place.towards or place.post, []
    for stop in stops:
        way = shortest_route(estimates.ways.campus, here, stop.post).posts
        corridors = [draw(estimates.corridor(a, b)) for a, b in pairwise(way)]
        handling = draw(estimates.stop(stop.kind, stop.arrived_at or now) if stop.kind else None, stop.arrived_at)
        parts.append((stop.key, first + corridors, handling))
        here, first = stop.post, []
    return parts
