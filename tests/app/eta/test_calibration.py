"""Intervals that hold what they promise, whatever they were worked out from."""

from collections.abc import Callable
from random import Random

import pytest

from fleet.eta.calibration import Calibration
from fleet.eta.intervals import Interval, pinball_s
from fleet.eta.promised import Told
from fleet.eta.score import ScoreBoard, Truth, score_of

RAW = Interval(80.0, 100.0, 120.0)
BY_MAP = Interval(50.0, 200.0, 350.0)


def told_of(truth_s: Callable[[int, Random], float], count: int = 1000) -> list[Truth]:
    """As many orders in a row, each told before its truth came."""
    calibration, rng, truths = Calibration(), Random(7), []
    for number in range(count):
        told, seconds = calibration.corrected(RAW), truth_s(number, rng)
        calibration.learn(RAW, told, seconds)
        truths.append(Truth(told, BY_MAP, seconds))
    return truths


def test_at_first_people_are_told_what_was_worked_out() -> None:
    assert tuple(Calibration().corrected(RAW)) == pytest.approx(tuple(RAW), abs=2.0)


@pytest.mark.parametrize(
    "truth_s",
    [
        pytest.param(lambda _, rng: rng.gauss(100.0, 60.0), id="wider than was thought"),
        pytest.param(lambda _, rng: rng.gauss(100.0, 3.0), id="narrower"),
        pytest.param(lambda _, rng: rng.gauss(170.0, 20.0), id="always later"),
        pytest.param(lambda _, rng: rng.lognormvariate(4.5, 1.0), id="with a long tail"),
        pytest.param(lambda at, rng: rng.gauss(100.0, 10.0 + at / 10), id="worse from day to day"),
        pytest.param(lambda at, rng: rng.gauss(100.0 if at < 500 else 200.0, 15.0), id="otherwise since noon"),
    ],
)
def test_four_of_five_come_inside_all_the_same(truth_s: Callable[[int, Random], float]) -> None:
    score = score_of(told_of(truth_s)[100:])
    assert 0.78 <= score.inside <= 0.82
    assert score.below == pytest.approx(0.1, abs=0.03)


def test_four_of_five_come_inside_of_each_kind_of_estimate() -> None:
    """Three of four estimates are nearly right, the fourth is much too early: each kind has its own corrections."""
    kinds, rng = (Told(), Told()), Random(3)
    truths: tuple[list[Truth], list[Truth]] = ([], [])
    for number in range(2000):
        is_early = number % 4 == 0
        seconds = rng.gauss(300.0, 90.0) if is_early else rng.gauss(105.0, 20.0)
        told = kinds[is_early].corrected(RAW)
        kinds[is_early].arrived(RAW, told, BY_MAP, seconds)
        truths[is_early].append(Truth(told, BY_MAP, seconds))
    for its, theirs in zip(kinds, truths, strict=True):
        assert 0.77 <= score_of(theirs[100:]).inside <= 0.83
        assert its.score() == score_of(theirs[-500:])


def test_who_always_comes_later_is_expected_later() -> None:
    assert told_of(lambda _, rng: rng.gauss(170.0, 20.0))[-1].told.p50_s == pytest.approx(170.0, abs=5.0)


def test_no_interval_begins_before_the_order() -> None:
    assert min(truth.told.p10_s for truth in told_of(lambda _, rng: rng.gauss(20.0, 5.0))) >= 0.0


def test_the_loss_is_least_for_the_true_quantiles() -> None:
    rng = Random(3)
    truths = [rng.uniform(0.0, 100.0) for _ in range(2000)]

    def loss(told: Interval) -> float:
        return sum(pinball_s(told, truth_s) for truth_s in truths)

    for wrong in (Interval(20.0, 50.0, 90.0), Interval(10.0, 60.0, 90.0), Interval(10.0, 50.0, 75.0)):
        assert loss(Interval(10.0, 50.0, 90.0)) < loss(wrong)


def test_the_score_is_of_the_latest_truths_and_none_before_the_first() -> None:
    board = ScoreBoard()
    assert board.score() is None
    for _ in range(500):
        board.add(Truth(RAW, BY_MAP, 200.0))
    for _ in range(500):
        board.add(Truth(RAW, BY_MAP, 100.0))
    score = board.score()
    assert score is not None
    assert (score.count, score.inside, score.median_error, score.median_error_by_map) == (500, 1.0, 0.0, 1.0)
