"""Where the robot is on the map, which way it looks, and which way to go: kept by what is seen at posts.

At a marker the map tells the heading: a robot that comes from post2 arrives at post3 along their corridor. From there
on odometry carries it, until the next marker resets it. Between posts only the heading goes on; the place is not
guessed.
"""

import math
from collections.abc import Set
from dataclasses import dataclass, replace
from itertools import pairwise

from maps import CampusMap, Corridor, NoRoute, corridor_name, shortest_route
from maps.geometry import wrapped
from protocol.parts import Leg
from robot.drivers.interfaces import Odometry, Sighting

LEFT_AFTER_MM = 700.0
"""A robot that has rolled on so far since it saw a marker has left the post (the marker stands 300 mm before it)."""
SAME_WAY_RAD = math.radians(60)
"""A heading that is off by less than this is taken for that of the corridor."""


@dataclass(frozen=True)
class Pose:
    """The last post seen, the one before, and the heading on the map when odometry's heading was `anchor_rad`.

    `standing`: the robot has not left `post` yet. `towards` is the post ahead once it has.
    """

    post: str | None = None
    previous: str | None = None
    standing: bool = False
    towards: str | None = None
    heading_rad: float | None = None
    anchor_rad: float = 0.0
    seen_at_s: float = -math.inf
    seen_at_mm: float = 0.0

    def heading_now(self, odometry: Odometry) -> float | None:
        return None if self.heading_rad is None else self.heading_rad + odometry.heading_rad - self.anchor_rad


def arrived(pose: Pose, campus: CampusMap, sighting: Sighting, odometry: Odometry) -> Pose:
    """After an accepted marker. One of the post just left, seen while rolling away from it, changes nothing."""
    post = sighting.text
    rolled_mm = odometry.travelled_mm - pose.seen_at_mm
    if post == pose.post and (pose.standing or rolled_mm < LEFT_AFTER_MM):
        return replace(pose, seen_at_s=sighting.at_s)
    previous = pose.previous if post == pose.post else pose.post
    heading_rad = _heading_on_arrival(campus, post, pose, odometry)
    return Pose(post, previous, True, None, heading_rad, odometry.heading_rad, sighting.at_s, odometry.travelled_mm)


def _heading_on_arrival(campus: CampusMap, post: str, pose: Pose, odometry: Odometry) -> float | None:
    arrivals = {corridor.other(post): corridor.heading_arriving(post) for _, corridor in campus.neighbours(post)}
    if pose.post in arrivals:
        return arrivals[pose.post]
    carried_rad = pose.heading_now(odometry)
    if carried_rad is not None and arrivals:
        nearest_rad = min(arrivals.values(), key=lambda heading: abs(wrapped(heading - carried_rad)))
        return nearest_rad if abs(wrapped(nearest_rad - carried_rad)) < SAME_WAY_RAD else carried_rad
    return next(iter(arrivals.values())) if len(arrivals) == 1 else None


def left(pose: Pose, campus: CampusMap, odometry: Odometry) -> Pose:
    """The robot follows the line away from its post, or on between two."""
    if not pose.standing or pose.post is None:
        return replace(pose, standing=False)
    towards = post_ahead(pose, campus, odometry)
    return replace(pose, standing=False, towards=towards, seen_at_mm=odometry.travelled_mm)


def rolled(pose: Pose, campus: CampusMap, odometry: Odometry) -> Pose:
    """A robot that drives in short pulses never says that it leaves: far enough from the marker, it has left."""
    if pose.standing and odometry.travelled_mm - pose.seen_at_mm > LEFT_AFTER_MM:
        return replace(left(pose, campus, odometry), seen_at_mm=pose.seen_at_mm)
    return pose


def post_ahead(pose: Pose, campus: CampusMap, odometry: Odometry) -> str | None:
    """The neighbour that the robot looks towards."""
    heading_rad = pose.heading_now(odometry)
    if pose.post is None or heading_rad is None:
        return None
    corridor = _nearest_corridor(campus, pose.post, heading_rad)
    return corridor.other(pose.post) if corridor else None


