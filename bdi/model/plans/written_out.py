"""`.if_then_else`, `.loop`, `.foreach` and `.fork` as the statements that they stand for."""

from collections.abc import Callable

from bdi.language.errors import Place
from bdi.language.syntax import Body, Does, For, Fork, If, Simple, Step, While
from bdi.language.terms import Atom, Code, List, Structure, Term, atom

Args = tuple[Term, ...]


def as_statement(written: Simple) -> Step | None:
    """`.loop(c,{a})` is `while (c) {a}`. None for any other step."""
    if written.does is not Does.INTERNAL or not isinstance(written.term, Structure):
        return None
    make = _STATEMENTS.get(written.term.functor)
    return make(written.term.args, written.place) if make else None


def _body(term: Term, place: Place) -> Body:
    if isinstance(term, Code) and isinstance(term.body, Body):
        return term.body
    return Body((Simple(Does.VARIABLE, term, place),))


def _if(args: Args, place: Place) -> Step:
    condition, *branches = args
    then, *otherwise = [_body(branch, place) for branch in branches]
    return If(condition, then, otherwise[0] if otherwise else Body(), place)


def _fork(args: Args, place: Place) -> Step:
    """.fork(and, {a}, {b})   .fork(or, [{a},{b}])"""
    how, *branches = args
    if len(branches) == 1 and isinstance(branches[0], List):
        branches = list(branches[0])
    return Fork(isinstance(how, Atom) and how is atom("and"), tuple(_body(each, place) for each in branches), place)


_STATEMENTS: dict[str, Callable[[Args, Place], Step]] = {
    ".if_then_else": _if,
    ".loop": lambda args, place: While(args[0], _body(args[1], place), place),
    ".foreach": lambda args, place: For(args[0], _body(args[1], place), place),
    ".fork": _fork,
}
