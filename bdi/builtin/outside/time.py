"""`.wait`: for a moment, an event or a formula."""

from bdi.builtin.arguments import running_intention
from bdi.builtin.code import event_in
from bdi.builtin.kinds import ANY, FORMULA, OUT, optional
from bdi.builtin.table import Answer, internal_action, wrong_arguments
from bdi.language.terms import Literal, Term
from bdi.language.unify import substituted, variables_in
from bdi.model.logic import Question
from bdi.model.mind import Mind
from bdi.model.waiting import event_waiter, formula_waiter, moment_after, moment_of


@internal_action("wait", FORMULA, optional(ANY), optional(OUT), named=True)
def wait(
    mind: Mind, variables: dict[str, Term], what: Question, timeout: Term | None = None, elapsed: Term | None = None
) -> Answer:
    """.wait(MS)   .wait("+event", MS, ELAPSED)   .wait(formula, MS, ELAPSED)

    MS is the longest time. When it is over the step fails (wait_timeout), unless ELAPSED asks how long it took. The
    variables of the event, or of the first answer to the formula, have their values then.
    """
    condition = what.term()
    intention = running_intention(mind, "wait")
    if isinstance(condition, int | float):
        mind.intention_base.wait_for(intention, moment_after(mind.now, condition))
        return True
    deadline_s = None if timeout is None else moment_of(mind.now, timeout)
    if timeout is not None and deadline_s is None:
        raise wrong_arguments("wait", "a number of milliseconds as longest time", timeout)
    event = event_in(condition)
    if event is not None:
        waiter = event_waiter(intention, event[0], _as_in_plan(event[1], variables), deadline_s)
    else:
        waiter = formula_waiter(intention, what, deadline_s)
    waiter.elapsed, waiter.since_s = elapsed, mind.now
    if event is None and waiter.check(mind):
        return waiter.tell_elapsed(mind)
    mind.intention_base.wait_for(intention, waiter)
    return True


def _as_in_plan(literal: Literal, variables: dict[str, Term]) -> Literal:
    """The X of "+b(X)" is the X of the plan."""
    values = {each: variables[each.name] for each in variables_in(literal) if each.name in variables}
    return substituted(literal, values)  # type: ignore[return-value]
