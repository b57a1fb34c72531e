"""What an agent has at one moment: beliefs, plans, events, intentions, and what it is about to tell the outside."""

import random
from collections import deque
from collections.abc import Callable, Iterable
from typing import Any

from bdi.beliefs import Beliefs
from bdi.builtin import find_builtin
from bdi.intentions import RUNNING, WAITS_FOR_EVENT, Event, Fork, Intention, State
from bdi.logic import Builtin, Logic
from bdi.messages import Finished, Message
from bdi.outcome import Action, GoalFailure, Outcome
from bdi.plans import Library, Options, relevant
from bdi.syntax import BELIEF_ADDED, Plan, Trigger
from bdi.terms import Literal, Term
from bdi.trace import Failed, TraceEntry
from bdi.unify import resolve
from bdi.waiting import Waiter


class Circumstance:
    """The state of an agent, with the changes that keep it consistent."""

    library: Library

    def __init__(self, name: str, actions: Iterable[str] | None, random_seed: int | None) -> None:
        self.name = name
        self.now = 0.0
        self.cycles = 0
        self.random = random.Random(random_seed)
        self.known_actions = None if actions is None else frozenset(actions)
        self.beliefs = Beliefs()
        self.logic = Logic(self.beliefs, self.builtin)
        self.events: deque[Event] = deque()
        self.intentions: dict[int, Intention] = {}
        self.running: deque[Intention] = deque()
        self.atomic: Intention | None = None
        self.current: Intention | None = None  # whose step is being taken
        self.selected: Intention | None = None  # whose turn this cycle was
        self.timers: list[tuple[float, int, Intention]] = []
        self.waiters: list[Waiter] = []
        self._builtins: dict[Any, Builtin | None] = {}
        self._feedback: deque[Finished] = deque()
        self._pending: dict[int, Intention] = {}  # by the action that each waits for
        self._asked: dict[str, tuple[Intention, Term, float | None]] = {}  # by message id: who, pattern, deadline
        self._last_action = 0
        self._last_intention = 0
        self._last_message = 0
        self._listeners: list[Callable[[TraceEntry], None]] = []
        self._reset_outcome()

    def builtin(self, key: Any) -> Builtin | None:
        """The internal action or function filed under this predicate, bound to this agent."""
        if key not in self._builtins:
            self._builtins[key] = find_builtin(key, self)
        return self._builtins[key]

    # ---- intentions ------------------------------------------------------------------------------------------------

    def _new_intention(self) -> Intention:
        self._last_intention += 1
        intention = self.intentions[self._last_intention] = Intention(self._last_intention)
        return intention

    def _resume(self, intention: Intention) -> None:
        """It can go on; unless somebody suspended it."""
        intention.state = RUNNING
        intention.waits_for = None
        if not intention.held:
            self.running.append(intention)

    def _go_on(self, intention: Intention) -> None:
        """What it waited for is here: on with the next step, or back to the plan below."""
        intention.state = RUNNING
        intention.waits_for = None
        if self.clear_finished(intention):
            self._resume(intention)

    def clear_finished(self, intention: Intention) -> bool:
        """Leave finished plans; their goals are reached, their answers go to the caller. False: all is done."""
        stack = intention.stack
        while stack and stack[-1].step is None:
            means = stack.pop()
            for outer, inner in means.event.returns:
                value = resolve(inner)
                if value is not outer and outer.ref is None:
                    outer.ref = value
            if means.plan.atomic:
                self._end_atomic(intention)
        if stack:
            return True
        self._end(intention)
        return False

    def _end_atomic(self, intention: Intention) -> None:
        intention.atomic = any(means.plan.atomic for means in intention.stack)
        if self.atomic is intention and not intention.atomic:
            self.atomic = None

    def _end(self, intention: Intention) -> None:
        intention.state = State.DONE
        self.intentions.pop(intention.number, None)
        if self.atomic is intention:
            self.atomic = None

    # ---- dropping and suspending -----------------------------------------------------------------------------------

    def drop(self, intention: Intention) -> None:
        """The intention is over; its started action is cancelled."""
        self._withdraw(intention)
        if self.events:
            self.events = deque(event for event in self.events if event.intention is not intention)
        intention.stack.clear()
        self._end(intention)

    def _withdraw(self, intention: Intention) -> None:
        """Whatever the intention waited for, it does no longer."""
        if intention.action is not None:
            self._pending.pop(intention.action, None)
            self._cancelled.append(intention.action)
            self._reported = True
            intention.action = None
        if intention in self.running:
            self.running.remove(intention)
        if self.waiters:
            self.waiters = [waiter for waiter in self.waiters if waiter.intention is not intention]
        if self._asked:
            self._asked = {key: asked for key, asked in self._asked.items() if asked[0] is not intention}

    def _interrupt(self, intention: Intention) -> None:
        """Nothing that it waits for matters any more."""
        self._withdraw(intention)
        self.events = deque(event for event in self.events if event.intention is not intention)
        intention.state = RUNNING

    def _drop_branches(self, fork: Fork) -> None:
        for branch in fork.branches:
            self.drop(branch)
        fork.branches = []

    def _unwind(self, intention: Intention, height: int) -> None:
        """Take the failed plans off the stack, and the branches that belong to them."""
        del intention.stack[height:]
        while intention.fork is not None and height < intention.fork.height:
            fork = intention.fork
            if intention in fork.branches:
                fork.branches.remove(intention)
            self._drop_branches(fork)
            intention.fork = fork.outer
        self._end_atomic(intention)

    def hold(self, intention: Intention) -> None:
        """It takes no more steps; what it waits for may still come in."""
        intention.held = True
        if intention in self.running:
            self.running.remove(intention)

    def release(self, intention: Intention) -> None:
        if intention.held:
            intention.held = False
            if intention.state is RUNNING:
                self.running.append(intention)

    # ---- events and plans ------------------------------------------------------------------------------------------

    def _wait_for_event(self, intention: Intention, event: Event) -> None:
        intention.state = WAITS_FOR_EVENT
        self.events.append(event)

    def notice(self, trigger: Trigger, literal: Literal) -> None:
        """An event of the world."""
        self.notice_events([Event(trigger, literal, self.relevant_plans(trigger, literal))])

    def notice_events(self, events: Iterable[Event]) -> None:
        """What came to be has its turn even if no plan is about it yet: one may be told by then. (Not while an atomic
        plan holds the agent: nobody would take it away.) What ceased to be has none."""
        lenient = self.atomic is None
        for event in events:
            if event.options or (lenient and event.trigger is BELIEF_ADDED):
                self.events.append(event)
            if self.waiters:
                self._tell_waiters(event.trigger, event.literal)

    def _tell_waiters(self, trigger: Trigger, literal: Literal) -> None:
        for waiter in self.waiters:
            waiter.notice(trigger, literal, self)

    def relevant_plans(self, trigger: Trigger, literal: Literal) -> Options:
        return relevant(self.library.options(trigger, literal.predicate), literal)

    def add_plan(self, plan: Plan, first: bool = False) -> None:
        """.add_plan, tellHow"""
        self.library.add(plan, first)
        self.plans_changed()

    def remove_plan(self, label: str) -> bool:
        """Whether there was one with this label."""
        self.plans_changed()
        return self.library.remove(label)

    def plans_changed(self) -> None:
        """Whatever was looked up by plan must be looked up again."""

    # ---- what the outside will hear --------------------------------------------------------------------------------

    def say(self, line: str) -> None:
        """.print"""
        self._printed.append(line)
        self._reported = True

    def send(self, message: Message) -> None:
        """.send"""
        self._messages.append(message)
        self._reported = True

    def new_message_id(self) -> str:
        self._last_message += 1
        return f"{self.name}-{self._last_message}"

    def _report(self, failure: GoalFailure) -> None:
        self._failures.append(failure)
        self._reported = True
        if self._listeners:
            self._trace(Failed(self.cycles, *failure))

    def _trace(self, entry: TraceEntry) -> None:
        self._entries.append(entry)
        self._reported = True
        for listener in self._listeners:
            listener(entry)

    def _reset_outcome(self) -> None:
        self._reported = False
        self._actions: list[Action] = []
        self._cancelled: list[int] = []
        self._messages: list[Message] = []
        self._printed: list[str] = []
        self._failures: list[GoalFailure] = []
        self._entries: list[TraceEntry] = []

    def _take_outcome(self) -> Outcome:
        outcome = Outcome(
            tuple(self._actions),
            tuple(self._cancelled),
            tuple(self._messages),
            tuple(self._printed),
            tuple(self._failures),
            tuple(self._entries),
        )
        self._reset_outcome()
        return outcome
