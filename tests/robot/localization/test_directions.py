"""Turns come from the map's geometry: the five of the paper's track, and the sectors of its prototype."""

import math

import pytest

from maps import NoRoute, UnknownPost
from robot.localization.directions import Way, next_post, sector, turn_at_rad
from tests.plain_maps import plain_map

TRACK = plain_map("test_track")


@pytest.mark.parametrize(
    ("came_from", "at", "to", "way"),
    [
        ("post4", "post3", "post2", Way.LEFT),
        ("post5", "post3", "post2", Way.RIGHT),
        ("post4", "post3", "post5", Way.FORWARD),
        ("post5", "post3", "post4", Way.FORWARD),
        ("post1", "post2", "post3", Way.LEFT),
        ("post3", "post4", "post3", Way.BEHIND),
    ],
)
def test_the_turns_of_the_papers_track_come_out(came_from: str, at: str, to: str, way: Way):
    assert sector(turn_at_rad(TRACK, came_from, at, to)) is way


@pytest.mark.parametrize(
    ("clockwise_deg", "way"),
    [
        *((0, "forward"), (45, "forward"), (316, "forward"), (359, "forward")),
        *((46, "right"), (135, "right"), (136, "behind"), (180, "behind"), (225, "behind")),
        *((226, "left"), (270, "left"), (315, "left")),
    ],
)
def test_sectors_are_those_of_the_prototype(clockwise_deg: float, way: str):
    assert sector(-math.radians(clockwise_deg)) == way


def test_every_turn_of_the_tunnels_has_a_word_and_back_is_behind():
    tunnels = plain_map("carleton")
    for post in tunnels.posts:
        for came_from, _ in tunnels.neighbours(post):
            for to, _ in tunnels.neighbours(post):
                way = sector(turn_at_rad(tunnels, came_from.name, post, to.name))
                assert (way is Way.BEHIND) == (came_from is to), (came_from.name, post, to.name)


def test_the_next_post_lies_on_the_shortest_route():
    assert next_post(TRACK, "post1", "post4") == "post2"
    assert next_post(TRACK, "post4", "post4") is None


def test_an_unknown_destination_is_an_error_and_so_is_one_that_cannot_be_reached():
    with pytest.raises(UnknownPost, match="post7"):
        next_post(TRACK, "post1", "post7")
    with pytest.raises(NoRoute):
        next_post(TRACK, "post1", "post4", frozenset({"post2-post3"}))
