"""The page about the simulated world names everything there is, and its example runs; so does the command."""

import os
import re
import signal
import stat
import subprocess
import sys
from pathlib import Path

import pytest
import serial
import typer
from typer.testing import CliRunner

from docs.site.robot_pages import simulated_faults
from maps import builtin_map
from protocol.clock import RealClock
from robot.simulated import SWITCHES, SimulatedRobot
from robot.simulated.__main__ import cli, let_live
from robot.simulated.door import COMMANDS

ROOT = Path(__file__).parents[3]
PAGE = (ROOT / "docs" / "reference" / "simulated-world.md").read_text(encoding="utf-8")
COMMAND = [sys.executable, "-m", "robot.simulated"]


@pytest.mark.parametrize("name", [*SWITCHES, *COMMANDS])
def test_the_page_describes_every_switch_and_door_command(name):
    assert re.search(rf"^\| `{name}` \|", PAGE + simulated_faults(), re.MULTILINE)


def test_the_pages_example_runs(capsys):
    example = re.search(r"```python\n(.*?)```", PAGE, re.DOTALL)
    assert example
    exec(example.group(1), {})  # noqa: S102  # our own page
    assert "(480, 640, 3)" in capsys.readouterr().out


def test_the_command_lists_its_faults():
    told = subprocess.run([*COMMAND, "--list-faults"], capture_output=True, text=True, check=True, cwd=ROOT).stdout
    assert all(name in told for name in SWITCHES)


@pytest.mark.parametrize("ending", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.slow
def test_the_command_opens_a_port_and_a_door_and_ends_with_ctrl_c(tmp_path, ending):
    link, door = tmp_path / "create2", tmp_path / "door"
    options = ["--link", str(link), "--door", str(door), "--start", "post1"]
    process = subprocess.Popen([*COMMAND, *options], stdout=subprocess.PIPE, text=True, cwd=ROOT)
    assert process.stdout
    path = process.stdout.readline().strip()
    assert os.path.realpath(link) == path
    assert stat.S_ISSOCK(door.stat().st_mode)
    with serial.Serial(path, 115200, timeout=5) as port:
        port.write(bytes((128, 142, 35)))
        assert port.read(1) == b"\x01"
    process.send_signal(ending)
    process.stdout.close()
    assert process.wait(timeout=10) == 0
    assert not link.is_symlink()
    assert not door.exists()


@pytest.mark.parametrize(
    ("options", "part"),
    [
        (["--map", "atlantis"], "atlantis"),
        (["--start", "post9"], "cannot start at 'post9'"),
        (["--door", "nowhere/door"], "--door nowhere/door: cannot be made"),
        (["--link", "nowhere/port"], "--link nowhere/port: cannot be made"),
        (["--link", "README.md"], "--link README.md: cannot be made: File exists"),
    ],
)
def test_a_wrong_map_start_or_place_ends_the_command_with_a_sentence(options, part):
    ended = CliRunner().invoke(cli, options)
    assert (ended.exit_code, part in ended.stderr) == (2, True)


def test_a_world_that_fails_ends_the_command_with_exit_1_and_says_why(capsys):
    def fails() -> None:
        raise ZeroDivisionError("the floor has no length")

    clock = RealClock()
    robot = SimulatedRobot(builtin_map("test_track"), clock.now(), "post1")
    robot.before_steps.append(fails)
    before = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        with pytest.raises(typer.Exit) as ended:
            let_live(robot, clock, None)
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
    assert ended.value.exit_code == 1
    assert "The simulated world has stopped: the floor has no length (ZeroDivisionError)." in capsys.readouterr().err
