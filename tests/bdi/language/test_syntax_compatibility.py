"""Older programs: the `and` of papers, and what Jason 2 let people leave out. Read on demand, with a warning."""

import gzip
import json
import re
from pathlib import Path

import pytest

from bdi import Agent, AgentSpeakSyntaxError, Finished, Program, load_program, parse_program

PAPER = Path(__file__).parents[4] / "shared" / "cases" / "paper"

OLD = """!deliver(post4).
@L1 +!deliver(P) : not busy and (free(P) or open) <- +busy go(P)
  !hand_over
  -busy
  done
.
+!hand_over <- if (a) { b } else { c } beep.
open.
"""
TODAY = """!deliver(post4).
@l1 +!deliver(P) : not busy & (free(P) | open) <- +busy; go(P);
  !hand_over;
  -busy;
  done
.
+!hand_over <- if (a) { b } else { c } beep.
open.
"""


def actions_of(program: Program) -> list[str]:
    agent = Agent(program)
    seen: list[str] = []
    finished: list[Finished] = []
    for cycle in range(20):
        outcome = agent.cycle(None, [], finished)
        seen += [f"{cycle} {action}" for action in outcome.actions]
        finished = [Finished(action.id) for action in outcome.actions]
    return seen


def test_an_old_program_means_what_is_written_differently_today() -> None:
    old, today = parse_program(OLD, compatible=True), parse_program(TODAY)
    assert [str(plan) for plan in old.plans] == [str(plan) for plan in today.plans]
    assert actions_of(old) == actions_of(today)
    assert [action.split()[1] for action in actions_of(old)] == ["go(post4)", "c", "beep", "done"]


def test_each_warning_has_its_place_and_says_what_to_write_today() -> None:
    told: list[str] = []
    program = parse_program(OLD, "old.asl", compatible=True, warn=lambda warning: told.append(str(warning)))
    assert [(str(each.place), each.today) for each in program.warnings] == [
        ("old.asl:2:2", "@l1"),
        ("old.asl:2:29", "&"),
        ("old.asl:2:42", "|"),
        ("old.asl:2:59", ";"),
        ("old.asl:2:65", ";"),
        ("old.asl:3:13", ";"),
        ("old.asl:4:8", ";"),
    ]
    assert [str(warning) for warning in program.warnings] == told
    assert told[1].splitlines() == [
        "old.asl:2:29: 'and' is written '&'",
        "    @L1 +!deliver(P) : not busy and (free(P) or open) <- +busy go(P)",
        "                                ^",
    ]


def test_a_program_of_today_has_no_warnings() -> None:
    assert parse_program(TODAY, compatible=True).warnings == ()


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("+!g : a and b.", "'and' is written '&'"),
        ("+!g <- a b.", "';' is missing between two steps"),
        ("+!g <- a\n -+b.", "';' is missing between a and -+b"),
        ("@L1 +!g.", "a name begins with a small letter, 'l1'"),
    ],
)
def test_without_the_mode_it_is_an_error_that_says_what_to_write(text: str, sentence: str) -> None:
    with pytest.raises(AgentSpeakSyntaxError, match=re.escape(sentence)):
        parse_program(text)
    assert len(parse_program(text, compatible=True).warnings) == 1


def test_an_action_before_a_sign_is_a_step_of_its_own() -> None:
    program = parse_program("!g. +!g <- a(1) +b -+c(2) -b; (d +e |&| f).", compatible=True)
    assert str(program.plans[0].body) == "a(1); +b; -+c(2); -b; (d; +e) |&| (f)"


def test_and_is_still_a_name_where_nothing_is_joined() -> None:
    program = parse_program("+!g(or) : p(and) <- and(1); or.", compatible=True)
    assert program.warnings == ()
    assert str(program.plans[0]) == "@p__1 +!g(or) : p(and) <- and(1); or."


def test_an_included_file_is_read_in_the_mode_of_the_program(tmp_path: Path) -> None:
    (tmp_path / "robot.asl").write_text('{ include("old.asl") }\n')
    (tmp_path / "old.asl").write_text("+!g : a and b <- c.\n")
    program = load_program(tmp_path / "robot.asl", compatible=True)
    assert [str(each.place) for each in program.warnings] == [f"{tmp_path / 'old.asl'}:1:9"]


@pytest.mark.skipif(not PAPER.exists(), reason=f"the paper's agent is not at {PAPER}")
def test_the_listings_of_the_paper_run_as_printed() -> None:
    text = (PAPER / "mail.asl").read_text()
    clauses = "".join(line for line in text.splitlines(keepends=True) if not line.startswith("//"))
    printed = parse_program(clauses.replace("&", "and"), compatible=True)
    assert len(printed.warnings) == clauses.count("&") > 10
    assert {each.today for each in printed.warnings} == {"&"}
    with gzip.open(PAPER / "trace.jsonl.gz", "rt") as file:
        percepts = [json.loads(line) for line in file]
    assert _run(printed, percepts) == _run(parse_program(text), percepts)


def _run(program: Program, stimuli: list[dict[str, object]]) -> list[tuple[object, ...]]:
    agent = Agent(program)
    seen: list[tuple[object, ...]] = []
    finished: list[Finished] = []
    for stimulus in stimuli:
        outcome = agent.cycle(stimulus["percepts"], [], finished)  # type: ignore[arg-type]
        seen.append((*map(str, outcome.actions), len(agent.events), len(agent.intentions)))
        finished = [Finished(action.id) for action in outcome.actions]
    return seen
