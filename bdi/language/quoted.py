"""Plans, bodies and rules as values unify like other terms: `{ First; Rest } = { drive(uc); !report }`.

A variable that stands where a step is takes that step as a body of its own; at the end of a body it takes all that is
left. Of a plan the label, the event, the context and the body have to agree; where there is no label, there must be
none in the other one.
"""

from collections.abc import Sequence

from bdi.language.syntax import Body, Does, Plan, Rule, Simple, Step, variables_of, with_terms
from bdi.language.terms import ANNOTATED, TRUE, Code, Structure, Term, Var, show_by
from bdi.language.unify import Trail, substituted, unify, unify_by

Quoted = Body | Plan | Rule
NOTHING = Body()


def unify_codes(left: Code, right: Term, trail: Trail) -> bool:
    if type(right) is not Code:
        return False
    if left is right or (left.body is right.body and left.scope == right.scope):
        return True
    return _unify(_meant(left), _meant(right), trail)


def whole_scope(code: Code) -> dict[Var, Term]:
    """Return the value of each of its variables; those without one get a fresh variable."""
    return {each: code.scope.get(each) or Var(each.name) for each in variables_of(code.body)}


def as_read(code: Code) -> Quoted:
    """Return the quoted code with the values that its variables have now."""
    scope = code.scope
    quoted: Quoted = with_terms(code.body, lambda term: substituted(term, scope)) if scope else code.body
    return quoted


def _meant(code: Code) -> Quoted:
    values = whole_scope(code)
    quoted: Quoted = with_terms(code.body, lambda term: substituted(term, values)) if values else code.body
    return quoted


def _value(quoted: Body) -> Term:
    """A variable alone is what it stands for."""
    if len(quoted.steps) == 1 and _is_variable(quoted.steps[0]):
        return quoted.steps[0].term  # type: ignore[union-attr]
    names: dict[Var, Term] = {each: Var(each.name) for each in variables_of(quoted)}
    written: Body = with_terms(quoted, lambda term: substituted(term, names))
    return Code(written, {names[each]: each for each in names})  # type: ignore[misc]


def _unify(left: Quoted, right: Quoted, trail: Trail) -> bool:
    if isinstance(left, Body) and isinstance(right, Body):
        return _unify_steps(left.steps, right.steps, trail)
    if isinstance(left, Plan) and isinstance(right, Plan):
        return _is_event(left) == _is_event(right) and _unify_plans(left, right, trail)
    if isinstance(left, Rule) and isinstance(right, Rule):
        return unify(left.head, right.head, trail) and unify(left.formula, right.formula, trail)
    return False


def _is_event(plan: Plan) -> bool:
    """{+!g(X)}"""
    return not plan.label.functor and plan.context is None and plan.body == NOTHING


def _unify_plans(left: Plan, right: Plan, trail: Trail) -> bool:
    return (
        left.trigger is right.trigger
        and unify(_label(left), _label(right), trail)
        and unify(_head(left), _head(right), trail)
        and unify(left.context or TRUE, right.context or TRUE, trail)
        and unify(_value(left.body), _value(right.body), trail)
    )


def _label(plan: Plan) -> Term:
    """{ @L +!G <- B }"""
    return plan.label.args[0] if plan.label.predicate is ANNOTATED else plan.label


def _head(plan: Plan) -> Term:
    """{+!G[source(S)]}"""
    return Structure(ANNOTATED, (plan.head,), plan.head_annots) if plan.head_annots else plan.head


def _unify_steps(left: Sequence[Step], right: Sequence[Step], trail: Trail) -> bool:
    met = False
    while left and right:
        for steps, others in ((left, right), (right, left)):
            if len(steps) == 1 and _is_variable(steps[0]):
                return unify(_value(Body(tuple(steps))), _value(Body(tuple(others))), trail)
        if not _unify_step(left[0], right[0], trail):
            return False
        left, right, met = left[1:], right[1:], True
    rest = (*left, *right)
    if met and len(rest) == 1 and _is_variable(rest[0]):
        return unify(_value(Body(rest)), Code(NOTHING), trail)
    return not rest


def _unify_step(left: Step, right: Step, trail: Trail) -> bool:
    if _is_variable(left) or _is_variable(right):
        return unify(_value(Body((left,))), _value(Body((right,))), trail)
    if isinstance(left, Simple) and isinstance(right, Simple):
        return left.does is right.does and unify(left.term, right.term, trail)
    return str(left) == str(right)


def _is_variable(step: Step) -> bool:
    return isinstance(step, Simple) and step.does is Does.VARIABLE


def _text(code: Code) -> str:
    return f"{{{str(as_read(code)).removesuffix('.')}}}"


unify_by(Code, unify_codes)
show_by(Code, _text)
