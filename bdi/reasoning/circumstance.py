"""What an agent has at one moment: beliefs, plans, events, intentions, and what it is about to tell the outside."""

import random
from collections import deque
from collections.abc import Iterable
from heapq import heapify, heappush
from typing import Any

from bdi.builtin import Table, find_builtin
from bdi.builtin.agent_state.learning import learn
from bdi.builtin.registered import Registered, key_of
from bdi.language.parser import Includes
from bdi.language.syntax import BELIEF_ADDED, Does, Function, Plan, Program, Trigger
from bdi.language.terms import Atom, Code, Literal, Term
from bdi.model.beliefs import Beliefs
from bdi.model.goal_states import GoalStates, is_meta
from bdi.model.intentions import (
    RUNNING,
    WAITS_FOR_EVENT,
    Event,
    FailureEvent,
    Fork,
    Intention,
    Means,
    State,
    Step,
    StepFailed,
    answered,
    branches_of,
    event_of,
)
from bdi.model.logic import Builtin, Logic
from bdi.model.messages import Finished
from bdi.model.plans import Library, Options, relevant
from bdi.model.society import ALONE, Asked, Society
from bdi.model.waiting import Moment, Waiter, reason_of
from bdi.reasoning.output import Telling


class Circumstance(Telling):
    """The state of an agent, with the changes that keep it consistent."""

    __slots__ = (  # more attributes than CPython finds quickly in an instance without slots
        "__weakref__",
        "_asked",
        "_builtins",
        "_feedback",
        "_last_action",
        "_last_intention",
        "_pending",
        "atomic",
        "attentive",
        "beliefs",
        "considered",
        "current",
        "events",
        "goal_states",
        "held_events",
        "includes",
        "intentions",
        "internal_actions",
        "known_actions",
        "library",
        "logic",
        "namespace_properties",
        "now",
        "program",
        "random",
        "running",
        "selected",
        "society",
        "timers",
        "waiters",
        "watches_clock",
    )
    library: Library
    program: Program

    def __init__(self, name: str, actions: Iterable[str] | None, random_seed: int | None) -> None:
        super().__init__(name)
        self.includes: Includes | None = None  # what .include may read
        self.society: Society = ALONE
        self.internal_actions: Table | None = None  # its own, beside those that all have
        self.now = 0.0
        self.random = random.Random(random_seed)
        self.known_actions = None if actions is None else frozenset(actions)
        self.beliefs = Beliefs()
        self.logic = Logic(self.beliefs, self.builtin)
        self.events: deque[Event] = deque()
        self.intentions: dict[int, Intention] = {}
        self.running: deque[Intention] = deque()
        self.atomic: Intention | None = None
        self.current: Intention | None = None  # whose step is being taken
        self.considered: Event | None = None  # what a plan is or was last chosen for
        self.selected: Intention | None = None  # whose turn this cycle was
        self.held_events: list[Event] = []  # of suspended goals and intentions
        self.timers: list[tuple[float, int, Intention]] = []
        self.waiters: list[Waiter] = []
        self.attentive = False  # whether goals have more to them: sub-plans, or plans about their states
        self.watches_clock = False  # whether somebody waits for a moment, an event, an answer, or has a deadline
        self.goal_states: GoalStates | None = None  # once some plan is about them
        self.namespace_properties: dict[Atom, dict[Term, Term]] = {}
        self._builtins: dict[Any, Builtin | None] = {}
        self._feedback: deque[Finished] = deque()
        self._pending: dict[int, Intention] = {}  # by the action that each waits for
        self._asked: dict[str, Asked] = {}  # by message id
        self._last_action = 0
        self._last_intention = 0

    def builtin(self, key: Any) -> Builtin | None:
        """The internal action or function filed under this predicate, bound to this agent."""
        if key not in self._builtins:
            self._builtins[key] = find_builtin(key, self, self.internal_actions)
        return self._builtins[key]

    def define(self, function: Function) -> None:
        """{ register_function(…) }"""
        self._builtins[key_of(function)] = Registered(self, function)

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
        acted = intention.state is State.ACTION
        intention.state = RUNNING
        intention.waits_for = None
        if self.goal_states is not None and not acted:
            self.goal_states.tell_all(intention, "executing")
        if not intention.held and (intention.stack[-1].step is not None or self.clear_finished(intention)):
            self.running.append(intention)
        if self.goal_states is not None and acted:
            self.goal_states.tell_all(intention, "executing")

    def clear_finished(self, intention: Intention, reached: Means | None = None) -> bool:
        """Leave finished plans; their goals are reached, their answers go to the caller. A goal with a condition waits
        until it holds, unless it is the one that counts as `reached`. False: nothing is left to do now."""
        stack, was_atomic = intention.stack, intention.atomic
        while stack and stack[-1].step is None:
            if intention.guarded and stack[-1].plan.condition is not None and stack[-1] is not reached:
                intention.state = State.CONDITION
                return False
            means = stack.pop()
            if self.goal_states is not None:
                self.goal_states.achieved(means, intention)
            failure = answered(means.event.returns) if means.event.returns else None
            if intention.atomic:
                self._end_atomic(intention)
            if failure is not None:
                self.fail(intention, failure)
                return False
        if stack:
            if was_atomic and self.atomic is None:
                self.atomic = intention  # after an atomic plan its intention has the next step, too
            return True
        self._end(intention)
        return False

    def fail(self, intention: Intention, failure: StepFailed, step: Step | None = None) -> None:
        """What it does cannot be done: see `recovery`."""

    def _end_atomic(self, intention: Intention, height: int | None = None) -> None:
        """Whether it holds the agent depends on what is below this height (None: on all)."""
        intention.atomic = any(means.holds_agent for means in intention.stack[:height])
        if intention.atomic and self.atomic is None:
            self.atomic = intention
        if self.atomic is intention and not intention.atomic:
            self._pass_atomic_on()

    def _pass_atomic_on(self) -> None:
        """Another branch of the same plan, or a plan resumed meanwhile, holds the agent now; or nobody."""
        intentions = self.intentions.values()
        self.atomic = next((each for each in intentions if each.atomic and not each.held), None)

    def _end(self, intention: Intention) -> None:
        intention.state = State.DONE
        self.intentions.pop(intention.number, None)
        if self.atomic is intention:
            self._pass_atomic_on()

    # ---- dropping and suspending -----------------------------------------------------------------------------------

    def drop(self, intention: Intention) -> None:
        """The intention is over, with all its branches; its started actions are cancelled."""
        for each in branches_of(intention):
            self._drop_branch(each)

    def _drop_branch(self, intention: Intention) -> None:
        if self.goal_states is not None:
            for event in (*self.events, *self.held_events):
                if event.intention is intention:
                    self.goal_states.event_dropped(event)
            self.goal_states.dropped(intention)
        self._withdraw(intention)
        self._forget_events(intention)
        intention.stack.clear()
        self._end(intention)

    def drop_event(self, event: Event) -> None:
        """It has no plan yet; the intention that waits for it is over too."""
        if event.intention is not None:
            self.drop(event.intention)
            return
        if self.goal_states is not None:
            self.goal_states.event_dropped(event)
        (self.held_events if event in self.held_events else self.events).remove(event)

    def _forget_events(self, intention: Intention) -> None:
        if self.events:
            self.events = deque(event for event in self.events if event.intention is not intention)
        if self.held_events:
            self.held_events = [event for event in self.held_events if event.intention is not intention]

    def _withdraw(self, intention: Intention) -> None:
        """Whatever the intention waited for, it does no longer."""
        if intention.action is not None:
            self._pending.pop(intention.action, None)
            if all(news.id != intention.action for news in self._feedback):  # otherwise it is over already
                self._cancelled.append(intention.action)
                self._reported = True
            intention.action = None
        if intention in self.running:
            self.running.remove(intention)
        if self.timers:
            self.timers = [timer for timer in self.timers if timer[2] is not intention]
            heapify(self.timers)
        if self.waiters:
            self.waiters = [waiter for waiter in self.waiters if waiter.intention is not intention]
        if self._asked:
            self._asked = {key: asked for key, asked in self._asked.items() if asked[0] is not intention}

    def _interrupt(self, intention: Intention) -> None:
        """Nothing that it waits for matters any more, nor that it was suspended."""
        self._withdraw(intention)
        self._forget_events(intention)
        intention.held = False
        intention.state = RUNNING
        intention.waits_for = None

    def _drop_branches(self, fork: Fork) -> None:
        for branch in fork.intentions():
            self._drop_branch(branch)
        fork.branches = []

    def _leave_fork(self, intention: Intention, fork: Fork) -> None:
        """Only this branch goes on, in the place of the fork."""
        fork.branches.remove(intention)
        self._drop_branches(fork)
        fork.give_place(intention)
        intention.fork = fork.outer

    def _leave_forks(self, intention: Intention, height: int) -> None:
        """The plan at this height is not carried on: neither are the branches in it and above."""
        while intention.fork is not None and height < intention.fork.height:
            self._leave_fork(intention, intention.fork)

    def _unwind(self, intention: Intention, failure: FailureEvent) -> None:
        """Take the failed plans off the stack, with their branches. The rescue of an atomic one is atomic, too."""
        height = failure.under
        failure.of_atomic = intention.atomic and any(means.holds_agent for means in intention.stack[height:])
        if self.goal_states is not None:
            self.goal_states.left(intention, height + 1)
        del intention.stack[height:]
        self._leave_forks(intention, height)
        if not failure.of_atomic:
            self._end_atomic(intention)

    def hold(self, intention: Intention) -> None:
        """It takes no more steps and no plan is chosen for it; what it waits for may still come in. A suspended
        atomic plan lets the others go on: nobody could resume it otherwise."""
        intention.held = True
        intention.held_by = self.current.stack[-1].plan.label if self.current is not None else ""
        if intention in self.running:
            self.running.remove(intention)
        for event in [event for event in self.events if event.intention is intention]:
            self._hold_event(event)
        if self.goal_states is not None:
            self.goal_states.tell_all(intention, "suspended")
        if self.atomic is intention:
            self._pass_atomic_on()

    def hold_goal(self, event: Event) -> None:
        """A goal that is still an event, and the intention that waits for it."""
        if event.intention is not None:
            self.hold(event.intention)
        else:
            self._hold_event(event)

    def _hold_event(self, event: Event) -> None:
        self.events.remove(event)
        self.held_events.append(event)
        if self.goal_states is not None:
            self.goal_states.tell(event, "suspended")

    def release(self, intention: Intention) -> None:
        if not intention.held:
            return
        intention.held = False
        for event in [event for event in self.held_events if event.intention is intention]:
            self._release_event(event)
        if self.goal_states is not None:
            self.goal_states.tell_all(intention, "resumed")
        if intention.state is RUNNING and intention is not self.current:
            self.running.append(intention)
        if intention.atomic and self.atomic is None:
            self.atomic = intention

    def release_goal(self, event: Event) -> None:
        if event.intention is not None:
            self.release(event.intention)
        else:
            self._release_event(event)

    def _release_event(self, event: Event) -> None:
        self.held_events.remove(event)
        self.events.append(event)
        if self.goal_states is not None:
            self.goal_states.tell(event, "resumed")

    def wait_for(self, intention: Intention, awaited: Moment | Waiter) -> None:
        """.wait"""
        intention.state = State.TIME
        intention.waits_for = awaited
        self.watches_clock = True
        if isinstance(awaited, Moment):
            heappush(self.timers, (awaited, intention.number, intention))
        else:
            self.waiters.append(awaited)
        if self.goal_states is not None:
            self.goal_states.tell_all(intention, "waiting", reason_of(intention))

    # ---- events and plans ------------------------------------------------------------------------------------------

    def _wait_for_event(self, intention: Intention, event: Event) -> None:
        intention.state = WAITS_FOR_EVENT
        (self.held_events if intention.held else self.events).append(event)

    def notice(self, trigger: Trigger, literal: Literal) -> None:
        """An event of the world. What came to be has its turn even if no plan is about it yet: one may be told by then.
        (Not while an atomic plan holds the agent: nobody would take it away.) What ceased to be has none, unless
        sub-plans may be about it."""
        event = event_of(trigger, literal, self.relevant_plans(trigger, literal))
        if event.options or self.attentive or (trigger is BELIEF_ADDED and self.atomic is None):
            self.events.append(event)
        if self.waiters:
            self._tell_waiters(trigger, literal)

    def _tell_waiters(self, trigger: Trigger, literal: Literal) -> None:
        for waiter in self.waiters:
            waiter.notice(trigger, literal, self)

    def relevant_plans(self, trigger: Trigger, literal: Literal) -> Options:
        return relevant(self.library.options(trigger, literal.predicate), literal)

    def add_plan(self, plan: Plan, first: bool = False) -> None:
        """.add_plan, tellHow"""
        self.library.add(plan, first)
        if self.goal_states is None and is_meta(plan):
            self.goal_states = GoalStates(self)
            self.attentive = True
        self.plans_changed()

    def learn(self, code: Code, does: Does) -> None:
        """+{ plan }   -{ rule }"""
        learn(self, code, does)  # type: ignore[arg-type]  # the whole agent is the Mind

    def remove_plan(self, label: str) -> bool:
        """Whether there was one with this label."""
        self.plans_changed()
        return self.library.remove(label)

    def load(self, program: Program) -> None:
        """What `.include` adds to the program."""

    def plans_changed(self) -> None:
        """Whatever was looked up by plan must be looked up again."""
