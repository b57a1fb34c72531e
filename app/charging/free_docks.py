"""Free docks: no robot stands in them or is on its way there, and they are no robot's own."""

from math import inf
from typing import Final

from app.dispatch.charge_limits import THRESHOLDS
from app.dispatch.open_work import OpenWork, RobotNow
from maps.ways import Ways
from protocol.parts import StopAction

UNTIL_RATIO: Final = "until_ratio"
"""Robots that do not know this field of a stop are left to their own battery plan."""


def free_docks(ways: Ways, work: OpenWork, robot: str) -> list[str]:
    """For this robot, its own among them."""
    its, others = work.robots[robot], [one for one in work.robots.values() if one.name != robot]
    taken = {dock for one in others for dock in docks_of(one, work)}
    taken |= {dock for other, dock in driving_there(ways, work).items() if other != robot}
    return [dock for dock in (*_its_own(ways, its), *shared_docks(ways, work)) if dock not in taken]


def shared_docks(ways: Ways, work: OpenWork) -> list[str]:
    """Those in which no robot has its home."""
    own = {robot.home for robot in work.robots.values()}
    return [dock for dock in ways.campus.docks_to_share() if dock not in own]


def driving_there(ways: Ways, work: OpenWork) -> dict[str, str]:
    """The dock that each robot comes to whose own battery plan has taken over: the nearest, occupied or not."""
    found, shared = dict[str, str](), shared_docks(ways, work)
    for one in work.robots.values():
        is_low = one.battery_ratio is not None and one.battery_ratio < THRESHOLDS.low
        if is_low and one.is_there and one.post and not docks_of(one, work):
            way_m = {dock: ways.length_m(one.post, dock) for dock in (*_its_own(ways, one), *shared)}
            nearest = min(way_m, key=lambda dock: (way_m[dock], dock), default=None)
            if nearest is not None and way_m[nearest] < inf:
                found[one.name] = nearest
    return found


def _its_own(ways: Ways, robot: RobotNow) -> set[str]:
    return {post.name for post in ways.campus.docks() if post.name == robot.home}


def docks_of(robot: RobotNow, work: OpenWork) -> list[str]:
    """Where it stands in a dock, and those that it is bound for."""
    bound = [stop.post for stop in work.stops.get(robot.name, ()) if stop.action == StopAction.DOCK]
    return [robot.post, *bound] if robot.docked and robot.post else bound


def taken_docks(work: OpenWork) -> set[str]:
    """Of robots that are not there, too: they may come back."""
    return {dock for robot in work.robots.values() for dock in docks_of(robot, work)}
