"""When an order should arrive: an interval from the lengths on the map. Thin: speed and waits are assumed."""

import math
from dataclasses import dataclass
from datetime import datetime, timedelta

from app.settings import Settings
from maps import shortest_route
from maps.ways import Ways

SPREAD = 2.0
"""The far end of the window: everything takes up to this much longer."""


@dataclass(frozen=True)
class Window:
    """From the earliest to the latest arrival that is expected; both UTC."""

    begins_at: datetime
    ends_at: datetime


def arrival_window(ways: Ways, from_post: str, to_post: str, now: datetime, settings: Settings) -> Window:
    """When mail ordered `now` should be at `to_post`. Raises the map's UnknownPost and NoRoute.

    The robot is assumed to come from the dock farthest from the sender: too late an estimate disappoints nobody.
    """
    way_m = _length_m(ways, from_post, to_post)
    coming_m = max((_length_m(ways, dock.name, from_post) for dock in ways.campus.docks()), default=0.0)
    earliest_s = way_m / settings.assumed_speed_m_s + settings.assumed_handover_s
    latest_s = SPREAD * ((way_m + coming_m) / settings.assumed_speed_m_s + settings.assumed_handover_s)
    return Window(now + timedelta(seconds=earliest_s), now + timedelta(seconds=latest_s))


def _length_m(ways: Ways, from_post: str, to_post: str) -> float:
    length_m = ways.length_m(from_post, to_post)
    # Asked anew where there is no way: the map says why.
    return length_m if math.isfinite(length_m) else shortest_route(ways.campus, from_post, to_post).length_m
