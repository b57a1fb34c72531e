"""Goals that no plan is for, goals for which no plan may apply, and beliefs that nothing brings about."""

from collections.abc import Collection, Iterator

from bdi.language.syntax import Plan, Trigger
from bdi.language.terms import NOT, TRUE, Predicate, Structure, Term, Var, is_internal, show
from bdi.tools.checks.findings import Finding, Severity, place_of
from bdi.tools.checks.names import similar, spelled, unifies
from bdi.tools.checks.reading import How, Reading

MESSAGE = "kqml_received"  # a message for which no such plan applies is read as usual
_OPPOSITE = {"<": ">=", ">=": "<", ">": "<=", "<=": ">", "==": "\\==", "\\==": "=="}


def goals_without_plan(reading: Reading) -> Iterator[Finding]:
    """A posted goal that no plan is about."""
    reported: set[str] = set()
    for use in reading.of(How.POSTED):
        key, text = use.literal.predicate, show(use.literal)
        plans = reading.plans_for(Trigger.GOAL_ADDED, key)
        if text in reported or any(unifies(plan.head, use.literal) for plan in plans) or key.namespace:
            continue
        reported.add(text)
        severity = Severity.ERROR
        caught = " (a plan -! takes care of that)" if reading.plans_for(Trigger.GOAL_FAILED, key) else ""
        if caught or reading.plans_come or is_internal(key.name):
            severity = Severity.HINT
        place = place_of(key.name, use.place)
        if plans:
            heads = ", ".join(f"+!{show(plan.head)}" for plan in plans[:3])
            problem = f"no plan takes !{text}: the heads are {heads}"
            yield Finding("goal-without-plan", severity, place, problem + caught, "add a plan for it")
            continue
        meant = similar(key, reading.heads(Trigger.GOAL_ADDED))
        advice = f"did you mean !{spelled(meant)}?" if meant else f"add a plan +!{text}"
        yield Finding("goal-without-plan", severity, place, f"there is no plan for !{spelled(key)}{caught}", advice)


def goals_without_default(reading: Reading) -> Iterator[Finding]:
    """A goal whose plans all ask for something (the paper's section 7.5)."""
    for key in sorted(reading.heads(Trigger.GOAL_ADDED), key=lambda each: each.name):
        plans = reading.plans_for(Trigger.GOAL_ADDED, key)
        if any(_is_unconditional(plan) for plan in plans) or leave_nothing_out(plans):
            continue
        if reading.plans_for(Trigger.GOAL_FAILED, key) or key.name == MESSAGE:
            continue  # it is said, or known, what happens then
        rescuer = _rescuer(reading, key)
        contexts = {1: "the plan asks", 2: "both plans ask"}.get(len(plans), f"all {len(plans)} plans ask")
        then = "the goal fails"
        then += f", up to -!{rescuer.head} in line {rescuer.place.line}" if rescuer else " and nothing takes care of it"
        yield Finding(
            "no-default-plan",
            Severity.HINT if rescuer else Severity.WARNING,
            plans[0].place,
            f"for !{spelled(key)} {contexts} for something: when that does not hold, {then}",
            f"add a plan without a context for the other cases, or one for -!{key.name}",
        )


def _is_unconditional(plan: Plan) -> bool:
    return plan.context is None or plan.context is TRUE


def leave_nothing_out(plans: list[Plan]) -> bool:
    """Return whether one context is the opposite of another, as in `: open` and `: not open`."""
    contexts = {show(plan.context) for plan in plans if plan.context is not None}
    return any(opposite in contexts for plan in plans for opposite in _opposites(plan.context))


def _opposites(context: Term | None) -> list[str]:
    if not isinstance(context, Structure):
        return []
    if context.predicate is NOT:
        return [show(context.args[0])]
    if context.functor in _OPPOSITE:
        left, right = context.args
        return [f"({show(left)}{_OPPOSITE[context.functor]}{show(right)})"]
    return []


def _rescuer(reading: Reading, key: Predicate) -> Plan | None:
    """A plan -! for a goal on the way to this one."""
    seen: set[Predicate] = set()
    waiting = [key]
    while waiting:
        current = waiting.pop()
        if current in seen:
            continue
        seen.add(current)
        found = [plan for plan in reading.plans_for(Trigger.GOAL_FAILED, current) if not isinstance(plan.head, Var)]
        if found:
            return found[0]
        for use in reading.of(How.POSTED):
            if use.literal.predicate is current and use.plan is not None and not isinstance(use.plan.head, Var):
                waiting.append(use.plan.head.predicate)
    return None


def unknown_beliefs(reading: Reading, declared: Collection[str] | None) -> Iterator[Finding]:
    """Beliefs that are asked for and that nothing brings about. Without declared percepts, only those that look like
    another name."""
    known = reading.names(How.ADDED)
    asked = [(use.literal.predicate, use.place) for use in reading.of(How.TESTED)]
    asked += [
        (plan.head.predicate, plan.place)
        for plan in reading.plans
        if plan.trigger in (Trigger.BELIEF_ADDED, Trigger.BELIEF_REMOVED) and not isinstance(plan.head, Var)
    ]
    answered = reading.heads(Trigger.TEST_ADDED)
    reported: set[Predicate] = set()
    for key, place in asked:
        if key in known or key in answered or key in reported or key.namespace or _is_declared(key, declared):
            continue
        reported.add(key)
        meant = similar(key, [other for other in known if other.negated == key.negated])
        if declared is None and (meant is None or meant.name == key.name):
            continue  # a percept or a message, as far as can be said
        advice = "add it to the declared percepts if it is one"
        yield Finding(
            "unknown-belief",
            Severity.WARNING,
            place_of(key.name, place),
            f"nothing brings about {spelled(key)}: no plan, rule or belief" + (", no percept" if declared else ""),
            f"did you mean {spelled(meant)}? Otherwise {advice}" if meant else advice,
        )


def _is_declared(key: Predicate, declared: Collection[str] | None) -> bool:
    return declared is not None and (key.name in declared or f"{key.name}/{key.arity}" in declared)
