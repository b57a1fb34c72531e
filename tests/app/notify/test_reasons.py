"""Why something waits is said in the reader's language, whoever said it first."""

import ast
import string
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.dispatch.choice import IdleRobot, why_nobody_comes
from app.dispatch.planning.why import SENTENCES, Why
from app.fleet.answers import RECALLED
from app.fleet.missions import NOT_REPORTED, UNLOADED
from app.fleet.receipts import PROBLEMS, counts_for_nothing
from app.orders.timer import NOBODY_CAME
from app.settings import ROOT
from app.texts import catalogue
from app.texts.reasons import PREFIXES, in_language, in_words, words_of
from protocol.parts import Leg
from robot.action.corridors import CLOSED_BY, turned_back
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


def test_what_the_planner_says_of_orders_is_known() -> None:
    not_said = {"fetched", "fetched_after", "later", "next", "turn"}
    said = [Why(code, ("r1",)).sentence(str) for code in SENTENCES.keys() - not_said]
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


@given(
    st.sampled_from([key for key in catalogue("en") if key.startswith(PREFIXES)]), st.text("abcxyz0189_", min_size=1)
)
def test_every_reason_of_the_catalogue_is_recognised_by_its_own_english(key: str, fact: str) -> None:
    if key == "why.in_english":
        return
    gaps = {name for _, name, _, _ in string.Formatter().parse(catalogue("en")[key]) if name}
    words = words_of(catalogue("en")[key].format_map(dict.fromkeys(gaps, fact)))
    assert words and (words.key, words.facts) == (key, dict.fromkeys(gaps, fact))


@given(st.text(max_size=500))
def test_whatever_a_robot_says_can_be_shown(said: str) -> None:
    assert said.strip(". ") in in_language("fr", said) or words_of(said)


def test_alarms_are_said_in_french_with_what_they_are_about() -> None:
    told = turned_back(Leg(from_post="post3", to_post="post4"), "blocked")
    assert in_language("fr", told) == (
        "Le robot a fait demi-tour dans le couloir de post3 à post4. Quelque chose s’y trouve."
    )
    assert in_language("fr", "The agent met every way blocked or denied.").startswith("Tous les chemins du robot")
    assert in_language("fr", "The agent met line_lost.") == "Le programme du robot a rencontré\u00a0: line_lost."
    late = "Order 1f2e3d is cancelled. But its mail changed hands (load) at post1."
    assert in_language("fr", late).startswith("La commande 1f2e3d est à l’état «\u00a0cancelled\u00a0»")
    words = words_of("4 messages of this robot are lost")
    assert words and (words.key, words.facts) == ("alarm.of.messages_lost", {"count": "4"})


def test_every_way_of_turning_back_is_known() -> None:
    for why in CLOSED_BY:
        words = words_of(turned_back(Leg(from_post="post3", to_post="post4"), why))
        assert words and words.key == f"alarm.of.turned_back.{why}"


@pytest.mark.parametrize("problem", PROBLEMS)
def test_every_reason_for_which_a_receipt_counts_for_nothing_is_known(problem: str) -> None:
    words = words_of(counts_for_nothing("load", "1f2e3d", problem))
    assert words and words.key == f"alarm.of.receipt.{problem}"


ALARMS = {
    "app/fleet/clocks.py": 1,
    "app/fleet/conversation.py": 1,
    "app/fleet/greeting.py": 5,
    "app/fleet/receipts.py": 1,
    "app/handover/service.py": 1,
}
"""Where the service raises alarms of its own, and how many sentences there are told."""


@pytest.mark.parametrize("file", ALARMS)
def test_the_services_own_alarms_are_known(file: str) -> None:
    """The sentence that stands beside `raise_alarm`, or in a name `sentence` just before."""
    tree = ast.parse((ROOT / file).read_text())
    said = [one for one in map(told_in, ast.walk(tree)) if one]
    assert len(said) == ALARMS[file]
    assert [one for one in said if words_of(one) is None] == []


def told_in(node: ast.AST) -> str | None:
    told: ast.AST | None = None
    if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name) and node.targets[0].id == "sentence":
        told = node.value
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "raise_alarm":
        told = node.args[3]
    if isinstance(told, ast.JoinedStr):
        return "".join(part.value if isinstance(part, ast.Constant) else "x1" for part in told.values)
    return told.value if isinstance(told, ast.Constant) else None
