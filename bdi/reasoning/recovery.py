"""The search for a plan that handles the failure of a step or goal."""

from collections.abc import Callable

from bdi.builtin.arguments import text_of
from bdi.debug.trace import GoalFailure
from bdi.language.errors import AgentSpeakSyntaxError, Place
from bdi.language.parser import parse_term
from bdi.language.syntax import BELIEF_ADDED, BELIEF_REMOVED, Trigger
from bdi.language.terms import Atom, String, Structure, Term, atom, literal_of, predicate, show, structure
from bdi.language.unify import resolve_all
from bdi.model.goal_states import META
from bdi.model.intentions import FAILURE_OF, Event, FailureEvent, Fork, Intention, Means, Step, StepFailed
from bdi.model.messages import Finished
from bdi.model.plans import relevant
from bdi.reasoning.circumstance import Circumstance
from bdi.reasoning.event_queue import EventQueue
from bdi.reasoning.intention_base import IntentionBase
from bdi.reasoning.output import Output

ERROR, ERROR_MESSAGE = predicate("error", 1), predicate("error_msg", 1)

WANTED = {failure: goal for goal, failure in FAILURE_OF.items()}


class Recovery:
    """Finds a plan for a failure.

    A failure is an event `-!g[error(E), error_msg(M), …]`, searched for from the failed goal down the stack.
    """

    __slots__ = ("agent", "event_queue", "intention_base", "output")

    def __init__(
        self, agent: Circumstance, output: Output, event_queue: EventQueue, intention_base: IntentionBase
    ) -> None:
        self.agent = agent
        self.output = output
        self.event_queue = event_queue
        self.intention_base = intention_base

    # ---- a failed step -----------------------------------------------------------------------------------------------

    def fail(self, intention: Intention, failure: StepFailed, step: Step | None = None) -> None:
        """A step failed: look down the stack for a plan `-!g` that takes care of it."""
        self.intention_base.withdraw(intention)
        done = intention.waits_for  # an action as it was started, with its values
        step = step or intention.last
        code = show(done) if isinstance(done, Atom | Structure) else "" if step is None else _code_of(step)
        annots = _failure_annots(failure, code, _place_of_step(step))
        is_reaction = intention.stack[-1].event.trigger in (BELIEF_ADDED, BELIEF_REMOVED)  # only goals can fail
        if is_reaction or not self._fail_below(intention, len(intention.stack), annots):
            self._give_up(intention, failure)

    def _fail_below(self, intention: Intention, height: int, annots: tuple[Term, ...]) -> bool:
        """Post the failure of the topmost goal below this height that has a plan for it. Return False if none has."""
        for place in range(height - 1, -1, -1):
            if intention.fork is not None and self._ends_branch(intention, place):
                return True
            means = intention.stack[place]
            trigger = FAILURE_OF.get(means.event.trigger)
            if trigger is None:
                continue
            if self._post_failure(intention, means.event, trigger, place, annots):
                return True
        return False

    def _ends_branch(self, intention: Intention, place: int) -> bool:
        """End a branch of `a ||| b` in the plan at this place if other branches still run. Return False otherwise."""
        branch: Intention | Fork = intention
        fork = intention.fork
        while fork is not None and place < fork.height:
            if not fork.wait_for_all and len(fork.branches) > 1:
                fork.branches.remove(branch)
                for each in branch.intentions() if isinstance(branch, Fork) else [branch]:
                    self.intention_base.drop_branch(each)
                return True
            branch, fork = fork, fork.outer
        return False

    def _post_failure(
        self, intention: Intention | None, goal: Event, trigger: Trigger, place: int, annots: tuple[Term, ...]
    ) -> bool:
        agent = self.agent
        options = agent.library.options(trigger, goal.key)
        if agent.scopes is not None and intention is not None:
            literal = literal_of(goal.key, resolve_all(goal.args), (*goal.annots, *annots))
            options = agent.scopes.options(intention.stack[:place], trigger, literal) or options
        if not options:
            return False
        for _, inner in goal.returns:
            inner.ref = None  # what the failed plan found out does not count
        args = resolve_all(goal.args)
        event = FailureEvent(trigger, goal.key, args, (*goal.annots, *annots), options, intention, goal.returns)
        event.under, event.of_atomic = place, False
        if intention is None:
            agent.events.append(event)
        else:
            self.event_queue.wait_for_event(intention, event)
        if agent.waiters:
            self.event_queue.tell_waiters(trigger, event.literal)
        if agent.goal_states is not None:
            for means in intention.stack[: place - 1 if place else None : -1] if intention is not None else ():
                agent.goal_states.failed(means.event, _error_of(annots), intention)
            agent.goal_states.failed(goal, _error_of(annots), intention)
        return True

    # ---- a failed goal -----------------------------------------------------------------------------------------------

    def fail_event(self, event: Event) -> None:
        """A goal that no plan is for, or none whose context holds."""
        if event.trigger in META:
            return  # no intention waits for a meta event
        known = bool(relevant(event.options, event.literal))
        error = "no_applicable" if known else "no_relevant"
        problem = "no plan has a context that holds" if known else "there is no plan"
        self.give_up_event(event, StepFailed(error, f"{problem} for {event}"))

    def give_up_event(self, event: Event, failure: StepFailed) -> None:
        """A goal that is no event any more fails."""
        trigger = FAILURE_OF.get(event.trigger)
        intention = event.intention
        height = len(intention.stack) if intention is not None else 0
        annots = event.annots
        if trigger is None:  # the plan for a failure does not apply: no other is tried
            failure = _first_failure(annots)
        else:
            last = None if intention is None else intention.last
            annots = _failure_annots(failure, str(event), _place_of_step(last))
            if self._post_failure(intention, event, trigger, height, annots):
                return
        if self.agent.goal_states is not None:
            self.agent.goal_states.given_up(event, atom(failure.error), intention)
        if intention is None:
            self.output.report(GoalFailure(_named(event), failure.error, failure.message))
        elif trigger is None or not self._fail_below(intention, height, annots):
            self._give_up(intention, failure, event)

    def _give_up(self, intention: Intention, failure: StepFailed, event: Event | None = None) -> None:
        goal = intention.stack[0].event if event is None or intention.stack else event
        self.output.report(GoalFailure(_named(goal), failure.error, failure.message))
        if self.agent.goal_states is not None:
            for means in reversed(intention.stack):
                self.agent.goal_states.given_up(means.event, atom(failure.error), intention)
        self.intention_base.drop(intention)

    # ---- goals that count as reached or failed -----------------------------------------------------------------------

    def reach_goal(self, intention: Intention, is_goal: Callable[[Means], bool]) -> None:
        """The lowest goal like this counts as reached: what was done for it is dropped."""
        place = _place_of(intention, is_goal)
        if place is None:
            return
        turn = self.agent.running.index(intention) if intention in self.agent.running else None
        self._leave_goals_above(intention, place)
        reached = intention.stack[place]
        reached.step, reached.loops = None, ()
        if self.intention_base.clear_finished(intention, reached) and intention is not self.agent.current:
            self.intention_base.make_ready(intention)
            if turn is not None:  # it keeps its turn
                self.agent.running.insert(turn, self.agent.running.pop())

    def reach_event(self, event: Event) -> None:
        """A goal that has no plan yet counts as reached."""
        if self.agent.goal_states is not None:
            self.agent.goal_states.event_achieved(event)
        self._take_event(event)
        if event.intention is not None:
            self.intention_base.go_on(event.intention)

    def give_up_waiting(self, event: Event, failure: StepFailed) -> None:
        """A goal that has no plan yet counts as failed."""
        self._take_event(event)
        self.give_up_event(event, failure)

    def _take_event(self, event: Event) -> None:
        if event.intention is not None:
            self.intention_base.interrupt(event.intention)
        else:
            (self.agent.suspended_events if event in self.agent.suspended_events else self.agent.events).remove(event)

    def give_up_goal(self, intention: Intention, is_goal: Callable[[Means], bool], failure: StepFailed) -> None:
        """The lowest goal like this counts as failed."""
        place = _place_of(intention, is_goal)
        if place is None:
            return
        self._leave_goals_above(intention, place)
        self.intention_base.end_atomic(intention, place)  # it fails from outside, and holds the agent no longer
        self.fail(intention, failure)

    def _leave_goals_above(self, intention: Intention, place: int) -> None:
        self.intention_base.interrupt(intention)
        if self.agent.goal_states is not None:
            self.agent.goal_states.dropped(intention, place + 1)
        del intention.stack[place + 1 :]
        self.intention_base.leave_forks(intention, place)
        self.intention_base.end_atomic(intention)


