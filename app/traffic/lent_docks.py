"""Docks that are no robot's home: each is lent to the robot that stands in it or is bound for it.

For as long as that lasts it rests there in the end, as it does in its home: no other is let in, and the way of all
robots to where they rest stays what the schedule is sure of.
"""

from collections.abc import Mapping
from dataclasses import replace

from app.traffic.snapshot import OF_ITS_OWN, RobotLocation
from maps import CampusMap, Post


def with_lent_docks(track: CampusMap, robots: Mapping[str, RobotLocation]) -> dict[str, RobotLocation]:
    """The same robots, with the docks that are lent to them for homes."""
    found = dict(robots)
    for dock in (place for place in track.docks() if place.is_lent):
        wants = {name: how for name, one in robots.items() if (how := _how_near(track, dock, one)) is not None}
        if wants:
            name = min(wants, key=lambda robot: (wants[robot], robot))
            found[name] = _at_home_in(dock, robots[name])
    return found


def _how_near(track: CampusMap, dock: Post, one: RobotLocation) -> int | None:
    """It is in it or was let in (0), is sent there (1), is on its way there (2) or asks for one (3)."""
    if _is_inside(dock, one) or any(hold.to_post == dock.name for hold in one.holds):
        return None if _moves_next_door(track, dock, one) else 0
    its = one.goals[0] if one.goals else None
    if its is not None and its.key != OF_ITS_OWN and its.charges_to is not None and its.post == dock.bay_of:
        return 1
    if any(hold.goal == dock.name for hold in one.holds):
        return 2
    return 3 if one.request is not None and one.request.place == dock.name else None


def _moves_next_door(track: CampusMap, dock: Post, one: RobotLocation) -> bool:
    """Tell if it goes from the dock to its own home at the same post."""
    home = one.home_bay
    return home is not None and track.address_of(home) == dock.bay_of and one.goes_into(home)


def _at_home_in(dock: Post, one: RobotLocation) -> RobotLocation:
    return replace(one, home=dock.bay_of, home_bay=dock.name, at_home=_is_inside(dock, one))


def _is_inside(dock: Post, one: RobotLocation) -> bool:
    return one.occupies is not None and one.occupies.place == dock.name
