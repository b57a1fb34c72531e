"""Reading a map file, and the answers to a broken one."""

import math
from dataclasses import replace
from itertools import pairwise

import pytest

from maps import MapError, Post, UnknownCorridor, UnknownPost, builtin_map, find_map, read_map
from maps.geometry import Point, moved, wrapped

TWO_POSTS = """
[[post]]
name = "a"
x_m = 0.0
y_m = 0.0

[[post]]
name = "b"
x_m = 3.0
y_m = 4.0
"""
CORRIDOR = '[[corridor]]\nends = ["a", "b"]\n'


def test_the_test_track_is_the_papers_figure_5():
    track = builtin_map("test_track")
    places = {name: (post.x_m, post.y_m) for name, post in track.posts.items()}
    assert places == {"post1": (0, 4), "post2": (0, 2), "post3": (2, 2), "post4": (2, 0), "post5": (2, 4)}
    assert {c.name: c.length_m for c in track.corridors} == {
        "post1-post2": 2,
        "post2-post3": 2,
        "post3-post4": 2,
        "post3-post5": 2,
    }
    assert not any(corridor.assumed for corridor in track.corridors)
    assert [post.name for post in track.docks()] == ["post1", "post4", "post5"], "of which the paper has the last"


def test_the_carleton_tunnels_say_that_their_lengths_are_assumed():
    carleton = builtin_map("carleton")
    assert (len(carleton.posts), len(carleton.corridors)) == (15, 16)
    assert all(corridor.assumed for corridor in carleton.corridors)
    assert "lengths and bays are assumed" in carleton.note
    own, shared = {"uc", "commons", "canal", "mackenzie"}, {"southam", "frontenac", "cttc"}
    assert {post.name for post in carleton.docks()} == own | shared
    assert set(carleton.docks_to_share()) == shared


@pytest.mark.parametrize(
    ("coming_from", "at", "going_to", "turn_degrees"),
    [
        ("post4", "post3", "post2", 90),
        ("post5", "post3", "post2", -90),
        ("post4", "post3", "post5", 0),
        ("post5", "post3", "post4", 0),
        ("post1", "post2", "post3", 90),
    ],
)
def test_turns_come_out_of_the_geometry(coming_from, at, going_to, turn_degrees):
    track = builtin_map("test_track")
    arriving = track.corridor(coming_from, at).heading_arriving(at)
    leaving = track.corridor(at, going_to).heading_leaving(at)
    assert math.degrees(wrapped(leaving - arriving)) == pytest.approx(turn_degrees)


def test_neighbours_and_corridors_are_found_from_both_ends():
    track = builtin_map("test_track")
    assert [post.name for post, _ in track.neighbours("post3")] == ["post2", "post4", "post5"]
    corridor = track.corridor("post3", "post2")
    assert corridor == track.corridor("post2", "post3") == track.corridor_named("post2-post3")
    assert corridor.other("post2") == "post3"
    assert corridor.tape_from("post3") == ((2, 2), (0, 2))


def test_an_unknown_post_is_answered_with_the_nearest_spelling():
    with pytest.raises(UnknownPost, match=r"'libary'.*Did you mean 'library'") as caught:
        builtin_map("carleton").post("libary")
    assert caught.value.nearest == "library"


def test_an_unknown_post_far_from_every_spelling_is_answered_with_all_of_them():
    with pytest.raises(UnknownPost, match="It has: post1, post2, post3, post4, post5"):
        builtin_map("test_track").neighbours("xyz")


def test_two_posts_that_are_no_neighbours_have_no_corridor():
    with pytest.raises(UnknownCorridor, match="post1-post4"):
        builtin_map("test_track").corridor("post4", "post1")


def test_a_length_left_out_is_the_length_of_the_tape(write_map):
    assert read_map(write_map(TWO_POSTS + CORRIDOR)).corridor("a", "b").length_m == pytest.approx(5)
    bent = CORRIDOR + "via = [[3.0, 0.0]]\nbend_radius_m = 1.0\n"
    # A quarter circle of radius 1 m is 2 − π/2 shorter than its corner; ten-degree chords are shorter still.
    length_m = read_map(write_map(TWO_POSTS + bent)).corridor("a", "b").length_m
    assert length_m == pytest.approx(7 - (2 - math.pi / 2), abs=0.01)


def test_a_bend_between_close_corners_stays_between_them(write_map):
    zigzag = CORRIDOR + "via = [[1.0, 0.0], [1.0, 0.0], [1.0, 1.0], [3.0, 1.0]]\nbend_radius_m = 5.0\n"
    tape = read_map(write_map(TWO_POSTS + zigzag)).corridor("a", "b").tape
    assert tape[0] == (0, 0)
    assert tape[-1] == (3, 4)
    assert all(-1e-9 <= x <= 3 + 1e-9 and -1e-9 <= y <= 4 + 1e-9 for x, y in tape)
    assert all(before != after for before, after in pairwise(tape))


def test_a_bend_is_taped_so_that_a_robot_can_follow_it():
    for corridor in builtin_map("carleton").corridors:
        legs = zip(corridor.tape, corridor.tape[1:], corridor.tape[2:], strict=False)
        for before, here, after in legs:
            turn = math.atan2(after[1] - here[1], after[0] - here[0]) - math.atan2(
                here[1] - before[1], here[0] - before[0]
            )
            assert abs(math.degrees(wrapped(turn))) < 15, corridor.name


def test_every_approach_of_the_shipped_maps_has_a_marker_on_its_left():
    for name in ("test_track", "carleton"):
        campus = builtin_map(name)
        for corridor in campus.corridors:
            for end in (corridor.a, corridor.b):
                assert _marker_on_the_left(campus.post(end), corridor.heading_arriving(end)), (corridor.name, end)


