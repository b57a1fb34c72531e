"""Where a simulated robot begins: `dock`, a post (just arrived, its marker in view) or POST:TOWARDS."""

from dataclasses import dataclass

from maps import CampusMap, UnknownPost
from maps.bays import MARKER_BEFORE_PLACE_M
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
    try:
        if where == "dock":
            return _docked(campus, start, towards)
        return _leaving(campus, where, towards) if towards else _arrived(campus, where)
    except (UnknownPost, UnknownCorridor) as error:
        raise UnknownStart(start, str(error)) from error


def _docked(campus: CampusMap, start: str, post: str) -> Pose:
    docks = campus.docks() if not post else (campus.post(post),)
    if not docks or not docks[0].dock:
        raise UnknownStart(start, f"{post or campus.name} has no dock")
    dock = docks[0].dock
    return Pose(dock.x_m, dock.y_m, dock.heading_rad)


def _arrived(campus: CampusMap, name: str) -> Pose:
    post = campus.post(name)
    ways = campus.neighbours(name)
    if not ways:
        raise UnknownStart(name, "no corridor leads there")
    heading = ways[0][1].heading_arriving(name)
    return Pose(*moved(post.point, heading, -MARKER_BEFORE_PLACE_M), heading)


def _leaving(campus: CampusMap, name: str, towards: str) -> Pose:
    post = campus.post(name)
    return Pose(post.x_m, post.y_m, campus.corridor(name, towards).heading_leaving(name))
