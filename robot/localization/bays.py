"""Bays on the track: where a robot stands for a post, and what it occupies wherever it is."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from maps import CampusMap, corridor_name
from protocol.parts import Leg
from protocol.to_server import Evidence, Where
from robot.localization.place import AtPost, Between, Place

WHOLLY_IN_MM: Final = 450.0
"""So far beyond a post the body of a robot (348 mm) has left the crossing to one that turns there, with some room."""


@dataclass(frozen=True, slots=True)
class Occupied:
    """`post`: the bay, the crossing, or the end of the corridor that lies behind; `towards`: its other end."""

    where: Where
    post: str
    towards: str | None = None


def places_to_stand(track: CampusMap, post: str) -> tuple[str, ...]:
    """The bays of a post; the post itself where it has none. A bay is its own."""
    return tuple(bay.name for bay in track.bays_of(post)) or (post,)


def bay_for(track: CampusMap, post: str, home: str | None, granted: Sequence[Leg], avoided: frozenset[str]) -> str:
    """The bay in which it stands for a post: the one that it was granted, its own home, or the first that is no home
    and not to be avoided."""
    bays = places_to_stand(track, post)
    allowed = [leg.to_post for leg in granted if leg.from_post == post and leg.to_post in bays]
    if allowed:
        return allowed[-1]
    if home in bays:
        return home
    passing = [bay for bay in bays if track.post(bay).is_for_passing] or list(bays)
    return next((bay for bay in passing if corridor_name(post, bay) not in avoided), passing[0])


def occupied(track: CampusMap, place: Place, ahead_mm: float) -> Occupied | None:
    """What the robot is wholly in, by its place and the reading of `Odometry.ahead_mm`; None while it is on its way
    from one to another, or cannot tell."""
    match place:
        case AtPost(here=here):
            if track.post(here).bay_of:
                return Occupied("bay", here)
            return Occupied("crossing", here) if track.bays_of(here) else None
        case Between(corridor=corridor) if track.post(corridor.b).bay_of:
            return None
        case Between() if not (track.bays_of(place.corridor.a) or track.bays_of(place.corridor.b)):
            return None
        case Between(begin_mm=float() as begin_mm) if ahead_mm - begin_mm >= WHOLLY_IN_MM:
            return Occupied("corridor", place.behind, place.towards)
        case Between(by_marker=True, ahead_mm=float() as end_mm) if end_mm - ahead_mm >= WHOLLY_IN_MM:
            return Occupied("corridor", place.behind, place.towards)
    return None


def evidence_of(place: Place, ahead_mm: float) -> tuple[Evidence, int | None]:
    """What tells that the robot is there, and the way driven since the last marker or dock, in mm."""
    match place:
        case AtPost(docked=True):
            return "dock", None
        case AtPost(by_marker=False):
            return "map", None
        case Between(by_marker=False, begin_mm=float() as begin_mm):
            return "distance", max(0, round(ahead_mm - begin_mm))
    return "marker", None
