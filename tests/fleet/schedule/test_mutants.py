"""The breaks of `make mutants-fleet` can be made, and the tests that are to see them are there."""

from pathlib import Path

import pytest

from benchmarks.fleet.mutants import CHECKOUT, Mutant, all_mutants, broken


@pytest.mark.parametrize("mutant", all_mutants(), ids=lambda mutant: mutant.name.replace(" ", "-"))
def test_each_break_has_one_place_and_python_can_still_read_the_file(mutant: Mutant) -> None:
    text = (CHECKOUT / mutant.file).read_text(encoding="utf-8")
    after = broken(mutant, text)
    assert after != text
    compile(after, mutant.file, "exec")
    assert [test for test in mutant.tests if not (CHECKOUT / test).is_file()] == []


def test_no_two_breaks_are_the_same_and_there_are_enough() -> None:
    mutants = all_mutants()
    assert len({(one.file, one.before, one.after) for one in mutants}) == len({one.name for one in mutants}) > 20
    with pytest.raises(ValueError, match="0 places"):
        broken(mutants[0], "")
    assert Path(mutants[0].file).parts[0] == "fleet"
