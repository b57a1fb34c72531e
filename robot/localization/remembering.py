"""The place that a robot knows when it is switched on again."""

import math
from enum import StrEnum

from maps import CampusMap
from maps.geometry import wrapped
from protocol import parts
from robot.drivers.interfaces import Odometry
from robot.localization.place import AtPost, Between, Facing, Leaving, Place, Unknown
from robot.localization.steps import corridor_between

LOOKS_BACK_MM = 600.0
"""So far back a marker that it has rolled past comes into sight again: it is seen from 500 to 100 mm before its post,
and a base at 200 mm/s rolls on for half a second."""
AS_ARRIVED_RAD = math.radians(15)
"""Less than half of what lies between the lines of two bays."""


class Moment(StrEnum):
    """The action under way, if a power cut then leaves doubt of its place; written down before it begins."""

    TURNING = "turning"
    """At a post, in a turn or back there after it had left: it looks as its base has counted since, else anywhere."""
    DOCKING = "docking"
    """Into its dock or out of it: it stands beside the end of the line, and may look anywhere."""
    LEAVING = "leaving"
    """On one of the lines of its post; which one is not known."""
    NEARING = "nearing"
    """Before the post ahead: its base may have rolled on, beyond the post and what it was granted."""
    BLIND = "blind"
    """It turned back so near to the post behind that its marker may have been passed on the way in."""
    LIFTED = "lifted"
    """In a person's hands, until a marker or a dock has told where it is."""


def remembered(
    campus: CampusMap, position: parts.Position, moment: Moment | None, turned_back_from: str | None
) -> tuple[Place, Facing | None]:
    """Where the robot was when it was switched off, and how it looked. `towards` was written down before it left or
    turned. `turned_back_from`: the far end of the corridor in which it turned round last."""
    post, previous, towards = position.post, position.previous, position.towards
    if post is None or post not in campus.posts:
        return Unknown(lifted=moment is Moment.LIFTED), None
    if moment is Moment.LIFTED:
        return Unknown(post, frozenset(one for one in (post, towards) if one), lifted=True), None
    if moment is Moment.LEAVING:
        return Leaving(post), None
    came_by = corridor_between(campus, post, previous) if previous else None
    if moment in (Moment.TURNING, Moment.DOCKING):
        return AtPost(post, 0.0, 0.0, came_by), None
    if towards:
        return _on_its_way(campus, post, towards, turned_back_from if towards == post else towards, moment)
    facing_rad = came_by.heading_arriving(post) if came_by else None
    return AtPost(post, 0.0, 0.0, came_by), Facing.of(facing_rad, Odometry())


def _on_its_way(
    campus: CampusMap, post: str, towards: str, far: str | None, moment: Moment | None
) -> tuple[Place, Facing | None]:
    """In the corridor from `post` to `far`. `towards` is `post` itself where it had turned round."""
    corridor, blind = corridor_between(campus, post, far) if far else None, moment is Moment.BLIND
    doubted = blind or moment is Moment.NEARING
    if corridor is None:
        return Leaving(post, doubted=doubted, blind=blind), None
    facing_rad = corridor.heading_arriving(post) if towards == post else corridor.heading_leaving(post)
    return Between(corridor, post, towards, doubted=doubted, blind=blind), Facing.of(facing_rad, Odometry())


def looks_as_arrived(campus: CampusMap, before: parts.Position, post: str, looks_rad: float | None) -> bool:
    """Return whether a robot that was seen at `post` just now, and `before` that as it says, would be right after a
    restart about the way it looks. Nothing is said of it where no corridor leads from the one post to the other."""
    previous = before.previous if before.post == post else before.post
    came_by = corridor_between(campus, post, previous) if previous else None
    if came_by is None:
        return True
    return looks_rad is not None and abs(wrapped(looks_rad - came_by.heading_arriving(post))) < AS_ARRIVED_RAD


def may_look_back_mm(place: Place) -> float:
    """How far it may go back in search of a marker: half of the corridor that it holds at most, and not at all towards
    what it has just turned back from."""
    if isinstance(place, Between | Leaving) and place.blind:
        return 0.0
    length_mm = 1000 * place.corridor.length_m if isinstance(place, Between) else LOOKS_BACK_MM
    return min(LOOKS_BACK_MM, length_mm / 2)
