"""A clock that leaps is believed after the leap has lasted; what a time server does is followed at once."""

import random
import time
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta

import pytest

from app.core.trusted_clock import TrustedClock, holds_on
from protocol.clock import RealClock, SteppedClock

DAY_S = 86400.0
SETTLES_S = 600.0
NINE = datetime(2026, 1, 5, 9, 0, tzinfo=UTC)


@dataclass
class Machine:
    """Its two clocks: one that any user may set, and one that no user can."""

    wall_s: float = NINE.timestamp()
    steady_s: float = 1000.0

    def clock(self) -> TrustedClock:
        return TrustedClock(SETTLES_S, lambda: self.wall_s, lambda: self.steady_s)

    def passes(self, seconds: float) -> None:
        self.wall_s += seconds
        self.steady_s += seconds


@pytest.fixture
def machine() -> Machine:
    return Machine()


@pytest.mark.parametrize("leap_s", [3 * DAY_S, -3 * DAY_S, 60.0, -60.0, 400 * DAY_S])
def test_a_leap_that_goes_back_was_none(machine: Machine, leap_s: float) -> None:
    clock = machine.clock()
    machine.wall_s += leap_s
    for _ in range(20):
        machine.passes(1.0)
        assert clock.utc() == NINE + timedelta(seconds=machine.steady_s - 1000.0)
        assert (holds_on(clock), clock.leapt_s) == (True, leap_s)
    machine.wall_s -= leap_s
    assert (clock.utc(), holds_on(clock), clock.leapt_s) == (NINE + timedelta(seconds=20), False, 0.0)


@pytest.mark.parametrize("leap_s", [3 * DAY_S, -3 * DAY_S])
def test_a_leap_that_lasts_is_believed(machine: Machine, leap_s: float) -> None:
    clock = machine.clock()
    machine.wall_s += leap_s
    assert clock.utc() == NINE
    machine.passes(SETTLES_S - 1)
    assert (clock.utc(), holds_on(clock)) == (NINE + timedelta(seconds=SETTLES_S - 1), True)
    machine.passes(1)
    assert (clock.utc(), holds_on(clock)) == (NINE + timedelta(seconds=SETTLES_S + leap_s), False)
    machine.passes(5)
    assert clock.utc() == NINE + timedelta(seconds=SETTLES_S + leap_s + 5)


def test_a_leap_after_a_leap_has_to_last_itself(machine: Machine) -> None:
    clock = machine.clock()
    for _ in range(10):
        machine.wall_s += DAY_S
        assert holds_on(clock)
        machine.passes(SETTLES_S - 1)
        assert clock.utc() < NINE + timedelta(hours=2)


def test_what_a_time_server_puts_right_is_followed_at_once(machine: Machine) -> None:
    clock, drift = machine.clock(), random.Random(7)
    for _ in range(5000):
        machine.passes(1.0)
        machine.wall_s += drift.uniform(-0.08, 0.08)  # more than any of them slews
        assert clock.utc().timestamp() == pytest.approx(machine.wall_s, abs=1e-5)
    machine.wall_s += 5.0
    assert clock.utc().timestamp() == pytest.approx(machine.wall_s, abs=1e-5)
    assert not holds_on(clock)


def test_a_wall_clock_that_runs_away_is_not_followed(machine: Machine) -> None:
    """A leap in many small steps: a hundred times too fast."""
    clock = machine.clock()
    for _ in range(3600):
        machine.passes(1.0)
        machine.wall_s += 99.0
        assert clock.utc() <= NINE + timedelta(seconds=machine.steady_s - 1000.0 + 20)
    assert holds_on(clock)


def test_sleep_of_the_machine_is_no_leap(machine: Machine) -> None:
    clock = machine.clock()
    machine.passes(3 * DAY_S)
    assert (clock.utc(), holds_on(clock)) == (NINE + timedelta(days=3), False)


@pytest.mark.parametrize(
    ("last", "is_settled"),
    [(0.0, True), (-3599.0, True), (-3601.0, False), (-3 * DAY_S, False), (9.0, True), (60.0, False), (None, True)],
)
def test_after_a_start_the_newest_record_is_the_witness(machine: Machine, last: float | None, is_settled: bool) -> None:
    clock = machine.clock()
    clock.compare_with_records(None if last is None else NINE + timedelta(seconds=last))
    assert clock.utc() == NINE, "after a real stop everything else would be wrong"
    assert holds_on(clock) is not is_settled
    machine.passes(SETTLES_S)
    assert not holds_on(clock)


def test_the_machines_own_clocks_go_on_together() -> None:
    clock = TrustedClock(SETTLES_S)
    assert abs(clock.utc().timestamp() - time.time()) < 1.0
    assert not holds_on(clock)


@pytest.mark.parametrize("clock", [RealClock(), SteppedClock()])
def test_other_clocks_hold_nothing_up(clock: RealClock | SteppedClock) -> None:
    assert not holds_on(clock)
