"""Where the map says that no robot is heard, none is: on a crossing or in a bay without network, by its true pose."""

import asyncio
import math
from collections import Counter
from typing import Final

from benchmarks.fleet_simulation.network import ROBOT_NOTICES_S, SERVICE_NOTICES_S
from benchmarks.stepped_fleet.judge import CROSSING_M
from benchmarks.stepped_fleet.robots import SteppedRobot
from maps import CampusMap
from maps.geometry import Point, distance_to_path_m

LOOK_S: Final = 0.5


def is_silent(track: CampusMap, here: Point) -> bool:
    posts = [post for post in track.posts.values() if not post.network and not post.bay_of]
    spurs = [track.corridor(post.name, bay.name) for post in posts for bay in track.bays_of(post.name)]
    on_crossing = any(math.dist(post.point, here) < CROSSING_M for post in posts)
    return on_crossing or any(distance_to_path_m(here, spur.tape) < CROSSING_M for spur in spurs)


async def keep_silent(one: SteppedRobot, track: CampusMap, befallen: Counter[str]) -> None:
    """For as long as the run lasts. Both ends notice after a while; before that it is only late."""
    while True:
        await asyncio.sleep(LOOK_S)
        if not is_silent(track, Point(one.body.pose.x_m, one.body.pose.y_m)):
            continue
        line, away_s = one.network.line, 0.0
        one.network.is_up = False
        if line is not None:
            line.cut()
        while is_silent(track, Point(one.body.pose.x_m, one.body.pose.y_m)):
            await asyncio.sleep(LOOK_S)
            away_s += LOOK_S
            if line is not None and away_s > ROBOT_NOTICES_S:
                line.break_off(service_after_s=SERVICE_NOTICES_S - ROBOT_NOTICES_S)
        befallen["silence"] += 1
        one.network.is_up = True
        if line is not None:
            line.heal()
