"""Strings: `.substring`, `.upper_case`, `.term2string`, …"""

import re

from bdi.builtin.arguments import alternatives, bind, text_of
from bdi.builtin.kinds import ANY, OUT, STRING, optional
from bdi.builtin.table import Answer, internal_action, wrong_arguments
from bdi.builtin.terms.lists import pattern_of
from bdi.language.parser import parse_term
from bdi.language.terms import String, Term, Var, show
from bdi.language.unify import resolve, substituted, variables_in
from bdi.model.logic import HasLogic


@internal_action("substring", ANY, ANY, optional(OUT), optional(OUT))
def substring(mind: HasLogic, part: Term, whole: Term, start: Term | None = None, end: Term | None = None) -> Answer:
    """Find the position of a part; with a given start (and end) the part itself. Then the text comes first, as in
    Jason: .substring("warehouse", P, 4), or second."""
    if isinstance(whole, Var) and isinstance(start, int):
        part, whole = whole, part
    text = text_of(whole)
    if isinstance(part, Var) and isinstance(start, int):
        return bind(mind, part, String(_between(text, start, end if isinstance(end, int) else len(text))))
    wanted = text_of(part)
    if start is None:
        return wanted in text
    places = [at for at in range(len(text) + 1) if text.startswith(wanted, at)]
    if end is None:
        return alternatives(mind, (((start, at),) for at in places))
    return alternatives(mind, (((start, at), (end, at + len(wanted))) for at in places))


def _between(text: str, start: int, end: int) -> str:
    if not 0 <= start <= end <= len(text):
        raise wrong_arguments("substring", f"places from 0 to {len(text)}, the start first", f"{start} and {end}")
    return text[start:end]


@internal_action("upper_case", ANY, OUT)
def upper_case(mind: HasLogic, text: Term, result: Term) -> Answer:
    return bind(mind, result, String(text_of(text).upper()))


@internal_action("lower_case", ANY, OUT)
def lower_case(mind: HasLogic, text: Term, result: Term) -> Answer:
    return bind(mind, result, String(text_of(text).lower()))


@internal_action("replace", ANY, STRING, STRING, OUT)
def replace(mind: HasLogic, text: Term, old: Term, new: Term, result: Term) -> Answer:
    """`old` is a regular expression; `$1` in `new` is what its first bracket found."""
    pattern = pattern_of(old, "replace")
    try:
        replaced = pattern.sub(lambda found: _filled_in(text_of(new), found), text_of(text))
    except IndexError as problem:
        raise wrong_arguments("replace", "a $ only before the number of a bracket", new) from problem
    return bind(mind, result, String(replaced))


def _filled_in(template: str, found: "re.Match[str]") -> str:
    """ "$2-$1" with what the brackets found; `\\$` is a dollar."""
    return _REFERENCE.sub(lambda each: each[1] if each[1] else found[int(each[2])] or "", template)


_REFERENCE = re.compile(r"\\(.)|\$(\d)")


@internal_action("term2string", OUT, OUT, named=True)
def term2string(mind: HasLogic, names: dict[str, Term], term: Term, text: Term) -> Answer:
    """Variables in the text are those of the plan."""
    if isinstance(term, Var) and isinstance(text, String):
        parsed = parse_term(str.__str__(text))
        values = {variable: names[variable.name] for variable in variables_in(parsed) if variable.name in names}
        return bind(mind, term, resolve(substituted(parsed, values)))
    return bind(mind, text, String(show(term)))
