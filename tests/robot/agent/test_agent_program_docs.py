"""The reference has each percept and action of the code, with its meaning, and no other."""

from pathlib import Path

from docs.site.robot_pages import percepts_and_actions
from robot.agent.actions.table import ACTIONS, PAPER_ACTIONS, Action
from robot.agent.perception.percepts import PERCEPTS, Percept

PAGE = Path(__file__).parents[3] / "docs" / "reference" / "agent-program.md"


def row(*cells: str) -> str:
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"


def percept_row(percept: Percept) -> str:
    return row(f"`{percept.name}`", percept.about, "both" if percept.drained else "latest")


def action_row(action: Action) -> str:
    form = f"{action.name}({', '.join(map(str, action.takes))})" if action.takes else action.name
    return row(f"`{form}`", action.about)


def table_under(heading: str) -> list[str]:
    section = percepts_and_actions().split(f"\n## {heading}\n")[1].split("\n## ")[0]
    return [line for line in section.splitlines() if line.startswith("| `")]


def test_the_percepts_of_the_page_are_those_of_the_code() -> None:
    assert table_under("Percepts") == [percept_row(percept) for percept in PERCEPTS]


def test_the_actions_of_the_page_are_those_of_the_code() -> None:
    assert table_under("Actions") == [action_row(action) for action in ACTIONS]
    assert table_under("The paper's actions") == [action_row(action) for action in PAPER_ACTIONS]


def test_every_file_of_the_program_is_on_the_page() -> None:
    files = [path.name for path in (PAGE.parents[2] / "robot" / "agent").glob("*.asl")]
    assert [name for name in files if f"| `{name}` |" not in PAGE.read_text("utf-8")] == []
