"""`calibrate` over a real pseudo-terminal: it drives, shows old and new, and writes only what was agreed to."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from maps import find_map
from protocol.clock import RealClock
from robot.__main__ import cli
from robot.core.config import load_settings
from robot.simulated import SimulatedRobot
from robot.simulated.live import Live


@pytest.fixture
def config(tmp_path: Path) -> Iterator[Path]:
    """Settings of a simulated robot that lives in real time."""
    clock = RealClock()
    robot = SimulatedRobot(find_map("test_track"), clock.now(), "post3:post2")
    with Live(robot, clock):
        path = tmp_path / "robot.toml"
        path.write_text(f'# ours\nserial_port = "{robot.port_path}"\ndata = "{tmp_path}"\n')
        yield path
    robot.close()


def calibrate(config: Path, *arguments: str, said: str = "") -> Result:
    return CliRunner().invoke(cli, ["calibrate", *arguments, "--config", str(config)], input=said)


def test_a_measured_distance_is_written_when_it_is_agreed_to(config: Path) -> None:
    ran = calibrate(config, "distance", "--length-mm", "300", said="310\ny\n")
    assert ran.exit_code == 0, ran.output
    assert "drive.mm_per_count         0.44456 → 0.4" in ran.output
    assert 0.40 < load_settings(config, {}).drive.mm_per_count < 0.46
    assert config.read_text().startswith("# ours\n")


def test_what_nobody_agrees_to_and_what_cannot_be_is_not_written(config: Path) -> None:
    before = config.read_text()
    assert calibrate(config, "distance", "--length-mm", "300", "--measured-mm", "310", said="n\n").exit_code == 1
    impossible = calibrate(config, "distance", "--length-mm", "300", "--measured-mm", "3000", "--yes")
    assert (impossible.exit_code, "drive.mm_per_count" in impossible.output) == (2, True)
    assert config.read_text() == before


def test_without_a_base_it_says_so(tmp_path: Path) -> None:
    config = tmp_path / "robot.toml"
    config.write_text(f'serial_port = "{tmp_path}/tty"\ndata = "{tmp_path}"\n')
    ran = calibrate(config, "distance")
    assert (ran.exit_code, "Nothing was written" in ran.output) == (2, True)


@pytest.mark.parametrize(
    ("arguments", "key", "low", "high"),
    [
        (["distance", "--length-mm", "300"], "drive.mm_per_count", 0.42, 0.47),
        (["turn", "--turns", "1"], "drive.wheel_base_mm", 225, 245),
        (["camera", "300"], "camera.field_of_view_deg", 59, 61),
    ],
)
def test_a_simulated_robot_is_measured_without_a_person_and_nothing_is_written(
    tmp_path: Path, arguments: list[str], key: str, low: float, high: float
) -> None:
    config = tmp_path / "robot.toml"
    config.write_text(f'data = "{tmp_path}"\n')
    ran = calibrate(config, *arguments, "--simulated")
    assert ran.exit_code == 0, ran.output
    (row,) = [line for line in ran.stdout.splitlines() if line.startswith(key)]
    assert low < float(row.split("→")[1].split()[0]) < high
    assert config.read_text() == f'data = "{tmp_path}"\n'


def test_a_simulated_line_is_swung_over(tmp_path: Path) -> None:
    config = tmp_path / "robot.toml"
    config.write_text(f'data = "{tmp_path}"\n')
    ran = calibrate(config, "line", "--simulated")
    assert ran.exit_code == 0, ran.output
    assert "line.line_is_low           True → True  (as it was)" in ran.stdout
