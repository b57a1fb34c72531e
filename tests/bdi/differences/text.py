"""The text of a program."""

import pytest

from bdi import Agent, AgentSpeakSyntaxError, parse_program
from tests.bdi.differences import happenings, shows


@shows("big-numbers")
def big_numbers() -> None:
    with pytest.raises(AgentSpeakSyntaxError, match="this number is too large"):
        parse_program("b(1e999).")


@shows("keywords")
def keywords() -> None:
    assert happenings("if(1). end(2). !g. +!g : if(X) & end(Y) <- begin(X,Y).") == ["1 begin(1,2)"]


@shows("nesting")
def nesting() -> None:
    with pytest.raises(AgentSpeakSyntaxError, match="nested too deeply"):
        parse_program(f"b({'f(' * 1000}1{')' * 1000}).")


@shows("old-notation")
def old_notation() -> None:
    old = "p. q. !g. @L1 +!g : p and q <- a b."
    with pytest.raises(AgentSpeakSyntaxError):
        parse_program(old)
    program = parse_program(old, compatible=True)
    assert [warning.today for warning in program.warnings] == ["@l1", "&", ";"]
    assert [str(action) for action in Agent(program).cycle().actions] == ["a"]


@shows("cyclic-terms")
def cyclic_terms() -> None:
    assert happenings("!g. +!g <- X = f(X); p(X). -!g[error(E)] <- why(E).") == ["3 why(recursion)"]


@shows("open-belief")
def open_belief() -> None:
    assert happenings("at(X). +at(_) <- seen.") == ["1 seen"]


@shows("negated-variable")
def negated_variable() -> None:
    with pytest.raises(AgentSpeakSyntaxError, match="'B' is a variable"):
        parse_program("!g. +!g <- B = p(1); +~B.")


@shows("open-rule")
def open_rule() -> None:
    with pytest.raises(AgentSpeakSyntaxError, match="belongs to a rule"):
        parse_program("!g. +!g <- X = { H :- F }; a.")


@shows("annotated-rule")
def annotated_rule() -> None:
    program = "!g. +!g <- R = { p(X) :- q(X) }; +R; +R[source(bob)]. -!g[error(E)] <- why(E)."
    assert [each.split()[1] for each in happenings(program)] == ["why(wrong_arguments)"]
