"""Why something waits is said in the reader's language, whichever part said it first."""

import ast
import json
import string
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.core.settings import ROOT
from app.core.texts import LANGUAGES, catalogue
from app.core.texts.reasons import EARLIER, PREFIXES, in_language, in_words, words_of
from app.dispatch.held_up import NONE_CONNECTED
from app.dispatch.why_orders_wait import BUSY, FETCHER_BUSY
from app.orders.timer import NOT_FETCHED_IN_TIME
from app.robots.progress.answers import RECALLED
from app.robots.progress.evidence import UNPROVED
from app.robots.progress.missions import NOT_REPORTED, UNLOADED
from app.robots.progress.receipts import PROBLEMS, claimed, counts_for_nothing
from fleet.assignment.why import SENTENCES, Why
from protocol.one_line import one_line
from protocol.parts import Leg
from robot.agent.actions.corridors import CLOSED_BY, turned_back
from robot.reflexes import FAULTS
from tests.app.notifications.every_reason import RAW, every_reason, told_beside_alarms

REASONS_OF_ROBOTS = ROOT / "robot" / "agent" / "reasons.py"


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
    # A part of one; what stands below a table or a name.
    no_sentences = ("In its dock", "Of an action", "The faults that")
    said = [one for one in sentences_in(REASONS_OF_ROBOTS) if not one.startswith(no_sentences)]
    assert len(said) > 12
    assert [one for one in said if words_of(one) is None] == []


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.name)
def test_every_fault_is_known_by_its_name(fault: object) -> None:
    words = words_of(fault.told)  # type: ignore[attr-defined]
    assert words and words.key == f"why.fault.{fault.name}"  # type: ignore[attr-defined]


def test_what_the_service_says_of_orders_is_known() -> None:
    said = [NONE_CONNECTED, BUSY, FETCHER_BUSY, Why("charging", ()).sentence(str)]
    said += [NOT_FETCHED_IN_TIME, RECALLED, UNLOADED, NOT_REPORTED, "The recipient cannot take it now."]
    assert len(set(said)) == 9
    assert [one for one in said if words_of(one) is None] == []


def test_what_the_planner_says_of_orders_is_known() -> None:
    not_said = {"fetched", "fetched_after", "later", "next", "sooner", "turn"}
    said = [Why(code, ("r1",)).sentence(str) for code in SENTENCES.keys() - not_said]
    assert [one for one in said if words_of(one) is None] == []


def test_it_is_said_in_french_with_what_stood_in_its_gaps() -> None:
    assert in_language("fr", "Charging at post3") == "Se recharge à post3"
    assert in_language("fr", "Every robot is busy.") == "Tous les robots sont occupés."
    assert in_language("en", "Charging at post3") == "Charging at post3"


def test_a_sentence_within_a_sentence_is_said_in_french_too() -> None:
    told = "The robot cannot get to the sender: Something blocks a wheel."
    assert in_language("fr", told).endswith(" : Quelque chose bloque une roue.")
    assert in_language("fr", "The robot cannot get to the sender: no_route.").endswith(
        "sa carte n’a pas de chemin jusque-là."
    )


def test_an_unknown_reason_is_shown_as_it_was_said_and_marked() -> None:
    assert words_of("Juggling at post3") is None
    assert in_language("fr", "Juggling at post3") == "« Juggling at post3 » (en anglais)"
    assert in_language("en", "Juggling at post3") == "Juggling at post3"
    assert in_words("fr", {"robot": "r1", "reason": "Paused"}) == {"robot": "r1", "reason": "En pause"}
    assert in_words("fr", {"robot": "r1"}) == {"robot": "r1"}


@pytest.mark.parametrize(("key", "sentence"), json.loads(EARLIER.read_text(encoding="utf-8")).items())
def test_what_a_robot_with_earlier_software_says_is_translated(key: str, sentence: str) -> None:
    assert sentence != catalogue("en")[key]
    gaps = {name: f"{name}1" for _, name, _, _ in string.Formatter().parse(sentence) if name}
    said = sentence.format_map(gaps)
    assert in_language("en", said) == catalogue("en")[key].format_map(gaps)
    assert in_language("fr", said) == catalogue("fr")[key].format_map(gaps)


@pytest.mark.parametrize("language", LANGUAGES)
def test_no_reason_that_the_code_can_give_is_read_raw(language: str) -> None:
    reasons = every_reason()
    assert {"no_one_came", "no_route", "way_closed", "wrong_arguments", "stall"} <= set(reasons)
    assert len(reasons) > 120
    said = {reason: in_language(language, reason) for reason in reasons}
    assert {reason: text for reason, text in said.items() if RAW.search(text)} == {}
    anybodys = {reason for reason in reasons if reason.endswith(": x1.")}
    assert [one for one, text in said.items() if "(en anglais)" in text and one not in anybodys] == []
    assert language == "en" or [reason for reason, text in said.items() if text == reason] == []


def test_a_code_alone_is_a_sentence_of_its_own_and_one_of_a_foreign_program_is_named_as_one() -> None:
    assert in_language("en", "no_one_came") == "Nobody came in time"
    assert in_language("fr", "no_one_came") == "Personne n’est venu à temps"
    assert in_language("en", "too_hot") == "Its program calls it “too_hot”"
    assert in_language("fr", "juggle(3)").startswith("Son programme l’appelle")
    assert words_of("hot") is None, "a single word may be anybody's"


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
    assert one_line(said).strip(". ") in in_language("fr", said) or words_of(said)


def test_alarms_are_said_in_french_with_what_they_are_about() -> None:
    told = turned_back(Leg(from_post="post3", to_post="post4"), "blocked")
    assert in_language("fr", told) == (
        "Le robot a fait demi-tour dans le couloir de post3 à post4. Quelque chose s’y trouve."
    )
    no_way = "The robot met a problem: every way is blocked or denied."
    assert in_language("fr", no_way).startswith("Tous les chemins du robot")
    lost = "Le robot a rencontré un problème\u00a0: il a perdu la ligne."
    assert in_language("fr", "The robot met a problem: line_lost.") == lost
    late = "Order 1f2e3d is cancelled. But its mail changed hands (load) at post1."
    assert in_language("fr", late).startswith(
        "La commande 1f2e3d est annulée, mais son envoi a changé de mains (chargement)"
    )
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


@pytest.mark.parametrize("problem", UNPROVED)
def test_every_reason_for_which_a_hand_over_is_only_claimed_is_known(problem: str) -> None:
    words = words_of(claimed("receive", "1f2e3d", "post4", problem))
    assert words and words.key == f"alarm.of.claimed.{problem}"


ALARMS = {
    "app/robots/link/clocks.py": 1,
    "app/robots/conversation/conversation.py": 1,
    "app/robots/conversation/handshake.py": 4,
    "app/robots/progress/handed_over.py": 1,
    "app/robots/homes.py": 1,
    "app/robots/conversation/intake.py": 2,
    "app/robots/progress/receipts.py": 1,
    "app/handover/service.py": 1,
}
"""Where the service raises alarms of its own, and how many sentences there are told."""


@pytest.mark.parametrize("file", ALARMS)
def test_the_services_own_alarms_are_known(file: str) -> None:
    said = list(told_beside_alarms(ROOT / file))
    assert len(said) == ALARMS[file]
    assert [one for one in said if words_of(one) is None] == []
