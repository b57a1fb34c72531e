"""Every turn of a map once: along a corridor to a post, round there, and off along the next one.

The robot must stop at the post, turn by the angle of the map, and be on the right tape 0.7 m later, without having
looked for the line: branches and corners of the tape lie under its diodes on the way.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from statistics import mean
from typing import Any

from benchmarks.body.tracks import Stepped
from maps import CampusMap, Point, builtin_map
from maps.campus_map import build_map, map_path
from maps.geometry import distance_to_path_m, heading_rad, moved
from maps.map_file import load_map_file
from maps.scaling import fitting_factor, scaled
from robot.localization.directions import turn_at_rad
from robot.simulated import Pose
from robot.skills import Done, FollowLine, Turn

FROM_M, ON_M = 1.2, 0.7
NEAR_M = 0.03
TURN_MM_S = 200.0
ON_THE_LINE = "on the line"


@dataclass
class Crossing:
    """The outcome of one turn."""

    came_from: str
    via: str
    towards: str
    outcome: str = ON_THE_LINE
    turn_s: float = 0.0
    stopped_off_m: float = 0.0
    searches: int = 0


def measure_turns(seed: int) -> dict[str, Any]:
    """On the tracks of both maps, bays included; the tunnels with corridors of 3 to 10 m."""
    campuses = (builtin_map("test_track").track, small_map("carleton").track)
    return {campus.name: _figures([cross(campus, *turn, seed) for turn in triples(campus)]) for campus in campuses}


def _figures(crossings: Sequence[Crossing]) -> dict[str, Any]:
    failed = [one for one in crossings if one.outcome != ON_THE_LINE or one.searches]
    return {
        "turns": len(crossings),
        "completed_share": 1 - len(failed) / len(crossings),
        "mean_turn_s": mean(one.turn_s for one in crossings),
        "longest_turn_s": max(one.turn_s for one in crossings),
        "farthest_stop_mm": 1000 * max(one.stopped_off_m for one in crossings),
        "failed": [str(one) for one in failed],
    }


def small_map(name: Path | str, shortest_m: float = 3.0, longest_m: float = 10.0) -> CampusMap:
    """A map with corridors of so many metres."""
    file = load_map_file(map_path(name))
    return build_map(scaled(file, fitting_factor(file, shortest_m, longest_m)))


def triples(campus: CampusMap) -> Iterator[tuple[str, str, str]]:
    for via in campus.posts:
        beside = [post.name for post, _ in campus.neighbours(via)]
        yield from ((came_from, via, towards) for came_from in beside for towards in beside)


def before(campus: CampusMap, came_from: str, via: str, before_m: float = FROM_M) -> Pose:
    """On the tape, so far before the post or half the corridor, looking along it."""
    corridor = campus.corridor(came_from, via)
    left_m = min(before_m, corridor.length_m / 2)
    line = corridor.tape_from(via)
    for a, b in pairwise(line):
        if left_m <= math.dist(a, b):
            here = moved(a, heading_rad(a, b), left_m)
            return Pose(here.x_m, here.y_m, heading_rad(b, a))
        left_m -= math.dist(a, b)
    return Pose(*line[-1], heading_rad(line[-1], line[-2]))


def cross(campus: CampusMap, came_from: str, via: str, towards: str, seed: int, lead_mm: float = 60.0) -> Crossing:
    """Drive it once."""
    one = Crossing(came_from, via, towards)
    stepped = Stepped(campus, f"{via}:{towards}", seed, lead_mm)
    try:
        stepped.robot.place(before(campus, came_from, via))
        outcome = stepped.do(FollowLine(campus, came_from, shape=stepped.shape))
        pose, post = stepped.robot.pose, campus.post(via)
        one.stopped_off_m = math.dist((pose.x_m, pose.y_m), post.point)
        if outcome != Done(via):
            one.outcome = f"before the post: {outcome}"
            return one
        began_s = stepped.now
        turned = stepped.do(Turn(turn_at_rad(campus, came_from, via, towards), stepped.shape, TURN_MM_S))
        one.turn_s = stepped.now - began_s
        _drive_on(stepped, via)
        one.searches = stepped.loop.view.find_line_episodes
        if not isinstance(turned, Done):
            one.outcome = f"turn: {turned}"
        elif _off_m(campus, via, towards, stepped.robot.pose) > NEAR_M:
            one.outcome = f"elsewhere: {stepped.robot.pose}"
        return one
    finally:
        stepped.close()


def _drive_on(stepped: Stepped, via: str) -> None:
    job = stepped.loop.start(FollowLine(stepped.campus, via, shape=stepped.shape), stepped.now)
    post = stepped.campus.post(via).point
    until_s = stepped.now + 30
    while stepped.now < until_s:
        stepped.tick()
        pose = stepped.robot.pose
        if math.dist((pose.x_m, pose.y_m), post) > ON_M or any(end.job == job for end in stepped.loop.finished()):
            return


def _off_m(campus: CampusMap, via: str, towards: str, pose: Pose) -> float:
    return distance_to_path_m(Point(pose.x_m, pose.y_m), campus.corridor(via, towards).tape)
