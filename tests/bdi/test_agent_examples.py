"""The pages about AgentSpeak run: programs, commands and Python, as they are shown."""

import re
import shlex
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from bdi.__main__ import app

ROOT = Path(__file__).parents[2]
AGENTS = ROOT / "examples" / "agents"
EXAMPLES = sorted([*AGENTS.glob("*.asl"), *(AGENTS / "contract_net").glob("*.asl")])
TESTED = [path for path in EXAMPLES if "prints" in path.read_text()]
DOCS = ROOT / "docs"
PAGE = (DOCS / "explanation" / "agentspeak.md").read_text()
TOOLS = (DOCS / "how-to" / "debug-an-agent-program.md").read_text()
SESSIONS = re.findall(r"```console\n\$ (.*)\n([\s\S]*?)```", TOOLS)
PIECES = re.findall(r"```python\n([\s\S]*?)```", (DOCS / "how-to" / "embed-an-agent.md").read_text())


@pytest.mark.parametrize("path", TESTED, ids=lambda path: path.name)
def test_an_example_does_what_it_says(path: Path) -> None:
    result = CliRunner().invoke(app, ["test", str(path)])
    assert result.exit_code == 0, result.output


def test_every_example_is_shown_as_it_is() -> None:
    assert len(TESTED) > 15
    assert [path.name for path in EXAMPLES if path.read_text().strip() not in PAGE] == []


def test_every_program_that_is_shown_is_an_example() -> None:
    texts = {path.read_text().strip() for path in EXAMPLES}
    shown = re.findall(r"```agentspeak\n([\s\S]*?)```", PAGE)
    assert [text for text in shown if text.strip() not in texts] == []


@pytest.mark.parametrize(("command", "output"), SESSIONS, ids=[command for command, _ in SESSIONS])
def test_a_command_prints_what_the_page_shows(command: str, output: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    typed, _, wanted = command.rpartition(" | ")
    lines = shlex.split(typed)[1].replace("\\n", "\n") if typed else None
    words = shlex.split(wanted)
    assert words[:3] == ["python", "-m", "bdi"]
    result = CliRunner().invoke(app, words[3:], input=lines)
    assert [line.rstrip() for line in result.stdout.rstrip().splitlines()] == output.rstrip().splitlines()


def test_the_pieces_of_python_run_one_after_the_other(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    names: dict[str, Any] = {}
    assert PIECES
    for piece in PIECES:
        exec(compile(piece, "docs/how-to/embed-an-agent.md", "exec"), names)  # noqa: S102 -- our own page
