"""Arrivals of a robot at its stops without a schedule: by the shortest way, on empty corridors."""

from collections.abc import Iterable, Iterator, Sequence
from datetime import datetime
from itertools import pairwise
from random import Random
from typing import Final, NamedTuple

from fleet.eta.arrivals import Estimates
from fleet.eta.durations import Kind, Thing
from fleet.eta.intervals import Interval, interval_of
from maps import CampusMapError

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
        parts = list(_parts(estimates, place, stops, now))
    except CampusMapError:  # a robot with another map than ours
        return {}
    reached, at_s = dict[str, Interval](), [0.0] * DRAWS
    for key, before, handling in parts:
        at_s = _later(estimates, at_s, before, rng)
        reached[key] = interval_of(at_s)
        at_s = _later(estimates, at_s, handling, rng)
    return reached


class Part(NamedTuple):
    """A part of the way that takes time. `over_s`: it has taken so long already."""

    thing: Thing
    over_s: float = 0.0


def _later(estimates: Estimates, at_s: Sequence[float], parts: Iterable[Part], rng: Random) -> list[float]:
    """Each of these moments, after all of these parts."""
    draws_s = (estimates.durations.draws_s(one.thing, rng, DRAWS, one.over_s) for one in parts)
    over_s = sum(one.over_s for one in parts)
    return [sum(one) - over_s for one in zip(at_s, *draws_s, strict=True)]


def _parts(
    estimates: Estimates, place: Place, stops: Sequence[Ahead], now: datetime
) -> Iterator[tuple[str, Sequence[Part], Sequence[Part]]]:
    """For each stop its key, the corridors before it, and what is done there."""

    def part(thing: Thing | None, since: datetime | None = None) -> list[Part]:
        over_s = max(0.0, (now - since).total_seconds()) if since else 0.0
        return [] if thing is None else [Part(thing, over_s)]

    first = [] if place.towards is None else part(estimates.corridor(place.post, place.towards), place.since)
    here = place.towards or place.post
    for stop in stops:
        way = estimates.ways.route(here, stop.post).posts
        corridors = [one for a, b in pairwise(way) for one in part(estimates.corridor(a, b))]
        handling = part(estimates.stop(stop.kind, stop.arrived_at or now), stop.arrived_at) if stop.kind else []
        yield stop.key, first + corridors, handling
        here, first = stop.post, []
