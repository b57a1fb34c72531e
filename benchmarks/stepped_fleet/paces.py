"""Paces: what each part of a way takes whole robots, by their true poses.

The durations of the simulated fleet (`benchmarks.fleet_simulation.durations`) are these.

A robot is on a crossing within `CROSSING_M` of its post, beyond that in a bay or a corridor, whichever line is nearer.
Waits do not count: a stay in which a robot stood is left out, and in bays only the ways in and out are timed.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np

from benchmarks.stepped_fleet.judge import CROSSING_M
from maps import CampusMap
from maps.geometry import Point, distance_to_path_m
from robot.simulated.true_poses import TruePose

STILL_M: Final = 0.0005
STILL_RAD: Final = 0.002
"""Between two looks."""
STANDS_S: Final = 1.0
"""A shorter rest belongs to a move."""


@dataclass
class _Stay:
    """In one bay, crossing or corridor, at which a robot was and comes from. `rests`: from when until when it stood."""

    kind: str
    place: str
    before: "_Stay | None"
    since_s: float
    rests: list[tuple[float, float]] = field(default_factory=list)
    still_since_s: float | None = None
    is_carried: bool = False

    def moves(self, now_s: float) -> None:
        if self.still_since_s is not None and now_s - self.still_since_s >= STANDS_S:
            self.rests.append((self.still_since_s, now_s))
        self.still_since_s = None

    def stands(self, now_s: float) -> None:
        self.still_since_s = now_s if self.still_since_s is None else self.still_since_s


@dataclass
class Paces:
    """Of all robots of one run; `look` at every true pose, `hear` what the database says that they occupy."""

    track: CampusMap
    _now: dict[str, _Stay] = field(default_factory=dict)
    _last: dict[str, TruePose] = field(default_factory=dict)
    _said: dict[str, str] = field(default_factory=dict)
    _took: dict[str, list[float]] = field(default_factory=dict)

    def look(self, poses: Mapping[str, TruePose]) -> None:
        for name, pose in poses.items():
            kind, place = self._region(Point(pose.x_m, pose.y_m))
            stay, last = self._now.get(name), self._last.get(name)
            self._last[name] = pose
            if stay is None or last is None or (stay.kind, stay.place) != (kind, place):
                self._now[name] = _Stay(kind, place, stay, pose.time_s)
                if stay is not None:
                    stay.moves(pose.time_s)
                    self._note(stay, kind, pose.time_s)
                    stay.before = None  # two of them are all that counts
                continue
            stay.is_carried |= last.handled != pose.handled
            if _is_still(last, pose):
                stay.stands(last.time_s)
            else:
                stay.moves(last.time_s)

    def hear(self, occupied: Mapping[str, str]) -> None:
        """`occupied`: what each robot said last that it is in: a bay, a crossing or a corridor."""
        for name, kind in occupied.items():
            said, self._said[name] = self._said.get(name), kind
            stay, last = self._now.get(name), self._last.get(name)
            if kind == "corridor" != said and stay is not None and last is not None and stay.kind == "corridor":
                self._add("beyond a crossing until it says so, s", last.time_s - stay.since_s)

    def figures(self) -> dict[str, Any]:
        return {
            what: {"count": len(took), **{f"p{q}": round(float(np.percentile(took, q)), 2) for q in (10, 50, 90)}}
            for what, took in sorted(self._took.items())
        }

    def _region(self, here: Point) -> tuple[str, str]:
        posts = (post for post in self.track.posts.values() if self.track.bays_of(post.name))
        near = next((post.name for post in posts if math.dist(post.point, here) < CROSSING_M), None)
        if near is not None:
            return "crossing", near
        line = min(self.track.corridors, key=lambda one: distance_to_path_m(here, one.tape))
        bay = next((end for end in (line.a, line.b) if self.track.post(end).bay_of), None)
        return ("bay", bay) if bay is not None else ("corridor", line.name)

    def _note(self, stay: _Stay, after: str, now_s: float) -> None:
        if stay.is_carried:
            return
        if stay.kind == "bay" and stay.rests:
            with_dock = " with a dock" if self.track.post(stay.place).dock else ""
            began_s, ended_s = max(stay.rests, key=lambda rest: rest[1] - rest[0])
            self._add(f"out of a bay{with_dock}, s", now_s - ended_s)
            if stay.before is not None:
                self._add(f"into a bay{with_dock}, s", began_s - stay.since_s)
        elif stay.before is None:
            return
        elif stay.kind == "crossing" and not stay.rests:
            self._add(f"over a crossing, from a {stay.before.kind} into a {after}, s", now_s - stay.since_s)
        elif stay.kind == "corridor" and after == "crossing" and not stay.rests:
            length_m = next(one.length_m for one in self.track.corridors if one.name == stay.place)
            self._add("corridor, s/m", (now_s - stay.since_s) / (length_m - 2 * CROSSING_M))

    def _add(self, what: str, took: float) -> None:
        self._took.setdefault(what, []).append(took)


def _is_still(before: TruePose, now: TruePose) -> bool:
    moved_m = math.dist((before.x_m, before.y_m), (now.x_m, now.y_m))
    return moved_m < STILL_M and abs(now.heading_rad - before.heading_rad) < STILL_RAD
