"""Commands as an operator types them, beside the running service and on its database."""

import json
import logging
import sys
from collections.abc import Callable, Iterator
from typing import Any

import pytest
import structlog
from click.testing import Result
from typer.testing import CliRunner

from app.__main__ import app as commands
from app.core.settings import Settings


@pytest.fixture(autouse=True)
def _logs_as_before() -> Iterator[None]:
    """Commands that run in this process set up logging for themselves; the service beside them logs elsewhere."""
    structlog.configure(logger_factory=structlog.PrintLoggerFactory(sys.stderr))
    root = logging.getLogger()
    handlers, level = root.handlers[:], root.level
    yield
    root.handlers[:] = handlers
    root.setLevel(level)
    structlog.reset_defaults()


Run = Callable[..., Result]


@pytest.fixture
def run(settings: Settings, monkeypatch: pytest.MonkeyPatch) -> Run:
    """`run("orders", "list")`: what it printed, and its exit code."""
    monkeypatch.setenv("CAMPUS_MAIL_DATA", str(settings.data))
    monkeypatch.setenv("CAMPUS_MAIL_DATABASE_URL", settings.database_url)

    def run_command(*words: str) -> Result:
        return CliRunner().invoke(commands, list(words))

    return run_command


@pytest.fixture
def ask(run: Run) -> Callable[..., Any]:
    """The JSON of a command that succeeds."""

    def ask_command(*words: str) -> Any:
        ran = run(*words, "--json")
        assert ran.exit_code == 0, ran.output
        return json.loads(ran.stdout)

    return ask_command
