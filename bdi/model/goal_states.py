"""Meta events: `^!g[state(S)]` is raised when the state of a goal changes, for plans such as

    ^!charge[state(executing)] <- .suspend(move).
    ^!charge[state(finished)]  <- .resume(move).

| state | when | reason |
|---|---|---|
| pending | the goal is an event | |
| executing | a plan was chosen; what it waited for is here | |
| waiting | for an action, a moment, an event, an answer | `drive(uc)`, `wait(W)[time(MS)]`, `ask(ID)` |
| suspended, resumed | by `.suspend` and `.resume` | |
| achieved | its plan is done, or `.succeed_goal` | |
| failed | its plan failed, or there is none | the error |
| dropped | `.drop_intention` and the like | |
| late | the time of its `soft_deadline` is over | `soft_deadline(MS)` |
| finished | last of all, however it ended | `achieved`, `unachieved` (it failed), `dropped` |

The reason is an annotation of the state: `state(failed)[reason(no_relevant)]`. Goals that a meta plan itself pursues
raise nothing, so that `^!G <- !log(G)` does not run for ever; a goal that it starts apart (`!!log`) does.
"""

from collections import deque
from typing import Protocol
from weakref import WeakSet

from bdi.language.syntax import Plan, Trigger
from bdi.language.terms import Structure, Term, atom, predicate, structure
from bdi.model.intentions import GOALS, Event, Intention, Means
from bdi.model.plans import Library, relevant

META_OF = {
    Trigger.GOAL_ADDED: Trigger.GOAL_STATE,
    Trigger.GOAL_FAILED: Trigger.GOAL_STATE,
    Trigger.TEST_ADDED: Trigger.TEST_STATE,
    Trigger.TEST_FAILED: Trigger.TEST_STATE,
}
META = frozenset(META_OF.values())
STATE = predicate("state", 1)


class HasPlans(Protocol):
    """An agent, as far as raising an event goes."""

    library: Library
    events: deque[Event]


def is_meta(plan: Plan) -> bool:
    return plan.trigger in META


def raise_state(mind: HasPlans, goal: Event, state: str, reason: Term | None = None) -> None:
    """The meta event, if some plan is about it; it goes before events of any other kind."""
    trigger = META_OF[goal.trigger]
    options = mind.library.options(trigger, goal.key)
    if not options:
        return
    why = () if reason is None else (structure("reason", reason),)
    literal = goal.literal
    annots = (*literal.annots, Structure(STATE, (atom(state),), why))
    event = Event(trigger, goal.key, literal.args, annots, options)
    if relevant(options, event.literal):
        events = mind.events
        place = next((place for place, other in enumerate(events) if other.trigger not in META), len(events))
        events.insert(place, event)


class GoalStates:
    """Tells the states of goals; an agent has one once it has a plan about them."""

    def __init__(self, mind: HasPlans) -> None:
        self._mind = mind
        self._failed: WeakSet[Event] = WeakSet()
        self._over: WeakSet[Event] = WeakSet()

    def tell(self, goal: Event, state: str, reason: Term | None = None, intention: Intention | None = None) -> None:
        if goal.trigger in GOALS and not _is_of_meta_plan(intention or goal.intention):
            raise_state(self._mind, goal, state, reason)

    def tell_all(self, intention: Intention, state: str, reason: Term | None = None) -> None:
        """Report a state of all goals of the intention, the innermost first."""
        for means in reversed(intention.stack):
            self.tell(means.event, state, reason, intention)

    def achieved(self, means: Means, intention: Intention) -> None:
        """Report that the plan for a goal is done; if it was that for its failure, the goal is not achieved."""
        if means.event.trigger in (Trigger.GOAL_ADDED, Trigger.TEST_ADDED):
            self._end(means.event, "achieved", "achieved", intention)
        elif means.event not in self._over:
            self._over.add(means.event)
            self.tell(means.event, "finished", atom("unachieved"), intention)

    def dropped(self, intention: Intention, above: int = 0) -> None:
        """The goals from this height on."""
        for means in reversed(intention.stack[above:]):
            self._end(means.event, "dropped", "dropped", intention)

    def left(self, intention: Intention, above: int) -> None:
        """The goals from this height on are over, for a plan takes care of the failure of the one below."""
        for means in reversed(intention.stack[above:]):
            self.given_up(means.event, atom("unachieved"), intention)

    def event_achieved(self, event: Event) -> None:
        self._end(event, "achieved", "achieved", event.intention)

    def event_dropped(self, event: Event) -> None:
        self._end(event, "dropped", "dropped", event.intention)

    def failed(self, goal: Event, error: Term, intention: Intention | None) -> None:
        """Report that a goal failed; a plan may handle it."""
        if goal not in self._failed and goal not in self._over:
            self._failed.add(goal)
            if goal.trigger in (Trigger.GOAL_ADDED, Trigger.TEST_ADDED):
                self.tell(goal, "failed", error, intention)

    def given_up(self, goal: Event, error: Term, intention: Intention | None) -> None:
        """Report that a goal failed and no plan handles the failure."""
        self.failed(goal, error, intention)
        if goal not in self._over:
            self._over.add(goal)
            self.tell(goal, "finished", atom("unachieved"), intention)

    def _end(self, goal: Event, state: str, result: str, intention: Intention | None) -> None:
        if goal in self._over:
            return
        self._over.add(goal)
        self.tell(goal, state, None, intention)
        self.tell(goal, "finished", atom(result), intention)


def _is_of_meta_plan(intention: Intention | None) -> bool:
    return intention is not None and bool(intention.stack) and intention.stack[0].event.trigger in META
