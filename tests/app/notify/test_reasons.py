"""Why something waits is said in the reader's language, whoever said it first."""

import ast
import string
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.dispatch.choice import IdleRobot, why_nobody_comes
from app.fleet.answers import RECALLED
from app.fleet.missions import NOT_REPORTED, UNLOADED
from app.orders.timer import NOBODY_CAME
from app.settings import ROOT
from app.texts import catalogue
from app.texts.reasons import in_language, in_words, words_of
from robot.reflexes import FAULTS

REASONS_OF_ROBOTS = ROOT / "robot" / "reasons.py"


def sentences_in(file: Path) -> Iterator[str]:
    """Every sentence that a module puts together, with its gaps filled: what begins with a capital and has a space."""
    tree = ast.parse(file.read_text())
    comments = {
        ast.get_docstring(node, clean=False)
        for node in ast.walk(tree)
        if isinstance(node, ast.Module | ast.FunctionDef)
    }
    inner = {part for node in ast.walk(tree) if isinstance(node, ast.JoinedStr) for part in node.values}
    for node in ast.walk(tree):
        if isinstance(node, ast.JoinedStr):
            said = "".join(part.value if isinstance(part, ast.Constant) else "post4" for part in node.values)
        elif isinstance(node, ast.Constant) and isinstance(node.value, str) and node not in inner:
            said = node.value
        else:
            continue
        if said[:1].isupper() and " " in said and said not in comments:
            yield said


def test_every_sentence_of_a_robot_is_known() -> None:
    # A part of one; what is an action of an agent's own; what stands below a table.
    no_sentences = ("In its dock", "Doing ", "The faults that")
    said = [one for one in sentences_in(REASONS_OF_ROBOTS) if not one.startswith(no_sentences)]
    assert len(said) > 12
    assert [one for one in said if words_of(one) is None] == []


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.name)
def test_every_fault_is_known_by_its_name(fault: object) -> None:
    words = words_of(fault.told)  # type: ignore[attr-defined]
    assert words and words.key == f"why.fault.{fault.name}"  # type: ignore[attr-defined]


def test_what_the_service_says_of_orders_is_known() -> None:
    idle, low = IdleRobot("r1", "post1", 0.9), IdleRobot("r2", "post1", 0.1)
    said = [why_nobody_comes(robots, connected) for robots, connected in (((), 0), ((), 1), ((low,), 1), ((idle,), 1))]
    said += [NOBODY_CAME, RECALLED, UNLOADED, NOT_REPORTED, "The recipient cannot take it now."]
    assert len(set(said)) == 9
    assert [one for one in said if words_of(one) is None] == []


def test_it_is_said_in_french_with_what_stood_in_its_gaps() -> None:
    assert in_language("fr", "Charging at post3") == "Se recharge à post3"
    assert in_language("fr", "Every robot is busy.") == "Tous les robots sont occupés."
    assert in_language("en", "Charging at post3") == "Charging at post3"


def test_a_sentence_within_a_sentence_is_said_in_french_too() -> None:
    told = "The robot cannot get to the sender: Something blocks a wheel."
    assert in_language("fr", told).endswith(" : Quelque chose bloque une roue.")
    assert in_language("fr", "The robot cannot get to the sender: no_way.").endswith(" : no_way.")


def test_what_nobody_knows_is_shown_as_it_was_said_and_marked() -> None:
    assert words_of("Doing juggle(3)") is None
    assert in_language("fr", "Doing juggle(3)") == "« Doing juggle(3) » (en anglais)"
    assert in_language("en", "Doing juggle(3)") == "Doing juggle(3)"
    assert in_words("fr", {"robot": "r1", "reason": "Paused"}) == {"robot": "r1", "reason": "En pause"}
    assert in_words("fr", {"robot": "r1"}) == {"robot": "r1"}


@given(st.sampled_from([key for key in catalogue("en") if key.startswith("why.")]), st.text("abcxyz0189_", min_size=1))
def test_every_reason_of_the_catalogue_is_recognised_by_its_own_english(key: str, fact: str) -> None:
    if key == "why.in_english":
        return
    gaps = {name for _, name, _, _ in string.Formatter().parse(catalogue("en")[key]) if name}
    words = words_of(catalogue("en")[key].format_map(dict.fromkeys(gaps, fact)))
    assert words and (words.key, words.facts) == (key, dict.fromkeys(gaps, fact))


@given(st.text(max_size=500))
def test_whatever_a_robot_says_can_be_shown(said: str) -> None:
    assert said.strip(". ") in in_language("fr", said) or words_of(said)
