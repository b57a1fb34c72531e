"""Where a robot is in the schedule's words, from its reports and from what it was granted on the track."""

from collections.abc import Iterator, Sequence

from app.traffic.snapshot import Hold, RobotLocation
from fleet.schedule.placing import Place
from maps import CampusMap, corridor_name


def standing(track: CampusMap, one: RobotLocation) -> Place:
    """Of a robot that has reported what it occupies."""
    assert one.occupies is not None  # noqa: S101  # others have no place on a map with bays
    match one.occupies.kind:
        case "bay":
            return _in_bay(track, one, one.occupies.place)
        case "crossing":
            return _on_crossing(track, one, one.occupies.place)
    return _in_corridor(track, one, one.occupies.place, one.occupies.towards or "")


def lanes_of(track: CampusMap, holds: Sequence[Hold]) -> tuple[Hold, ...]:
    """Those that are corridors between posts."""
    return tuple(hold for hold in holds if not _bay_of(track, hold))


def bay_ahead(track: CampusMap, one: RobotLocation, post: str) -> str | None:
    """The bay of this post into which it was let, and has not come yet."""
    bays = (hold.to_post for hold in one.holds if hold.from_post == post and _bay_of(track, hold))
    return next((bay for bay in bays if one.occupies is None or bay != one.occupies.place), None)


def _in_bay(track: CampusMap, one: RobotLocation, bay: str) -> Place:
    post, at_home = track.address_of(bay), bay == one.home_bay
    if towards := tuple(_chain(track, one, post)):
        return Place(post, at_home, towards, on_crossing=True, to_home=_to_home(track, one, towards))
    other = bay_ahead(track, one, post)
    return Place(post, at_home, on_crossing=other is not None, to_home=other is not None and other == one.home_bay)


def _on_crossing(track: CampusMap, one: RobotLocation, post: str) -> Place:
    if towards := tuple(_chain(track, one, post)):
        return Place(post, False, towards, on_crossing=True, to_home=_to_home(track, one, towards))
    bay = bay_ahead(track, one, post)
    return Place(post, bay is not None and bay == one.home_bay, on_crossing=True)


def _in_corridor(track: CampusMap, one: RobotLocation, behind: str, ahead: str) -> Place:
    """Turned round, or where it was not granted, it comes to the other end all the same. Out of what it was granted it
    is on the crossing, and says so next."""
    inside = corridor_name(behind, ahead)
    if all(hold.corridor != inside for hold in one.holds) and any(hold.from_post == ahead for hold in one.holds):
        return _on_crossing(track, one, ahead)
    towards = tuple(_chain(track, one, behind))
    if towards[:1] != (ahead,):
        towards = (ahead,)
    is_let_in = bay_ahead(track, one, towards[-1]) is not None
    return Place(behind, False, towards, to_home=_to_home(track, one, towards), is_let_in=is_let_in)


def _chain(track: CampusMap, one: RobotLocation, start: str) -> Iterator[str]:
    """The posts to which it may drive on from here, one after the other."""
    lanes, seen = lanes_of(track, one.holds), {start}
    at: str | None = start
    while at is not None:
        at = next((lane.to_post for lane in lanes if lane.from_post == at and lane.to_post not in seen), None)
        if at is not None:
            seen.add(at)
            yield at


def _to_home(track: CampusMap, one: RobotLocation, towards: Sequence[str]) -> bool:
    bay = bay_ahead(track, one, towards[-1])
    return bay == one.home_bay if bay else one.home == towards[-1] and one.home_bay is not None


def _bay_of(track: CampusMap, hold: Hold) -> bool:
    return bool(track.post(hold.from_post).bay_of or track.post(hold.to_post).bay_of)
