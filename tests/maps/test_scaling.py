"""A campus in another size: corridors as long as asked for, docks and markers where robots find them."""

import math

import pytest

from maps import MapError
from maps.campus_map import build_map, builtin_path
from maps.map_file import load_map_file
from maps.scaling import fitting_factor, scaled

CARLETON = load_map_file(builtin_path("carleton"))


def test_the_tunnels_fit_into_corridors_of_3_to_10_m():
    campus = build_map(scaled(CARLETON, fitting_factor(CARLETON, 3.0, 10.0)))
    lengths_m = [corridor.length_m for corridor in campus.corridors]
    assert min(lengths_m) >= 3.0
    assert max(lengths_m) <= 10.0


def test_turns_stay_what_they_are():
    small, large = build_map(scaled(CARLETON, 0.05)), build_map(CARLETON)
    for here, there in zip(small.corridors, large.corridors, strict=True):
        assert here.heading_arriving(here.b) == pytest.approx(there.heading_arriving(there.b))


def test_docks_and_markers_stay_as_far_from_their_post_as_they_were():
    small, large = build_map(scaled(CARLETON, 0.05)), build_map(CARLETON)
    for name in ("uc", "commons"):
        here, there = small.post(name), large.post(name)
        assert here.dock
        assert there.dock
        assert here.dock.x_m - here.x_m == pytest.approx(there.dock.x_m - there.x_m)
        distances_m = [math.dist(here.point, (marker.x_m, marker.y_m)) for marker in here.markers]
        assert max(distances_m) < 0.8


def test_a_scaled_map_is_another_map_and_says_so():
    small = build_map(scaled(CARLETON, 0.05))
    assert small.version != build_map(CARLETON).version
    assert "Scaled by 0.05" in small.note


def test_lengths_that_cannot_be_had_together_are_refused_by_name():
    with pytest.raises(MapError, match="cannot become 3 to 4 m"):
        fitting_factor(CARLETON, 3.0, 4.0)
    with pytest.raises(MapError, match="above 0"):
        scaled(CARLETON, 0.0)
