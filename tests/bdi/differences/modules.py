"""Directives, goal patterns and namespaces."""

import pytest

from bdi import AgentSpeakSyntaxError, parse_program
from tests.bdi.differences import happenings, shows


@shows("register-function")
def register_function() -> None:
    with pytest.raises(AgentSpeakSyntaxError, match="has the wrong arguments"):
        parse_program('{ register_function("pkg.Class") }')


@shows("bdg")
def bdg() -> None:
    program = "{begin bdg(ok)} +!ok : never <- a. {end} !g. +!g <- !ok. -!g[error(E)] <- why(E)."
    assert [each.split()[1] for each in happenings(program, cycles=60)] == ["why(no_applicable)"]


@shows("mg")
def mg() -> None:
    assert happenings("{begin mg(ok)} +!ok <- a; +ok. {end}", cycles=9) == ["1 a"]
    assert happenings("{begin mg(ok)} +!ok <- a. {end} ok.", cycles=9) == []


@shows("sga")
def sga() -> None:
    program = '{begin sga("+e(X)", "true", once(X))} {end} +!once(X) <- begins(X); ends(X).'
    seen = [each.split()[1] for each in happenings(program, [{"e(1)", "e(2)"}])]
    assert seen == ["begins(1)", "ends(1)", "begins(2)", "ends(2)"]


@shows("number-in-namespace")
def number_in_namespace() -> None:
    assert happenings("!g. +!g <- ns::A = 10; a. -!g[error(E)] <- why(E).") == ["2 why(constraint_failed)"]


@shows("catch-all")
def catch_all() -> None:
    program = "{begin namespace(n)} !g. +!g <- !nowhere. {end} -!G <- caught."
    assert [each.split()[1] for each in happenings(program)] == ["caught"]


@shows("namespaces-listed")
def namespaces_listed() -> None:
    assert happenings("n::b(1). !g. +!g <- .findall(N,.namespace(N),L); p(L).") == ["2 p([default,n])"]
