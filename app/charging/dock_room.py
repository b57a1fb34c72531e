"""Makes room in docks: who has charge enough and nothing to do leaves its dock to a robot that needs it more.

It is sent to park first, and the other to the dock once it is free: no robot sees that another stands in it.
"""

from collections.abc import Iterable, Iterator, Mapping
from math import inf

from app.dispatch.charge_limits import LEAVES_DOCK, THRESHOLDS
from app.dispatch.open_work import OpenWork, RobotNow
from fleet.charging.docks import Need
from fleet.charging.top_ups import Move, makes_room
from maps import CampusMap
from maps.ways import Ways


def leaving(
    moves: Iterable[Move], needs: Mapping[str, Need], resting: Mapping[str, str], awaited: Iterable[str]
) -> Iterator[str]:
    """Robots that leave their docks. `moves`: to docks that are taken; `resting`: who may be asked to, by dock;
    `awaited`: see `free_docks.driving_there`."""
    for move in moves:
        other = resting.get(move.dock)
        if other is not None and makes_room(needs[other], needs[move.robot], THRESHOLDS):
            yield other
    for dock in awaited:
        other = resting.get(dock)
        if other is not None and needs[other].charge.ratio >= LEAVES_DOCK:
            yield other


def parking(campus: CampusMap, work: OpenWork, robot: RobotNow, ways: Ways) -> str | None:
    """The nearest post without a dock where it blocks no robot: a bay stays free beside it, or no way leads on.
    None if there is none. A robot is led aside only if it asks for a way."""
    taken = [post for one in work.robots.values() if one.name != robot.name for post in _posts_of(one, work)]
    way_m = {
        post.name: ways.length_m(robot.post, post.name)
        for post in campus.posts.values()
        if post.dock is None and post.bays - taken.count(post.name) > (len(campus.neighbours(post.name)) > 1)
    }
    nearest = min(way_m, key=lambda name: (way_m[name], name), default=None)
    return nearest if nearest is not None and way_m[nearest] < inf else None


def _posts_of(robot: RobotNow, work: OpenWork) -> set[str]:
    """Where it takes a bay, or will: not at home, where its place is clear of them."""
    here = {robot.post} if robot.post and robot.post != robot.home else set[str]()
    return here | {stop.post for stop in work.stops.get(robot.name, ())}
