"""The judge: which bodies touched or overlapped, by true poses alone."""

import csv
from pathlib import Path

import pytest

from robot.simulated import CollisionJudge, PoseLog, TruePose

BODY_M = 0.3485


def look(judge: CollisionJudge, now: float, apart_mm: float, handled: tuple[int, int] = (0, 0)) -> None:
    """r1 stands; r2 is so far from touching it, to the east."""
    x_m = BODY_M + apart_mm / 1000
    judge.look({"r1": TruePose(now, 0.0, 0.0, 0.0, handled[0]), "r2": TruePose(now, x_m, 0.0, 0.0, handled[1])})


def test_two_that_pass_through_each_other_are_told_with_place_time_and_depth() -> None:
    judge = CollisionJudge()
    for now, apart_mm in enumerate((500, 100, -50, -300, -120, 80, 500)):
        look(judge, float(now), float(apart_mm))
    (met,) = judge.overlaps
    assert (met.one, met.other, met.began_s, met.lasted_s, met.by_hand) == ("r1", "r2", 2.0, 2.0, False)
    assert met.depth_mm == pytest.approx(300)
    assert (met.x_m, met.y_m) == pytest.approx(((BODY_M - 0.3) / 2, 0.0))
    assert str(met) == "r1 and r2 overlap by 300 mm at (0.02, 0.00), from 2.0 s on for 2.0 s"


def test_a_touch_is_no_overlap_and_side_by_side_is_neither() -> None:
    judge = CollisionJudge()
    look(judge, 0.0, 50.0)
    look(judge, 1.0, 3.0)
    assert judge.found == []
    look(judge, 2.0, 1.0)
    assert (judge.touches, judge.overlaps) == (1, [])
    look(judge, 3.0, 8.0)
    look(judge, 4.0, 1.0)
    assert judge.touches == 1, "they did not really part"
    look(judge, 5.0, 12.0)
    look(judge, 6.0, -4.0)
    assert (judge.touches, judge.overlaps) == (2, [])
    look(judge, 7.0, -6.0)
    assert len(judge.overlaps) == 1


def test_three_in_a_heap_are_three_pairs() -> None:
    judge = CollisionJudge()
    judge.look({name: TruePose(0.0, float(x_m), 0.0, 0.0) for name, x_m in (("a", 0), ("b", 5), ("c", 10))})
    judge.look({name: TruePose(1.0, x_m, 0.0, 0.0) for name, x_m in (("a", 0.0), ("b", 0.1), ("c", 0.2))})
    assert {(one.one, one.other) for one in judge.overlaps} == {("a", "b"), ("a", "c"), ("b", "c")}


def test_what_a_person_put_there_is_the_persons_until_it_has_left() -> None:
    judge = CollisionJudge()
    look(judge, 0.0, 900.0)
    look(judge, 1.0, 60.0, (0, 1))  # r2 is put before r1
    look(judge, 2.0, -30.0, (0, 1))  # and is met there
    (met,) = judge.found
    assert (met.by_hand, judge.overlaps, judge.touches) == (True, [], 0)
    look(judge, 3.0, 500.0, (0, 1))
    look(judge, 4.0, -40.0, (0, 1))
    assert len(judge.overlaps) == 1, "that one is its own"


def test_one_that_was_put_into_a_bay_and_goes_on_to_its_marker_is_still_where_a_person_put_it() -> None:
    judge = CollisionJudge()
    look(judge, 0.0, 900.0)
    look(judge, 1.0, 400.0, (0, 1))
    look(judge, 2.0, 290.0, (0, 1))
    judge.look({"r1": TruePose(3.0, 0.29, 0.0, 0.0, 0), "r2": TruePose(3.0, BODY_M + 0.29, 0.0, 0.0, 1)})
    assert [one.by_hand for one in judge.found] == [True]


def test_robots_that_stand_in_each_other_when_the_world_begins_were_put_there() -> None:
    judge = CollisionJudge()
    look(judge, 0.0, -100.0)
    look(judge, 1.0, -100.0)
    assert [one.by_hand for one in judge.found] == [True]


def test_one_that_never_left_its_place_and_is_driven_into_is_nobodys_fault_but_the_robots() -> None:
    judge = CollisionJudge()
    look(judge, 0.0, 900.0)
    look(judge, 1.0, -40.0)
    assert len(judge.overlaps) == 1


def test_the_log_has_a_row_for_every_robot_that_has_moved_and_none_for_one_that_stands(tmp_path: Path) -> None:
    log = PoseLog(tmp_path / "poses.csv")
    for tick in range(11):
        now = tick / 8
        log.note({"r1": TruePose(now, tick * 0.02, 1.0, 0.5, 0), "r2": TruePose(now, 7.0, 8.0, 0.0, 3)})
    log.close()
    with (tmp_path / "poses.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [row["robot"] for row in rows].count("r2") == 1
    assert [float(row["x_m"]) for row in rows if row["robot"] == "r1"] == pytest.approx(
        [0, 0.04, 0.08, 0.12, 0.16, 0.2]
    )
