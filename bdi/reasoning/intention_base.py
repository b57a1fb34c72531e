"""The intentions of an agent: started, continued, ended, dropped, suspended."""

from collections import deque
from collections.abc import Callable
from heapq import heapify, heappush

from bdi.model.intentions import (
    RUNNING,
    Event,
    FailureEvent,
    Fork,
    Intention,
    Means,
    State,
    StepFailed,
    answered,
    branches_of,
)
from bdi.model.waiting import Moment, Waiter, reason_of
from bdi.reasoning.circumstance import Circumstance
from bdi.reasoning.output import Output


class IntentionBase:
    """Keeps the intentions of one agent consistent. `on_failure` handles a step that cannot be done: see `recovery`."""

    __slots__ = ("agent", "on_failure", "output")

    def __init__(self, agent: Circumstance, output: Output) -> None:
        self.agent = agent
        self.output = output
        self.on_failure: Callable[[Intention, StepFailed], None]

    # ---- start, go on, end -------------------------------------------------------------------------------------------

    def new_intention(self) -> Intention:
        agent = self.agent
        number = agent.last_intention = agent.last_intention + 1
        intention = agent.intentions[number] = Intention(number)
        return intention

    def make_ready(self, intention: Intention) -> None:
        """Let it take steps again, unless it is suspended."""
        intention.state = RUNNING
        intention.waits_for = None
        if not intention.suspended:
            self.agent.running.append(intention)

    def go_on(self, intention: Intention) -> None:
        """Continue with the next step, or with the plan below: the wait is over."""
        agent = self.agent
        acted = intention.state is State.ACTION
        intention.state = RUNNING
        intention.waits_for = None
        if agent.goal_states is not None and not acted:
            agent.goal_states.tell_all(intention, "executing")
        if not intention.suspended and (intention.stack[-1].step is not None or self.clear_finished(intention)):
            agent.running.append(intention)
        if agent.goal_states is not None and acted:
            agent.goal_states.tell_all(intention, "executing")

    def clear_finished(self, intention: Intention, reached: Means | None = None) -> bool:
        """Leave finished plans; their goals are reached, their answers go to the caller. A goal with a condition waits
        until it holds, unless it is the one that counts as `reached`. False: nothing is left to do now."""
        agent = self.agent
        stack, was_atomic = intention.stack, intention.atomic
        while stack and stack[-1].step is None:
            if intention.guarded and stack[-1].plan.condition is not None and stack[-1] is not reached:
                intention.state = State.CONDITION
                return False
            means = stack.pop()
            if agent.goal_states is not None:
                agent.goal_states.achieved(means, intention)
            failure = answered(means.event.returns) if means.event.returns else None
            if intention.atomic:
                self.end_atomic(intention)
            if failure is not None:
                self.on_failure(intention, failure)
                return False
        if stack:
            if was_atomic and agent.atomic is None:
                agent.atomic = intention  # after an atomic plan its intention has the next step, too
            return True
        self.end(intention)
        return False

    def end_atomic(self, intention: Intention, height: int | None = None) -> None:
        """Decide whether the plans below this height (None: all) still keep the intention atomic."""
        agent = self.agent
        intention.atomic = any(means.holds_agent for means in intention.stack[:height])
        if intention.atomic and agent.atomic is None:
            agent.atomic = intention
        if agent.atomic is intention and not intention.atomic:
            self.pass_atomic_on()

    def pass_atomic_on(self) -> None:
        """Make another atomic intention that is not suspended the current one, if there is one."""
        intentions = self.agent.intentions.values()
        self.agent.atomic = next((each for each in intentions if each.atomic and not each.suspended), None)

    def end(self, intention: Intention) -> None:
        intention.state = State.DONE
        self.agent.intentions.pop(intention.number, None)
        if self.agent.atomic is intention:
            self.pass_atomic_on()

    # ---- drop --------------------------------------------------------------------------------------------------------

    def drop(self, intention: Intention) -> None:
        """The intention is over, with all its branches; its started actions are cancelled."""
        for each in branches_of(intention):
            self.drop_branch(each)

    def drop_branch(self, intention: Intention) -> None:
        if self.agent.goal_states is not None:
            for event in (*self.agent.events, *self.agent.suspended_events):
                if event.intention is intention:
                    self.agent.goal_states.event_dropped(event)
            self.agent.goal_states.dropped(intention)
        self.withdraw(intention)
        self._forget_events(intention)
        intention.stack.clear()
        self.end(intention)

    def drop_event(self, event: Event) -> None:
        """Drop an event that has no plan yet; the intention that waits for it is dropped too."""
        if event.intention is not None:
            self.drop(event.intention)
            return
        if self.agent.goal_states is not None:
            self.agent.goal_states.event_dropped(event)
        (self.agent.suspended_events if event in self.agent.suspended_events else self.agent.events).remove(event)

    def _forget_events(self, intention: Intention) -> None:
        if self.agent.events:
            self.agent.events = deque(event for event in self.agent.events if event.intention is not intention)
        if self.agent.suspended_events:
            self.agent.suspended_events = [
                event for event in self.agent.suspended_events if event.intention is not intention
            ]

    def withdraw(self, intention: Intention) -> None:
        """End every wait of the intention; cancel its action."""
        agent = self.agent
        if intention.action is not None:
            agent.pending.pop(intention.action, None)
            if all(news.id != intention.action for news in agent.feedback):  # otherwise it is over already
                self.output.cancel(intention.action)
            intention.action = None
        if intention in agent.running:
            agent.running.remove(intention)
        if agent.timers:
            agent.timers = [timer for timer in agent.timers if timer[2] is not intention]
            heapify(agent.timers)
        if agent.waiters:
            agent.waiters = [waiter for waiter in agent.waiters if waiter.intention is not intention]
        if agent.asked:
            agent.asked = {key: asked for key, asked in agent.asked.items() if asked[0] is not intention}

    def interrupt(self, intention: Intention) -> None:
        """End every wait and suspension of the intention."""
        self.withdraw(intention)
        self._forget_events(intention)
        intention.suspended = False
        intention.state = RUNNING
        intention.waits_for = None

    def _drop_branches(self, fork: Fork) -> None:
        for branch in fork.intentions():
            self.drop_branch(branch)
        fork.branches = []

    # ---- branches and failed plans -----------------------------------------------------------------------------------

    def leave_fork(self, intention: Intention, fork: Fork) -> None:
        """Let only this branch go on, in the place of the fork."""
        fork.branches.remove(intention)
        self._drop_branches(fork)
        fork.give_place(intention)
        intention.fork = fork.outer

    def leave_forks(self, intention: Intention, height: int) -> None:
        """The plan at this height is not carried on: neither are the branches in it and above."""
        while intention.fork is not None and height < intention.fork.height:
            self.leave_fork(intention, intention.fork)

    def unwind(self, intention: Intention, failure: FailureEvent) -> None:
        """Take the failed plans off the stack, with their branches. The rescue of an atomic one is atomic, too."""
        height = failure.under
        failure.of_atomic = intention.atomic and any(means.holds_agent for means in intention.stack[height:])
        if self.agent.goal_states is not None:
            self.agent.goal_states.left(intention, height + 1)
        del intention.stack[height:]
        self.leave_forks(intention, height)
        if not failure.of_atomic:
            self.end_atomic(intention)

    # ---- wait --------------------------------------------------------------------------------------------------------

    def wait_for(self, intention: Intention, awaited: Moment | Waiter) -> None:
        """.wait"""
        intention.state = State.TIME
        intention.waits_for = awaited
        self.agent.watches_clock = True
        if isinstance(awaited, Moment):
            heappush(self.agent.timers, (awaited, intention.number, intention))
        else:
            self.agent.waiters.append(awaited)
        if self.agent.goal_states is not None:
            self.agent.goal_states.tell_all(intention, "waiting", reason_of(intention))