def _named(event: Event) -> str:
    """The goal as it was wanted, also where it is the plan for its failure that failed: `+!g`, not `-!g`."""
    wanted = WANTED.get(event.trigger)
    return str(event) if wanted is None else f"{wanted}{str(event).removeprefix(str(event.trigger))}"


def _place_of(intention: Intention, is_goal: Callable[[Means], bool]) -> int | None:
    return next((place for place, means in enumerate(intention.stack) if is_goal(means)), None)


def _code_of(step: Step) -> str:
    """Return the text of a step; of a compound step, such as `if`, all of it."""
    return show(step.source.term) if hasattr(step.source, "term") else str(step.source)


def _place_of_step(step: Step | None) -> Place | None:
    return None if step is None else getattr(step.source, "place", None)


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


def _first_failure(annots: tuple[Term, ...]) -> StepFailed:
    """Return the failure that an event reports."""
    message = next(each.args[0] for each in annots if type(each) is Structure and each.predicate is ERROR_MESSAGE)
    return StepFailed(show(_error_of(annots)), text_of(message))


def _error_of(annots: tuple[Term, ...]) -> Term:
    return next(each.args[0] for each in annots if type(each) is Structure and each.predicate is ERROR)


def _failure_annots(failure: StepFailed, code: str, place: Place | None) -> tuple[Term, ...]:
    """error(E), error_msg(M), what the failure adds, and where it happened."""
    annots = (structure("error", atom(failure.error)), structure("error_msg", String(failure.message)))
    where = (
        structure("code", String(code)),
        structure("code_src", String(place.source if place else "")),
        structure("code_line", place.line if place else 0),
    )
    said = [annot.predicate for annot in failure.annots if type(annot) is Structure]  # by .fail(error_msg("…"))
    return (*failure.annots, *[annot for annot in annots if annot.predicate not in said], *where)
