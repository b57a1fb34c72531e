"""Set-up and tests on machines that lack something: it is named."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.own_checkout import CHECKOUT, copied_to, make, sentences

LEAST_TOOLS = ("sh", "env", "awk", "cut", "git", "make")


@pytest.fixture
def bare_machine(tmp_path: Path) -> Path:
    """A folder to be the whole PATH: a shell, make, git, and neither Python, node nor browser."""
    tools = tmp_path / "bin"
    tools.mkdir()
    for name in LEAST_TOOLS:
        found = shutil.which(name)
        assert found, name
        (tools / name).symlink_to(found)
    return tools


@pytest.mark.parametrize("verb", ["setup", "setup-robot", "demo"])
@pytest.mark.parametrize(
    ("python", "sentence"),
    [
        (None, "There is no python3. Install Python 3.11 or newer (apt install python3 python3-venv)"),
        (
            'test "$1" = --version && echo "Python 3.9.2"; exit 1',
            "Python 3.11 or newer is needed; this is Python 3.9.2",
        ),
        ('case "$2" in *ensurepip*) exit 1;; esac; exit 0', "apt install python3-venv"),
    ],
    ids=["no Python", "an old Python", "Debian's without venv"],
)
def test_a_python_that_cannot_be_used_is_named(
    bare_machine: Path, verb: str, python: str | None, sentence: str
) -> None:
    """`python`: a shell script in its place."""
    if python:
        (bare_machine / "python3").write_text(f"#!{bare_machine}/sh\n{python}\n")
        (bare_machine / "python3").chmod(0o755)
    finished = make(copied_to(bare_machine.parent / "checkout"), verb, PATH=str(bare_machine))
    assert finished.returncode != 0
    (said,) = sentences(finished)
    assert sentence in said


def test_a_python_without_a_ready_made_lgpio_is_told_what_to_install(bare_machine: Path) -> None:
    checkout = copied_to(bare_machine.parent / "checkout")
    (checkout / ".venv/bin").mkdir(parents=True)
    (checkout / ".venv/bin/pip").touch()
    (bare_machine / "touch").symlink_to(shutil.which("touch") or "")
    trixies = checkout / ".venv/bin/python"
    trixies.write_text(f'#!{bare_machine}/sh\ncase "$2" in *"3, 13"*) exit 1;; esac; exit 0\n')
    trixies.chmod(0o755)
    finished = make(checkout, "setup-robot", PATH=str(bare_machine))
    assert finished.returncode != 0
    assert sentences(finished) == [
        "For this Python lgpio has to be built: apt install swig python3-dev build-essential liblgpio-dev"
    ]


BROWSER_TESTS = """
import pytest

@pytest.mark.browser
@pytest.mark.parametrize("page", range(3))
def test_in_a_browser(page): ...

def test_without_one(): ...
"""


def run_browser_tests(tmp_path: Path, **environment: str) -> subprocess.CompletedProcess[str]:
    shutil.copy(CHECKOUT / "tests/conftest.py", tmp_path)
    shutil.copy(CHECKOUT / "pyproject.toml", tmp_path)
    (tmp_path / "test_pages.py").write_text(BROWSER_TESTS)
    command = [sys.executable, "-m", "pytest", "-q", "-o", "testpaths=.", "-p", "no:cacheprovider"]
    environment = {"PATH": os.defpath, "HOME": str(tmp_path), "PYTHONPATH": str(CHECKOUT), **environment}
    return subprocess.run(
        command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False, timeout=60
    )


@pytest.mark.slow
def test_without_a_browser_the_last_line_counts_what_did_not_run(tmp_path, bare_machine):
    finished = run_browser_tests(tmp_path, PATH=str(bare_machine))
    assert finished.returncode == 0
    assert "1 passed, 3 deselected" in finished.stdout
    last = finished.stdout.splitlines()[-1]
    assert last == "NOT RUN: 3 browser tests (no Chromium found: apt install chromium, or set CHROMIUM=/path)"


@pytest.mark.slow
def test_where_a_browser_is_required_its_absence_is_a_failure(tmp_path, bare_machine):
    finished = run_browser_tests(tmp_path, PATH=str(bare_machine), CAMPUS_MAIL_REQUIRE_BROWSER="1")
    assert finished.returncode != 0
    assert "no Chromium found, and 3 browser tests must run" in finished.stderr


@pytest.mark.slow
def test_a_named_browser_that_is_not_there_is_an_error(tmp_path, bare_machine):
    finished = run_browser_tests(tmp_path, PATH=str(bare_machine), CHROMIUM="/nowhere/chromium")
    assert finished.returncode != 0
    assert "CHROMIUM=/nowhere/chromium is no program" in finished.stderr


@pytest.mark.slow
def test_with_a_browser_all_tests_run_and_nothing_is_counted(tmp_path, bare_machine):
    (bare_machine / "chromium").symlink_to(bare_machine / "sh")
    finished = run_browser_tests(tmp_path, PATH=str(bare_machine))
    assert "4 passed" in finished.stdout
    assert "NOT RUN" not in finished.stdout
