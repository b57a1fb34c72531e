"""Trace entries for a listener."""

import json

import pytest

from bdi import Agent, Deliberated, Finished, Message, Stepped, parse_program
from bdi.debug.trace import Changed, Verdict

COURIER = """
speed(3). limit(5). post(library). post(uc).
far(P) :- post(P) & not near(P).
near(uc).
"""


def choice(plans: str, beliefs: str = COURIER, percepts: tuple[str, ...] = ()) -> Deliberated:
    """Return the choice for the first goal of this program, with its reasons."""
    agent = Agent(parse_program(beliefs + "!go(library,2). " + plans))
    agent.listen(lambda entry: None, explain=True)
    for _ in range(10):
        for entry in agent.cycle(percepts).trace:
            if isinstance(entry, Deliberated) and str(entry.event).startswith("+!go"):
                return entry
    raise AssertionError("the goal was never deliberated on")


def verdict(plan: str, **options: str) -> Verdict:
    """Return the verdict on this plan, which comes before one that applies."""
    return choice(f"{plan} @last +!go(_,_) <- stay.", **options).verdicts[0]  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("plan", "kind", "why"),
    [
        ("@p +!go(uc,_).", "head", "argument 1 is library, not uc"),
        ("@p +!go(P,P).", "head", "argument 2 is 2, not library"),
        ("@p +!go(_,_)[urgent].", "head", "no [urgent] among the annotations [source(self)]"),
        ("@p +!go(_,_) : docked.", "context", "docked does not hold"),
        ("@p +!go(P,_) : near(P).", "context", "near(library) does not hold (believed: near(uc))"),
        ("@p +!go(P,_) : speed(S) & S > 4.", "context", "3>4 is false"),
        ("@p +!go(P,_) : post(X) & near(X) & X == P.", "context", "uc==library is false"),
        ("@p +!go(P,_) : post(X) & locked(X).", "context", "for any of 2 answers to what stands before it"),
        ("@p +!go(P,_) : not post(P).", "context", "post(library) holds"),
        ("@p +!go(P,_) : far(uc).", "context", "far(uc) does not hold"),
        ("@p +!go(P,N) : .member(P, N).", "error", "cannot be worked out"),
        ("@p +!go(P,N) : .member(P, [uc,herzberg]).", "context", ".member(library,[uc,herzberg]) does not hold"),
    ],
)
def test_it_is_said_why_a_plan_does_not_apply(plan: str, kind: str, why: str) -> None:
    said = verdict(plan)
    assert said.plan == "p"
    assert said.verdict == kind
    assert why in said.why


def test_a_variable_that_the_plan_bound_was_free_before() -> None:
    """An earlier plan is explained for the event as it was, not as the chosen plan left it."""
    program = "!ask. +!ask <- !where(X); tell(X). @a +!where(uc) : no. @b +!where(library)."
    agent = Agent(parse_program(program))
    agent.listen(lambda entry: None, explain=True)
    entries = [entry for _ in range(3) for entry in agent.cycle().trace]
    asked = next(e for e in entries if isinstance(e, Deliberated) and e.plan is not None and e.plan.label == "b")
    assert [(v.plan, v.verdict, v.why) for v in asked.verdicts] == [
        ("a", "context", "no does not hold"),
        ("b", "chosen", "the first that applies"),
    ]


def test_the_chosen_plan_comes_with_its_variables_and_later_ones_are_named() -> None:
    chosen = choice("@a +!go(P,N) : speed(S) & S > N. @b +!go(_,_).")
    assert chosen.plan is not None
    assert chosen.plan.label == "a"
    first, second = chosen.verdicts
    assert dict(first.bindings) == {"P": "library", "N": "2", "S": "3"}
    assert (second.plan, second.verdict) == ("b", "would apply")
    assert chosen.tried == ("a",)


def test_explaining_changes_nothing() -> None:
    program = """!go. n(0).
      +!go : n(30) <- done.
      +!go : .random(X) & X > 0.5 & .print("asked") <- up(X); -+n(30); !go.
      +!go : n(N) & math.random(9) > 1 <- .random(X); down(X); -+n(N+1); !go.
      +!go <- !go."""

    def run(explain: bool) -> list[tuple[list[str], tuple[str, ...]]]:
        agent = Agent(parse_program(program), random_seed=3)
        if explain:
            agent.listen(lambda entry: None, explain=True)
        finished: list[Finished] = []
        seen = []
        for _ in range(60):
            outcome = agent.cycle(None, [], finished)
            finished = [Finished(action.id) for action in outcome.actions]
            seen.append(([str(action) for action in outcome.actions], outcome.printed))
        return seen

    assert run(True) == run(False)
    assert any(actions for actions, _ in run(False))


def test_changes_of_beliefs_are_told_from_any_source() -> None:
    agent = Agent(parse_program("!g. old(1). +!g <- +mine; -old(1)."))
    heard: list[str] = []
    agent.listen(lambda entry: heard.append(str(entry)) if isinstance(entry, Changed) else None)
    agent.cycle(("seen",))
    agent.cycle((), [Message("bob", "tell", "told")])
    for _ in range(4):
        agent.cycle(())
    assert "1 +seen[source(percept)]" in heard
    assert "2 -seen[source(percept)]" in heard
    assert "2 +told[source(bob)]" in heard
    assert any(text.endswith(" +mine[source(self)]") for text in heard)
    assert any(text.endswith(" -old(1)[source(self)]") for text in heard)


def test_every_entry_can_be_written_as_json() -> None:
    agent = Agent(parse_program("!g(1). b. @p +!g(N) : b <- -b; ?nothing."))
    agent.listen(lambda entry: None, explain=True)
    entries = [entry.data() for _ in range(5) for entry in agent.cycle().trace]
    kinds = [entry["kind"] for entry in json.loads(json.dumps(entries))]
    assert set(kinds) == {"deliberated", "stepped", "changed", "failed"}
    deliberated = next(entry for entry in entries if entry["kind"] == "deliberated" and entry["event"] == "+!g(1)")
    assert deliberated["plan"] == "p"
    assert deliberated["options"][0]["bindings"] == {"N": "1"}


def test_a_step_says_where_it_stands() -> None:
    agent = Agent(parse_program("!g.\n+!g\n  <- a;\n     b.", source="mail.asl"))
    agent.listen(lambda entry: None)
    step = next(entry for entry in agent.cycle().trace if isinstance(entry, Stepped))
    assert (step.step.place.source, step.step.place.line) == ("mail.asl", 3)
    assert str(step) == "1 intention 1: a"


def test_without_a_listener_nothing_is_kept() -> None:
    agent = Agent(parse_program("!g. +!g <- +b; !g."))
    outcomes = [agent.cycle() for _ in range(50)]
    assert all(outcome.trace == () for outcome in outcomes)
    assert not agent.choices


def test_who_stops_listening_hears_no_more_and_the_others_go_on() -> None:
    agent = Agent(parse_program("+b : true <- true."))
    first: list[str] = []
    second: list[str] = []
    tell_first, tell_second = (lambda entry: first.append(str(entry))), (lambda entry: second.append(str(entry)))
    agent.listen(tell_first, explain=True)
    agent.listen(tell_second)
    agent.cycle(("b",))
    agent.stop_listening(tell_first)
    agent.cycle(())
    heard = len(first)
    assert len(second) > heard > 0
    agent.stop_listening(tell_second)
    assert agent.cycle(("b",)).trace == ()
    assert (len(first), list(agent.choices)) == (heard, [])
