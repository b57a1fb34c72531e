"""Room for bodies: the check against circles put on the floor by hand, and by trial."""

import math
from collections.abc import Iterable, Iterator
from itertools import combinations
from random import Random

import pytest

from maps import CampusMap, read_map
from maps.bays import WAITS_BEFORE_CROSSING_M
from maps.check import check_file
from maps.room import BODY_M, CLEAR_M, MARGIN_M, room_problems


def bay(bearing_deg: float, length_m: float = 1.0, more: str = "") -> str:
    return f"[[post.bay]]\nbearing_deg = {bearing_deg}\nlength_m = {length_m}\n{more}\n"


def floor(*bays: str, b: tuple[float, float] = (5.0, 0.0), b_bays: str = bay(0), more: str = "", way: str = "") -> str:
    """Post a at the origin with these bays, and a corridor to b."""
    a = '[[post]]\nname = "a"\nx_m = 0.0\ny_m = 0.0\n' + "".join(bays)
    there = f'[[post]]\nname = "b"\nx_m = {b[0]}\ny_m = {b[1]}\n{b_bays}'
    return f'{a}{there}{more}[[corridor]]\nends = ["a", "b"]\n{way}'


def kinds(write_map, text: str) -> list[str]:
    return sorted(f"{p.kind} {p.place}" for p in room_problems(read_map(write_map(text))))


def test_a_body_is_a_create_2():
    """348.5 mm with its bumper (Open Interface specification), and a margin."""
    assert pytest.approx(0.3485, abs=0.001) == BODY_M
    assert CLEAR_M == BODY_M + MARGIN_M


def test_a_post_with_room_has_no_problem(write_map):
    path = write_map(floor(bay(60), bay(120), bay(180, more="dock = true"), bay(240), bay(300)))
    assert check_file(path) == ()


@pytest.mark.parametrize(("length_m", "fits"), [(0.37, False), (0.38, True)])
def test_a_robot_in_a_bay_is_clear_of_one_that_turns_on_the_post(write_map, length_m, fits):
    assert kinds(write_map, floor(bay(180, length_m))) == ([] if fits else ["bay_too_short a_bay1"])


@pytest.mark.parametrize(("length_m", "fits"), [(0.43, False), (0.45, True)])
def test_a_robot_in_a_bay_is_clear_of_the_corridor_beside_it(write_map, length_m, fits):
    """At 60° the axle is 0.87 times the length beside the line: 0.372 m, then 0.390 m."""
    assert kinds(write_map, floor(bay(60, length_m))) == ([] if fits else ["bay_not_clear a_bay1"])


@pytest.mark.parametrize(("length_m", "fits"), [(0.43, False), (0.45, True)])
def test_a_robot_in_a_bay_is_clear_of_the_other_spurs(write_map, length_m, fits):
    found = kinds(write_map, floor(bay(180, length_m), bay(120)))
    assert found == ([] if fits else ["bay_not_clear a_bay1"])


def test_a_docked_robot_is_clear_of_every_line(write_map):
    """The corridor comes round behind the bay: 0.4 m beyond its end, and 0.1 m before the middle of the dock."""
    way = "via = [[0.0, 1.7], [-1.7, 1.7], [-1.7, 0.0]]\nbend_radius_m = 0.1\n"
    round_about = {"b": (-4.0, 0.0), "b_bays": bay(180), "way": way}
    assert kinds(write_map, floor(bay(180, 1.3), **round_about)) == []
    found = kinds(write_map, floor(bay(180, 1.3, "dock = true"), **round_about))
    assert found == ["bay_not_clear a_bay1", "waiting_not_clear a-b"]


def test_bays_of_two_posts_are_clear_of_each_other(write_map):
    """Ends at x = 1.0 and 4.0 − 2.7 = 1.3, on a corridor that goes round by y = 4."""
    way = "via = [[0.0, 4.0], [4.0, 4.0]]\n"
    found = kinds(write_map, floor(bay(0), b=(4.0, 0.0), b_bays=bay(180, 2.7), way=way))
    assert found == ["lines_not_clear b_bay1"]
    assert kinds(write_map, floor(bay(0), b=(4.0, 0.0), b_bays=bay(180, 2.6), way=way)) == []


def test_a_spur_across_a_corridor_of_other_posts_is_named(write_map):
    more = '[[post]]\nname = "c"\nx_m = 2.0\ny_m = 1.0\n' + bay(270, 2.0) + '[[corridor]]\nends = ["b", "c"]\n'
    found = [p for p in room_problems(read_map(write_map(floor(bay(180), more=more)))) if p.kind == "lines_not_clear"]
    assert [p.place for p in found] == ["c_bay1"]
    assert "the spur of c_bay1 crosses the corridor a-b" in found[0].sentence


@pytest.mark.parametrize(("x_m", "fits"), [(1.37, False), (1.38, True)])
def test_a_corridor_has_room_for_a_robot_that_waits_at_each_end(write_map, x_m, fits):
    """0.50 m from each post, and 0.378 m from axle to axle."""
    found = kinds(write_map, floor(bay(180), b=(x_m, 0.0)))
    assert found == ([] if fits else ["corridor_too_short a-b"])


