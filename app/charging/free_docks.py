"""Free docks: no robot stands in them or is on its way there, and they are no robot's own."""

from typing import Final

from app.dispatch.open_work import OpenWork, RobotNow
from maps import CampusMap
from protocol.parts import StopAction

UNTIL_RATIO: Final = "until_ratio"
"""Robots that do not know this field of a stop are left to their own battery plan."""


def free_docks(campus: CampusMap, work: OpenWork, robot: str) -> list[str]:
    """For this robot, its own among them."""
    its, others = work.robots[robot], [one for one in work.robots.values() if one.name != robot]
    taken = {dock for one in others for dock in docks_of(one, work)}
    its_own = {post.name for post in campus.docks()} & {its.home}
    return [dock for dock in (*its_own, *shared_docks(campus, work)) if dock not in taken]


def shared_docks(campus: CampusMap, work: OpenWork) -> list[str]:
    """Those in which no robot has its home."""
    own = {robot.home for robot in work.robots.values()}
    return [dock for dock in campus.docks_to_share() if dock not in own]


def docks_of(robot: RobotNow, work: OpenWork) -> list[str]:
    """Where it stands in a dock, and those that it is bound for."""
    bound = [stop.post for stop in work.stops.get(robot.name, ()) if stop.action == StopAction.DOCK]
    return [robot.post, *bound] if robot.docked and robot.post else bound


def taken_docks(work: OpenWork) -> set[str]:
    """Of robots that are not there, too: they may come back."""
    return {dock for robot in work.robots.values() for dock in docks_of(robot, work)}
