"""The tutorials: their commands print what they show, and each is short."""

import pytest

from tests.docs.pages_that_run import CHECKOUT, make_checkout, run

TUTORIALS = sorted((CHECKOUT / "docs" / "tutorials").glob("*.md"))
LONGEST_WORDS = 1000


@pytest.mark.system
@pytest.mark.timeout(400)
@pytest.mark.parametrize("tutorial", TUTORIALS, ids=lambda tutorial: tutorial.stem)
def test_the_commands_of_a_tutorial_print_what_it_shows(tutorial, tmp_path):
    ran = list(run(tutorial.read_text(encoding="utf-8"), make_checkout(tmp_path)))
    assert ran
    for one in ran:
        assert one.as_expected, f"$ {one.command}\n{one.output}"


@pytest.mark.parametrize("tutorial", TUTORIALS, ids=lambda tutorial: tutorial.stem)
def test_a_tutorial_is_short(tutorial):
    assert len(tutorial.read_text(encoding="utf-8").split()) <= LONGEST_WORDS
