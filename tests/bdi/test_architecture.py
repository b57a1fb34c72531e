"""docs/architecture.md names every module of the mind, and none that is not there."""

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]


def test_every_module_of_the_mind_is_named_and_every_module_named_exists() -> None:
    section = (ROOT / "docs" / "architecture.md").read_text().partition("## Inside the mind")[2].partition("\n## ")[0]
    named = set(re.findall(r"`(?:bdi/)?(\w+)(?:\.py)?`", section))
    there = {path.stem for path in (ROOT / "bdi").iterdir() if (path.is_dir() or path.suffix == ".py")}
    modules = {name for name in there if not name.startswith("_")}
    assert named == modules
