"""Limits, and what Java brings with it."""

from bdi import Agent, Message, parse_program
from tests.bdi.differences import happenings, shows


@shows("deep-rules")
def deep_rules() -> None:
    program = "n(N) :- n(N+1). !g. +!g <- ?n(0). -!g[error(E)] <- why(E)."
    assert happenings(program, cycles=3) == ["2 why(recursion)"]


@shows("arithmetic")
def arithmetic() -> None:
    assert happenings("!g. +!g <- X = 1 div 0; p(X). -!g[error(E)] <- why(E).") == ["2 why(arithmetic)"]


@shows("kqml-belief")
def kqml_belief() -> None:
    agent = Agent(parse_program("b(1). +!g <- .list_beliefs."))
    agent.cycle({"c(2)"}, [Message("bob", "tell", "d(3)")])
    said = agent.cycle(None, [Message("bob", "achieve", "g")]).printed
    assert sorted(said) == ["b(1)[source(self)]", "c(2)[source(percept)]", "d(3)[source(bob)]"]


@shows("perceive")
def perceive() -> None:
    assert happenings("!g. +!g <- .perceive; a. +p <- b.") == ["2 a"]


@shows("include")
def include() -> None:
    assert happenings('!g. +!g <- .include("x.asl"). -!g[error(E)] <- why(E).') == ["2 why(ia_failed)"]


@shows("alone")
def alone() -> None:
    assert happenings('!g. +!g <- .create_agent(bob, "bob.asl"). -!g[error(E)] <- why(E).') == ["2 why(alone)"]
