"""Bays: the places on the floor where robots stand, clear of the line, and the markers and docks of places.

A bay is a spur of tape off a post: it begins at the post, ends where the axle of a standing robot is, and has a marker
beside its end. A robot drives straight on from there into the dock, if it has one.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass

from maps.geometry import Point, heading_rad, moved
from maps.map_file import BayRow, PoseRow, PostRow

MARKER_SIZE_M = 0.08
# Where a marker stands unless the file says otherwise, as seen on arrival: on the left, where the camera looks; before
# the place, so that the robot knows the distance left to roll; and clear of the line by more than the robot's radius
# (174 mm), so that a branch to the left stays free.
MARKER_BEFORE_PLACE_M = 0.30
MARKER_BEFORE_CROSSING_M = 0.60
"""Before a post with bays: a robot that may not cross yet reads it, and stops where nothing that crosses can touch
it."""
WAITS_BEFORE_CROSSING_M = 0.50
"""The axle of a robot that may not cross yet, from the post: it has room to stop after the marker, its body (348 mm) is
clear of one that turns there, and a line 55° beside its own is 0.41 m away (`maps.room`)."""
MARKER_BEFORE_BAY_M = 0.10
"""Nearer than before a post: markers of other lines stand beside the beginning of the spur."""
MARKER_BESIDE_LINE_M = 0.35
DOCK_BEYOND_BAY_M = 0.50
"""The centre of a docked robot, from the end of the tape: the firmware needs that much to come straight."""


@dataclass(frozen=True)
class Marker:
    """A QR code that says `post`, at (x_m, y_m); heading_rad is the way its printed face looks."""

    post: str
    x_m: float
    y_m: float
    heading_rad: float
    size_m: float = MARKER_SIZE_M


@dataclass(frozen=True)
class Dock:
    """Where the centre of a docked robot is, and the way that robot looks: into the dock."""

    x_m: float
    y_m: float
    heading_rad: float


@dataclass(frozen=True)
class Bay:
    """A spur of tape off `post`: its bearing from there, its length, and the place of the axle of a robot in it.

    `home`: it is kept for the robot whose home it is; `tag`: see `maps.tags`. One with a dock that is no home is kept
    for robots that charge; all others are for every robot.
    """

    name: str
    post: str
    bearing_rad: float
    length_m: float
    x_m: float
    y_m: float
    markers: tuple[Marker, ...]
    home: bool = False
    dock: Dock | None = None
    tag: int | None = None

    @property
    def point(self) -> Point:
        return Point(self.x_m, self.y_m)

    @property
    def is_for_passing(self) -> bool:
        return not self.home and self.dock is None

    @property
    def is_lent(self) -> bool:
        """To robots that charge."""
        return not self.home and self.dock is not None


def bays_of(row: PostRow, tags: Mapping[str, int | None]) -> tuple[Bay, ...]:
    """The bays of one post, in the order of the file."""
    return tuple(_bay(row, bay, name, tags[name]) for bay, name in zip(row.bay, row.bay_names(), strict=True))


def _bay(row: PostRow, bay: BayRow, name: str, tag: int | None) -> Bay:
    bearing_rad = math.radians(bay.bearing_deg)
    post = Point(row.x_m, row.y_m)
    end = moved(post, bearing_rad, bay.length_m)
    dock = Dock(*moved(end, bearing_rad, DOCK_BEYOND_BAY_M), bearing_rad) if bay.dock else None
    beside_end = marker(name, end, bearing_rad, MARKER_BEFORE_BAY_M)
    beside_dock = (marker(name, Point(dock.x_m, dock.y_m), bearing_rad, 0.0),) if dock else ()
    markers = (beside_end, *beside_dock)
    return Bay(name, row.name, bearing_rad, bay.length_m, end.x_m, end.y_m, markers, bay.home, dock, tag)


def own_markers(post: str, rows: tuple[PoseRow, ...]) -> tuple[Marker, ...]:
    """The markers whose places the file gives."""
    return tuple(Marker(post, row.x_m, row.y_m, math.radians(row.heading_deg)) for row in rows)


def marker(post: str, seen_from: Point, robot_heading_rad: float, before_m: float) -> Marker:
    """A marker on the left of a robot, its face turned towards the camera."""
    x_m, y_m = moved(seen_from, robot_heading_rad, -before_m, MARKER_BESIDE_LINE_M)
    return Marker(post, x_m, y_m, heading_rad(Point(x_m, y_m), moved(seen_from, robot_heading_rad, -before_m)))
