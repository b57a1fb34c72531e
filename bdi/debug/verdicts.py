"""Verdicts: why each plan for an event did or did not apply, worked out again from its source.

    head      argument 2 is post1, not uc
    context   line(center) does not hold (believed: line(lost))
    error     X>2 cannot be worked out: …

Nothing is changed by asking: chance is put back, and internal actions that do something are not called again.
"""

from typing import NamedTuple

from bdi.builtin import ACTIONS
from bdi.debug.trace import CHOSEN, CONTEXT, ERROR, HEAD, WOULD_APPLY, Deliberated, Observed, Verdict
from bdi.language.syntax import Plan
from bdi.language.terms import AND, INTERNAL, NOT, OPERATORS, RELATIONS, Atom, Literal, Structure, Term, Var, show
from bdi.language.unify import Trail, deref, parts_of, renamed, resolve, substituted, undo, unify, unify_annots
from bdi.model.intentions import NOT_WORKED_OUT, Event
from bdi.model.plans import CompiledPlan

ENOUGH_ANSWERS = 20  # of the first part of a context: to say "for none of them"
SHOWN_BELIEFS = 3
ASKS_ONLY = frozenset(
    {
        "bdi.builtin.terms.lists",
        "bdi.builtin.terms.strings",
        "bdi.builtin.terms.formulas",
        "bdi.builtin.terms.functions",
    }
)
ASKS_TOO = frozenset(
    {
        *(".desire", ".intend", ".belief", ".my_name", ".time", ".random", ".suspended", ".current_intention", ".true"),
        *(".relevant_plans", ".map.get", ".map.key", ".queue.head", ".set.to_list", ".queue.to_list"),
    }
)

Bindings = dict[str, Term]


class _Failed(NamedTuple):
    kind: str
    why: str
    bindings: Bindings


def deliberated(agent: Observed, event: Event, plan: CompiledPlan | None, explain: bool) -> Deliberated:
    """The entry of the trace for this choice; the agent remembers it for a while."""
    said = tuple(verdicts(agent, event, plan)) if explain else ()
    choice = Deliberated(agent.cycles, event, plan, tuple(event.options), said)
    agent.choices.append(choice)
    return choice


def verdicts(agent: Observed, event: Event, chosen: CompiledPlan | None) -> list[Verdict]:
    """One for each plan with this trigger and name, in source order. Beliefs must be as they were for the choice."""
    found_out = [(inner, inner.ref) for _, inner in event.returns]
    for inner, _ in found_out:
        inner.ref = None  # as the event was before a plan was chosen
    chance = agent.random.getstate()
    try:
        literal = event.literal
        options = _candidates(agent, event)
        last = options.index(chosen) if chosen in options else len(options)
        return [_verdict(agent, each, literal, chosen, number < last) for number, each in enumerate(options)]
    finally:
        agent.random.setstate(chance)
        for inner, value in found_out:
            inner.ref = value


def _candidates(agent: Observed, event: Event) -> list[CompiledPlan]:
    """Return the plans for an event, also where the head does not unify; sub-plans replace those of the agent."""
    mine = agent.library.plans
    scoped = [option for option in event.options if option not in mine]
    return scoped or [option for option in mine if _is_about(option.plan, event)]


def _is_about(plan: Plan, event: Event) -> bool:
    return plan.trigger is event.trigger and (isinstance(plan.head, Var) or plan.head.predicate is event.key)


def _verdict(
    agent: Observed, option: CompiledPlan, literal: Literal, chosen: CompiledPlan | None, tried: bool
) -> Verdict:
    """`tried`: whether it was its turn before the one that was taken, so that it certainly did not apply."""
    plan = option.as_seen()
    failed, bindings = _try(agent, plan, literal)
    shown = tuple((name, show(value)) for name, value in bindings.items())
    if option is chosen:
        kind, why = CHOSEN, "the first that applies"
    elif failed is None and tried:
        kind, why = CONTEXT, "it did not hold then, and may hold now: it is not asked again"
    elif failed is None:
        kind, why = WOULD_APPLY, "an earlier plan comes first"
    else:
        kind, why, _ = failed
    return Verdict(option.label, plan.place.source, plan.place.line, kind, why, shown)


def _try(agent: Observed, plan: Plan, literal: Literal) -> tuple[_Failed | None, Bindings]:
    names: dict[Var, Term] = {}
    trail: Trail = []
    try:
        problem = _head_problem(plan.head, literal, names, trail)
        values = {var.name: resolve(value) for var, value in names.items() if var.name != "_"}
        known = {name: value for name, value in values.items() if type(value) is not Var}
        if problem:
            return _Failed(HEAD, problem, known), known
        if plan.context is None:
            return None, known
        return _context_problem(agent, plan.context, names, known)
    finally:
        undo(trail, 0)


