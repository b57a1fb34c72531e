"""Taking one more item along: where it fits into the way that a robot has before it, and how much longer that gets.

A pure function: cheapest insertion of a place to load and a place to give, in every pair of positions. Issue 7 will put
a plan for the whole fleet in its place.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

from maps.ways import Ways


@dataclass(frozen=True)
class Visit:
    """One stop ahead: how the number of items aboard changes there (+1 load, -1 receive or return)."""

    key: str
    post: str
    change: int


@dataclass(frozen=True)
class Tour:
    """The way that a robot has before it. `start` is the post that it comes to next; None: unknown, so that its way
    begins at its first stop."""

    robot: str
    start: str | None
    visits: tuple[Visit, ...]
    aboard: int = 0


@dataclass(frozen=True)
class Insertion:
    """The new way, and how much longer it is."""

    visits: tuple[Visit, ...]
    detour_m: float


def cheapest_insertion(tour: Tour, load: Visit, receive: Visit, capacity: int, ways: Ways) -> Insertion | None:
    """The shortest way that also serves one more order; None if the item fits nowhere, or cannot be got to."""
    before_m = _length_m(tour.start, tour.visits, ways)
    ways_on = (
        Insertion(visits, _length_m(tour.start, visits, ways) - before_m) for visits in _ways_on(tour, load, receive)
    )
    fitting = [
        one for one in ways_on if _most_aboard(tour.aboard, one.visits) <= capacity and one.detour_m < float("inf")
    ]
    # Of equal ones the first: what is loaded late and given early leaves room.
    return min(fitting, key=lambda one: one.detour_m, default=None)


def _ways_on(tour: Tour, load: Visit, receive: Visit) -> Iterator[tuple[Visit, ...]]:
    first = 1 if tour.start is None else 0
    for loading in range(first, len(tour.visits) + 1):
        for receiving in range(loading, len(tour.visits) + 1):
            ahead, between = tour.visits[:loading], tour.visits[loading:receiving]
            yield (*ahead, load, *between, receive, *tour.visits[receiving:])


def _length_m(start: str | None, visits: Sequence[Visit], ways: Ways) -> float:
    posts = [*([start] if start is not None else []), *(visit.post for visit in visits)]
    return sum(ways.length_m(one, following) for one, following in pairwise(posts))


def _most_aboard(aboard: int, visits: Sequence[Visit]) -> int:
    most = aboard
    for visit in visits:
        aboard += visit.change
        most = max(most, aboard)
    return most
