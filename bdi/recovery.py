"""When a step or a goal fails: the search for a plan that takes care of it."""

from collections.abc import Callable

from bdi.builtin.arguments import text_of
from bdi.circumstance import Circumstance
from bdi.errors import AgentSpeakSyntaxError, Place
from bdi.intentions import FAILURE_OF, Event, Intention, Means, Step, StepFailed
from bdi.messages import Finished
from bdi.outcome import GoalFailure
from bdi.parser import parse_term
from bdi.plans import relevant
from bdi.syntax import Trigger
from bdi.terms import Atom, String, Structure, Term, atom, show, structure
from bdi.unify import resolve_all


class Recovery(Circumstance):
    """A failure is an event `-!g[error(E), error_msg(M), …]`, searched for from the failed goal down the stack."""

    def fail(self, intention: Intention, failure: StepFailed, step: Step | None = None) -> None:
        """A step failed: look down the stack for a plan `-!g` that takes care of it."""
        self._withdraw(intention)
        code = show(step.source.term) if step is not None and hasattr(step.source, "term") else ""
        place = getattr(step.source, "place", None) if step is not None else None
        annots = _failure_annots(failure, code or str(intention.waits_for or ""), place)
        if not self._fail_below(intention, len(intention.stack), annots):
            self._give_up(intention, failure)

    def _fail_below(self, intention: Intention, height: int, annots: tuple[Term, ...]) -> bool:
        """Post the failure of the topmost goal below this height that somebody has a plan for. False: nobody has."""
        for place in range(height - 1, -1, -1):
            means = intention.stack[place]
            trigger = FAILURE_OF.get(means.event.trigger)
            if trigger is None:
                continue
            if self._post_failure(intention, means.event, trigger, place, annots):
                return True
        return False

    def _post_failure(
        self, intention: Intention | None, goal: Event, trigger: Trigger, place: int, annots: tuple[Term, ...]
    ) -> bool:
        options = self.library.options(trigger, goal.key)
        if not options:
            return False
        for _, inner in goal.returns:
            inner.ref = None  # what the failed plan found out does not count
        literal = Structure(goal.key, resolve_all(goal.args), (*goal.annots, *annots))
        event = Event(trigger, literal, options, intention, returns=goal.returns, under=place)
        if intention is None:
            self.events.append(event)
        else:
            self._wait_for_event(intention, event)
        return True

    def _fail_event(self, event: Event) -> None:
        """A goal that no plan is for, or none whose context holds."""
        known = bool(relevant(event.options, event.literal))
        error = "no_applicable" if known else "no_relevant"
        problem = "no plan has a context that holds" if known else "there is no plan"
        failure = StepFailed(error, f"{problem} for {event}")
        trigger = FAILURE_OF.get(event.trigger)
        intention = event.intention
        height = len(intention.stack) if intention is not None else 0
        if trigger is None:  # the failure plan itself did not apply: search on where it came from
            height, annots = event.under, event.annots
        else:
            annots = _failure_annots(failure, str(event), None)
            if self._post_failure(intention, event, trigger, height, annots):
                return
        if intention is None:
            self._report(GoalFailure(str(event), error, failure.message))
        elif not self._fail_below(intention, height, annots):
            self._give_up(intention, failure, event)

    def _give_up(self, intention: Intention, failure: StepFailed, event: Event | None = None) -> None:
        goal = intention.stack[0].event if intention.stack else event
        self._report(GoalFailure(str(goal), failure.error, failure.message))
        if intention.fork is not None:
            self._drop_branches(intention.fork)
        self.drop(intention)

    def reach_goal(self, intention: Intention, is_goal: Callable[[Means], bool]) -> None:
        """The lowest goal like this counts as reached: what was done for it is dropped."""
        place = _place_of(intention, is_goal)
        if place is None:
            return
        self._interrupt(intention)
        del intention.stack[place + 1 :]
        intention.stack[place].step = None
        if self.clear_finished(intention) and intention is not self.current:
            self._resume(intention)

    def give_up_goal(self, intention: Intention, is_goal: Callable[[Means], bool], annots: tuple[Term, ...]) -> None:
        """The lowest goal like this counts as failed."""
        place = _place_of(intention, is_goal)
        if place is None:
            return
        self._interrupt(intention)
        del intention.stack[place + 1 :]
        self.fail(intention, StepFailed("goal_failed", "given up by .fail_goal", annots))


def _place_of(intention: Intention, is_goal: Callable[[Means], bool]) -> int | None:
    return next((place for place, means in enumerate(intention.stack) if is_goal(means)), None)


def action_failure(finished: Finished) -> StepFailed:
    """The reason as plans see it: -!g[error(action_failed), error_msg("…"), REASON, reason(REASON)]"""
    failure = finished.failure
    reason = _reason_of("" if failure is None else failure)
    message = finished.message or text_of(reason)
    plain: tuple[Term, ...] = (reason,) if isinstance(reason, Atom | Structure) else ()
    return StepFailed("action_failed", message, (*plain, structure("reason", reason)))


def _reason_of(failure: Term | str) -> Term:
    """The reason as a term; a sentence becomes a string."""
    if type(failure) is not str:
        return failure  # type: ignore[return-value]
    try:
        return parse_term(failure)
    except AgentSpeakSyntaxError:
        return String(failure)


def _failure_annots(failure: StepFailed, code: str, place: Place | None) -> tuple[Term, ...]:
    """error(E), error_msg(M), what the failure adds, and where it happened."""
    annots = (structure("error", atom(failure.error)), structure("error_msg", String(failure.message)))
    where = (
        structure("code", String(code)),
        structure("code_src", String(place.source if place else "")),
        structure("code_line", place.line if place else 0),
    )
    return (*failure.annots, *annots, *where)