class Suspension:
    """Suspends goals and intentions, and resumes them."""

    __slots__ = ("agent", "intention_base")

    def __init__(self, agent: Circumstance, intention_base: IntentionBase) -> None:
        self.agent = agent
        self.intention_base = intention_base

    def suspend(self, intention: Intention) -> None:
        """Suspend: it takes no steps and no plan is chosen for it; what it waits for may still come in. A suspended
        atomic plan lets the others go on: no plan could resume it otherwise."""
        agent = self.agent
        intention.suspended = True
        intention.suspended_by = agent.current.stack[-1].plan.label if agent.current is not None else ""
        if intention in agent.running:
            agent.running.remove(intention)
        for event in [event for event in agent.events if event.intention is intention]:
            self._suspend_event(event)
        if agent.goal_states is not None:
            agent.goal_states.tell_all(intention, "suspended")
        if agent.atomic is intention:
            self.intention_base.pass_atomic_on()

    def suspend_goal(self, event: Event) -> None:
        """A goal that is still an event, and the intention that waits for it."""
        if event.intention is not None:
            self.suspend(event.intention)
        else:
            self._suspend_event(event)

    def _suspend_event(self, event: Event) -> None:
        self.agent.events.remove(event)
        self.agent.suspended_events.append(event)
        if self.agent.goal_states is not None:
            self.agent.goal_states.tell(event, "suspended")

    def resume(self, intention: Intention) -> None:
        agent = self.agent
        if not intention.suspended:
            return
        intention.suspended = False
        for event in [event for event in agent.suspended_events if event.intention is intention]:
            self._resume_event(event)
        if agent.goal_states is not None:
            agent.goal_states.tell_all(intention, "resumed")
        if intention.state is RUNNING and intention is not agent.current:
            agent.running.append(intention)
        if intention.atomic and agent.atomic is None:
            agent.atomic = intention

    def resume_goal(self, event: Event) -> None:
        if event.intention is not None:
            self.resume(event.intention)
        else:
            self._resume_event(event)

    def _resume_event(self, event: Event) -> None:
        self.agent.suspended_events.remove(event)
        self.agent.events.append(event)
        if self.agent.goal_states is not None:
            self.agent.goal_states.tell(event, "resumed")