def _marker_on_the_left(post: Post, heading_rad: float) -> bool:
    """The standard place: 0.60 m before a post with bays, 0.35 m beside the line, the face looking across it."""
    expected = moved(Point(post.x_m, post.y_m), heading_rad, -0.60, 0.35)
    return any(
        math.dist((marker.x_m, marker.y_m), expected) < 1e-6
        and abs(wrapped(marker.heading_rad - heading_rad + math.pi / 2)) < 1e-6
        for marker in post.markers
    )


def test_a_docked_robot_has_a_marker_on_its_left():
    """North of post5: 1 m of tape and half a metre more."""
    bay = builtin_map("test_track").track.post("post5_bay1")
    assert bay.dock is not None
    assert (bay.dock.x_m, bay.dock.y_m) == pytest.approx((2.0, 5.5))
    assert math.degrees(bay.dock.heading_rad) == pytest.approx(90)
    assert any(math.dist((marker.x_m, marker.y_m), (1.65, 5.5)) < 1e-6 for marker in bay.markers)


def test_markers_of_the_file_replace_the_standard_ones(write_map):
    own = TWO_POSTS.replace('name = "b"', 'name = "b"\nmarkers = [{ x_m = 3.0, y_m = 4.5, heading_deg = 270.0 }]')
    campus = read_map(write_map(own + CORRIDOR))
    assert [(m.x_m, m.y_m, m.post, m.size_m) for m in campus.post("b").markers] == [(3.0, 4.5, "b", 0.08)]
    assert len(campus.post("a").markers) == 1


def test_the_version_changes_with_a_fact_and_with_nothing_else(write_map):
    version = read_map(write_map(TWO_POSTS + CORRIDOR)).version
    assert len(version) == 12
    assert read_map(write_map("# a remark\n" + TWO_POSTS + CORRIDOR)).version == version
    assert read_map(write_map(TWO_POSTS + CORRIDOR + "length_m = 5.0\n")).version == version
    assert read_map(write_map(TWO_POSTS + CORRIDOR + "length_m = 5.5\n")).version != version
    assert read_map(write_map(TWO_POSTS.replace("x_m = 0.0", "x_m = -0.0") + CORRIDOR)).version == version
    campus = builtin_map("test_track")
    assert replace(campus, note="another remark").version == campus.version


def test_where_there_is_no_network_is_a_fact_and_there_is_unless_the_file_says_so(write_map):
    plain = read_map(write_map(TWO_POSTS + CORRIDOR))
    assert plain.corridor("a", "b").network and plain.post("a").network
    silent = read_map(write_map(TWO_POSTS + CORRIDOR + "network = false\n"))
    assert not silent.corridor("a", "b").network and silent.post("a").network
    assert silent.version != plain.version
    assert builtin_map("test_track").version == "aad6a97e7c15"


def test_a_map_is_found_by_name_or_by_file(write_map):
    assert find_map("test_track").name == "test_track"
    assert find_map(write_map(TWO_POSTS + CORRIDOR)).name == "campus"
    with pytest.raises(MapError, match=r"nowhere.*There are: carleton, test_track"):
        find_map("nowhere")
    with pytest.raises(MapError, match="No such file"):
        find_map("missing.toml")


@pytest.mark.parametrize(
    ("text", "place", "message"),
    [
        ('name = "a"\ntitle = \n', "line 2, column 9", "Invalid value"),
        ('name = "a"\ntitle = "A', "line 2, column 11", "Unterminated string"),
        (TWO_POSTS + CORRIDOR + "lenght_m = 5.0\n", "corridor.1.lenght_m", "not permitted"),
        (TWO_POSTS.replace("x_m = 3.0\n", ""), "post.2.x_m", "required"),
        (TWO_POSTS.replace("3.0", '"three"'), "post.2.x_m", "valid number"),
        (TWO_POSTS.replace("3.0", "nan"), "post.2.x_m", "finite"),
        (TWO_POSTS + CORRIDOR + "length_m = -5.0\n", "corridor.1.length_m", "greater than 0"),
        (TWO_POSTS + CORRIDOR.replace('"b"', '"c"'), "a-c", "no post of this map"),
        (TWO_POSTS + CORRIDOR.replace('"b"', '"a"'), "a-a", "both ends are the same"),
        (TWO_POSTS + CORRIDOR + CORRIDOR, "a-b", "2 corridors join"),
        (TWO_POSTS + CORRIDOR + "length_m = 4.9\n", "a-b", "shorter than the straight line of 5.00 m"),
        (TWO_POSTS.replace("3.0", "0.0").replace("4.0", "0.0") + CORRIDOR, "a-b", "stand in the same place"),
        (TWO_POSTS.replace('"b"', '"a"'), "a", "2 posts or bays have this name"),
        (TWO_POSTS.replace('"b"', '"Post 1"'), "Post 1", "not a name"),
        (TWO_POSTS.replace('"b"', '"CM1:abc"'), "CM1:abc", "looks like a hand-over code"),
    ],
)
def test_a_broken_map_says_where_and_what(write_map, text, place, message):
    with pytest.raises(MapError) as caught:
        read_map(write_map(text))
    assert caught.value.place == place
    assert message in caught.value.message
    assert caught.value.way_out
    assert "campus.toml" in str(caught.value)


def test_a_map_that_is_not_text_says_so(write_map):
    path = write_map("")
    path.write_bytes(b'name = "\xff"')
    with pytest.raises(MapError, match="byte 8: this is not UTF-8"):
        read_map(path)
