"""A person stops a robot whose mind is dead, and starts its computer again: it stays stopped until it is re-armed."""

import json
from pathlib import Path

from protocol.clock import SteppedClock
from robot.agent.mind import messages_from_person
from robot.core.config import load_settings
from robot.drive_loop.black_box import rows
from robot.ops.assembly import Parts, Simulation, assemble
from robot.ops.runners import LockstepRunner, Loop

TOGETHER = {"rates.line_hz": 50.0}


def put_together(data: Path, clock: SteppedClock, start: str | None = None) -> Parts:
    settings = load_settings(None, {"data": data, **TOGETHER})
    parts = assemble(settings, clock, Simulation(start, in_memory=True))
    parts.mind.inbox.extend(messages_from_person([], ["visit(post1)"]))
    return parts


def let_pass(parts: Parts, clock: SteppedClock, duration_s: float, mind: bool = True) -> None:
    """A while of the daemon's life, with or without a mind in it."""
    until_s = clock.now() + duration_s

    def look(now: float) -> None:
        if now >= until_s:
            runner.stop()

    loops = [loop for loop in parts.daemon.loops() if mind or loop.name != "mind"]
    runner = LockstepRunner([*loops, Loop("end", 50.0, "this test", look)], clock)
    runner.run()


def test_it_wakes_up_stopped_and_goes_on_when_somebody_rearms_it(tmp_path: Path) -> None:
    clock = SteppedClock()
    first = put_together(tmp_path, clock, "post3:post2")
    let_pass(first, clock, 4.0)
    assert first.robot is not None
    assert first.robot.driven_mm > 60
    let_pass(first, clock, 1.5, mind=False)
    assert first.daemon.drive.view.faults == {"agent_silent"}
    first.robot.press("clean")
    let_pass(first, clock, 1.0, mind=False)
    assert json.loads((tmp_path / "stops.json").read_text()) == ["emergency_stop"]
    assert first.mind.hands.missions.held.faults == frozenset(), "no mind has heard of it"
    first.daemon.close_devices()  # the plug is pulled

    second = put_together(tmp_path, clock)
    let_pass(second, clock, 5.0)
    assert second.robot is not None
    assert second.daemon.drive.view.faults == {"emergency_stop"}
    assert second.robot.driven_mm < 1.0
    second.robot.press("spot")
    let_pass(second, clock, 8.0)
    assert second.daemon.drive.view.faults == frozenset()
    assert second.robot.driven_mm > 60
    assert json.loads((tmp_path / "stops.json").read_text()) == []
    second.daemon.close(clock.now())


def test_a_robot_that_was_stopped_leaves_its_last_minute_with_what_the_mind_saw_and_did(tmp_path: Path) -> None:
    clock = SteppedClock()
    parts = put_together(tmp_path, clock, "post3:post2")
    let_pass(parts, clock, 4.0)
    parts.daemon.drive.emergency_stop()
    let_pass(parts, clock, 2.0)
    parts.daemon.close(clock.now())
    (file,) = (tmp_path / "black_box").glob("*-emergency_stop.jsonl.gz")
    found = list(rows(file))
    kinds = {row.kind for row in found}
    assert {"black_box", "heard", "sent", "faults", "job", "line", "percepts", "action"} <= kinds
    assert any(row.kind == "percepts" and "+fault(emergency_stop)" in row.data for row in found)


def test_a_stop_just_before_the_end_is_remembered_though_nobody_but_the_wheels_has_heard_of_it(tmp_path: Path) -> None:
    clock = SteppedClock()
    parts = put_together(tmp_path, clock, "post3:post2")
    let_pass(parts, clock, 1.0)
    parts.daemon.drive.emergency_stop()
    for _ in range(2):
        clock.now_s += 0.02
        parts.daemon.drive.tick(clock.now())
    parts.daemon.close(clock.now())
    again = put_together(tmp_path, clock)
    let_pass(again, clock, 0.1)
    assert again.daemon.drive.view.faults == {"emergency_stop"}
    again.daemon.close(clock.now())
