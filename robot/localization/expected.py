"""Which markers may come next, and where: everything else is foreign, until a second marker agrees with it.

Anybody can hold a code up to the camera. Believed, it would make the robot stop, call people and give back a corridor
that it is in. So without a lift a marker counts where the map and the wheels allow it.
"""

import math
from collections.abc import Iterator, Mapping, Set
from dataclasses import dataclass

from maps import CampusMap, Corridor
from maps.geometry import seen_from
from robot.drivers.interfaces import Sighting
from robot.localization.approach import marker_point, robot_heading_rad
from robot.localization.place import AtPost, Between, Coming, Leaving, Place, Unknown
from robot.localization.steps import LEFT_MM, corridor_between

SHARE, SLACK_MM = 0.08, 200.0
"""A marker comes so much earlier than the map says at most: calibrated wheels and tape measures err by 3 % and 40 mm
(`skills/unread_post.py`), wheels not calibrated for months by twice as much."""
DISTURBED_MM = 200.0
"""Each search and each touch on the way may cost so much of what the wheels count."""
OWN_POST_MM = 600.0
"""So near to the post that it sets out from, that post's markers say nothing."""
BESIDE_MM = 250.0
"""A marker farther from where it hangs beside the line is seen across a room, and tells nothing of this line."""
AGREE_SHARE, AGREE_MM = 0.15, (600.0, 1500.0)
"""Two markers agree if the way driven between them is the corridor's length, so much less or more: it may have turned
round before or beyond the first one."""
Window = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Expected:
    """`windows`: by post, the readings of `Odometry.ahead_mm` between which it may lie; None: any post, anywhere.
    `disturbed`: searches and touches when the windows were made."""

    windows: Mapping[str, Window] | None = None
    disturbed: int = 0
    foreign: bool = False
    """A foreign marker has been read, and nothing has said since that the place is right."""

    def allows(self, post: str, at_mm: float, disturbed: int) -> bool:
        """Return whether this post may lie at this reading, after so many searches and touches."""
        if self.windows is None:
            return True
        least_mm, most_mm = self.windows.get(post, (math.inf, -math.inf))
        return least_mm - DISTURBED_MM * (disturbed - self.disturbed) <= at_mm <= most_mm


def expected(campus: CampusMap, place: Place, real_per_counted: float, disturbed: int, foreign: bool) -> Expected:
    """The markers that may be read next at a place."""
    if isinstance(place, Unknown):
        return Expected()
    return Expected(dict(_windows(campus, place, real_per_counted)), disturbed, foreign)


def _windows(
    campus: CampusMap, place: AtPost | Leaving | Coming | Between, real_per_counted: float
) -> Iterator[tuple[str, Window]]:
    match place:
        case AtPost():
            yield place.here, (place.at_mm - LEFT_MM, place.at_mm + LEFT_MM if place.by_marker else math.inf)
        case Coming():
            yield place.towards, (place.at_mm - SLACK_MM, math.inf)
        case Between():
            length_mm = 1000 * place.corridor.length_m / real_per_counted
            yield place.towards, (_least_mm(place.ahead_mm, 0.0 if place.by_marker else length_mm), math.inf)
            if place.begin_mm is None and not place.by_marker:
                yield place.behind, (-math.inf, math.inf)
            if place.meant is not None:
                yield from _ends(campus, place.here, {place.meant}, place.begin_mm, real_per_counted)
        case Leaving():
            posts = {post.name for post, _ in campus.neighbours(place.here)}
            yield from _ends(campus, place.here, posts, place.begin_mm, real_per_counted)
            if place.begin_mm is None:
                yield place.here, (-math.inf, math.inf)


def _ends(
    campus: CampusMap, here: str, posts: Set[str], begin_mm: float | None, real_per_counted: float
) -> Iterator[tuple[str, Window]]:
    """The windows in which these neighbours of `here` may be read, each at the end of its corridor."""
    for post, corridor in campus.neighbours(here):
        if post.name in posts:
            length_mm = 1000 * corridor.length_m / real_per_counted
            at_mm = None if begin_mm is None else begin_mm + length_mm
            yield post.name, (_least_mm(at_mm, length_mm), math.inf)


def _least_mm(at_mm: float | None, length_mm: float) -> float:
    return -math.inf if at_mm is None else at_mm - SHARE * length_mm - SLACK_MM


def is_own(place: Place, post: str, here_mm: float, at_mm: float) -> bool:
    """A marker of the post where it stands, or that it has just left: it says nothing."""
    if isinstance(place, Between):
        if post != place.behind or place.begin_mm is None:
            return False
        return abs(here_mm - place.begin_mm) < OWN_POST_MM or abs(at_mm - place.begin_mm) < SLACK_MM
    return post == place.here


def hangs_beside_this_line(campus: CampusMap, sighting: Sighting) -> bool:
    """Return whether it is where a marker of its post would be; others are seen across a room."""
    post = campus.post(sighting.text)
    for marker in post.markers:
        _, right_m = seen_from(marker_point(marker), robot_heading_rad(marker), post.point)
        if abs(sighting.left_mm + 1000 * right_m) < BESIDE_MM:
            return True
    return False


@dataclass(frozen=True, slots=True)
class Foreign:
    """A marker that was not expected, the way driven when it was read last, and where its post would be."""

    post: str
    travelled_mm: float
    at_mm: float


def wrong_corridor(campus: CampusMap, place: Between, foreign: Foreign, real_per_counted: float) -> Corridor | None:
    """The corridor of the same post in which the robot would be if the foreign marker were true.

    It found no marker where it should, and this one where another corridor ends: its turn met the wrong line.
    """
    corridor = corridor_between(campus, place.here, foreign.post)
    if corridor is None or place.begin_mm is None or place.turned_round:
        return None
    length_mm = 1000 * corridor.length_m / real_per_counted
    off_mm = abs(foreign.at_mm - place.begin_mm - length_mm)
    return corridor if off_mm < SHARE * length_mm + SLACK_MM else None


def agree(campus: CampusMap, first: Foreign, second: Foreign) -> bool:
    """Return whether two foreign markers fit each other: the robot was carried, and has driven from one to the
    other."""
    driven_mm = second.travelled_mm - first.travelled_mm
    lengths_mm = [1000 * way.length_m for post, way in campus.neighbours(first.post) if post.name == second.post]
    least_mm = [(1 - AGREE_SHARE) * length_mm - AGREE_MM[0] for length_mm in lengths_mm]
    most_mm = [(1 + AGREE_SHARE) * length_mm + AGREE_MM[1] for length_mm in lengths_mm]
    return any(least <= driven_mm <= most for least, most in zip(least_mm, most_mm, strict=True))
