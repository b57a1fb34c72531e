"""Where a simulated robot begins: `dock`, a post or bay (just arrived, its marker in view) or POST:TOWARDS."""

from dataclasses import dataclass

from maps import CampusMap, Post, UnknownPost
from maps.bays import MARKER_BEFORE_BAY_M, MARKER_BEFORE_CROSSING_M, MARKER_BEFORE_PLACE_M
from maps.errors import UnknownCorridor
from maps.geometry import moved
from robot.simulated.errors import UnknownStart


@dataclass(frozen=True)
class Pose:
    """The middle of the axle, in metres and radians of the map."""

    x_m: float
    y_m: float
    heading_rad: float


def start_pose(campus: CampusMap, start: str) -> Pose:
    """Raises UnknownStart.

    `dock` is on the first dock of the map, `dock:POST` on that post's. A post alone is where its marker is abreast of
    the camera, on the way in from its first neighbour. POST:TOWARDS stands at the post, looking along that corridor.
    """
    where, _, towards = start.partition(":")
    track = campus.track
    try:
        if where == "dock":
            return _docked(track, start, towards)
        return _leaving(track, where, towards) if towards else _arrived(track, where)
    except (UnknownPost, UnknownCorridor) as error:
        raise UnknownStart(start, str(error)) from error


def _docked(track: CampusMap, start: str, post: str) -> Pose:
    docks = [place for place in track.docks() if (post in (place.name, place.bay_of) if post else not place.is_lent)]
    if not docks or not docks[0].dock:
        track.post(post or next(iter(track.posts)))
        raise UnknownStart(start, f"{post or track.name} has no dock")
    dock = docks[0].dock
    return Pose(dock.x_m, dock.y_m, dock.heading_rad)


def _arrived(track: CampusMap, name: str) -> Pose:
    place = track.post(name)
    ways = track.neighbours(name)
    if not ways:
        raise UnknownStart(name, "no corridor leads there")
    heading = ways[0][1].heading_arriving(name)
    return Pose(*moved(place.point, heading, -_marker_before_m(track, place)), heading)


def _marker_before_m(track: CampusMap, place: Post) -> float:
    if place.bay_of:
        return MARKER_BEFORE_BAY_M
    return MARKER_BEFORE_CROSSING_M if track.bays_of(place.name) else MARKER_BEFORE_PLACE_M


def _leaving(track: CampusMap, name: str, towards: str) -> Pose:
    post = track.post(name)
    return Pose(post.x_m, post.y_m, track.corridor(name, towards).heading_leaving(name))
