"""Strings: `.substring`, `.upper_case`, `.term2string`, …"""

from bdi.builtin.arguments import alternatives, bind, text_of
from bdi.builtin.table import Answer, internal_action
from bdi.logic import HasLogic
from bdi.parser import parse_term
from bdi.terms import String, Term, Var
from bdi.unify import substituted, variables_in


@internal_action("substring", 2, 4)
def substring(mind: HasLogic, part: Term, whole: Term, start: Term | None = None, end: Term | None = None) -> Answer:
    """Where the part stands; with a given start (and end) the part itself."""
    text = text_of(whole)
    if isinstance(part, Var) and isinstance(start, int):
        stop = end if isinstance(end, int) else len(text)
        return bind(mind, part, String(text[start:stop]))
    wanted = text_of(part)
    places = (at for at in range(len(text) + 1) if text.startswith(wanted, at))
    pairs: list[tuple[tuple[Term, Term], ...]] = []
    for at in places:
        found: list[tuple[Term, Term]] = [(start, at)] if start is not None else []
        pairs.append((*found, *([(end, at + len(wanted))] if end is not None else [])))
    return alternatives(mind, pairs)


@internal_action("upper_case", 2)
def upper_case(mind: HasLogic, text: Term, result: Term) -> Answer:
    return bind(mind, result, String(text_of(text).upper()))


@internal_action("lower_case", 2)
def lower_case(mind: HasLogic, text: Term, result: Term) -> Answer:
    return bind(mind, result, String(text_of(text).lower()))


@internal_action("replace", 4)
def replace(mind: HasLogic, text: Term, old: Term, new: Term, result: Term) -> Answer:
    return bind(mind, result, String(text_of(text).replace(text_of(old), text_of(new))))


@internal_action("term2string", 2, named=True)
def term2string(mind: HasLogic, names: dict[str, Term], term: Term, text: Term) -> Answer:
    """Variables in the text are those of the plan."""
    if isinstance(term, Var) and isinstance(text, String):
        parsed = parse_term(str.__str__(text))
        values = {variable: names[variable.name] for variable in variables_in(parsed) if variable.name in names}
        return bind(mind, term, substituted(parsed, values))
    return bind(mind, text, String(text_of(term)))
