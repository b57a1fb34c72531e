"""The pages for maintainers name every command and every check, and what they tell people to type exists."""

import re
from pathlib import Path

import typer

from docs.site import reference
from robot.__main__ import cli
from robot.ops.doctor.table import CHECKS

ROOT = Path(__file__).parents[3]
HOW_TO = ROOT / "docs" / "how-to"
OPERATION = (HOW_TO / "install-a-robot.md").read_text() + (HOW_TO / "repair-a-robot.md").read_text()
WIRING = (HOW_TO / "wire-a-robot.md").read_text()
COMMANDS = typer.main.get_command(cli).commands  # type: ignore[attr-defined]


def test_every_command_is_in_the_manual() -> None:
    page = reference.commands()
    assert [name for name in COMMANDS if f"`python -m robot {name}`" not in page] == []


def test_every_check_of_the_doctor_is_explained() -> None:
    assert [name for name, _ in CHECKS if not re.search(rf"^\| {name} \| .+ \| .+ \|$", OPERATION, re.MULTILINE)] == []


def test_whatever_a_page_tells_people_to_type_exists() -> None:
    typed = re.findall(r"(?:^|`)(?:python -m robot|robot) ([a-z]+)", OPERATION + WIRING, re.MULTILINE)
    assert len(typed) > 10
    assert set(typed) <= set(COMMANDS)


def test_every_file_that_is_to_be_installed_is_there() -> None:
    named = set(re.findall(r"deploy/[a-z0-9.-]+", OPERATION + WIRING))
    assert {"deploy/stop-base", "deploy/campus-mail-robot.service", "deploy/99-campus-mail.rules"} <= named
    assert [name for name in named if not (ROOT / name).exists()] == []
