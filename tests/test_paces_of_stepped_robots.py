"""Paces of stepped robots: what parts of a way take, from true poses alone."""

import math
from itertools import pairwise

import pytest

from benchmarks.stepped_fleet.paces import Paces
from maps import read_map
from robot.simulated.true_poses import TruePose
from tests.app.traffic.bay_travelling import MAP

TRACK = read_map(MAP).track
EVERY_S, SPEED_M_S = 0.1, 0.2


class Walk:
    """One body that drives straight from place to place, and stands."""

    def __init__(self, place: str) -> None:
        self.paces, self.now_s, self.handled = Paces(TRACK), 0.0, 0
        self.x_m, self.y_m = TRACK.post(place).point

    def _look(self) -> None:
        self.now_s += EVERY_S
        self.paces.look({"r1": TruePose(self.now_s, self.x_m, self.y_m, 0.0, self.handled)})

    def stands(self, duration_s: float) -> None:
        for _ in range(round(duration_s / EVERY_S)):
            self._look()

    def drives(self, *places: str) -> None:
        for place, after in pairwise(places):
            corridor = TRACK.corridor(place, after)
            for point in corridor.tape if corridor.a == place else reversed(corridor.tape):
                self.to(*point)

    def to(self, x_m: float, y_m: float) -> None:
        from_x_m, from_y_m = self.x_m, self.y_m
        steps = round(math.dist((from_x_m, from_y_m), (x_m, y_m)) / SPEED_M_S / EVERY_S)
        for step in range(1, steps + 1):
            self.x_m = from_x_m + (x_m - from_x_m) * step / steps
            self.y_m = from_y_m + (y_m - from_y_m) * step / steps
            self._look()


def median(walk: Walk, what: str) -> float:
    found = walk.paces.figures()[what]["p50"]
    assert isinstance(found, float)
    return found


def test_what_a_body_takes_is_told_by_part() -> None:
    walk = Walk("post3_bay1")
    walk.stands(30.0)
    walk.drives("post3_bay1", "post3", "post2", "post2_bay1")
    walk.stands(30.0)
    walk.drives("post2_bay1", "post2")
    spur_s = (TRACK.corridor("post2", "post2_bay1").length_m - 0.4) / SPEED_M_S
    assert median(walk, "corridor, s/m") == pytest.approx(1 / SPEED_M_S, rel=0.05)
    assert median(walk, "into a bay, s") == pytest.approx(spur_s, abs=0.3)
    assert median(walk, "out of a bay, s") == pytest.approx(spur_s, abs=0.3)
    assert median(walk, "over a crossing, from a bay into a corridor, s") == pytest.approx(4.0, abs=0.3)
    assert median(walk, "over a crossing, from a corridor into a bay, s") == pytest.approx(4.0, abs=0.3)


def test_a_wait_on_the_way_is_no_pace() -> None:
    walk = Walk("post3_bay1")
    walk.stands(30.0)
    walk.drives("post3_bay1", "post3")
    walk.stands(5.0)
    walk.drives("post3", "post2")
    assert "over a crossing, from a bay into a corridor, s" not in walk.paces.figures()
    assert "corridor, s/m" in walk.paces.figures()


def test_a_body_in_hands_drives_nowhere() -> None:
    walk = Walk("post3_bay1")
    walk.drives("post3_bay1", "post3")
    walk.handled += 1
    walk.drives("post3", "post2")
    assert "over a crossing, from a bay into a corridor, s" not in walk.paces.figures()


def test_what_it_says_is_timed_from_where_it_truly_left_the_crossing() -> None:
    walk = Walk("post3_bay1")
    walk.drives("post3_bay1", "post3")
    walk.paces.hear({"r1": "crossing"})
    there, here = TRACK.post("post2").point, TRACK.post("post3").point
    share = 0.8 / math.dist(here, there)
    walk.to(here.x_m + share * (there.x_m - here.x_m), here.y_m + share * (there.y_m - here.y_m))
    walk.paces.hear({"r1": "corridor"})
    assert median(walk, "beyond a crossing until it says so, s") == pytest.approx(2.0, abs=0.3)
