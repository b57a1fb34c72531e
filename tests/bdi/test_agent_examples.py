"""The examples of docs/agentspeak.md do what they say, and the page shows them as they are."""

import json
import re
from pathlib import Path

import pytest
from typer.testing import CliRunner

from bdi.__main__ import app

ROOT = Path(__file__).parents[2]
EXAMPLES = sorted((ROOT / "examples" / "agents").glob("*.asl"))
PAGE = ROOT / "docs" / "agentspeak.md"


def sections(text: str) -> dict[str, list[str]]:
    """The closing comment: `percepts`, `messages`, `fails NAME` and `prints`, each followed by its lines."""
    found: dict[str, list[str]] = {}
    comment = text.rpartition("/*")[2].partition("*/")[0]
    for block in re.split(r"\n\s*\n", comment.strip()):
        title, *lines = block.splitlines()
        found[title.strip()] = lines
    return found


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.name)
def test_an_example_prints_what_it_says(path: Path, tmp_path: Path) -> None:
    said = sections(path.read_text())
    percepts = said.get("percepts", [])
    messages = [line.split(" ", 1) for line in said.get("messages", [])]
    script = [{"percepts": line.split(), "messages": []} for line in percepts] or [
        {"percepts": [], "messages": messages}
    ]
    (tmp_path / "percepts.jsonl").write_text("\n".join(map(json.dumps, script)))
    failing = [
        word for title in said if title.startswith("fails ") for word in ("--fail", title.removeprefix("fails "))
    ]
    arguments = ["run", str(path), "--percepts", str(tmp_path / "percepts.jsonl"), "--cycles", "60", *failing]
    assert CliRunner().invoke(app, arguments).stdout.splitlines() == said["prints"]


def test_the_page_shows_every_example_as_it_is() -> None:
    page = PAGE.read_text()
    missing = [path.name for path in EXAMPLES if path.read_text().strip() not in page]
    assert EXAMPLES
    assert not missing


def test_the_page_names_every_internal_action_and_function() -> None:
    from bdi.builtin import ACTIONS, FUNCTIONS

    page = PAGE.read_text()
    assert [name for name in [*ACTIONS, *FUNCTIONS] if f"`{name}`" not in page] == []