def _head_problem(pattern: Literal | Var, literal: Literal, names: dict[Var, Term], trail: Trail) -> str | None:
    pattern, literal = substituted(pattern, names, fresh=True), renamed(literal, {})  # type: ignore[assignment]
    if isinstance(pattern, Var) or not isinstance(literal, Atom | Structure):
        unify(pattern, literal, trail)
        return None
    for number, (wanted, given) in enumerate(zip(pattern.args, literal.args, strict=True), 1):
        if not unify(wanted, given, trail):
            return f"argument {number} is {show(given)}, not {show(resolve(wanted))}"
    if pattern.annots and not unify_annots(pattern.annots, literal.annots, trail):
        return f"no {_listed(pattern.annots)} among the annotations {_listed(literal.annots)}"
    return None


def _listed(annots: tuple[Term, ...]) -> str:
    return f"[{','.join(map(show, annots))}]"


def _context_problem(
    agent: Observed, context: Term, names: dict[Var, Term], known: Bindings
) -> tuple[_Failed | None, Bindings]:
    """The first part of the conjunction that makes it false."""
    holds: Term | None = None
    answers: list[Bindings] = [{}]
    for part in conjuncts(context):
        written = substituted(part, names, fresh=True)
        bindings = {**known, **answers[0]}
        try:
            asked = resolve(written)
            if not _only_asks(asked):
                continue  # it held when the plan was tried, as far as can be said
            so_far: Term = asked if holds is None else Structure(AND, (holds, asked))
            found = agent.logic.query(so_far, ENOUGH_ANSWERS)
        except NOT_WORKED_OUT as error:
            undo(agent.logic.trail, 0)
            return _Failed(ERROR, f"{_with(written, bindings)} cannot be worked out: {error}", bindings), bindings
        if not found:
            return _Failed(CONTEXT, _why_not(agent, written, answers, bindings), bindings), bindings
        holds, answers = so_far, found
    return None, {**known, **answers[0]}


def conjuncts(formula: Term) -> list[Term]:
    """a & b & c as a list."""
    if isinstance(formula, Structure) and formula.predicate is AND:
        return [part for side in formula.args for part in conjuncts(side)]
    return [formula]


def _only_asks(formula: Term) -> bool:
    """Return whether asking again changes nothing."""
    name = getattr(formula, "functor", "")
    if name.startswith(INTERNAL) and name not in ASKS_TOO:
        known = ACTIONS.get(name)
        if known is None or getattr(known.call, "__module__", "") not in ASKS_ONLY:
            return False
    return all(map(_only_asks, parts_of(formula)))


def _why_not(agent: Observed, formula: Term, answers: list[Bindings], bindings: Bindings) -> str:
    text = _with(formula, bindings if len(answers) == 1 else {})
    for_all = ""
    if len(answers) > 1:
        count = f"{len(answers)} or more" if len(answers) == ENOUGH_ANSWERS else str(len(answers))
        for_all = f" for any of {count} answers to what stands before it"
    key = getattr(formula, "predicate", None)
    if key is NOT:
        return f"{_with(parts_of(formula)[0], bindings)} holds{for_all}"
    if key in RELATIONS:
        return f"{text} is false{for_all}"
    return f"{text} does not hold{for_all}{_believed(agent, formula)}"


def _with(formula: Term, bindings: Bindings) -> str:
    """The formula with the values found so far, without brackets around it."""
    values = {var: bindings[var.name] for var in _variables(formula) if var.name in bindings}
    try:
        text = show(resolve(substituted(formula, dict(values))))
    except NOT_WORKED_OUT:
        text = show(substituted(formula, dict(values)))
    operator = isinstance(formula, Structure) and formula.functor in OPERATORS and text.startswith("(")
    return text[1:-1] if operator else text


def _variables(formula: Term) -> list[Var]:
    formula = deref(formula)
    if isinstance(formula, Var):
        return [formula]
    return [variable for part in parts_of(formula) for variable in _variables(part)]


def _believed(agent: Observed, formula: Term) -> str:
    """Return the beliefs of the same name that hold instead."""
    if not isinstance(formula, Atom | Structure) or formula.functor in OPERATORS or formula.functor.startswith("."):
        return ""
    relation = agent.beliefs.relations.get(formula.predicate)
    facts = [show(Structure(formula.predicate, each.args)) for each in relation] if relation else []
    if not facts or not formula.args:
        return ""
    more = ", …" if len(facts) > SHOWN_BELIEFS else ""
    return f" (believed: {', '.join(facts[:SHOWN_BELIEFS])}{more})"
