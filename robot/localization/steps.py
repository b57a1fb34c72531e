"""Which place follows from which: a marker that was expected, way driven, a turn. Pure functions over `place.py`."""

from dataclasses import replace

from maps import CampusMap, Corridor
from maps.bays import MARKER_BEFORE_CROSSING_M
from robot.localization.place import AtPost, Between, Coming, Leaving, Place, Unknown

REACHED_MM = 30.0
"""So near counts as at the post; a robot that stops there is within a few millimetres."""
LEFT_MM = 100.0
"""So far beyond it the robot has left the post."""
SURELY_SEEN_MM = 1000 * MARKER_BEFORE_CROSSING_M + 500.0
"""From so far before its post a marker comes into sight."""


def corridor_between(campus: CampusMap, post: str, other: str) -> Corridor | None:
    """The corridor between two posts; None unless they are neighbours."""
    return next((corridor for neighbour, corridor in campus.neighbours(post) if neighbour.name == other), None)


def set_out(place: AtPost, corridor: Corridor | None, counted_m: float) -> Between | Leaving:
    """It follows the line away from its post; `corridor` None: it is not known which line. `counted_m`: the length of
    the corridor as its wheels count it."""
    if corridor is None:
        return Leaving(place.here, place.at_mm)
    towards = corridor.other(place.here)
    return Between(corridor, place.here, towards, place.at_mm, place.at_mm + 1000 * counted_m)


def marked(campus: CampusMap, place: Place, post: str, at_mm: float, here_mm: float) -> Place:
    """A marker that was expected says that its post is (or was) at the reading `at_mm`; the robot is at `here_mm`."""
    match place:
        case AtPost():
            return _marked_at_post(place, post, at_mm, here_mm)
        case Between():
            if post == place.towards:
                return replace(place, ahead_mm=at_mm, by_marker=True, doubted=False, blind=False)
            if post == place.behind:
                return Between(place.corridor, place.here, post, None, at_mm, by_marker=True)
            corridor = corridor_between(campus, place.here, post) if post == place.meant else None
            if corridor:  # slipping wheels turn the compass, and it was right
                return Between(corridor, place.here, post, place.begin_mm, at_mm, by_marker=True)
        case Leaving():
            corridor = corridor_between(campus, place.here, post)
            if corridor:
                return Between(corridor, place.here, post, place.begin_mm, at_mm, by_marker=True)
        case Unknown():
            corridor = corridor_between(campus, place.here, post) if place.here and post in place.was else None
            if corridor and place.here:  # put back onto its way
                return Between(corridor, place.here, post, None, at_mm, by_marker=True)
    return Coming(post, at_mm)


def _marked_at_post(place: AtPost, post: str, at_mm: float, here_mm: float) -> Place:
    """Standing at a post, its marker tells how exactly. A robot that has stopped well short of it is still on its
    way."""
    if post != place.here or at_mm < here_mm - LEFT_MM:
        return place
    if at_mm <= here_mm + LEFT_MM:
        return replace(place, at_mm=at_mm, by_marker=True)
    if place.by_marker or place.came_by is None:
        return place
    return Between(place.came_by, place.came_by.other(post), post, None, at_mm, by_marker=True)


def has_reached(place: Place, here_mm: float) -> bool:
    """Return whether the axle has come to the post ahead: by its marker, or by the way that it came and goes back."""
    match place:
        case Coming():
            return place.at_mm - here_mm <= REACHED_MM
        case Between(ahead_mm=float() as ahead_mm):
            near = ahead_mm - here_mm <= REACHED_MM
            return near and (place.by_marker or (place.turned_round and abs(ahead_mm - here_mm) <= REACHED_MM))
    return False


def has_left(place: AtPost, here_mm: float) -> bool:
    return abs(place.at_mm - here_mm) > LEFT_MM


def searched(place: AtPost, here_mm: float) -> AtPost:
    """It looks for the line or the dock around its post: what its wheels count there leads nowhere."""
    return replace(place, at_mm=min(max(place.at_mm, here_mm - LEFT_MM), here_mm + LEFT_MM))


def turned_round(place: Between, here_mm: float) -> Between:
    """Turn the place round: what lay behind lies ahead, as far as it was behind. One that was switched on on its way
    counts from there: it is at least as far."""
    begin_mm = ahead_mm = None
    if place.begin_mm is not None:
        ahead_mm = 2 * here_mm - place.begin_mm
    elif place.by_marker and place.ahead_mm is not None:
        ahead_mm = 2 * here_mm - place.ahead_mm + 1000 * place.corridor.length_m
    if place.ahead_mm is not None:
        begin_mm = 2 * here_mm - place.ahead_mm
    blind = (here_mm if ahead_mm is None else ahead_mm - here_mm) < SURELY_SEEN_MM
    doubted = blind and ahead_mm is None
    return Between(place.corridor, place.here, place.behind, begin_mm, ahead_mm, doubted=doubted, blind=blind)


def gone_astray(place: Between, corridor: Corridor, counted_m: float) -> Between:
    """It is in another corridor of the same post than it was taken to be in."""
    begin_mm, towards = place.begin_mm, corridor.other(place.here)
    ahead_mm = None if begin_mm is None else begin_mm + 1000 * counted_m
    meant = place.meant or place.towards
    return Between(corridor, place.here, towards, begin_mm, ahead_mm, meant=None if meant == towards else meant)
