"""The settings file as a person gets it, and as a command changes it."""

from pathlib import Path

import pytest
from typer.testing import CliRunner

from robot.__main__ import cli
from robot.core.config import ConfigError, Settings, keys, load_settings
from robot.core.settings_file import complete_toml, rows, write_settings

MINE = """\
# The robot of the library.
name = "r7"   # as on its lid

[battery]
low_ratio = 0.30
"""


def test_the_printed_settings_are_accepted_as_they_are_and_change_nothing(tmp_path: Path) -> None:
    path = tmp_path / "robot.toml"
    path.write_text(CliRunner().invoke(cli, ["settings"]).output)
    assert load_settings(path, {}) == Settings()


def test_the_printed_settings_name_and_describe_every_key() -> None:
    printed = complete_toml()
    assert [row.key for row in rows()] == list(keys())
    assert [row.key for row in rows() if row.about not in printed] == []


def test_a_right_file_is_called_right(tmp_path: Path) -> None:
    path = tmp_path / "robot.toml"
    path.write_text(MINE)
    ran = CliRunner().invoke(cli, ["settings", "--check", str(path)])
    assert (ran.exit_code, ran.output) == (0, f"{path} is right.\n")


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("battry = 1\n", "'battery"),
        ('home = "post2"\n', "post2 is no home"),
        ('map = "moon"\n', "test_track"),
        ('server = "wss://mail.campus.example/link"\n', "token_file"),
        ('[mind]\nprogram = "absent.asl"\n', "mind.program"),
    ],
)
def test_a_wrong_file_is_refused_with_what_is_wrong(tmp_path: Path, text: str, named: str) -> None:
    path = tmp_path / "robot.toml"
    path.write_text(text)
    ran = CliRunner().invoke(cli, ["settings", "--check", str(path)])
    assert ran.exit_code == 2
    assert named in ran.output


def test_a_changed_setting_leaves_comments_and_mode_as_they_were(tmp_path: Path) -> None:
    path = tmp_path / "robot.toml"
    path.write_text(MINE)
    path.chmod(0o640)
    write_settings(path, {"battery.low_ratio": 0.2, "drive.mm_per_count": 0.441, "server": "wss://mail.example/link"})
    text = path.read_text()
    assert "# The robot of the library." in text
    assert "# as on its lid" in text
    assert path.stat().st_mode & 0o777 == 0o640
    settings = load_settings(path, {})
    assert (settings.name, settings.battery.low_ratio, settings.drive.mm_per_count) == ("r7", 0.2, 0.441)
    assert settings.server == "wss://mail.example/link"


def test_a_change_that_would_not_be_accepted_leaves_the_file_alone(tmp_path: Path) -> None:
    path = tmp_path / "robot.toml"
    path.write_text(MINE)
    with pytest.raises(ConfigError, match="mm_per_count"):
        write_settings(path, {"drive.mm_per_count": 4.4})
    assert path.read_text() == MINE
    assert list(tmp_path.iterdir()) == [path]


def test_the_first_setting_begins_the_file(tmp_path: Path) -> None:
    write_settings(tmp_path / "robot.toml", {"name": "r9"})
    assert load_settings(tmp_path / "robot.toml", {}).name == "r9"


def test_a_folder_that_takes_no_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="cannot be written"):
        write_settings(tmp_path / "nowhere" / "robot.toml", {"name": "r9"})
