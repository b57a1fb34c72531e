"""The reasoning cycle.

    cycle ─ sense ──────── perceive                what the body sees: deletions, then additions
          │              └ process_message         one a cycle
          ├ deliberate ─── select_event            first in, first out
          │              ├ select_plan             relevant plans, the first applicable in source order
          │              └ add_means               on a new intention, or on the one that waits for this event
          └ act ────────── process_feedback        one finished action a cycle
                         ├ select_intention        round robin
                         └ step                    one step of one plan body

Nothing here knows a clock, a thread or a device: all comes in by `cycle` and goes out by its answer.
"""

from collections.abc import Callable, Iterable
from heapq import heappop
from typing import Any

from bdi.arithmetic import ArithmeticFailure
from bdi.beliefs import PERCEPT, SELF
from bdi.doing import Doing
from bdi.errors import AgentSpeakError, UnknownActionId, UnknownPerformative
from bdi.explain import Why, explain
from bdi.intentions import Event, Intention, Means, State, StepFailed
from bdi.loading import check_program
from bdi.logic import Frame
from bdi.messages import Finished, Message
from bdi.outcome import QUIET, Outcome
from bdi.parser import parse_literal, parse_term
from bdi.performatives import PERFORMATIVES, sourced
from bdi.plans import CompiledPlan, Compiler
from bdi.recovery import action_failure
from bdi.syntax import Belief, Program, Trigger
from bdi.terms import Atom, Literal, Structure, Term, atom, show
from bdi.trace import Deliberated, Stepped, TraceEntry
from bdi.unify import is_ground, undo, unify
from bdi.waiting import Waiter

REMEMBERED_TEXTS = 20_000  # percepts and messages given as text are parsed once; then the memory starts again
BELIEF_EVENTS = (Trigger.BELIEF_ADDED, Trigger.BELIEF_REMOVED)
FAILURE_EVENTS = (Trigger.GOAL_FAILED, Trigger.TEST_FAILED)


class _Percept:
    """A percept with everything that adding and removing it needs, looked up once."""

    __slots__ = ("annots", "literal", "on_added", "on_removed", "relation")

    def __init__(self, literal: Literal, agent: "Agent") -> None:
        self.literal = literal
        self.relation = agent.beliefs.relation(literal.predicate)
        self.annots = (*literal.annots, PERCEPT)
        self.on_added = agent.relevant_plans(Trigger.BELIEF_ADDED, literal)
        self.on_removed = agent.relevant_plans(Trigger.BELIEF_REMOVED, literal)


