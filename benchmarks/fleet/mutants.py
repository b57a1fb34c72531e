"""Break the traffic rules on purpose, one subtle break at a time, and see that a test says so.

In a copy of the tree; the breaks and the tests that must see them are in `mutants.toml`.
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

CHECKOUT = Path(__file__).parents[2]
LIST = Path(__file__).with_suffix(".toml")
FAILED = re.compile(r"^(?:FAILED|ERROR) (\S+)", re.MULTILINE)

app = typer.Typer(add_completion=False, pretty_exceptions_enable=False)


@dataclass(frozen=True, slots=True)
class Mutant:
    name: str
    file: str
    before: str
    after: str
    tests: tuple[str, ...]


def all_mutants() -> list[Mutant]:
    rows = tomllib.loads(LIST.read_text(encoding="utf-8"))["mutant"]
    return [Mutant(**{**row, "tests": tuple(row["tests"])}) for row in rows]


def broken(mutant: Mutant, text: str) -> str:
    """The file with the break. Raises ValueError if there is not one place for it."""
    if text.count(mutant.before) != 1:
        raise ValueError(
            f"{mutant.file} has {text.count(mutant.before)} places for the break {mutant.name!r}: see {LIST}"
        )
    return text.replace(mutant.before, mutant.after)


@app.command()
def main(
    names: Annotated[list[str] | None, typer.Argument(help="Words in the names; all breaks if none.")] = None,
) -> None:
    """Say of each break which test has seen it. Ends with 1 if one was not seen."""
    mutants = [one for one in all_mutants() if not names or any(word in one.name for word in names)]
    with tempfile.TemporaryDirectory() as folder:
        tree = _copied(Path(folder))
        seen_by = _first_failure(tree, sorted({test for one in mutants for test in one.tests}))
        if seen_by:
            raise SystemExit(f"{seen_by} fails without any break: mend that first.")
        missed = [one.name for one in mutants if not _is_seen(tree, one)]
    print(f"{len(mutants) - len(missed)} of {len(mutants)} breaks were seen.")
    raise typer.Exit(bool(missed))


def _copied(folder: Path) -> Path:
    """Only what git has, so that nothing of earlier runs is there."""
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=CHECKOUT, capture_output=True, text=True, check=True).stdout
    for name in filter(None, listed.split("\0")):
        if (CHECKOUT / name).is_file() and not name.startswith("docs/pictures"):
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(CHECKOUT / name, folder / name)
    return folder


def _is_seen(tree: Path, mutant: Mutant) -> bool:
    file = tree / mutant.file
    whole = file.read_text(encoding="utf-8")
    file.write_text(broken(mutant, whole), encoding="utf-8")
    try:
        seen_by = _first_failure(tree, mutant.tests)
    finally:
        file.write_text(whole, encoding="utf-8")
    print(f"{mutant.name}: {seen_by or 'NOT SEEN'}", flush=True)
    return seen_by is not None


def _first_failure(tree: Path, tests: Sequence[str]) -> str | None:
    """The first test that fails, or is not done in ten minutes; None if all pass."""
    command = [
        sys.executable,
        "-m",
        "pytest",
        "-q",
        "-x",
        "-p",
        "no:cacheprovider",
        "-m",
        "not nightly and not slow",
        *tests,
    ]
    # Compiled modules are known by time and size: a break of the same size in the same second would not be seen.
    environment = {**os.environ, "PYTHONDONTWRITEBYTECODE": "1"}
    try:
        ran = subprocess.run(
            command, cwd=tree, env=environment, capture_output=True, text=True, check=False, timeout=600
        )
    except subprocess.TimeoutExpired:
        return f"no end of {', '.join(tests)}"
    if ran.returncode == 0:
        return None
    found = FAILED.search(ran.stdout)
    if found is None:
        raise SystemExit(f"pytest could not run {', '.join(tests)}:\n{ran.stdout[-2000:]}{ran.stderr[-2000:]}")
    return found[1]


if __name__ == "__main__":
    app()
