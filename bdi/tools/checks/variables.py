"""Variables that stand once in a plan or rule: most are typing mistakes or should be `_`."""

from collections import Counter
from collections.abc import Iterable, Iterator

from bdi.language.errors import Place
from bdi.language.syntax import Body, Does, Plan, Rule, Simple, terms_of
from bdi.language.terms import Code, Term, Var
from bdi.language.unify import parts_of
from bdi.tools.checks.findings import Finding, Severity, place_of
from bdi.tools.checks.names import alike
from bdi.tools.checks.reading import Reading, steps_of

_GIVES = frozenset({Does.ACTION, Does.ADD, Does.ADD_APART, Does.ADD_FIRST, Does.ADD_LAST, Does.UPDATE})


def lone_variables(reading: Reading) -> Iterator[Finding]:
    for plan in reading.program.plans:
        yield from _in_plan(plan, frozenset())
    for rule in reading.rules:
        yield from _lone(terms_of(rule), rule.place, set())


def _in_plan(plan: Plan, outer: frozenset[str]) -> Iterator[Finding]:
    """`outer`: the variables of the plans around a sub-plan, which may be meant there."""
    yield from _lone(_terms(plan), plan.place, _given(plan), outer)
    names = frozenset(name for term in terms_of(plan) for name in _occurrences(term))
    for inner in plan.subplans:
        yield from _in_plan(inner, outer | names)


def _terms(plan: Plan) -> Iterator[Term]:
    yield from terms_of(plan)
    for inner in plan.subplans:
        yield from _terms(inner)


def _occurrences(term: Term) -> Iterator[str]:
    if isinstance(term, Var):
        yield term.name
    if isinstance(term, Code) and isinstance(term.body, Body | Plan | Rule):
        for inner in terms_of(term.body):
            yield from _occurrences(inner)
        return
    for part in parts_of(term):
        yield from _occurrences(part)


def _given(plan: Plan) -> set[str]:
    """Variables that an action or a new belief is given: there they need a value."""
    simple = [step for step in steps_of(plan.body) if isinstance(step, Simple) and step.does in _GIVES]
    return {name for step in simple for name in _occurrences(step.term)}


def _lone(
    terms: Iterable[Term], place: Place, given: set[str], outer: frozenset[str] = frozenset()
) -> Iterator[Finding]:
    counts = Counter(name for term in terms for name in _occurrences(term))
    for name, count in counts.items():
        if count > 1 or name.startswith("_") or name in outer:
            continue
        meant = next((other for other in counts if alike(other, name) or _short_and_alike(other, name)), None)
        where = place_of(name, place)
        if name in given:
            problem = f"{name} has no value here: it stands nowhere else in this plan"
            advice = f"did you mean {meant}?" if meant else "give it a value in the head, the context or a step before"
            yield Finding("variable-without-value", Severity.WARNING, where, problem, advice)
        elif meant:
            problem = f"{name} stands only once, and looks like {meant}"
            advice = f"write {meant}, or _{name} if it is another"
            yield Finding("lone-variable", Severity.WARNING, where, problem, advice)
        else:
            yield Finding("lone-variable", Severity.HINT, where, f"{name} stands only once", f"write _ or _{name}")


def _short_and_alike(left: str, right: str) -> bool:
    return left != right and left.lower() == right.lower()
