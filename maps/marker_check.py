"""Findings about markers: each arriving robot must see one in time, and none may stand where bodies are."""

import math
from collections.abc import Iterator

from maps.bays import MARKER_SIZE_M, WAITS_BEFORE_CROSSING_M, Marker
from maps.campus_map import CampusMap, Corridor, Post
from maps.geometry import Point, Segment, cross, distance_m, distance_to_path_m, moved, seen_from, wrapped
from maps.lines import Line, lines_of
from maps.problem import Problem, error, warning

# Where the left-hand camera can make out a marker of 80 mm, for a robot that rolls towards a place, and for one
# who stands in a dock and sees only what is abreast. 0.8 m leave 2.5 pixels per module at 640 × 480 and 60°.
SEEN_ROLLING_M = (-1.0, 0.2)
SEEN_STANDING_M = (-0.2, 0.2)
SEEN_LEFT_M = (0.2, 0.8)
SEEN_TURNED_RAD = math.radians(45)
# The robot's radius (174 mm, Create 2) and a little for the sheet itself.
CLEAR_OF_LINE_M = 0.22
SHEET_WIDTH_M = 0.148
"""The whole sheet hides what is behind it (A5, see `maps.sheets`)."""
# The bytes of a QR code of version 2 at error correction H (ISO/IEC 18004, table 7): 25 modules on 80 mm.
LONGEST_EASY_NAME = 14


def marker_problems(campus: CampusMap) -> Iterator[Problem]:
    """On the track: a bay is a place as a post is, and its spur a corridor."""
    track = campus.track
    markers = [marker for place in track.posts.values() for marker in place.markers]
    lines = lines_of(campus)
    for place in track.posts.values():
        for other, corridor in track.neighbours(place.name):
            yield from _approach(track, place, other, corridor, markers)
        yield from _dock(place)
        yield from _unseen(track, place)
        yield from _in_the_way(place, lines)
        if len(place.name) > LONGEST_EASY_NAME:
            yield _dense(place.name)


def _approach(
    track: CampusMap, place: Post, other: Post, corridor: Corridor, markers: list[Marker]
) -> Iterator[Problem]:
    seen = [marker for marker in place.markers if seen_on_arrival(track, marker, place, corridor)]
    if not seen:
        what = f"no marker of {place.name}{' in time to wait before it' if _waits(track, place, corridor) else ''}"
        said = f"a robot that comes from {other.name} sees {what}: its camera looks to the left"
        yield error("unseen_approach", place.name, said, "Put a marker on the left of that approach.")
        return
    arriving = corridor.heading_arriving(place.name)
    hiding = [hides for marker in seen if (hides := _hiding(marker, place.point, arriving, markers))]
    if len(hiding) == len(seen):
        said = f"the marker of {hiding[0].post} hides its marker from a robot that comes from {other.name}"
        yield error("hidden_marker", place.name, said, "Move one of the two markers, or turn one of the lines away.")


def _dock(place: Post) -> Iterator[Problem]:
    if place.dock and not any(_seen_from_dock(marker, place) for marker in place.markers):
        said = f"a robot in the dock of {place.name} sees no marker, so it would wake up without knowing where"
        yield warning("unseen_dock", place.name, said, "Put a marker on the left of the docked robot.")


def _unseen(track: CampusMap, place: Post) -> Iterator[Problem]:
    arrivals = [corridor for _, corridor in track.neighbours(place.name)]
    for number, marker in enumerate(place.markers, start=1):
        if not _seen_from_dock(marker, place) and not any(
            seen_on_arrival(track, marker, place, corridor) for corridor in arrivals
        ):
            at = f"{place.name}, marker {number}"
            yield error("unseen_marker", at, "no approach sees this marker", "Move or turn it, or take it away.")


def _in_the_way(place: Post, lines: tuple[Line, ...]) -> Iterator[Problem]:
    for number, marker in enumerate(place.markers, start=1):
        here = Point(marker.x_m, marker.y_m)
        for line in lines:
            if line.is_far_from((*here, *here), CLEAR_OF_LINE_M):
                continue
            if distance_to_path_m(here, line.path) < CLEAR_OF_LINE_M:
                said = f"it stands where a robot drives on {line}{', or stands at its end' if line.bay else ''}"
                way_out = f"Keep {CLEAR_OF_LINE_M} m from every line."
                yield error("marker_in_the_way", f"{place.name}, marker {number}", said, way_out)


def _dense(name: str) -> Problem:
    said = f"a name of {len(name)} characters makes a dense marker that is hard to read from a moving robot"
    return warning("dense_marker", name, said, f"Use {LONGEST_EASY_NAME} characters at most.")


# The camera


def seen_on_arrival(track: CampusMap, marker: Marker, place: Post, corridor: Corridor) -> bool:
    """Does a robot that comes along this corridor of the track see the marker, and early enough if it has to wait?"""
    latest_m = -WAITS_BEFORE_CROSSING_M if _waits(track, place, corridor) else SEEN_ROLLING_M[1]
    reach_m = (max(SEEN_ROLLING_M[0], -corridor.length_m), latest_m)
    return _seen(marker, place.point, corridor.heading_arriving(place.name), reach_m)


def _waits(track: CampusMap, place: Post, corridor: Corridor) -> bool:
    """A robot waits for the crossing in the corridor, or in the bay from which it comes."""
    return bool(track.bays_of(place.name)) and not track.post(corridor.other(place.name)).bay_of


def _seen_from_dock(marker: Marker, place: Post) -> bool:
    dock = place.dock
    return dock is not None and _seen(marker, Point(dock.x_m, dock.y_m), dock.heading_rad, SEEN_STANDING_M)


def _seen(marker: Marker, at: Point, robot_heading_rad: float, reach_m: tuple[float, float]) -> bool:
    """Does the left-hand camera of a robot that is, or rolls, at this place see the printed face?"""
    ahead_m, left_m = seen_from(at, robot_heading_rad, Point(marker.x_m, marker.y_m))
    turned_rad = wrapped(marker.heading_rad - (robot_heading_rad - math.pi / 2))
    near = reach_m[0] <= ahead_m <= reach_m[1] and SEEN_LEFT_M[0] <= left_m <= SEEN_LEFT_M[1]
    return near and abs(turned_rad) <= SEEN_TURNED_RAD


def _hiding(marker: Marker, at: Point, robot_heading_rad: float, markers: list[Marker]) -> Marker | None:
    """The sheet of another place between this marker and the camera that has it abreast, where it is read best."""
    ahead_m, _ = seen_from(at, robot_heading_rad, Point(marker.x_m, marker.y_m))
    camera = moved(at, robot_heading_rad, ahead_m)
    sights = [(camera, corner) for corner in _edges(marker, MARKER_SIZE_M)]
    for other in markers:
        near = distance_m(camera, Point(other.x_m, other.y_m)) < SEEN_LEFT_M[1] + SHEET_WIDTH_M
        if near and other.post != marker.post and any(cross(_edges(other, SHEET_WIDTH_M), sight) for sight in sights):
            return other
    return None


def _edges(marker: Marker, width_m: float) -> Segment:
    """Left and right edge of something upright on the marker's place, as seen from above."""
    here = Point(marker.x_m, marker.y_m)
    return moved(here, marker.heading_rad, 0.0, width_m / 2), moved(here, marker.heading_rad, 0.0, -width_m / 2)
