"""A robot's agent lives alone: what it sends to other agents reaches none, and the log says so."""

from pathlib import Path

from structlog.testing import capture_logs

from tests.robot.daemon.simulated_run import SimulatedRun


def test_a_message_to_another_agent_is_named_in_the_log(tmp_path: Path) -> None:
    program = tmp_path / "writes.asl"
    program.write_text("!g. +!g <- .send(r2, tell, at(post1)); .print(sent).", encoding="utf-8")
    with capture_logs() as logs:
        run = SimulatedRun(tmp_path, mind__program=program)
        run.until(lambda: run.printed, 10)
        run.close()
    told = [entry for entry in logs if entry["event"] == "agent_message_undelivered"]
    assert [(each["receiver"], each["performative"], each["content"]) for each in told] == [("r2", "tell", "at(post1)")]
    assert told[0]["log_level"] == "warning"
