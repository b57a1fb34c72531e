"""Logging waits for no disk; a command that misses a log says where it may be."""

import logging
import shutil
import subprocess
import sys
import threading
from contextlib import suppress
from pathlib import Path

import pytest
import structlog
import typer
from typer.testing import CliRunner

from robot.__main__ import cli
from robot.core.logs import WAITING_LINES, WrittenElsewhere, configure_logs
from robot.ops.commands.logs import journal_of

ROOT = Path(__file__).parents[3]


class Card(logging.Handler):
    """Writes nothing until it is let."""

    def __init__(self) -> None:
        super().__init__()
        self.hangs = threading.Event()
        self.lines: list[str] = []

    def emit(self, record: logging.LogRecord) -> None:
        self.hangs.wait()
        self.lines.append(record.getMessage())


def test_a_card_that_hangs_keeps_nobody_waiting_and_what_there_is_room_for_is_written_in_the_end() -> None:
    card = Card()
    handler = WrittenElsewhere(card)
    for number in range(2 * WAITING_LINES):
        handler.handle(logging.LogRecord("robot", logging.INFO, __file__, 1, f"line {number}", None, None))
    assert card.lines == []
    threading.Timer(0.05, card.hangs.set).start()
    handler.close()
    assert card.lines[:2] == ["line 0", "line 1"]
    assert WAITING_LINES <= len(card.lines) < 2 * WAITING_LINES


@pytest.mark.skipif(not shutil.which("journalctl"), reason="no systemd here")
def test_a_journal_without_a_line_of_the_unit_is_no_answer_but_what_to_do_is(capfd: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(typer.Exit) as ended:
        journal_of("no-unit-has-this-name", newest=5, follow=False)
    told = capfd.readouterr()
    assert (ended.value.exit_code, told.out) == (2, "")
    assert "systemctl status no-unit-has-this-name" in told.err
    assert "log_file" in told.err


def test_a_log_file_that_is_not_there_yet_is_named(tmp_path: Path) -> None:
    (tmp_path / "robot.toml").write_text(f'log_file = "{tmp_path / "robot.log"}"\n')
    shown = CliRunner().invoke(cli, ["logs", "--config", str(tmp_path / "robot.toml"), "--data", str(tmp_path)])
    assert (shown.exit_code, f"{tmp_path / 'robot.log'} (the setting log_file)" in shown.stderr) == (2, True)


def test_a_log_file_is_five_of_a_megabyte_at_most_and_the_command_shows_the_newest_lines(tmp_path: Path) -> None:
    log = tmp_path / "robot.log"
    configure_logs(log)
    try:
        for number in range(7_000):  # one at a time, so that none is lost for want of room
            logging.getLogger("robot").info("%d %s", number, "x" * 1_000)
            if number % (WAITING_LINES // 2) == 0:
                while not _is_written(log, f"{number} x"):
                    threading.Event().wait(0.005)
    finally:
        for handler in tuple(logging.getLogger("robot").handlers):
            logging.getLogger("robot").removeHandler(handler)
            handler.close()
        structlog.reset_defaults()
    sizes = [path.stat().st_size for path in tmp_path.glob("robot.log*")]
    assert len(sizes) == 5
    assert max(sizes) <= 1_000_000
    assert sum(sizes) > 4_000_000, "the newest are there"
    (tmp_path / "robot.toml").write_text(f'log_file = "{log}"\n')
    newest = _shown(tmp_path, "--lines", "2")
    assert [line.split()[0] for line in newest.splitlines()] == ["6998", "6999"]


def _is_written(log: Path, line: str) -> bool:
    with suppress(FileNotFoundError):  # one that is renamed between the two looks
        return any(line in path.read_text() for path in log.parent.glob("robot.log*"))
    return False


def _shown(folder: Path, *options: str) -> str:
    words = (sys.executable, "-m", "robot", "logs", "--config", folder / "robot.toml", "--data", folder, *options)
    return subprocess.run(words, cwd=ROOT, capture_output=True, text=True, check=True, timeout=60).stdout


def test_a_traceback_in_the_terminal_shows_no_local_variable(capsys: pytest.CaptureFixture[str]) -> None:
    structlog.reset_defaults()  # as a process starts
    configure_logs(None)
    token = "a-secret-of-the-robot"
    try:
        raise RuntimeError(f"{len(token)} characters refused")
    except RuntimeError:
        structlog.get_logger("robot").exception("sign_in_failed", robot="r1")
    printed = capsys.readouterr()
    assert "sign_in_failed" in printed.err
    assert "RuntimeError: 21 characters refused" in printed.err
    assert token not in printed.err
    assert printed.out == ""
