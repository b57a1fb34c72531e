"""`python -m robot`: what a person types, and what they are told when it cannot be."""

import json
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

import pytest
from typer.testing import CliRunner

from robot.__main__ import cli

ROOT = Path(__file__).parents[3]


def refused(*arguments: str) -> str:
    """The sentence with which it ends, exit status 2, without a traceback."""
    ran = CliRunner().invoke(cli, list(arguments))
    assert ran.exit_code == 2, ran.output
    assert "Traceback" not in ran.output
    return " ".join(ran.output.split())


def write(path: Path, text: str) -> str:
    path.write_text(text)
    return str(path)


def test_help_shows_the_papers_run_and_where_the_settings_are_described() -> None:
    said = " ".join(CliRunner().invoke(cli, ["--help"]).output.split())
    for needed in ("collectAndDeliverMail(post1,post4)", "docs/reference/settings.md", "--simulated", "Exit status"):
        assert needed in said


def test_a_broken_agent_program_is_shown_with_line_column_and_caret(tmp_path: Path) -> None:
    ran = CliRunner().invoke(
        cli, ["--simulated", "--agent", write(tmp_path / "broken.asl", "!go.\n+!go <- drive(forward;\n   stop.\n")]
    )
    assert ran.exit_code == 2
    assert "broken.asl:2:" in ran.output
    assert any(line.strip() == "^" for line in ran.output.splitlines()), ran.output


def test_a_broken_map_is_named_with_the_place(tmp_path: Path) -> None:
    file = write(tmp_path / "mine.toml", 'name = "mine"\n[[corridor]]\nends = ["a", "b"]\n')
    assert "mine.toml" in refused("--simulated", "--map", file)


def test_an_unknown_map_says_which_there_are() -> None:
    assert "test_track" in refused("--simulated", "--map", "moon")


def test_an_absent_serial_port_says_what_to_do(tmp_path: Path) -> None:
    config = write(tmp_path / "robot.toml", f'serial_port = "{tmp_path}/ttyNone"\ndata = "{tmp_path}"\n')
    said = refused("--config", config)
    assert "ttyNone" in said
    assert "--simulated" in said


def test_an_unknown_setting_is_named_with_the_nearest(tmp_path: Path) -> None:
    assert "'battery.low_ratio'" in refused("--config", write(tmp_path / "r.toml", "[battery]\nlow_ration = 0.3\n"))


def test_a_token_that_others_may_read_is_refused(tmp_path: Path) -> None:
    token = write(tmp_path / "token", "cmr_x_y")
    Path(token).chmod(0o644)
    server = ["--server", "ws://127.0.0.1:9/link", "--data", str(tmp_path)]
    assert "chmod 600" in refused("--simulated", *server, "--token-file", token)


def test_a_server_elsewhere_without_encryption_is_refused(tmp_path: Path) -> None:
    assert "wss" in refused("--simulated", "--server", "ws://mail.campus.example/link")


def test_a_start_that_is_not_on_the_map_is_named() -> None:
    assert "post9" in refused("--simulated", "--start", "post9")


def test_a_door_that_somebody_listens_at_is_taken(tmp_path: Path) -> None:
    with socket.socket(socket.AF_UNIX) as listener:
        listener.bind(str(tmp_path / "door"))
        listener.listen()
        assert "--door" in refused("--simulated", "--door", str(tmp_path / "door"))


def test_a_data_folder_that_cannot_be_made_is_named(tmp_path: Path) -> None:
    assert "--data" in refused("--simulated", "--data", write(tmp_path / "file", "no folder"))


def test_a_door_in_a_folder_that_is_not_there_is_named(tmp_path: Path) -> None:
    assert "--door" in refused("--simulated", "--door", str(tmp_path / "nowhere" / "door"))


@pytest.mark.parametrize("file", ["world.json", "robot.db"])
def test_a_broken_file_in_the_data_folder_is_named(tmp_path: Path, file: str) -> None:
    write(tmp_path / file, "neither json nor a database")
    assert file in refused("--simulated", "--data", str(tmp_path))


def test_an_errand_to_a_post_that_is_not_there_is_not_done() -> None:
    ran = CliRunner().invoke(cli, ["--simulated", "--achieve", "visit(post9)", "--json"])
    assert ran.exit_code == 1
    summary = json.loads(ran.stdout)
    assert (summary["done"], "unknown_post" in summary["reason"]) == (False, True)


def test_a_goal_that_fails_ends_with_status_1_and_the_reason(tmp_path: Path) -> None:
    program = write(tmp_path / "lost.asl", "+!deliver(P) <- setDestination(P).\n")
    arguments = ["--simulated", "--agent", program, "--achieve", "deliver(post9)", "--json"]
    ran = CliRunner().invoke(cli, arguments)
    assert ran.exit_code == 1
    summary = json.loads(ran.stdout)
    assert summary["done"] is False
    assert "unknown_post" in summary["reason"]


@pytest.mark.slow
def test_a_goal_that_takes_too_long_ends_with_status_1_and_says_what_it_was_doing(tmp_path: Path) -> None:
    ran = CliRunner().invoke(cli, ["--simulated", "--achieve", "visit(post4)", "--limit", "20", "--json"])
    assert ran.exit_code == 1
    assert "Driving towards post" in json.loads(ran.stdout)["reason"]


@pytest.mark.system
@pytest.mark.alone
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_signal_stops_the_wheels_and_leaves_the_base_in_passive_within_two_seconds(
    tmp_path: Path, number: signal.Signals
) -> None:
    door = tmp_path / "door"
    command = [sys.executable, "-m", "robot", "--simulated", "--start", "post3:post2", "--data", str(tmp_path)]
    command += ["--door", str(door), "--achieve", "visit(post1)", "--speed", "1"]
    with subprocess.Popen(command, cwd=ROOT, stderr=subprocess.PIPE, text=True) as process:
        assert process.stderr is not None
        for line in process.stderr:
            if "follow_line" in line:
                break
        time.sleep(0.5)
        asked_s = time.monotonic()
        process.send_signal(number)
        assert process.wait(10) == 1, "what it was to achieve is not done"
        assert time.monotonic() - asked_s < 2.0
    saved = json.loads((tmp_path / "world.json").read_text())
    assert saved["mode"] == "passive"
    assert saved["wheels_mm_s"] == [0, 0]
    assert not door.exists()