def _nearest_corridor(campus: CampusMap, post: str, heading_rad: float) -> Corridor | None:
    def off_rad(corridor: Corridor) -> float:
        return abs(wrapped(corridor.heading_leaving(post) - heading_rad))

    nearest = min((corridor for _, corridor in campus.neighbours(post)), key=off_rad, default=None)
    return nearest if nearest and off_rad(nearest) < SAME_WAY_RAD else None


def docked_at(pose: Pose, campus: CampusMap, post: str, odometry: Odometry) -> Pose:
    """Where a docked robot is, whatever it believed before."""
    dock = campus.post(post).dock
    previous = pose.previous if pose.post == post else pose.post
    heading_rad = dock.heading_rad if dock else None
    return Pose(post, previous, True, None, heading_rad, odometry.heading_rad, pose.seen_at_s, odometry.travelled_mm)


def looking(pose: Pose, heading_rad: float, odometry: Odometry) -> Pose:
    """It is known to look this way now (a turn or an undocking has ended on the line)."""
    return replace(pose, heading_rad=heading_rad, anchor_rad=odometry.heading_rad, seen_at_mm=odometry.travelled_mm)


def legs(campus: CampusMap, start: str, goal: str, avoid: Set[Leg] = frozenset()) -> tuple[Leg, ...]:
    """The corridors on the way. Raises NoRoute, UnknownPost."""
    names = frozenset(corridor_name(leg.from_post, leg.to_post) for leg in avoid)
    posts = shortest_route(campus, start, goal, names).posts
    return tuple(Leg(from_post=a, to_post=b) for a, b in pairwise(posts))


def turn_rad(pose: Pose, campus: CampusMap, odometry: Odometry, way: str, next_post: str | None) -> float:
    """How far to turn (left is positive): to the corridor to `next_post`, else by the plain meaning of `way`."""
    heading_rad = pose.heading_now(odometry)
    plain_rad = {"left": math.pi / 2, "right": -math.pi / 2, "behind": math.pi}[way]
    if heading_rad is None or pose.post is None or next_post is None or not pose.standing:
        return plain_rad
    by_map_rad = wrapped(campus.corridor(pose.post, next_post).heading_leaving(pose.post) - heading_rad)
    # Behind is behind on either side: a hair beyond 180 degrees must not turn the other way round than asked.
    return (
        by_map_rad if abs(by_map_rad) < math.radians(170) else math.copysign(math.pi, -1.0 if way == "right" else 1.0)
    )


def way_to(pose: Pose, campus: CampusMap, odometry: Odometry, destination: str, avoid: Set[Leg]) -> str | None:
    """forward, left, right, behind or arrived; None between posts, or where no way leads.

    Sectors are the paper's: within 45 degrees of the heading is forward, and so on; an unknown heading is forward.
    """
    if pose.post is None or not pose.standing:
        return None
    if pose.post == destination:
        return "arrived"
    heading_rad = pose.heading_now(odometry)
    if heading_rad is None:
        return "forward"
    try:
        first = legs(campus, pose.post, destination, avoid)[0]
    except NoRoute:
        return None
    return sector(wrapped(campus.corridor(first.from_post, first.to_post).heading_leaving(pose.post) - heading_rad))


def sector(bearing_rad: float) -> str:
    """The word for a bearing, counter-clockwise from the heading, in (-π, π]."""
    quarter = math.radians(45)
    if abs(bearing_rad) <= quarter:
        return "forward"
    if abs(bearing_rad) >= 3 * quarter:
        return "behind"
    return "left" if bearing_rad > 0 else "right"


def nearest_dock(campus: CampusMap, post: str | None, home: str | None, avoid: Set[Leg] = frozenset()) -> str | None:
    """The dock with the shortest way from `post`; the robot's own if the place is unknown."""
    reachable: list[tuple[float, str]] = []
    for dock in campus.docks() if post else ():
        try:
            names = frozenset(corridor_name(leg.from_post, leg.to_post) for leg in avoid)
            reachable.append((shortest_route(campus, post or "", dock.name, names).length_m, dock.name))
        except NoRoute:
            continue
    return min(reachable)[1] if reachable else home
