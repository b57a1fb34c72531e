"""The number of robots that a map can carry, and its limits: home places, bays, and corridors that all robots need."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from maps.campus_map import CampusMap, Corridor, Post
from maps.problem import Problem, error, warning

ASSUMED_SPEED_M_S: Final = 0.15
"""What robots drove on straight tape in the simulated world (docs/reference/measurements.md), and a little less."""


@dataclass(frozen=True)
class Bottleneck:
    """A corridor that is the only way between two sides, with as many posts. `deliveries_per_h`: no more orders between
    random posts can be brought in an hour, however many robots there are, with one robot in it at a time."""

    corridor: str
    posts: tuple[int, int]
    deliveries_per_h: float


@dataclass(frozen=True)
class Carrying:
    """`homes`: home places by post; there can be as many robots as there are of them together, but one alone where
    `bays_on_floor` is false. `without_dock`: bays of robots that find no dock, neither at home nor to share."""

    robots: int
    homes: dict[str, int]
    bottleneck: Bottleneck | None
    bays_on_floor: bool
    without_dock: tuple[str, ...]

    def __str__(self) -> str:
        if not self.robots:
            return "It carries no robot: no post has a home place."
        if not self.bays_on_floor:
            return "It carries 1 robot, since no post has a bay on the floor."
        where = ", ".join(f"{post} {homes}" for post, homes in self.homes.items())
        said = f"It carries {self.robots} robot{'s' if self.robots > 1 else ''}, one for each home place ({where})."
        if self.without_dock:
            said += (
                f" Robots at home in {', '.join(self.without_dock)} find no dock: a person has to charge them, unless "
                "their bay, or one that is no home, gets a dock."
            )
        if self.bottleneck is None:
            return said
        bound = self.bottleneck
        return (
            f"{said} However many there are, they bring at most about {bound.deliveries_per_h:.0f} orders an hour: "
            f"{bound.corridor} is the only way between {bound.posts[0]} posts and {bound.posts[1]}."
        )


def carrying(campus: CampusMap, speed_m_s: float = ASSUMED_SPEED_M_S) -> Carrying:
    """For robots that drive so fast and orders between all pairs of posts alike."""
    homes = {post.name: post.homes for post in campus.posts.values() if post.homes}
    bounds = [bound for corridor in campus.corridors if (bound := _bound(campus, corridor, speed_m_s)) is not None]
    narrowest = min(bounds, key=lambda bound: bound.deliveries_per_h, default=None)
    bays_on_floor, robots = _has_bays_on_floor(campus), sum(homes.values())
    lacking = tuple(place.name for place in campus.track.home_bays if place.dock is None)
    without_dock = () if any(place.is_lent for place in campus.track.docks()) else lacking
    return Carrying(robots if bays_on_floor else min(robots, 1), homes, narrowest, bays_on_floor, without_dock)


def places_problems(campus: CampusMap) -> Iterator[Problem]:
    """Where robots could not stop, or not rest."""
    yield from _not_on_floor(campus)
    for post in campus.posts.values():
        if post.dock is not None and post.homes == 0 and not post.spurs:
            said = f"{post.name} has a dock and no home place, so no robot could stay in the dock"
            yield error("dock_without_home", post.name, said, "Count the dock among its homes.")
        if post.bays == 0:
            yield warning("no_bay", post.name, _no_bay(campus, post), "Give it a bay, or leave it out.")


def _not_on_floor(campus: CampusMap) -> Iterator[Problem]:
    if not _has_bays_on_floor(campus):
        said = (
            "it carries one robot, since no post has a bay on the floor, and a robot that stops at a post stands where "
            "others drive"
        )
        yield warning(
            "no_bays_on_floor", campus.name, said, "Give each post a table [[post.bay]] (docs/reference/maps.md)."
        )
        return
    for post in campus.posts.values():
        if not post.spurs:
            said = (
                "other posts have bays on the floor and it has none: a robot that stops there stands where others drive"
            )
            yield warning("bay_missing", post.name, said, "Give it a table [[post.bay]].")


def _has_bays_on_floor(campus: CampusMap) -> bool:
    return any(post.spurs for post in campus.posts.values())


def _no_bay(campus: CampusMap, post: Post) -> str:
    ways = len(campus.neighbours(post.name))
    return f"{post.name} has no bay: no robot can stop there{', and none can pass' if ways > 1 else ''}"


def _bound(campus: CampusMap, corridor: Corridor, speed_m_s: float) -> Bottleneck | None:
    """Return the throughput of a corridor without a way round it; None if there is one, or if robots may follow each
    other."""
    here = _side(campus, corridor)
    there = len(campus.posts) - len(here)
    if corridor.b in here or corridor.following_s is not None:
        return None
    pairs = len(campus.posts) * (len(campus.posts) - 1)
    share = 2 * len(here) * there / pairs
    passages_per_h = 3600.0 * speed_m_s / corridor.length_m
    return Bottleneck(corridor.name, (len(here), there), passages_per_h / share)


def _side(campus: CampusMap, without: Corridor) -> set[str]:
    """The posts that are reached from one end of a corridor without going through it."""
    reached, ahead = {without.a}, [without.a]
    for post in ahead:
        for other, corridor in campus.neighbours(post):
            if corridor != without and other.name not in reached:
                reached.add(other.name)
                ahead.append(other.name)
    return reached
