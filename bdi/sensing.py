"""What comes in: percepts, messages, news of actions, and the moments that somebody waits for."""

from collections import deque
from collections.abc import Iterable
from heapq import heappop
from typing import Any, NamedTuple

from bdi.beliefs import PERCEPT
from bdi.doing import Doing
from bdi.errors import UnknownActionId, UnknownPerformative
from bdi.intentions import NOT_WORKED_OUT, Intention, State, StepFailed
from bdi.messages import Finished, Message
from bdi.parser import literal_from, term_from
from bdi.percepts import REMEMBERED_TEXTS, Change, Percepts
from bdi.performatives import PERFORMATIVES
from bdi.terms import Literal, Term, atom, show
from bdi.unify import is_ground, undo, unify
from bdi.waiting import Waiter

FROM_PERCEPT = (PERCEPT,)


class Letter(NamedTuple):
    """A message that has been read: `content` is what its performative takes."""

    message: Message
    content: Any


class Sensing(Doing):
    """An agent that perceives and is told."""

    def __init__(self, name: str, actions: Iterable[str] | None, random_seed: int | None) -> None:
        super().__init__(name, actions, random_seed)
        self.percepts = Percepts(self)
        self._mailbox: deque[Letter] = deque()
        self._read: dict[str, Literal] = {}

    # ---- the door: whatever is wrong is refused here, before anything changes --------------------------------------

    def read(self, message: Message) -> Letter:
        """Raises UnknownPerformative, AgentSpeakSyntaxError, NotALiteral."""
        if message.reply_to:
            return Letter(message, term_from(message.content))
        performative = PERFORMATIVES.get(message.performative)
        if performative is None:
            raise UnknownPerformative(message.performative)
        return Letter(message, performative.read(self, message.content))

    def literal_of(self, content: Term | str) -> Literal:
        """What a message is about. Text without variables is remembered."""
        if type(content) is not str:
            return literal_from(content)
        literal = self._read.get(content)
        if literal is None:
            literal = literal_from(content)
            if len(self._read) >= REMEMBERED_TEXTS:
                self._read.clear()
            if is_ground(literal):
                self._read[content] = literal
        return literal

    def started(self, finished: Finished) -> Finished:
        """News of an action that was started. Raises UnknownActionId."""
        if not 0 < finished.id <= self._last_action:
            raise UnknownActionId(f"action {finished.id} was never started by {self.name}")
        return finished

    # ---- percepts --------------------------------------------------------------------------------------------------

    def perceive(self, change: Change) -> None:
        """Believe what is perceived now, forget what no longer is: deletions, then additions."""
        self.percepts.now, gone, new = change
        events = []
        for percept in gone:
            if percept.relation.take_back(percept.literal.args, FROM_PERCEPT):
                events.append(percept.removed)
        for percept in new:
            if percept.relation.add(percept.literal.args, percept.annots):
                events.append(percept.added)
        self.notice_events(events)

    def plans_changed(self) -> None:
        self.percepts.forget_plans()

    # ---- messages --------------------------------------------------------------------------------------------------

    def process_message(self, letter: Letter) -> None:
        """One message of another agent."""
        message, content = letter
        if message.reply_to:
            self._process_answer(message.reply_to, content)
        else:
            PERFORMATIVES[message.performative].obey(self, message, content)

    def _process_answer(self, question: str, answer: Term) -> None:
        asked = self._asked.pop(question, None)
        if asked is None:
            return  # the question was dropped meanwhile
        intention, pattern, _ = asked
        if intention.number in self.intentions:
            self._take_answer(intention, pattern, answer)

    def _take_answer(self, intention: Intention, pattern: Term, answer: Term) -> None:
        if unify(pattern, answer, self.logic.trail):
            self.logic.trail.clear()
            self._go_on(intention)
        else:
            undo(self.logic.trail, 0)
            self.fail(intention, StepFailed("ask_failed", f"the answer is {show(answer)}, not {show(pattern)}"))

    # ---- time ------------------------------------------------------------------------------------------------------

    def wake(self) -> None:
        """Intentions whose `.wait` is over go on."""
        while self.timers and self.timers[0][0] <= self.now:
            _, _, intention = heappop(self.timers)
            if intention.state is State.TIME and isinstance(intention.waits_for, float):
                self._go_on(intention)
        for waiter in list(self.waiters):
            self._check_waiter(waiter)
        for message_id, (intention, pattern, deadline_s) in list(self._asked.items()):
            if deadline_s is not None and self.now >= deadline_s:
                del self._asked[message_id]
                self._take_answer(intention, pattern, atom("timeout"))

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
        if in_time or waiter.quiet:
            self._go_on(waiter.intention)
        else:
            self.fail(waiter.intention, StepFailed("wait_timeout", f"{waiter.what} did not happen in time"))
