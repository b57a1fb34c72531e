"""What comes in beside messages: percepts, news of actions, and the moments that somebody waits for."""

from collections.abc import Iterable
from heapq import heappop

from bdi.debug.trace import Changed
from bdi.language.errors import UnknownActionId
from bdi.language.terms import atom
from bdi.language.unify import undo
from bdi.model.intentions import NOT_WORKED_OUT, Event, State, StepFailed
from bdi.model.messages import Finished
from bdi.model.waiting import Waiter
from bdi.reasoning.message_handling import Hearing
from bdi.reasoning.percepts import Change, Percepts


class Sensing(Hearing):
    """An agent that perceives, and knows the time."""

    __slots__ = ("percepts",)

    def __init__(self, name: str, actions: Iterable[str] | None, random_seed: int | None) -> None:
        super().__init__(name, actions, random_seed)
        self.percepts = Percepts(self)

    def started(self, finished: Iterable[Finished]) -> list[Finished]:
        """News of actions that were started. Raises UnknownActionId."""
        news = list(finished)
        for each in news:
            if not 0 < each.id <= self._last_action:
                raise UnknownActionId(f"action {each.id} was never started by {self.name}")
        return news

    # ---- percepts --------------------------------------------------------------------------------------------------

    def perceive(self, change: Change) -> None:
        """Believe what is perceived now, forget what no longer is: deletions, then additions, with events as `notice`
        has them."""
        self.percepts.now, gone, new = change
        queue, attentive, watched = self.events, self.attentive, self._listeners or self.waiters
        for percept in gone:
            if percept.vanish():
                event = percept.removed
                if attentive or event.options:
                    queue.append(event)
                if watched:
                    self._tell_of(event)
        lenient = attentive or self.atomic is None
        for percept in new:
            if percept.appear():
                event = percept.added
                if lenient or event.options:
                    queue.append(event)
                if watched:
                    self._tell_of(event)

    def _tell_of(self, event: Event) -> None:
        """Those who listen or wait."""
        if self._listeners:
            self._trace(Changed(self.cycles, event.trigger, event.literal))
        if self.waiters:
            self._tell_waiters(event.trigger, event.literal)

    def plans_changed(self) -> None:
        self.percepts.forget_plans()

    # ---- time ------------------------------------------------------------------------------------------------------

    def wake(self) -> None:
        """What waited for a moment goes on; what is too late fails."""
        while self.timers and self.timers[0][0] <= self.now:
            _, _, intention = heappop(self.timers)
            if intention.state is State.TIME and isinstance(intention.waits_for, float):
                self._go_on(intention)
        for waiter in list(self.waiters):
            self._check_waiter(waiter)
        for message_id, (intention, pattern, deadline_s, _) in list(self._asked.items()):
            if deadline_s is not None and self.now >= deadline_s:
                del self._asked[message_id]
                self._take_answer(intention, pattern, atom("timeout"))
        if self.deadlines:
            self.check_deadlines()
        self.watches_clock = bool(self.timers or self.waiters or self._asked or self.deadlines)

    def _check_waiter(self, waiter: Waiter) -> None:
        try:
            verdict = waiter.check(self)
        except NOT_WORKED_OUT as problem:
            undo(self.logic.trail, 0)
            self.waiters.remove(waiter)
            self.fail(waiter.intention, StepFailed("wait_failed", f"{waiter.what} cannot be worked out: {problem}"))
            return
        if verdict is not None:
            self.waiters.remove(waiter)
            self._finish_waiting(waiter, verdict)

    def _finish_waiting(self, waiter: Waiter, in_time: bool) -> None:
        if waiter.intention.number not in self.intentions:
            return
        if in_time or waiter.elapsed is not None:
            waiter.tell_elapsed(self)
            self._go_on(waiter.intention)
        else:
            self.fail(waiter.intention, StepFailed("wait_timeout", f"{waiter.what} did not happen in time"))