class Agent(Doing):
    """One AgentSpeak agent.

    `actions` declares the external actions that the body can do, as names or name/arity ("drive", "drive/1"); a plan
    with another one is then refused with UnknownAction. Without it every action is taken as known.
    """

    def __init__(
        self,
        program: Program,
        name: str = "agent",
        actions: Iterable[str] | None = None,
        random_seed: int | None = None,
    ) -> None:
        super().__init__(name, actions, random_seed)
        self.library = Compiler(self, self.logic).library
        self._percepts: frozenset[Any] = frozenset()
        self._read: dict[str, Literal] = {}
        self._notations: set[str] = set()
        self._mixed = False  # whether one percept may come written in several ways
        self._load(program)

    def _load(self, program: Program) -> None:
        check_program(program, self.known_actions)
        for plan in program.plans:
            self.library.add(plan)
        self._scoped = any(plan.subplans for plan in program.plans)
        for clause in reversed(program.beliefs):
            if isinstance(clause, Belief):
                self.believe(clause.literal, None)
            else:
                self.beliefs.relation(clause.head.predicate).add_rule(self.logic.derivation(clause))
        for goal in program.goals:
            self.achieve_apart(sourced(goal.literal, SELF))

    # ---- the cycle -------------------------------------------------------------------------------------------------

    def cycle(
        self,
        percepts: Iterable[Term | str] | None = None,
        messages: Iterable[Message] = (),
        finished: Iterable[Finished] = (),
        now: float = 0.0,
    ) -> Outcome:
        """One reasoning cycle.

        `percepts` is all that is perceived now (None: nothing new), `finished` the actions that are over since the
        last cycle, `now` a clock in seconds that never goes back. Terms may be given as text. Raises
        AgentSpeakSyntaxError for text that is none, UnknownActionId for an action that was never started.
        """
        self.now = now
        self.cycles += 1
        self.sense(percepts, messages, finished)
        if self.events:
            self.deliberate()
        self.act()
        return self._take_outcome() if self._reported else QUIET

    # ---- sense -----------------------------------------------------------------------------------------------------

    def sense(
        self, percepts: Iterable[Term | str] | None, messages: Iterable[Message], finished: Iterable[Finished]
    ) -> None:
        if percepts is not None:
            self.perceive(percepts)
        if messages:
            self._mailbox.extend(messages)
        if self._mailbox:
            self.process_message(self._mailbox.popleft())
        if finished:
            self._feedback.extend(finished)
        if self.timers or self.waiters or self._asked:
            self._wake()

    def perceive(self, percepts: Iterable[Term | str]) -> None:
        """Believe what is perceived now, forget what no longer is: deletions, then additions."""
        now = frozenset(map(self._canonical, percepts) if self._mixed else percepts)
        before = self._percepts
        if now == before:
            return
        gone = [self._percept(percept) for percept in before - now]
        new = [self._percept(percept) for percept in now - before]
        if self._mixed and any(type(percept) is str for percept in now):
            self._percepts = frozenset(map(self._canonical, before))
            self.perceive(now)
            return
        self._percepts = now
        for percept in gone:
            if percept.relation.take_back(percept.literal.args, (PERCEPT,)) and (percept.on_removed or self.waiters):
                self.notice(Trigger.BELIEF_REMOVED, percept.literal, percept.on_removed)
        for percept in new:
            if percept.relation.add(percept.literal.args, percept.annots) and (percept.on_added or self.waiters):
                self.notice(Trigger.BELIEF_ADDED, percept.literal, percept.on_added)

    def _percept(self, percept: Term | str) -> _Percept:
        """Looked up by text or term."""
        seen = self._seen.get(percept)
        if seen is None:
            if len(self._seen) >= REMEMBERED_TEXTS:
                self._seen.clear()
            literal = as_literal(percept)
            # The same percept in two notations must stay one percept: from then on terms are compared, not texts.
            notation = "term" if type(percept) is not str else "text" if show(literal) == percept else "free text"
            self._notations.add(notation)
            self._mixed = len(self._notations) > 1 or notation == "free text"
            seen = self._seen[percept] = _Percept(literal, self)
        return seen

    def _canonical(self, percept: Term | str) -> Literal:
        return self._percept(percept).literal

    def process_message(self, message: Message) -> None:
        """One message of another agent."""
        if message.reply_to:
            return self._process_answer(message)
        if message.performative not in PERFORMATIVES:
            raise UnknownPerformative(message.performative)
        return PERFORMATIVES[message.performative](self, message)

    def literal_in(self, message: Message) -> Literal:
        """What a message is about. Text without variables is remembered."""
        text = message.content
        if type(text) is not str:
            return as_literal(text)
        literal = self._read.get(text)
        if literal is None:
            literal = as_literal(text)
            if len(self._read) >= REMEMBERED_TEXTS:
                self._read.clear()
            if is_ground(literal):
                self._read[text] = literal
        return literal

    def _process_answer(self, message: Message) -> None:
        asked = self._asked.pop(message.reply_to, None)
        if asked is None:
            return  # the question was dropped meanwhile
        intention, pattern, _ = asked
        if intention.number in self.intentions:
            self._take_answer(intention, pattern, as_term(message.content))

    def _take_answer(self, intention: Intention, pattern: Term, answer: Term) -> None:
        if unify(pattern, answer, self.logic.trail):
            self.logic.trail.clear()
            self._go_on(intention)
        else:
            undo(self.logic.trail, 0)
            self.fail(intention, StepFailed("ask_failed", f"the answer is {show(answer)}, not {show(pattern)}"))

    def _wake(self) -> None:
        """Intentions whose `.wait` is over go on."""
        while self.timers and self.timers[0][0] <= self.now:
            _, _, intention = heappop(self.timers)
            if intention.state is State.TIME and isinstance(intention.waits_for, float):
                self._go_on(intention)
        for waiter in list(self.waiters):
            verdict = waiter.check(self)
            if verdict is not None:
                self.waiters.remove(waiter)
                self._finish_waiting(waiter, verdict)
        for message_id, (intention, pattern, deadline_s) in list(self._asked.items()):
            if deadline_s is not None and self.now >= deadline_s:
                del self._asked[message_id]
                self._take_answer(intention, pattern, atom("timeout"))

    def _finish_waiting(self, waiter: Waiter, in_time: bool) -> None:
        if waiter.intention.number not in self.intentions:
            return
        if in_time or waiter.quiet:
            self._go_on(waiter.intention)
        else:
            self.fail(waiter.intention, StepFailed("wait_timeout", f"{waiter.what} did not happen in time"))

    # ---- deliberate ------------------------------------------------------------------------------------------------

    def deliberate(self) -> None:
        """Answer one event; events of the world that no plan is about do not count."""
        event = self.select_event()
        while event is not None and not event.options and event.intention is None and event.trigger in BELIEF_EVENTS:
            event = self.select_event()
        if event is None:
            return
        chosen = self.select_plan(event)
        if self._listeners:
            self._trace(Deliberated(self.cycles, str(event), chosen[0].label if chosen else None, len(event.options)))
        if chosen is not None:
            self.add_means(event, *chosen)
        elif event.trigger in BELIEF_EVENTS:
            if event.intention is not None:
                self._resume(event.intention)
        else:
            self._fail_event(event)

    def select_event(self) -> Event | None:
        """First in, first out; while an atomic plan runs only its own events."""
        if self.atomic is None:
            return self.events.popleft() if self.events else None
        for event in self.events:
            if event.intention is self.atomic:
                self.events.remove(event)
                return event
        return None

    def select_plan(self, event: Event) -> tuple[CompiledPlan, Frame] | None:
        """The first plan in source order whose head and context hold, with its variables."""
        trail = self.logic.trail
        for plan in event.options:
            try:
                frame = plan.applicable(event)
            except (ArithmeticFailure, StepFailed, AgentSpeakError, RecursionError):
                frame = None  # a context that cannot be worked out does not hold
            if frame is not None:
                trail.clear()
                return plan, frame
            if trail:
                undo(trail, 0)
        return None

    def add_means(self, event: Event, plan: CompiledPlan, frame: Frame) -> None:
        """The plan becomes the top of the waiting intention, or a new intention."""
        intention = event.intention
        if intention is None:
            intention = self._new_intention()
        elif event.trigger in FAILURE_EVENTS:
            self._unwind(intention, event.under)
        elif intention.stack:
            self._forget_finished_caller(intention.stack, event)
        intention.stack.append(Means(plan, frame, event))
        if plan.atomic:
            intention.atomic = True
            self.atomic = intention
        if plan.condition is not None:
            intention.guarded = True
        self._resume(intention)

    def _forget_finished_caller(self, stack: list[Means], event: Event) -> None:
        """Tail recursion does not grow the stack: a plan whose last step is its own goal again makes room."""
        top = stack[-1]
        if (
            top.step is None
            and event.key is top.event.key
            and event.trigger is Trigger.GOAL_ADDED
            and top.event.trigger is Trigger.GOAL_ADDED
            and not top.plan.atomic
        ):
            stack.pop()
            event.returns += top.event.returns

    # ---- act -------------------------------------------------------------------------------------------------------

    def act(self) -> None:
        if self._feedback:
            self.process_feedback(self._feedback.popleft())
        intention = self.select_intention()
        if intention is not None:
            self.step(intention)
            if intention.state is State.RUNNING and self.clear_finished(intention) and not intention.held:
                self.running.append(intention)

    def process_feedback(self, finished: Finished) -> None:
        """An action is over: its intention goes on, or fails."""
        if not 0 < finished.id <= self._last_action:
            raise UnknownActionId(f"action {finished.id} was never started by {self.name}")
        intention = self._pending.pop(finished.id, None)
        if intention is None:
            return  # it was cancelled, and ended before the body heard of it
        intention.action = None
        if finished.failure is not None:
            self.fail(intention, action_failure(finished))
            return
        self._go_on(intention)

    def select_intention(self) -> Intention | None:
        """Round robin; an atomic plan runs alone."""
        if self.atomic is None:
            return self.running.popleft() if self.running else None
        if self.atomic in self.running:
            self.running.remove(self.atomic)
            return self.atomic
        return None

    def step(self, intention: Intention) -> None:
        """The next step of the top plan."""
        if intention.guarded:
            self._leave_reached_goals(intention)
        means = intention.stack[-1]
        step = means.step
        if step is None:
            return  # leaving a finished plan takes the cycle
        means.step = step.next
        self.current = intention
        if self._listeners:
            self._trace(Stepped(self.cycles, intention.number, str(step.source)))
        try:
            step.run(intention, means)
        except StepFailed as failure:
            self.fail(intention, failure, step)
        except ArithmeticFailure as failure:
            self.fail(intention, StepFailed("arithmetic", str(failure)), step)
        except AgentSpeakError as failure:  # text that an internal action was to read
            self.fail(intention, StepFailed("wrong_arguments", str(failure)), step)
        except RecursionError:
            self.fail(intention, StepFailed("recursion", f"{step.source} goes too deep"), step)
        finally:
            self.current = None

    def _leave_reached_goals(self, intention: Intention) -> None:
        """`+!g <: condition`: once the condition holds, the goal counts as reached."""
        for height, means in enumerate(intention.stack):
            condition = means.plan.condition
            if condition is not None and condition(means.frame):
                del intention.stack[height + 1 :]
                means.step = None
                return

    # ---- looking in ------------------------------------------------------------------------------------------------

    def ask(self, formula: Term | str) -> list[dict[str, Term]]:
        """All answers to a formula over the beliefs, each as name → value."""
        return self.logic.query(as_term(formula))

    def believes(self, formula: Term | str) -> bool:
        return bool(self.ask(formula))

    @property
    def idle(self) -> bool:
        """Whether nothing is left to do until something comes in: no percept, message or news of an action is due,
        and no wait has an end."""
        waits = [waiter.deadline_s for waiter in self.waiters] + [asked[2] for asked in self._asked.values()]
        busy = self.events or self.running or self._mailbox or self._feedback or self._pending or self.timers
        return not busy and all(deadline_s is None for deadline_s in waits)

    def listen(self, callback: Callable[[TraceEntry], None]) -> None:
        """Call this for everything that is chosen, and fill `outcome.trace`. Costs time only from here on."""
        self._listeners.append(callback)

    def why(self, goal: Term | str) -> Why:
        """Why a goal is not reached yet, in words and as data."""
        return explain(self.intentions.values(), self.events, as_literal(goal))


def as_term(content: Term | str) -> Term:
    """Text is parsed, a term is itself."""
    return parse_term(content) if type(content) is str else content  # type: ignore[return-value]


def as_literal(content: Term | str) -> Literal:
    """A belief, goal or percept. Raises AgentSpeakSyntaxError for text that is none, TypeError for another term."""
    if type(content) is str:
        return parse_literal(content)
    if isinstance(content, Atom | Structure):
        return content
    raise TypeError(f"{content!r} is no literal")
