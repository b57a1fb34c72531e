"""Which bay of a post a robot gets: decided when it is let in, by what all robots report and hold."""

from collections.abc import Iterable, Iterator

from app.traffic.snapshot import RobotLocation
from maps import CampusMap, corridor_name


def free_bay(
    track: CampusMap, post: str, robot: RobotLocation, all_robots: Iterable[RobotLocation], closed: frozenset[str]
) -> str | None:
    """The first bay of a post for passing that is no other robot's, and whose spur no robot found closed."""
    taken = {bay for other in all_robots if other.robot != robot.robot for bay in bays_of(track, other)}
    passing = [bay.name for bay in track.bays_of(post) if bay.is_for_passing]
    return next((bay for bay in passing if bay not in taken and corridor_name(post, bay) not in closed), None)


def bays_of(track: CampusMap, one: RobotLocation) -> Iterator[str]:
    """The bays that a robot stands in, comes from or was let into."""
    places = [] if one.occupies is None else [one.occupies.place]
    for hold in one.holds:
        places += [hold.from_post, hold.to_post]
    yield from (place for place in places if track.post(place).bay_of)
