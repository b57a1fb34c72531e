"""Commands answer at once: what takes long to import is imported when it is needed, and said before."""

import gc
import importlib
import re
import signal
import subprocess
import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
HEAVY = {"fastapi", "sqlalchemy", "httpx", "structlog", "numpy", "cv2", "reportlab", "asyncio", "bdi"}
IMPORTED = re.compile(r"^import time: .*\| +(\S+)$")


def command(*words: str) -> list[str]:
    return [sys.executable, "-X", "importtime", "-m", *words]


def heavy(said: Iterable[str]) -> set[str]:
    """The packages among HEAVY that Python says it has imported."""
    names = (found[1].partition(".")[0] for line in said if (found := IMPORTED.match(line)))
    return HEAVY.intersection(names)


@contextmanager
def at_a_terminal(words: list[str], stderr: int, stdout: int | None = None) -> Iterator[subprocess.Popen[str]]:
    """Run a command that Ctrl-C reaches, though the tests run where it is ignored: in the background of a shell."""
    heed = partial(signal.signal, signal.SIGINT, signal.SIG_DFL)
    pipes = {"stdout": stdout, "stderr": stderr}
    with subprocess.Popen(words, cwd=ROOT, text=True, preexec_fn=heed, **pipes) as run:  # noqa: PLW1509
        try:
            yield run
        finally:
            run.terminate()


@pytest.mark.parametrize("program", ["app", "robot", "demo"])
def test_help_lists_every_command_without_importing_what_they_need(program: str) -> None:
    ran = subprocess.run(command(program, "--help"), cwd=ROOT, capture_output=True, text=True, check=True, timeout=60)
    assert {"app": "serve", "robot": "doctor", "demo": "letter"}[program] in ran.stdout
    assert heavy(ran.stderr.splitlines()) == set()
    assert heavy(["import time:         1 |          2 |     fastapi.routing"]) == {"fastapi"}, "is still said so"


@pytest.mark.parametrize("program", ["app", "robot"])
def test_every_command_is_listed_as_its_own_help_begins(program: str) -> None:
    commands = importlib.import_module(f"{program}.__main__")
    for name, (_, summary) in commands.COMMANDS.items():
        own = " ".join(commands.loaded(name).help.split())
        assert own.startswith(summary), name


@pytest.mark.parametrize("demo", ["letter", "fleet"])
@pytest.mark.nightly
def test_a_demonstration_says_what_it_starts_before_it_loads_anything_and_ctrl_c_that_it_stops(demo: str) -> None:
    with at_a_terminal(command("demo", demo, "--json", "--port", "0"), stderr=subprocess.PIPE) as run:
        assert run.stderr is not None
        before = []
        for line in run.stderr:
            if not line.startswith("import time:"):
                break
            before.append(line)
        assert line.startswith("Campus Mail: starting a service")
        assert heavy(before) == set()
        assert any(line.startswith("Starting the service") for line in run.stderr)
        run.send_signal(signal.SIGINT)
        assert any(line.startswith("Stopping") for line in run.stderr)
        assert run.wait(20) == 0


@pytest.mark.parametrize(("options", "code"), [((), 0), (("--once",), 130)], ids=["that goes on", "that would end"])
def test_a_demonstration_that_is_stopped_while_it_loads_says_so(options: tuple[str, ...], code: int) -> None:
    words = [sys.executable, "-m", "demo", "letter", "--port", "0", *options]
    with at_a_terminal(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT) as run:
        assert run.stdout is not None
        run.stdout.readline()
        run.send_signal(signal.SIGINT)
        assert run.stdout.read().splitlines() == ["Stopping: nothing has been started yet."]
        assert run.wait(20) == code


@pytest.mark.parametrize(("program", "command"), [("app", "people"), ("robot", "settings")])
def test_garbage_is_collected_again_once_a_command_is_imported(program: str, command: str) -> None:
    importlib.import_module(f"{program}.__main__").loaded(command)
    assert gc.isenabled()
