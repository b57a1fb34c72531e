"""The clock that server and robot agree on."""

import os
import subprocess
import sys
import time
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest

from protocol.clock import RealClock, SharedClock, SteppedClock, sleep


def test_two_holders_of_one_file_read_the_same_time(tmp_path: Path) -> None:
    ours = SharedClock.create(tmp_path / "clock", speed=50.0)
    theirs = SharedClock(tmp_path / "clock")
    before, between, after = ours.now(), theirs.now(), ours.now()
    assert before <= between <= after


def test_another_process_reads_the_same_time(tmp_path: Path) -> None:
    clock = SharedClock.create(tmp_path / "clock", speed=1000.0)
    program = (
        "import sys; from pathlib import Path; from protocol.clock import SharedClock; "
        "print(SharedClock(Path(sys.argv[1])).now())"
    )
    before = clock.now()
    said = subprocess.run(
        [sys.executable, "-c", program, str(tmp_path / "clock")],
        capture_output=True,
        text=True,
        check=True,
        cwd=Path(__file__).parents[2],
        env={**os.environ, "PYTHONPATH": "."},
    )
    assert before < float(said.stdout) < clock.now()


def test_a_change_of_speed_makes_no_jump(tmp_path: Path) -> None:
    clock = SharedClock.create(tmp_path / "clock", speed=1000.0)
    last_s, stepped_back = clock.now(), False
    for speed in (10.0, 500.0, 1.0, 1000.0):
        clock.set_speed(speed)
        now_s = clock.now()
        stepped_back = stepped_back or now_s < last_s
        last_s = now_s
    assert not stepped_back
    clock.set_speed(1.0)
    start_s = clock.now()
    assert clock.now() - start_s < 1.0


def test_processes_that_change_its_speed_at_once_do_so_one_after_the_other(tmp_path: Path) -> None:
    clock = SharedClock.create(tmp_path / "clock", speed=10.0)
    program = (
        "import sys; from pathlib import Path; from protocol.clock import SharedClock; "
        "clock = SharedClock(Path(sys.argv[1])); [clock.set_speed(10.0 + n % 7) for n in range(3000)]"
    )
    command = [sys.executable, "-c", program, str(tmp_path / "clock")]
    changing = [subprocess.Popen(command, cwd=Path(__file__).parents[2]) for _ in range(2)]
    last_s, stepped_back = clock.now(), False
    while any(process.poll() is None for process in changing):
        now_s = clock.now()
        stepped_back = stepped_back or now_s < last_s
        last_s = now_s
    assert not stepped_back
    assert [process.returncode for process in changing] == [0, 0]
    writes = int.from_bytes((tmp_path / "clock").read_bytes()[:8], "little")
    assert writes == 2 * 2 * 3000, "some of the changes were made in the middle of others"


def test_it_runs_as_many_times_faster_as_it_says(tmp_path: Path) -> None:
    clock = SharedClock.create(tmp_path / "clock", speed=100.0)
    # Anybody may be held up between two looks: what passed lies between the inner and the outer of them.
    outer_s, scaled_s, inner_s = time.monotonic(), clock.now(), time.monotonic()
    time.sleep(0.05)
    inner_s = time.monotonic() - inner_s
    scaled_passed_s = clock.now() - scaled_s
    outer_s = time.monotonic() - outer_s
    assert 100.0 * inner_s - 0.01 <= scaled_passed_s <= 100.0 * outer_s + 0.01
    assert clock.real_s(50.0) == pytest.approx(0.5)


def test_records_and_durations_of_a_shared_clock_advance_together(tmp_path: Path) -> None:
    clock = SharedClock.create(tmp_path / "clock", speed=100.0)
    outer_s, utc, inner_s = clock.now(), clock.utc(), clock.now()
    time.sleep(0.02)
    inner_s = clock.now() - inner_s
    passed_s = (clock.utc() - utc).total_seconds()
    outer_s = clock.now() - outer_s
    assert inner_s - 0.01 <= passed_s <= outer_s + 0.01


def test_a_clock_that_was_never_made_is_named(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match="absent"):
        SharedClock(tmp_path / "absent")


async def test_sleep_lasts_as_long_as_the_clock_says(tmp_path: Path) -> None:
    clock = SharedClock.create(tmp_path / "clock", speed=1000.0)
    start_s = clock.now()
    await sleep(clock, 20.0)
    assert clock.now() - start_s >= 20.0


def test_a_stepped_clock_stands_until_it_is_moved() -> None:
    clock = SteppedClock()
    start = clock.utc()
    assert clock.now() == 0.0
    clock.advance(2.5)
    assert (clock.now(), (clock.utc() - start).total_seconds()) == (2.5, 2.5)


def test_the_real_clock_is_the_machines() -> None:
    clock = RealClock()
    assert clock.now() == pytest.approx(time.monotonic(), abs=0.5)
    assert clock.utc().timestamp() == pytest.approx(time.time(), abs=0.5)


def test_a_shared_clock_starts_when_it_is_told_to(tmp_path: Path) -> None:
    morning = datetime(2026, 10, 14, 14, 24, tzinfo=UTC)
    clock = SharedClock.create(tmp_path / "clock", speed=1e-6, starts_at=morning)
    assert abs(clock.utc() - morning) < timedelta(seconds=0.1)
