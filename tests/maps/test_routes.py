"""Routes against an independent answer: every simple path of small random maps, tried one by one."""

import math
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from maps import CampusMap, Corridor, NoRoute, Point, Post, UnknownCorridor, UnknownPost, builtin_map, shortest_route
from maps.ways import Ways

NAMES = "abcdefg"


@st.composite
def campuses(draw: st.DrawFn) -> CampusMap:
    """Up to seven posts on a grid, corridors of the straight length or up to three times as long."""
    places = draw(st.lists(st.tuples(st.integers(0, 9), st.integers(0, 9)), min_size=2, max_size=7, unique=True))
    posts = {name: Post(name, name, x, y) for name, (x, y) in zip(NAMES, places, strict=False)}
    pairs = [(a, b) for a in posts for b in posts if a < b]
    corridors = [
        Corridor(a, b, math.dist(posts[a].point, posts[b].point) * draw(st.floats(1, 3)), False, ())
        for a, b in draw(st.lists(st.sampled_from(pairs), unique=True))
    ]
    return CampusMap("random", "Random", posts, tuple(corridors))


def every_length(campus: CampusMap, start: str, goal: str, avoid: frozenset[str]) -> list[float]:
    """The lengths of all simple paths, by walking each of them."""
    found = []

    def walk(here: str, been: tuple[str, ...], length_m: float) -> None:
        if here == goal:
            found.append(length_m)
            return
        for corridor in campus.corridors:
            if here in (corridor.a, corridor.b) and corridor.name not in avoid:
                there = corridor.b if here == corridor.a else corridor.a
                if there not in been:
                    walk(there, (*been, there), length_m + corridor.length_m)

    walk(start, (start,), 0.0)
    return found


@given(st.data(), campuses())
def test_no_other_path_is_shorter_than_the_route(data: st.DataObject, campus: CampusMap):
    start, goal = data.draw(st.sampled_from(sorted(campus.posts))), data.draw(st.sampled_from(sorted(campus.posts)))
    corridors = [corridor.name for corridor in campus.corridors]
    avoid = data.draw(st.frozensets(st.sampled_from(corridors)) if corridors else st.just(frozenset()))
    lengths = every_length(campus, start, goal, avoid)
    if not lengths:
        with pytest.raises(NoRoute):
            shortest_route(campus, start, goal, avoid)
        return
    route = shortest_route(campus, start, goal, avoid)
    assert route.length_m == pytest.approx(min(lengths))
    assert (route.posts[0], route.posts[-1]) == (start, goal)
    used = [campus.corridor(a, b) for a, b in pairwise(route.posts)]
    assert sum(corridor.length_m for corridor in used) == pytest.approx(route.length_m)
    assert avoid.isdisjoint(corridor.name for corridor in used)


def test_the_papers_demonstration_goes_round_the_corner():
    route = shortest_route(builtin_map("test_track"), "post1", "post4")
    assert route.posts == ("post1", "post2", "post3", "post4")
    assert route.length_m == 6


def test_where_one_is_already_is_no_way_at_all():
    route = shortest_route(builtin_map("test_track"), "post2", "post2")
    assert (route.posts, route.length_m) == (("post2",), 0)


def test_a_corridor_to_avoid_is_gone_round():
    carleton = builtin_map("carleton")
    assert "azrieli-uc" in _corridors(carleton, "library", "uc", frozenset())
    assert "azrieli-uc" not in _corridors(carleton, "library", "uc", frozenset({"azrieli-uc"}))


def _corridors(campus: CampusMap, start: str, goal: str, avoid: frozenset[str]) -> set[str]:
    return {campus.corridor(a, b).name for a, b in pairwise(shortest_route(campus, start, goal, avoid).posts)}


def test_no_route_says_why():
    island = Post("island", "Island", 9, 9)
    track = builtin_map("test_track")
    with pytest.raises(NoRoute, match=r"from post1 to post4: every way uses a corridor to be avoided \(post2-post3\)"):
        shortest_route(track, "post1", "post4", frozenset({"post2-post3"}))
    with_island = CampusMap("islands", "Islands", {**track.posts, "island": island}, track.corridors)
    with pytest.raises(NoRoute, match="no corridors lead there"):
        shortest_route(with_island, "post1", "island")


def test_unknown_names_are_refused_and_not_overlooked():
    track = builtin_map("test_track")
    with pytest.raises(UnknownPost):
        shortest_route(track, "post1", "post9")
    with pytest.raises(UnknownPost):
        shortest_route(track, "post9", "post1")
    with pytest.raises(UnknownCorridor):
        shortest_route(track, "post1", "post4", frozenset({"post3-post2"}))


def test_a_straight_line_is_what_the_estimate_believes_in():
    """The premise of the search: no shipped corridor is shorter than the straight line between its ends."""
    for name in ("test_track", "carleton"):
        campus = builtin_map(name)
        for corridor in campus.corridors:
            a, b = campus.post(corridor.a), campus.post(corridor.b)
            assert corridor.length_m >= math.dist(Point(a.x_m, a.y_m), Point(b.x_m, b.y_m)) - 1e-9


@given(campuses())
def test_lengths_found_in_one_search_are_those_of_the_routes(campus: CampusMap) -> None:
    ways = Ways(campus)
    for start in campus.posts:
        for goal in campus.posts:
            try:
                length_m = ways.route(start, goal).length_m
            except NoRoute:
                length_m = math.inf
            assert ways.length_m(start, goal) == pytest.approx(length_m)
