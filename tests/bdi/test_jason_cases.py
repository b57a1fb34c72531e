"""Results recorded with Jason 3.3.2 are ours too: 40 programs, 900 terms, and the paper's agent.

The records lie beside the checkout (shared/cases); without them these tests are skipped and say so.
"""

import gzip
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from bdi import Agent, Finished, Literal, Message, Term, Var, load_program, parse_program, parse_term, show
from bdi.language.arithmetic import ArithmeticFailure
from bdi.language.terms import Structure, literal_of
from bdi.language.unify import Trail, compare, deref, resolve, unify, variables_in
from bdi.model.beliefs import SELF
from bdi.model.intentions import State

CASES = Path(__file__).parents[3] / "shared" / "cases"
needs_cases = pytest.mark.skipif(not CASES.exists(), reason=f"the recorded cases are not at {CASES}")

# Programs that do not come out yet, with the reason. One that begins to pass must leave this table.
MISSING: dict[str, str] = {}


def recorded_programs() -> list[Any]:
    path = CASES / "agentspeak" / "expected.json"
    return (
        [pytest.param(case, id=case["file"]) for case in json.loads(path.read_text())["cases"]]
        if CASES.exists()
        else []
    )


def recorded_terms() -> dict[str, list[list[str]]]:
    kinds: dict[str, list[list[str]]] = {"parse": [], "unify": [], "eval": [], "cmp": [], "query": []}
    path = CASES / "agentspeak" / "terms.tsv"
    for line in path.read_text().splitlines() if CASES.exists() else []:
        kind, *fields = line.split("\t")
        kinds[kind].append([field for field in fields if field != "=>"])
    return kinds


# ---- programs ------------------------------------------------------------------------------------------------------


def actions_of(agent: Agent, cycles: int) -> list[str]:
    """ "3 p(1)" for every action; all succeed at once but `fail_action`; the run ends at `done`."""
    seen: list[str] = []
    finished: list[Finished] = []
    for cycle in range(1, cycles + 1):
        outcome = agent.cycle(None, [], finished, cycle * 0.1)
        seen += [f"{cycle} {action}" for action in outcome.actions]
        if any(action.term.functor == "done" for action in outcome.actions):
            break
        finished = [
            Finished(action.id, "my_reason", "my message")
            if action.term.functor == "fail_action"
            else Finished(action.id)
            for action in outcome.actions
        ]
    return seen


@needs_cases
@pytest.mark.parametrize("case", recorded_programs())
def test_a_program_does_the_same_actions_in_the_same_cycles(case: dict[str, Any]) -> None:
    agent = Agent(load_program(CASES / "agentspeak" / case["file"]), name="ag")
    same = actions_of(agent, 300) == case["actions"]
    if case["file"] in MISSING:
        assert not same, f"{case['file']} comes out now: take it out of the table"
    else:
        agent = Agent(load_program(CASES / "agentspeak" / case["file"]), name="ag")
        assert actions_of(agent, 300) == case["actions"]


# ---- the paper's agent ---------------------------------------------------------------------------------------------


def own_beliefs(agent: Agent) -> list[str]:
    own = [literal for literal in agent.beliefs if SELF in literal.annots]
    return sorted(str(literal_of(literal.predicate, literal.args)) for literal in own)


def intentions_as_recorded(agent: Agent) -> int:
    """The record counts the selected intention besides: it stays selected until the next turn, unless it waits."""
    selected = agent.selected
    return len(agent.intentions) + (selected is not None and selected.state in (State.RUNNING, State.DONE))


@needs_cases
@pytest.mark.parametrize("as_terms", [False, True], ids=["percepts as text", "percepts as terms"])
def test_the_papers_agent_acts_believes_and_intends_as_recorded_in_all_3000_cycles(as_terms: bool) -> None:
    with gzip.open(CASES / "paper" / "trace.jsonl.gz", "rt") as lines:
        trace = [json.loads(line) for line in lines]
    agent = Agent(load_program(CASES / "paper" / "mail.asl"), name="mail")
    matched, first_difference = 0, ""
    finished: list[Finished] = []
    for row in trace:
        messages = [Message("user", "achieve", row["achieve"])] if row["achieve"] else []
        percepts = [parse_term(text) for text in row["percepts"]] if as_terms else row["percepts"]
        outcome = agent.cycle(percepts, messages, finished, row["cycle"] * 0.1)
        finished = [Finished(action.id) for action in outcome.actions]
        got = (
            [str(action) for action in outcome.actions],
            own_beliefs(agent),
            intentions_as_recorded(agent),
            len(agent.events),
        )
        wanted = (
            [row["action"]] if row["action"] else [],
            sorted(text for text in row["beliefs"] if not text.startswith("kqml::")),
            row["intentions"],
            row["events"],
        )
        matched += got == wanted
        if got != wanted and not first_difference:
            first_difference = f"first in cycle {row['cycle']}: wanted {wanted}, got {got}"
    assert matched == len(trace) == 3000, f"{matched} of {len(trace)} cycles; {first_difference}"


# ---- terms ---------------------------------------------------------------------------------------------------------


def as_recorded(bindings: dict[str, Term]) -> str:
    return "{" + ", ".join(f"{name}={show(value)}" for name, value in sorted(bindings.items())) + "}"


def parsed(text: str) -> str:
    return show(parse_term(text))


def unified(left: str, right: str) -> str:
    pair = parse_term(f"pair({left},{right})")
    assert isinstance(pair, Structure)
    trail: Trail = []
    variables = variables_in(pair)
    if not unify(*pair.args, trail):
        return "false"
    return "true " + as_recorded({each.name: resolve(each) for each in variables if not isinstance(deref(each), Var)})


def evaluated(text: str) -> str:
    try:
        return show(resolve(parse_term(text)))
    except ArithmeticFailure:
        return "ERROR ArithmeticException"


def compared(left: str, right: str) -> str:
    return str(compare(parse_term(left), parse_term(right)))


def queried(program: str, formula: str) -> str:
    agent = Agent(parse_program(program))
    return "[" + ", ".join(as_recorded(answer) for answer in agent.ask(formula)) + "]"


KINDS: dict[str, Callable[..., str]] = {
    "parse": parsed,
    "unify": unified,
    "eval": evaluated,
    "cmp": compared,
    "query": queried,
}


@needs_cases
@pytest.mark.parametrize("kind", KINDS)
def test_terms_come_out_as_recorded(kind: str) -> None:
    cases = recorded_terms()[kind]
    assert cases
    wrong = [(given, wanted, KINDS[kind](*given)) for *given, wanted in cases if KINDS[kind](*given) != wanted]
    assert not wrong, f"{len(wrong)} of {len(cases)} differ, as {wrong[:5]}"


def test_a_literal_is_the_same_however_it_is_built() -> None:
    literal: Literal = Structure(parse_term("p(1)").predicate, (1,))  # type: ignore[union-attr]
    assert literal == parse_term("p(1.0)")
