"""Differences from Jason, as docs/reference lists them: every row has a program that shows our behaviour.

A row without a program, a program without a row, or a behaviour that has changed fails: then either the page or the
interpreter has to be put right.
"""

import re
from importlib import import_module
from pathlib import Path

import pytest

from tests.bdi.differences import SHOWN

for _module in ("agents", "builtins", "goals", "limits", "mistakes", "modules", "refused", "text", "world"):
    import_module(f"tests.bdi.differences.{_module}")

PAGE = Path(__file__).parents[2] / "docs" / "reference" / "agentspeak-differences.md"
ROW = re.compile(r"^\| `([\w-]+)` \|(.*)\|$", re.MULTILINE)


def rows() -> dict[str, list[str]]:
    """Name → the other cells: construct, in Jason, here, why."""
    section = PAGE.read_text().partition("## What differs from Jason")[2].partition("\n## ")[0]
    return {name: [cell.strip() for cell in rest.split(" | ")] for name, rest in ROW.findall(section)}


def test_every_row_has_a_program_and_every_program_a_row() -> None:
    assert sorted(rows()) == sorted(SHOWN)


def test_every_row_says_what_jason_does_what_we_do_and_why() -> None:
    assert [name for name, cells in rows().items() if len(cells) != 4 or not all(cells)] == []


@pytest.mark.parametrize("row", sorted(SHOWN))
@pytest.mark.slow
def test_the_row_tells_the_truth_about_us(row: str) -> None:
    SHOWN[row]()
