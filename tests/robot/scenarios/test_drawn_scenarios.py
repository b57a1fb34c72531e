"""Scenarios drawn by a seed: the bays of a map and their spurs have trouble too."""

import pytest

from maps import Point
from maps.geometry import distance_to_path_m
from robot.scenarios.campus import campus_of
from robot.scenarios.replay.drawing import WORLDS, drawn

SEEDS = range(1, 31)


@pytest.mark.parametrize("world", WORLDS)
def test_markers_of_bays_are_dirty_and_spurs_are_dark_now_and_then(world: str) -> None:
    campus = campus_of(WORLDS[world])
    spurs = campus.track.corridors[len(campus.corridors) :]
    scenarios = [drawn(world, seed) for seed in SEEDS]
    dirty = {place for scenario in scenarios for place in scenario.dirt}
    assert dirty > campus.posts.keys()
    assert dirty == campus.track.posts.keys()
    dark = [Point(*spot.at) for scenario in scenarios for spot in scenario.dark if spot.at]
    on_spurs = [spot for spot in dark if min(distance_to_path_m(spot, spur.tape) for spur in spurs) < 1e-6]
    assert 0 < len(on_spurs) < len(dark)
