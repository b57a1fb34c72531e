"""Mistakes are found before the program runs."""

import pytest

from bdi import (
    Agent,
    IncludeNotFound,
    Message,
    UnknownAction,
    UnknownDirective,
    UnknownInternalAction,
    UnknownPerformative,
    parse_program,
)
from tests.bdi.differences import actions_of, shows, together


@shows("unknown-internal-action")
def unknown_internal_action() -> None:
    with pytest.raises(UnknownInternalAction, match=r"there is no internal action \.pint; did you mean \.print"):
        Agent(parse_program("!g. +!g <- p. +!never <- .pint(1)."))


@shows("argument-count")
def argument_count() -> None:
    with pytest.raises(UnknownInternalAction, match="takes 3 arguments, not 1"):
        Agent(parse_program("+!never <- .nth(1)."))


@shows("argument-kind")
def argument_kind() -> None:
    with pytest.raises(UnknownInternalAction, match=r"argument 2 of \.range is a whole number, not a"):
        Agent(parse_program("+!never <- .range(X,a,3)."))


@shows("unknown-action")
def unknown_action() -> None:
    program = parse_program("+!never <- dirve(post1).")
    Agent(program)  # the actions of the body are not declared
    with pytest.raises(UnknownAction, match="the body has no action dirve/1"):
        Agent(program, actions=["drive"])


@shows("missing-include")
def missing_include() -> None:
    with pytest.raises(IncludeNotFound, match=r"nowhere\.asl"):
        parse_program('{ include("nowhere.asl") }')


@shows("unknown-directive")
def unknown_directive() -> None:
    with pytest.raises(UnknownDirective, match="unknown directive"):
        parse_program("{ turn_round(1) }")


@shows("unknown-performative")
def unknown_performative() -> None:
    with pytest.raises(UnknownPerformative, match="'whisper'"):
        Agent(parse_program("b.")).cycle(None, [Message("bob", "whisper", "p")])
    seen = together(ann="!g. +!g <- .send(ben, whisper, p). -!g[error(E)] <- why(E).", ben="b.")
    assert actions_of(seen) == ["ann why(unknown_performative)"]
