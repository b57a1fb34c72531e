"""Percepts, and the passing of time: waits and deadlines that are over."""

from heapq import heappop

from bdi.debug.trace import Changed
from bdi.language.terms import atom
from bdi.language.unify import undo
from bdi.model.intentions import NOT_WORKED_OUT, Event, State, StepFailed
from bdi.model.waiting import Waiter
from bdi.reasoning.circumstance import Circumstance
from bdi.reasoning.deadlines import DeadlineWatch
from bdi.reasoning.event_queue import EventQueue
from bdi.reasoning.intention_base import IntentionBase
from bdi.reasoning.message_handling import MessageHandling
from bdi.reasoning.output import Output
from bdi.reasoning.percepts import Change
from bdi.reasoning.recovery import Recovery


class Sensing:
    """Takes in percepts and the passing of time."""

    __slots__ = ("agent", "deadline_watch", "event_queue", "intention_base", "message_handling", "output", "recovery")

    def __init__(
        self,
        agent: Circumstance,
        output: Output,
        event_queue: EventQueue,
        intention_base: IntentionBase,
        recovery: Recovery,
        deadline_watch: DeadlineWatch,
        message_handling: MessageHandling,
    ) -> None:
        self.agent = agent
        self.output = output
        self.event_queue = event_queue
        self.intention_base = intention_base
        self.recovery = recovery
        self.deadline_watch = deadline_watch
        self.message_handling = message_handling

    def perceive(self, change: Change) -> None:
        """Believe what is perceived now, forget what no longer is: deletions, then additions, with events as `notice`
        has them."""
        agent = self.agent
        agent.percepts.now, gone, new = change
        queue, attentive, watched = agent.events, agent.attentive, self.output.listeners or agent.waiters
        for percept in gone:
            if percept.vanish():
                event = percept.removed
                if attentive or event.options:
                    queue.append(event)
                if watched:
                    self._tell_of(event)
        lenient = attentive or agent.atomic is None
        for percept in new:
            if percept.appear():
                event = percept.added
                if lenient or event.options:
                    queue.append(event)
                if watched:
                    self._tell_of(event)

    def _tell_of(self, event: Event) -> None:
        """Notify listeners and waiters of an event."""
        if self.output.listeners:
            self.output.trace(Changed(self.agent.cycles, event.trigger, event.literal))
        if self.agent.waiters:
            self.event_queue.tell_waiters(event.trigger, event.literal)

    def wake(self) -> None:
        """Continue intentions whose wait is over; fail those that are too late."""
        agent = self.agent
        while agent.timers and agent.timers[0][0] <= agent.now:
            _, _, intention = heappop(agent.timers)
            if intention.state is State.TIME and isinstance(intention.waits_for, float):
                self.intention_base.go_on(intention)
        for waiter in list(agent.waiters):
            self._check_waiter(waiter)
        for message_id, (intention, pattern, deadline_s, _) in list(agent.asked.items()):
            if deadline_s is not None and agent.now >= deadline_s:
                del agent.asked[message_id]
                self.message_handling.take_answer(intention, pattern, atom("timeout"))
        if agent.deadlines:
            self.deadline_watch.check()
        agent.watches_clock = bool(agent.timers or agent.waiters or agent.asked or agent.deadlines)

    def _check_waiter(self, waiter: Waiter) -> None:
        try:
            verdict = waiter.check(self.agent)
        except NOT_WORKED_OUT as problem:
            undo(self.agent.logic.trail, 0)
            self.agent.waiters.remove(waiter)
            self.recovery.fail(
                waiter.intention, StepFailed("wait_failed", f"{waiter.what} cannot be worked out: {problem}")
            )
            return
        if verdict is not None:
            self.agent.waiters.remove(waiter)
            self._finish_waiting(waiter, verdict)

    def _finish_waiting(self, waiter: Waiter, in_time: bool) -> None:
        if waiter.intention.number not in self.agent.intentions:
            return
        if in_time or waiter.elapsed is not None:
            waiter.tell_elapsed(self.agent)
            self.intention_base.go_on(waiter.intention)
        else:
            self.recovery.fail(waiter.intention, StepFailed("wait_timeout", f"{waiter.what} did not happen in time"))
