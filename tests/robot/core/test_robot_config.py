"""Settings: what a person writes into the file, and what they are told when it is wrong."""

from pathlib import Path

import pytest

from robot.core.config import ConfigError, Settings, keys, load_settings, read_token
from robot.ops.assembly import check_settings


def write(folder: Path, text: str) -> Path:
    path = folder / "robot.toml"
    path.write_text(text)
    return path


def test_without_a_file_every_setting_has_a_value() -> None:
    assert load_settings(None, {}) == Settings()


def test_the_command_line_wins_over_the_file_and_silence_leaves_it(tmp_path: Path) -> None:
    path = write(tmp_path, 'name = "r7"\nmap = "carleton"\n[mind]\npercepts = "drain"\n')
    settings = load_settings(path, {"map": "test_track", "name": None, "mind.steps_per_tick": 3})
    assert (settings.name, settings.map) == ("r7", "test_track")
    assert (settings.mind.percepts, settings.mind.steps_per_tick) == ("drain", 3)


@pytest.mark.parametrize(
    ("text", "key", "hint"),
    [
        ("[battery]\nlow_rato = 0.3\n", "battery.low_rato", "battery.low_ratio"),
        ("sever = 'wss://mail'\n", "sever", "server"),
    ],
)
def test_an_unknown_key_is_named_with_the_nearest_one(tmp_path: Path, text: str, key: str, hint: str) -> None:
    with pytest.raises(ConfigError) as caught:
        load_settings(write(tmp_path, text), {})
    assert caught.value.key == key
    assert repr(hint) in caught.value.way_out


@pytest.mark.parametrize(
    ("text", "key"),
    [
        ("[battery]\nlow_ratio = 25\n", "battery.low_ratio"),
        ("[drive]\ncruise_mm_s = 10\n", "drive.cruise_mm_s"),
        ("[drive]\ncruise_mm_s = 400\n", "drive.cruise_mm_s"),
        ("server = 'ws://mail.campus.example/link'\n", "server"),
        ("name = [broken\n", "file"),
        ("[line]\nleft_pin = 'BOARD8'\n", "line"),
        ("[line]\nleft_pin = 'twelve'\n", "line.left_pin"),
        ("[battery]\nlow_ratio = 0.99\n", "battery"),
        ("[rates]\ndrive_hz = 0\n", "rates.drive_hz"),
        ("[drive]\nmm_per_count = 4.4\n", "drive.mm_per_count"),
        ("brc = 'dtr'\n", "brc"),
    ],
)
def test_a_value_that_cannot_be_is_refused_by_its_key(tmp_path: Path, text: str, key: str) -> None:
    with pytest.raises(ConfigError) as caught:
        load_settings(write(tmp_path, text), {})
    assert caught.value.key == key


def test_an_absent_file_says_so(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="cannot be read"):
        load_settings(tmp_path / "absent.toml", {})


def test_every_setting_is_described() -> None:
    assert [key for key, description in keys().items() if not description] == []


def test_a_token_that_others_may_read_is_refused_with_the_way_out(tmp_path: Path) -> None:
    path = tmp_path / "token"
    path.write_text("cmr_abc_def\n")
    path.chmod(0o644)
    with pytest.raises(ConfigError, match="chmod 600"):
        read_token(path)
    path.chmod(0o600)
    assert read_token(path) == "cmr_abc_def"


def test_an_absent_token_names_the_command_that_makes_one(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="robots enrol"):
        read_token(tmp_path / "token")


def test_a_mailroom_that_is_not_on_the_map_is_found_before_any_robot_starts(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="mailroom: map test_track has no post nowhere"):
        check_settings(load_settings(None, {"data": tmp_path, "mailroom": "nowhere"}))
