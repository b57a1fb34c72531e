"""The table of AprilTag numbers."""

import pytest

from maps import MapError, builtin_map, read_map
from maps.check import check_file
from maps.tags import tag_numbers

THREE = """
name = "campus"
title = "Campus"
[[post]]
name = "a"
x_m = 0
y_m = 0
{first}
[[post]]
name = "b"
x_m = 5
y_m = 0
{second}
[[corridor]]
ends = ["a", "b"]
"""


def test_a_post_has_the_number_of_its_place_in_the_file_and_a_bay_counts_from_the_end():
    bays = [
        "post1_bay1",
        "post1_bay2",
        "post2_bay1",
        "post3_bay1",
        "post4_bay1",
        "post4_bay2",
        "post5_bay1",
        "post5_bay2",
    ]
    posts = {n - 1: f"post{n}" for n in range(1, 6)}
    assert tag_numbers(builtin_map("test_track")) == posts | {586 - n: name for n, name in enumerate(bays)}


def test_a_number_may_be_pinned(write_map):
    assert tag_numbers(read_map(write_map(THREE.format(first="tag = 40", second="")))) == {40: "a", 1: "b"}


def test_two_posts_never_share_a_number(write_map):
    path = write_map(THREE.format(first="tag = 1", second=""))
    problem = next(problem for problem in check_file(path) if problem.kind == "tag_twice")
    assert "a and b have the same tag" in problem.sentence


def test_a_number_outside_the_family_is_refused(write_map):
    with pytest.raises(MapError, match="less than or equal to 586") as refused:
        read_map(write_map(THREE.format(first="tag = 587", second="")))
    assert refused.value.place == "post.1.tag"