def test_a_corridor_that_comes_back_to_where_it_began_has_no_room_either(write_map):
    """2.6 m of tape, but the two waiting points are 0.2 m apart."""
    way = "via = [[1.2, 0.0], [1.2, 0.2]]\nbend_radius_m = 0.0\n"
    assert "corridor_too_short a-b" in kinds(write_map, floor(bay(270), b=(0.0, 0.2), b_bays=bay(90), way=way))


def test_a_robot_that_waits_is_clear_of_the_other_lines(write_map):
    """The corridor leaves at 60° and bends back along the spur: 0.5 m from the post they are 0.22 m apart."""
    bent = {"b": (5.0, 0.2), "way": "via = [[0.2, 0.2]]\nbend_radius_m = 0.0\n"}
    found = kinds(write_map, floor(bay(345), **bent))
    assert "waiting_not_clear a-b" in found
    assert "narrow_angle a" not in found


@pytest.mark.parametrize(("bearing_deg", "fits"), [(54, False), (55, True)])
def test_lines_of_a_post_are_55_degrees_apart(write_map, bearing_deg, fits):
    assert kinds(write_map, floor(bay(bearing_deg))) == ([] if fits else ["narrow_angle a"])
    assert kinds(write_map, floor(bay(360 - bearing_deg))) == ([] if fits else ["narrow_angle a"])


def test_the_angle_is_said_with_both_lines(write_map):
    (problem,) = room_problems(read_map(write_map(floor(bay(180), bay(130)))))
    assert "the spur of a_bay2 and the spur of a_bay1 are 50° apart" in problem.sentence


def test_two_docks_at_one_post_are_refused(write_map):
    text = floor(bay(90, more="dock = true"), bay(180, more="dock = true"))
    assert kinds(write_map, text) == ["second_dock a"]


def test_a_map_without_bays_on_the_floor_is_not_asked_for_room(write_map):
    assert kinds(write_map, floor(b=(1.0, 0.0), b_bays="")) == []


# By trial: circles on the floor, 1 cm apart


def test_what_the_check_passes_has_room_by_trial_and_what_it_refuses_has_not(write_map):
    """Bodies wherever two robots may be at the same time, without the geometry that the check uses."""
    random, verdicts = Random(22), []
    for _ in range(200):
        campus = read_map(write_map(_some_floor(random)))
        refused = {p.kind for p in room_problems(campus)} - {"narrow_angle", "second_dock"}
        gap_m = min(math.dist(one, other) for one, other in _bodies(campus))
        assert (gap_m < CLEAR_M - 0.01) <= bool(refused), (gap_m, campus.posts["a"].spurs)
        assert bool(refused) <= (gap_m < CLEAR_M + 0.01), (gap_m, refused)
        verdicts.append(bool(refused))
    assert 50 < sum(verdicts) < 150, "both verdicts occur"


def _some_floor(random: Random) -> str:
    bearings = random.sample(range(60, 301, 60), 2)
    dock = random.choice(["", "dock = true"])
    bays = [
        bay(bearing + random.randint(-10, 10), random.choice([0.3, 0.6, 1.0, 1.0, 1.0, 1.0]), dock)
        for bearing in bearings[:1]
    ]
    bays += [bay(bearing, random.choice([0.4, 0.8, 1.0, 1.0])) for bearing in bearings[1:]]
    b = random.choice([(1.3, 0.0), (1.6, 0.1), (1.8, 0.4), (2.2, 0.0), (2.5, 1.0)])
    return floor(*bays, b=b, b_bays=bay(random.choice([0, 90, 120, 145, 240])))


def _bodies(campus: CampusMap) -> Iterator[tuple[tuple[float, float], tuple[float, float]]]:
    """Pairs of places at which two robots may be at the same time."""
    spurs = [(post, spur) for post in campus.posts.values() for spur in post.spurs]
    (a, b), stands = campus.posts.values(), {}
    corridor = _dots(a.point, b.point)
    waits = WAITS_BEFORE_CROSSING_M
    inner = [dot for dot in corridor if waits <= math.dist(dot, a.point) and waits <= math.dist(dot, b.point)]
    for post, spur in spurs:
        last = (spur.dock.x_m, spur.dock.y_m) if spur.dock else spur.point
        stands[spur.name] = post, _dots(spur.point, last), _dots(post.point, last)
    for post, stand, _ in stands.values():
        yield from ((dot, post.point) for dot in stand)
        yield from ((dot, other) for dot in stand for other in corridor)
        yield from ((dot, other) for dot in inner for other in stand)
    for (one_post, stand, drive), (other_post, its_stand, its_drive) in combinations(stands.values(), 2):
        if one_post is other_post:
            yield from ((dot, other) for dot in stand for other in its_drive)
            yield from ((dot, other) for dot in drive for other in its_stand)
        else:
            yield from ((dot, other) for dot in drive for other in its_drive)
    for _, _, drive in stands.values():
        yield from ((dot, other) for dot in drive for other in inner)
    ends = [min(inner, key=lambda dot, post=post: math.dist(dot, post.point), default=(0.0, 0.0)) for post in (a, b)]
    yield ends[0], ends[1]


def _dots(here: Iterable[float], there: Iterable[float]) -> list[tuple[float, float]]:
    (x0, y0), (x1, y1) = here, there
    steps = max(1, math.ceil(math.dist((x0, y0), (x1, y1)) / 0.01))
    return [(x0 + (x1 - x0) * n / steps, y0 + (y1 - y0) * n / steps) for n in range(steps + 1)]
