"""Loops run at their rates, in order, and together end; a clock that is too fast is slowed down."""

import threading
import time
from pathlib import Path

import pytest

from protocol.clock import RealClock, SharedClock, SteppedClock
from robot.agent.mind import messages_from_person
from robot.core.config import load_settings
from robot.ops.assembly import Simulation, assemble
from robot.ops.runners import Governor, LockstepRunner, Loop, ThreadedRunner

pytestmark = pytest.mark.alone


def test_in_lockstep_every_loop_ticks_at_its_own_time_in_the_order_of_the_table() -> None:
    seen: list[tuple[float, str]] = []
    clock = SteppedClock()

    def ticker(name: str) -> Loop:
        def tick(now: float) -> None:
            seen.append((round(now, 3), name))
            if now >= 0.2:
                runner.stop()

        return Loop(name, {"quick": 20.0, "slow": 10.0}[name], "nobody", tick)

    runner = LockstepRunner([ticker("quick"), ticker("slow")], clock)
    runner.run()
    assert seen[:5] == [(0.0, "quick"), (0.0, "slow"), (0.05, "quick"), (0.1, "quick"), (0.1, "slow")]
    assert clock.now() == pytest.approx(0.2)


def test_a_shared_clock_that_runs_ahead_of_a_slow_world_is_slowed_down(tmp_path: Path) -> None:
    clock = SharedClock.create(tmp_path / "clock", 50.0)
    began_s = clock.now()

    def heavy(now: float) -> None:
        time.sleep(0.01)  # 100 ticks a second at most: ten times as fast as real time at 10 Hz
        if now - began_s > 12.0:
            runner.stop()

    runner = LockstepRunner([Loop("heavy", 10.0, "nobody", heavy)], clock, 50.0)
    runner.run()
    assert clock.speed < 11.0


def test_with_time_to_spare_the_clock_goes_as_fast_as_was_asked_and_no_faster() -> None:
    governor, speed, real_s = Governor(max_speed=8.0), 1.0, time.perf_counter()
    for _ in range(40):
        real_s += 0.25
        speed = governor.speed(speed, lag_s=0.0, done_s=0.25 * speed, worked_s=0.05, real_s=real_s)
    assert speed == 8.0


def test_a_lag_slows_the_clock_to_a_little_less_than_what_is_possible_and_not_to_nothing() -> None:
    governor, speed, real_s = Governor(max_speed=40.0), 40.0, time.perf_counter()
    for _ in range(5):
        real_s += 0.25
        speed = governor.speed(speed, lag_s=60.0, done_s=10.0 * 0.25, worked_s=0.25, real_s=real_s)
    assert speed == pytest.approx(7.5)


def test_threads_keep_their_rates_and_stop_together() -> None:
    counts = {"quick": 0, "slow": 0}

    def counter(name: str, rate_hz: float) -> Loop:
        def tick(_: float) -> None:
            counts[name] += 1

        return Loop(name, rate_hz, "nobody", tick)

    runner = ThreadedRunner([counter("quick", 50.0), counter("slow", 5.0)], RealClock())
    threading.Timer(1.0, runner.stop).start()
    runner.run()
    assert counts["quick"] > 3 * counts["slow"] > 0
    so_far = dict(counts)
    time.sleep(0.1)
    assert counts == so_far


def test_a_loop_that_breaks_stops_all_the_others_and_is_raised() -> None:
    def broken(_: float) -> None:
        raise RuntimeError("the camera fell off")

    runner = ThreadedRunner([Loop("broken", 10.0, "nobody", broken), Loop("fine", 10.0, "nobody", float)], RealClock())
    with pytest.raises(RuntimeError, match="fell off"):
        runner.run()


def test_on_threads_and_real_time_the_same_loops_drive_the_same_robot(tmp_path: Path) -> None:
    clock = RealClock()
    settings = load_settings(None, {"data": tmp_path})
    parts = assemble(settings, clock, Simulation("post3:post2"))
    parts.mind.inbox.extend(messages_from_person([], ["visit(post2)"]))
    assert parts.robot is not None
    robot = parts.robot
    runner = ThreadedRunner(parts.daemon.loops(), clock)
    until_s = clock.now() + 20.0
    parts.daemon.watchers = (lambda now: runner.stop() if robot.driven_mm > 150 or now > until_s else None,)
    runner.run()
    parts.daemon.close(clock.now())
    assert robot.driven_mm > 150
    assert robot.state()["mode"] == "passive"
    assert runner.lags["line and drive"].ticks > 100
