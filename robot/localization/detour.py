"""What a detour means that the service sends a robot on: decided here for the robot and for the one that benchmarks
simulate."""

from collections.abc import Collection

from maps import CampusMap, corridor_name
from protocol.parts import Leg


def detour_from(
    campus: CampusMap, told: Leg | None, at: str | None, waits_before: str | None, closed: Collection[str] = ()
) -> Leg | None:
    """Return the corridor that it has to take first from where it stands or waits, unless it knows that to be closed;
    `closed`: names of corridors. In a bay it goes from the bay's post."""
    address = at and campus.address_of(at)
    if told is None or told.from_post not in (at, address, waits_before):
        return None
    return None if corridor_name(told.from_post, told.to_post) in closed else told


def place_aside(campus: CampusMap, detour: Leg | None) -> str | None:
    """Return the place at its end, if it has to stand there first. A post with bays it passes: in the corridor it asks
    for what comes after, by its own plan."""
    return detour.to_post if detour is not None and not campus.bays_of(detour.to_post) else None
