"""Markers of posts with bays: seen in time, clear of bodies, and not behind one another."""

import pytest

from maps import read_map
from maps.marker_check import marker_problems

TWO_POSTS = """
[[post]]
name = "a"
x_m = 0.0
y_m = 0.0
{markers}
[[post.bay]]
bearing_deg = 90.0
[[post.bay]]
bearing_deg = 180.0
dock = true

[[post]]
name = "b"
x_m = 5.0
y_m = 0.0
[[post.bay]]
bearing_deg = {b_bearing}
length_m = {b_length}

[[corridor]]
ends = ["a", "b"]
"""
ON_SPURS = ["{ x_m = 0.35, y_m = 0.6, heading_deg = 180 }", "{ x_m = -0.6, y_m = 0.35, heading_deg = 270 }"]
ON_CORRIDOR = "{ x_m = 0.6, y_m = -0.35, heading_deg = 90 }"


def found(write_map, *markers: str, b: tuple[float, float] = (0.0, 1.0)) -> dict[str, str]:
    """By kind and place; `markers` are those of post a."""
    own = f"markers = [{', '.join(markers)}]" if markers else ""
    text = TWO_POSTS.format(markers=own, b_bearing=b[0], b_length=b[1])
    return {f"{p.kind} {p.place}": p.sentence for p in marker_problems(read_map(write_map(text)))}


def test_the_standard_places_have_no_problem(write_map):
    assert found(write_map) == {}
    assert found(write_map, *ON_SPURS, ON_CORRIDOR) == {}


def test_each_approach_of_a_post_has_its_marker_those_from_bays_too(write_map):
    problems = found(write_map, ON_CORRIDOR, ON_SPURS[0])
    assert list(problems) == ["unseen_approach a"]
    assert "comes from a_bay2" in problems["unseen_approach a"]


@pytest.mark.parametrize(("x_m", "in_time"), [(0.49, False), (0.50, True), (1.0, True), (1.01, False)])
def test_a_marker_is_seen_before_the_waiting_point(write_map, x_m, in_time):
    """A robot waits 0.50 m before the post; beyond 1 m the marker is another place's."""
    problems = found(write_map, *ON_SPURS, ON_CORRIDOR.replace("0.6", str(x_m)))
    assert list(problems) == ([] if in_time else ["unseen_approach a", "unseen_marker a, marker 3"])
    assert in_time or "in time to wait before it" in problems["unseen_approach a"]


def test_a_robot_that_comes_from_a_bay_has_waited_there(write_map):
    """Its marker may be nearer to the post than the waiting point."""
    assert found(write_map, ON_SPURS[0], ON_SPURS[1].replace("-0.6", "-0.4"), ON_CORRIDOR) == {}


def test_a_robot_cannot_have_passed_a_marker_beyond_the_end_of_its_spur(write_map):
    """From a spur of 0.5 m: the marker 0.6 m before the post is where no robot comes by."""
    assert list(found(write_map, b=(0.0, 0.5))) == ["unseen_approach b", "unseen_marker b, marker 2"]


@pytest.mark.parametrize("y_m", [0.5, 1.0])
def test_no_marker_stands_beside_a_spur_or_its_end(write_map, y_m):
    problems = found(write_map, *ON_SPURS, ON_CORRIDOR, f"{{ x_m = 0.2, y_m = {y_m}, heading_deg = 180 }}")
    assert "the spur of a_bay1, or stands at its end" in problems["marker_in_the_way a, marker 4"]


def test_no_marker_stands_where_a_robot_docks(write_map):
    problems = found(write_map, *ON_SPURS, ON_CORRIDOR, "{ x_m = -1.6, y_m = 0.1, heading_deg = 0 }")
    assert "the spur of a_bay2" in problems["marker_in_the_way a, marker 4"]


def test_a_marker_behind_that_of_another_place_is_named(write_map):
    """At 50° and 0.7 m the bay's sheet stands 0.12 m before that of the corridor; from a longer spur it does not."""
    problems = found(write_map, b=(130.0, 0.7))
    assert "the marker of b_bay1 hides its marker from a robot that comes from a" in problems["hidden_marker b"]
    assert "hidden_marker b" not in found(write_map, b=(130.0, 1.2))


def test_a_marker_of_the_same_place_hides_none(write_map):
    nearer = "{ x_m = 0.6, y_m = -0.25, heading_deg = 90 }"
    assert found(write_map, *ON_SPURS, ON_CORRIDOR, nearer) == {}
