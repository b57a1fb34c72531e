"""docs/reference/faults.md shows people the same table that the robot obeys."""

from pathlib import Path

import pytest

from robot.reflexes import FAULTS, Fault

PAGE = (Path(__file__).parents[3] / "docs" / "reference" / "faults.md").read_text("utf-8")


def row_of(fault: Fault) -> str:
    stands = "drives on" if fault.stands_within_s is None else f"{fault.stands_within_s:g} s"
    after = f"{fault.after_s:g} s" if fault.after_s else "at once"
    name = f"**{fault.name}**" if fault.clears_s is None else fault.name
    return f"| {name} | {fault.response.value} | {after} | {stands} | {fault.cleared_by} | {fault.told} |"


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.name)
def test_each_row_of_the_table_is_on_the_page_as_it_is(fault: Fault) -> None:
    assert row_of(fault) in PAGE.splitlines(), f"docs/reference/faults.md must have this row:\n{row_of(fault)}"


def test_the_page_has_no_row_that_the_robot_does_not_know() -> None:
    table = PAGE.split("## The fault table")[1].split("\n## ")[0]
    rows = [line for line in table.splitlines() if line.startswith("| ")][1:]
    assert rows == [row_of(fault) for fault in FAULTS]
