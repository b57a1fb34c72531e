"""Bays on the floor: spurs of tape off a post, as the map tells robots, schedules and the simulated world."""

import math

import pytest

from maps import MapError, UnknownPost, read_map
from maps.geometry import Point

TWO_POSTS = """
[[post]]
name = "a"
x_m = 0.0
y_m = 0.0
[[post.bay]]
bearing_deg = 90.0
length_m = 0.8
[[post.bay]]
bearing_deg = 180.0
length_m = 0.6
dock = true
home = true

[[post]]
name = "b"
x_m = 5.0
y_m = 0.0

[[corridor]]
ends = ["a", "b"]
"""


@pytest.fixture
def campus(write_map):
    return read_map(write_map(TWO_POSTS))


def test_a_bay_lies_at_its_bearing_and_length(campus):
    passing, home = campus.post("a").spurs
    assert (passing.name, home.name) == ("a_bay1", "a_bay2")
    assert passing.point == pytest.approx((0.0, 0.8))
    assert home.point == pytest.approx((-0.6, 0.0))
    assert (passing.home, home.home) == (False, True)


def test_the_dock_is_straight_on_beyond_the_end_of_the_tape(campus):
    dock = campus.post("a").spurs[1].dock
    assert (dock.x_m, dock.y_m) == pytest.approx((-1.1, 0.0))
    assert dock.heading_rad == pytest.approx(math.pi)


def test_a_dock_that_is_no_home_is_for_all_to_charge_and_not_for_passing(write_map):
    campus = read_map(write_map(TWO_POSTS.replace("home = true\n", "")))
    assert (campus.post("a").bays, campus.post("a").homes) == (1, 0)
    assert campus.post("a").dock is not None


def test_a_post_counts_its_bays_and_homes(campus):
    assert (campus.post("a").bays, campus.post("a").homes) == (1, 1)
    assert [post.name for post in campus.docks()] == ["a"]


def test_the_track_has_each_bay_as_a_place_and_each_spur_as_a_corridor(campus):
    track = campus.track
    assert set(track.posts) == {"a", "b", "a_bay1", "a_bay2"}
    assert track.version == campus.version
    assert [place.name for place in track.home_bays] == ["a_bay2"]
    assert track.post("a_bay1").bay_of == "a"
    assert track.post("a_bay1").title == "a, bay 1"
    assert track.corridor("a", "a_bay1").tape == (Point(0.0, 0.0), campus.post("a").spurs[0].point)
    assert track.corridor("a_bay2", "a").length_m == pytest.approx(0.6)
    assert [place.name for place in track.docks()] == ["a_bay2"]
    assert {post.name for post, _ in track.neighbours("a")} == {"b", "a_bay1", "a_bay2"}


def test_addresses_are_posts_alone(campus):
    assert set(campus.posts) == {"a", "b"}
    with pytest.raises(UnknownPost):
        campus.post("a_bay1")
    assert (campus.address_of("a_bay1"), campus.address_of("b")) == ("a", "b")
    assert campus.track.address_of("a_bay1") == "a"


def test_the_track_tells_the_bays_of_a_post(campus):
    assert [bay.name for bay in campus.track.bays_of("a")] == ["a_bay1", "a_bay2"]
    assert campus.track.bays_of("b") == ()


def test_a_bay_has_a_marker_on_the_left_before_its_end(campus):
    (marker,) = campus.post("a").spurs[0].markers
    assert marker.post == "a_bay1"
    assert (marker.x_m, marker.y_m) == pytest.approx((-0.35, 0.7))


def test_the_marker_of_a_post_with_bays_is_read_before_its_crossing(campus):
    (from_b, *from_bays), (from_a,) = campus.post("a").markers, campus.post("b").markers
    assert from_b.x_m == pytest.approx(0.6)
    assert [(one.x_m, one.y_m) for one in from_bays] == [pytest.approx((0.35, 0.6)), pytest.approx((-0.6, 0.35))]
    assert from_a.x_m == pytest.approx(4.7)


def test_a_map_without_bays_is_its_own_track(write_map):
    campus = read_map(write_map(TWO_POSTS[: TWO_POSTS.index("[[post.bay]]")]))
    assert campus.track is campus


def test_bays_change_the_version(campus, write_map):
    other = read_map(write_map(TWO_POSTS.replace("bearing_deg = 90.0", "bearing_deg = 91.0")))
    assert other.version != campus.version


def test_bays_have_tags_from_the_end_of_the_family(campus):
    assert {name: place.tag for name, place in campus.track.posts.items()} == {
        "a": 0,
        "b": 1,
        "a_bay1": 586,
        "a_bay2": 585,
    }


@pytest.mark.parametrize("old", ["bays = 2", "homes = 1", "dock = { x_m = 0.0, y_m = 1.0, heading_deg = 90.0 }"])
def test_bays_on_the_floor_do_not_go_with_those_from_before(write_map, old):
    with pytest.raises(MapError, match=r"from before there were such.*\[\[post\.bay\]\]"):
        read_map(write_map(TWO_POSTS.replace('name = "a"\n', f'name = "a"\n{old}\n', 1)))


def test_a_bay_may_not_have_the_name_of_a_post(write_map):
    with pytest.raises(MapError, match="2 posts or bays have this name"):
        read_map(write_map(TWO_POSTS.replace('name = "b"', 'name = "a_bay1"').replace('"a", "b"', '"a", "a_bay1"')))
