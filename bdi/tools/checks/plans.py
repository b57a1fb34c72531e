"""Plans that are never taken, and steps that are never reached."""

from collections.abc import Iterator

from bdi.language.syntax import Body, Plan, Simple, Trigger
from bdi.language.terms import TRUE, Structure, Term, Var, atom, show
from bdi.language.unify import Trail, renamed, substituted, undo, unify, variables_in
from bdi.tools.checks.findings import Finding, Severity
from bdi.tools.checks.reading import How, Reading, bodies_of

ENDS = frozenset({".fail", ".drop_intention"})  # without arguments that name another goal


def shadowed_plans(reading: Reading) -> Iterator[Finding]:
    """A plan after one that applies whenever it would."""
    for plans in _scopes(reading):
        for number, plan in enumerate(plans):
            earlier = next((each for each in plans[:number] if _covers(each, plan)), None)
            if earlier is not None:
                always = earlier.context is None or earlier.context is TRUE
                why = "has no context" if always else "has the same context"
                where = f"line {earlier.place.line}"
                if earlier.place.source != plan.place.source:
                    where += f" of {earlier.place.source}"
                yield Finding(
                    "shadowed-plan",
                    Severity.WARNING,
                    plan.place,
                    f"this plan is never taken: the one in {where} comes first, takes the same and {why}",
                    "put the plan that asks for more first, or give the other one a context",
                )


def _scopes(reading: Reading) -> Iterator[list[Plan]]:
    """The plans that are looked through together: those of the program, and the sub-plans of each plan."""
    yield list(reading.program.plans)
    for plan in reading.plans:
        if plan.subplans:
            yield list(plan.subplans)


def _covers(earlier: Plan, later: Plan) -> bool:
    """Return whether the earlier plan applies to every event, in every state, in which the later one does."""
    if earlier.trigger is not later.trigger or earlier.has("all_unifs"):
        return False
    constants: dict[Var, Term] = {
        variable: atom(f"any {number}") for number, variable in enumerate(variables_in(later.head))
    }
    pattern: dict[Var, Term] = {}
    trail: Trail = []
    try:
        if not unify(renamed(earlier.head, pattern), substituted(later.head, constants), trail):
            return False
        if earlier.context is None or earlier.context is TRUE:
            return True
        return later.context is not None and _in_order(earlier.context, pattern) == _in_order(later.context, constants)
    finally:
        undo(trail, 0)


def _in_order(context: Term, known: dict[Var, Term]) -> str:
    """The context with its own variables numbered, so that names make no difference."""
    own = [variable for variable in variables_in(context) if variable not in known]
    return show(substituted(context, {**known, **{each: Var(f"V{place}") for place, each in enumerate(own)}}))


def same_labels(reading: Reading) -> Iterator[Finding]:
    """Two plans of one name."""
    seen: dict[str, Plan] = {}
    for plan in reading.program.plans:
        label = plan.label.functor
        first = seen.setdefault(label, plan)
        if first is not plan:
            yield Finding(
                "same-label",
                Severity.WARNING,
                plan.place,
                f"the label @{label} is taken: the plan in line {first.place.line} has it",
                "give each plan a label of its own; .remove_plan and the trace go by it",
            )


def unreached_steps(reading: Reading) -> Iterator[Finding]:
    """Steps after `.fail`."""
    for plan in reading.plans:
        yield from _after_the_end(plan.body)


def _after_the_end(body: Body) -> Iterator[Finding]:
    for step, following in zip(body.steps, body.steps[1:], strict=False):
        if isinstance(step, Simple) and getattr(step.term, "functor", "") in ENDS and _ends(step):
            yield Finding(
                "unreached-step",
                Severity.WARNING,
                following.place,
                f"this step is never taken: {step} comes before it",
                "put it before, or take it out",
            )
            return
    for step in body.steps:
        for inner in bodies_of(step):
            yield from _after_the_end(inner)


def _ends(step: Simple) -> bool:
    return getattr(step.term, "functor", "") == ".fail" or not getattr(step.term, "args", ())


def uncalled_plans(reading: Reading) -> Iterator[Finding]:
    """Plans for goals that the program does not post: only a message can."""
    if reading.posts_anything:
        return
    posted = reading.names(How.POSTED)
    reported: set[object] = set()
    for plan in reading.plans:
        if plan.trigger is not Trigger.GOAL_ADDED or isinstance(plan.head, Var):
            continue
        key = plan.head.predicate
        if key in posted or key in reported or key.name == "kqml_received" or _is_for_others(plan):
            continue
        reported.add(key)
        yield Finding(
            "uncalled-plan",
            Severity.HINT,
            plan.place,
            f"nothing in the program posts !{key.name}/{key.arity}: its plans wait for a message",
            "fine for a goal that another agent sends; otherwise post it, or take the plan out",
        )


def _is_for_others(plan: Plan) -> bool:
    """+!g[source(user)]: it says itself whose goal it is."""
    annots = () if isinstance(plan.head, Var) else plan.head.annots
    sources = [annot.args[0] for annot in annots if isinstance(annot, Structure) and annot.functor == "source"]
    return any(source != atom("self") for source in sources)
