"""Enrolling: an accepted token is kept so that no other user may read it, and a refused one is not kept."""

from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from robot.__main__ import cli
from robot.core.config import load_settings, read_token


def enrol(folder: Path, server: str, token: str, *more: str) -> Result:
    arguments = ["enrol", "r7", server, "--config", str(folder / "robot.toml"), "--token-stdin", *more]
    return CliRunner().invoke(cli, arguments, input=token)


def test_a_token_that_the_service_takes_is_kept_and_named_in_the_settings(tmp_path: Path, link: str) -> None:
    (tmp_path / "robot.toml").write_text("# ours\n[battery]\nlow_ratio = 0.3\n")
    ran = enrol(tmp_path, link, "good\n")
    assert ran.exit_code == 0, ran.output
    settings = load_settings(tmp_path / "robot.toml", {})
    assert (settings.name, settings.server, settings.battery.low_ratio) == ("r7", link, 0.3)
    assert settings.token_file == tmp_path / "r7.token"
    assert settings.token_file.stat().st_mode & 0o777 == 0o600
    assert read_token(settings.token_file) == "good"
    assert (tmp_path / "robot.toml").read_text().startswith("# ours\n")
    assert "good" not in ran.output


def test_a_token_that_the_service_refuses_is_not_kept(tmp_path: Path, link: str) -> None:
    ran = enrol(tmp_path, link, "stolen")
    assert (ran.exit_code, "Nothing was written" in ran.output) == (1, True)
    assert list(tmp_path.iterdir()) == []


def test_a_service_that_is_out_of_reach_is_said_and_the_token_kept(tmp_path: Path) -> None:
    ran = enrol(tmp_path, "ws://127.0.0.1:9/link", "later", "--token-file", str(tmp_path / "secret" / "token"))
    assert ran.exit_code == 0
    assert "could not be tried" in ran.output
    assert read_token(tmp_path / "secret" / "token") == "later"


@pytest.mark.parametrize(
    ("server", "token", "named"),
    [
        ("ws://mail.campus.example/link", "x", "wss"),
        ("wss://mail.campus.example/link", "", "one word"),
        ("wss://mail.campus.example/link", "two words", "one word"),
    ],
)
def test_what_cannot_be_is_refused_before_anything_is_written(
    tmp_path: Path, server: str, token: str, named: str
) -> None:
    ran = enrol(tmp_path, server, token)
    assert (ran.exit_code, named in ran.output) == (2, True)
    assert list(tmp_path.iterdir()) == []
