"""Runs the code blocks of a page as a reader does: saves the named files, types the commands, compares the output.

- A block with `title="path"` is saved there; one with `title="end of path"` is added to the end of that file.
- A `console` block has commands (`$ …`) and their output. A line of "…" stands for any lines, "…" within a line for
  any text. Output and error stream are one text.
- All other blocks are shown only.
"""

import os
import re
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

CHECKOUT = Path(__file__).parents[2]
BLOCK = re.compile(r"^```(\w+)([^\n]*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
TITLE = re.compile(r'title="(end of )?([^"]+)"')
COMMAND_SECONDS = 100


@dataclass(frozen=True)
class Ran:
    command: str
    expected: str
    output: str

    @property
    def as_expected(self) -> bool:
        lines = [
            re.escape(line.rstrip()).replace(r"\ …", " ?.*").replace("…", ".*") for line in self.expected.splitlines()
        ]
        pattern = "".join(r"(?:.*\n)*?" if line == ".*" else rf"{line}[ ]*\n" for line in lines)
        return re.fullmatch(pattern, self.output) is not None


def make_checkout(folder: Path) -> Path:
    """A folder that looks like the checkout to the commands, with a `var` of its own."""
    for entry in CHECKOUT.iterdir():
        if entry.name not in {"var", ".git"}:
            (folder / entry.name).symlink_to(entry)
    (folder / "var" / "tutorial").mkdir(parents=True)
    return folder


def run(page: str, folder: Path) -> Iterator[Ran]:
    """Do what the page says, in its order. Yields each command with what is printed."""
    for language, info, text in BLOCK.findall(page):
        if title := TITLE.search(info):
            with (folder / title[2]).open("a" if title[1] else "w", encoding="utf-8") as file:
                file.write(("\n" if title[1] else "") + text)
        elif language == "console":
            for command, expected in re.findall(r"^\$ (.*)\n((?:(?!\$ ).*\n)*)", text, re.MULTILINE):
                yield Ran(command, expected, _output(command, folder))


def _output(command: str, folder: Path) -> str:
    done = subprocess.run(
        ["bash", "-c", command.replace(".venv/bin/python", sys.executable)],
        cwd=folder,
        env={**os.environ, "COLUMNS": "100", "NO_COLOR": "1"},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=COMMAND_SECONDS,
        check=False,
    )
    return "\n".join(line.rstrip() for line in done.stdout.splitlines()) + "\n" if done.stdout.strip() else ""
