"""The table of limits and reasons is what the skills do."""

import ast
import inspect

import pytest

from robot.skills import Dock, FindLine, FollowLine, Say, Skill, Turn, Undock, WaitHandover
from robot.skills.ends import ENDS, OF_ANY, Ends
from tests.plain_maps import plain_map

SKILLS: tuple[Skill, ...] = (
    FollowLine(plain_map("test_track")),
    Turn(1.0),
    FindLine(),
    Dock(),
    Undock(),
    WaitHandover(lambda: ()),
    Say(),
)
PART_OF = {"follow_line": (FindLine,)}
"""Skills that another one steps itself: their reasons are its own."""


def reasons_in(kind: type) -> set[str]:
    """Every name that the text of a class fails by."""
    calls = (node for node in ast.walk(ast.parse(inspect.getsource(kind))) if isinstance(node, ast.Call))
    named = (call for call in calls if isinstance(call.func, ast.Name) and call.func.id == "Failed")
    return {call.args[0].value for call in named if isinstance(call.args[0], ast.Constant)}


@pytest.mark.parametrize("skill", SKILLS, ids=lambda skill: skill.name)
def test_every_skill_ends_as_its_row_says(skill: Skill):
    row: Ends = next(row for row in ENDS if row.skill == skill.name)
    assert (skill.limit_s, skill.on_timeout) == (row.limit_s, row.on_timeout)
    parts = (type(skill), *PART_OF.get(skill.name, ()))
    assert set().union(*map(reasons_in, parts)) | {skill.on_timeout} == set(row.reasons)


def test_every_row_is_a_skill_and_says_something_of_every_end():
    assert [row.skill for row in ENDS] == [skill.name for skill in SKILLS]
    assert all(meaning for row in ENDS for meaning in (row.done, *row.reasons.values()))
    assert not set(OF_ANY) & {reason for row in ENDS for reason in row.reasons}
