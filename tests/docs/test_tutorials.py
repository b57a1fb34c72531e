"""The tutorials: their commands print what they show, their labels are those of the pages, and each is short."""

import json
import re
import subprocess
from typing import Any

import pytest

from tests.docs.pages_that_run import CHECKOUT, make_checkout, run

TUTORIALS = sorted((CHECKOUT / "docs" / "tutorials").glob("*.md"))
LONGEST_WORDS = 1000


@pytest.mark.system
@pytest.mark.timeout(400)
@pytest.mark.parametrize("tutorial", TUTORIALS, ids=lambda tutorial: tutorial.stem)
@pytest.mark.nightly
def test_the_commands_of_a_tutorial_print_what_it_shows(tutorial, tmp_path):
    ran = list(run(tutorial.read_text(encoding="utf-8"), make_checkout(tmp_path)))
    assert ran
    for one in ran:
        assert one.as_expected, f"$ {one.command}\n{one.output}"


@pytest.mark.parametrize("tutorial", TUTORIALS, ids=lambda tutorial: tutorial.stem)
def test_a_tutorial_is_short(tutorial):
    assert len(tutorial.read_text(encoding="utf-8").split()) <= LONGEST_WORDS


def test_labels_of_the_pages_are_spelled_as_the_pages_spell_them():
    listed = subprocess.run(
        ["git", "ls-files", "web/*en.json"], cwd=CHECKOUT, capture_output=True, text=True, check=True
    )
    texts = set(_values(json.loads((CHECKOUT / listed.stdout.split()[0]).read_text(encoding="utf-8"))))
    labels = re.findall(r"\*\*(.+?)\*\*", (CHECKOUT / "docs/tutorials/first-letter.md").read_text(encoding="utf-8"))
    assert len(labels) > 5
    assert set(labels) - texts == set()


def _values(node: Any) -> list[str]:
    return [node] if isinstance(node, str) else [text for one in node.values() for text in _values(one)]
