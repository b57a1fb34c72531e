"""The run-time library of compiled formulas, for cases that a dictionary look-up does not decide."""

from collections.abc import Callable, Iterable, Iterator
from typing import Any

from bdi.language.arithmetic import ArithmeticFailure
from bdi.language.quoted import whole_scope
from bdi.language.syntax import Plan, event_alone
from bdi.language.terms import (
    TRUE,
    Atom,
    Code,
    List,
    OpenList,
    Predicate,
    Structure,
    Term,
    Var,
    annotated,
    atom,
    in_space,
    literal_of,
    make,
    predicate,
    space_of,
)
from bdi.language.unify import (
    FIXED,
    Trail,
    annots_of,
    compare,
    deref,
    evaluated,
    resolve,
    resolve_all,
    substituted,
    undo,
    unify,
    unify_annots,
)
from bdi.model.beliefs import FROM_SELF, Belief, Derivation, Relation, agreements, agrees
from bdi.model.intentions import NOT_WORKED_OUT
from bdi.model.logic.frames import Question

Terms = tuple[Term, ...]


def prove(relation: Relation, args: Terms, annots: Terms, trail: Trail, then: Callable[[], Any]) -> Any:
    """Call `then` for every fact that unifies and every proof by a rule, until it answers something."""
    mark = len(trail)
    for key in tuple(relation.candidates(deref(args[0]) if args else None)):
        entry = relation.facts.get(key)
        answer = None
        if type(entry) is Derivation:
            answer = entry.proof.call(args, then)
        elif type(entry) is Belief and annots:
            for _ in agreements(entry, args, annots, trail):
                answer = then()
                if answer is not None:
                    return answer
        elif type(entry) is Belief and agrees(entry, args, annots, trail):
            answer = then()
        if answer is not None:
            return answer
        if len(trail) > mark:
            undo(trail, mark)
    return None


def unified(relation: Relation, args: Terms, annots: Terms, trail: Trail) -> Iterator[Terms]:
    """The arguments of every fact that unifies, while its bindings hold. For relations without rules."""
    mark = len(trail)
    for key in tuple(relation.candidates(deref(args[0]) if args else None)):
        entry = relation.facts.get(key)
        if type(entry) is Belief and annots:
            for _ in agreements(entry, args, annots, trail):
                yield entry.args
        elif type(entry) is Belief and agrees(entry, args, annots, trail):
            yield entry.args
        undo(trail, mark)


def restoring(answers: Iterable[Any], trail: Trail) -> Iterator[Any]:
    """The answers; what was bound since is taken back before the next."""
    mark = len(trail)
    for answer in answers:
        yield answer
        undo(trail, mark)


def unifies(left: Term, right: Term) -> bool:
    """Return whether they could be made equal; nothing stays bound."""
    trail: Trail = []
    try:
        return unify(resolve(left), resolve(right), trail)
    except ArithmeticFailure:
        return False
    finally:
        undo(trail, 0)


def each(answer: Any, trail: Trail) -> Iterator[None]:
    """The ways in which an internal action is true."""
    mark = len(trail)
    if answer is True:
        yield
    elif answer:
        for _ in answer:
            yield
            undo(trail, mark)
    undo(trail, mark)


def calculated(key: Predicate, args: Terms) -> Term:
    """Arithmetic: the number, or the expression while an operand is none. Raises ArithmeticFailure."""
    return evaluated(Structure(key, resolve_all(args)))


def holds(name: str, left: Term, right: Term) -> bool:
    """Numbers by value, other terms by the standard order. What cannot be calculated does not hold."""
    try:
        a, b = resolve(left), resolve(right)
    except ArithmeticFailure:
        return False
    if name in ("==", "\\==") or (type(a) in (int, float) and type(b) in (int, float)):
        return TESTS[name](a, b)
    return TESTS[name](compare(a, b), 0)


TESTS: dict[str, Callable[[Any, Any], bool]] = {
    "<": lambda a, b: a < b,
    "<=": lambda a, b: a <= b,
    ">": lambda a, b: a > b,
    ">=": lambda a, b: a >= b,
    "==": lambda a, b: a == b,
    "\\==": lambda a, b: a != b,
}


def decomposed(left: Term, right: Term, trail: Trail) -> bool:
    """p(a)[x] =.. [p,[a],[x]], s::p(a)[x] =.. [s,p,[a],[x]], in either direction.

    Of a plan the label, the event, the context and the body."""
    value, pattern = resolve(left), resolve(right)
    if isinstance(value, Code) and isinstance(value.body, Plan):
        return unify(List(_parts_of_plan(value.body, whole_scope(value))), pattern, trail)
    if isinstance(value, Atom | Structure):
        parts: list[Term] = [atom(value.functor), List(value.args), List(value.annots)]
        if isinstance(pattern, List) and len(pattern) == 4:
            parts.insert(0, space_of(value.predicate))
        return unify(List(parts), pattern, trail)
    made = _composed(pattern)
    return made is not None and unify(value, made, trail)


def _parts_of_plan(plan: Plan, scope: dict[Var, Term]) -> tuple[Term, ...]:
    """Return its label, its event, its context and its body."""
    label = plan.label if plan.label.functor else atom("nolabel")
    context = TRUE if plan.context is None else substituted(plan.context, scope)
    return label, Code(event_alone(plan), scope), context, Code(plan.body, scope)


def _composed(pattern: Term) -> Term | None:
    """[p,[a],[x]] → p(a)[x], [s,p,[a],[x]] → s::p(a)[x]"""
    if isinstance(pattern, List) and len(pattern) == 4:
        made = _composed(List(pattern[1:]))
        return None if made is None else in_space(pattern[0], made)
    if not isinstance(pattern, List) or len(pattern) != 3:
        return None
    name, args, annots = pattern
    if not isinstance(name, Atom) or not isinstance(args, List) or not isinstance(annots, List):
        return None
    return literal_of(predicate(name.functor, len(args)), tuple(args), tuple(annots))


# What generated code can name, besides the trail and the logic of its agent.
RUNTIME: dict[str, Any] = {
    "ArithmeticFailure": ArithmeticFailure,
    "Code": Code,
    "FIXED": FIXED,
    "FROM_SELF": FROM_SELF,
    "List": List,
    "ONCE": (None,),
    "NOT_WORKED_OUT": NOT_WORKED_OUT,
    "OpenList": OpenList,
    "Question": Question,
    "Structure": Structure,
    "Var": Var,
    "annotated": annotated,
    "annots_of": annots_of,
    "calculated": calculated,
    "decomposed": decomposed,
    "deref": deref,
    "each": each,
    "holds": holds,
    "make": make,
    "prove": prove,
    "resolve": resolve,
    "resolve_all": resolve_all,
    "restoring": restoring,
    "undo": undo,
    "unified": unified,
    "unifies": unifies,
    "unify": unify,
    "unify_annots": unify_annots,
}
