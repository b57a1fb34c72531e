"""Where the simulated world has each robot, beside what the robot reports to be in."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Literal

from maps import CampusMap, Corridor
from maps.bays import WAITS_BEFORE_CROSSING_M
from maps.geometry import Point, distance_m, distance_to_path_m, heading_rad, path_length_m, seen_from
from robot.simulated import TruePose

Agreement = Literal["agrees", "moving", "differs"]
Place = tuple[str, str]
"""A kind and a name: a bay, the crossing of a post, a corridor."""


@dataclass(frozen=True)
class OnTrack:
    """The nearest point of the track: `part` of the way from `a` to `b`, two posts or a post and its bay.

    `beside_m`: how far the middle of the axle is from there; half a metre in a dock.
    """

    a: str
    b: str
    part: float
    beside_m: float
    heading_rad: float


def on_track(campus: CampusMap, pose: TruePose) -> OnTrack:
    """The true pose as a place on the lines that a map draws."""
    point = Point(pose.x_m, pose.y_m)
    line = _line_at(campus, point)
    part = _along_m(line.tape, point) / path_length_m(line.tape)
    return OnTrack(line.a, line.b, part, distance_to_path_m(point, line.tape), pose.heading_rad)


def true_places(campus: CampusMap, pose: TruePose) -> frozenset[Place]:
    """The bay or corridor whose tape is nearest, and the crossing if the body is on it."""
    point = Point(pose.x_m, pose.y_m)
    return frozenset(_places_at(campus, point))


def agreement(campus: CampusMap, reported: Mapping[str, Any] | None, pose: TruePose) -> Agreement | None:
    """Compare them; None without a report. A robot reports a place when it is wholly there: until then it is `moving`
    from the place before, which is beside the true one."""
    place = _reported_place(campus, reported) if reported else None
    if place is None:
        return None
    true = true_places(campus, pose)
    if place in true:
        return "agrees"
    return "moving" if any(place in _beside(campus, one) for one in true) else "differs"


def _places_at(campus: CampusMap, point: Point) -> Iterator[Place]:
    line = _line_at(campus, point)
    bay = next((end for end in (line.a, line.b) if campus.track.post(end).bay_of), None)
    yield ("bay", bay) if bay else ("corridor", line.name)
    for end in {campus.address_of(line.a), campus.address_of(line.b)}:
        if distance_m(campus.post(end).point, point) < WAITS_BEFORE_CROSSING_M:
            yield "crossing", end


def _beside(campus: CampusMap, place: Place) -> Iterator[Place]:
    """Places that a body enters next from here."""
    kind, name = place
    if kind == "bay":
        yield "crossing", campus.address_of(name)
    elif kind == "corridor":
        line = campus.corridor_named(name)
        yield from (("crossing", line.a), ("crossing", line.b))
    else:
        yield from (("bay", bay.name) for bay in campus.track.bays_of(name))
        yield from (("corridor", line.name) for _, line in campus.neighbours(name))


def _reported_place(campus: CampusMap, reported: Mapping[str, Any]) -> Place | None:
    kind, place, towards = reported["kind"], reported["place"], reported["towards"]
    if kind != "corridor":
        return kind, place
    bay = next((end for end in (place, towards) if campus.track.post(end).bay_of), None)
    return ("bay", bay) if bay else ("corridor", campus.corridor(place, towards).name)


def _line_at(campus: CampusMap, point: Point) -> Corridor:
    return min(campus.track.corridors, key=lambda line: distance_to_path_m(point, line.tape))


def _along_m(tape: tuple[Point, ...], point: Point) -> float:
    """How far along the tape its nearest point is."""
    before_m, best = 0.0, (float("inf"), 0.0)
    for a, b in pairwise(tape):
        length_m = distance_m(a, b)
        ahead_m = min(max(seen_from(a, heading_rad(a, b), point)[0], 0.0), length_m)
        best = min(best, (distance_to_path_m(point, (a, b)), before_m + ahead_m))
        before_m += length_m
    return best[1]
