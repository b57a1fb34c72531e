"""Failures that the plans for them may not take."""

from collections.abc import Iterator

from bdi.language.syntax import Plan, Trigger
from bdi.language.terms import TRUE, Predicate, Structure, Term, Var, show
from bdi.tools.checks.findings import Finding, Severity
from bdi.tools.checks.goals import leave_nothing_out
from bdi.tools.checks.names import spelled
from bdi.tools.checks.reading import Reading

ALWAYS_GIVEN = frozenset({"error", "error_msg", "code", "code_src", "code_line"})
"""What every failure says of itself; `reason` and the like only some."""


def failures_without_plan(reading: Reading) -> Iterator[Finding]:
    """A goal with plans -! that each ask for something. As in Jason, a failure that none of them takes ends the whole
    intention: a plan further down the stack is asked only where this goal has no plan -! at all."""
    for trigger, mark in ((Trigger.GOAL_FAILED, "!"), (Trigger.TEST_FAILED, "?")):
        for key in sorted(reading.heads(trigger), key=lambda each: each.name):
            plans = reading.plans_for(trigger, key)
            if not _take_every_failure(plans):
                yield _finding(plans, f"{mark}{spelled(key)}", f"-{mark}{_general_head(key)}")


def _finding(plans: list[Plan], goal: str, head: str) -> Finding:
    asked = {1: "the only plan asks"}.get(len(plans), f"all {len(plans)} plans ask")
    return Finding(
        "open-failure",
        Severity.WARNING,
        plans[0].place,
        f"for failures of {goal} {asked} for something: any other failure ends the intention",
        f"add a last plan {head}[error_msg(Why)] <- .fail(error_msg(Why)), or one that takes care of it",
    )


def _general_head(key: Predicate) -> str:
    return key.name + (f"({','.join('_' * key.arity)})" if key.arity else "")


def _take_every_failure(plans: list[Plan]) -> bool:
    for_all = [plan for plan in plans if _is_for_every_goal(plan) and _asks_nothing_of_the_failure(plan)]
    return any(plan.context in (None, TRUE) for plan in for_all) or leave_nothing_out(for_all)


def _is_for_every_goal(plan: Plan) -> bool:
    if isinstance(plan.head, Var):
        return True
    named = [show(arg) for arg in plan.head.args if show(arg) != "_"]
    return all(isinstance(arg, Var) for arg in plan.head.args) and len(named) == len(set(named))


def _asks_nothing_of_the_failure(plan: Plan) -> bool:
    annots = plan.head_annots if isinstance(plan.head, Var) else plan.head.annots
    return all(_is_always_given(annot) for annot in annots)


def _is_always_given(annot: Term) -> bool:
    return isinstance(annot, Structure) and annot.functor in ALWAYS_GIVEN and isinstance(annot.args[0], Var)
