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

from collections.abc import Callable, Iterable, Sequence

from bdi.arithmetic import ArithmeticFailure
from bdi.beliefs import SELF
from bdi.errors import AgentSpeakError
from bdi.explain import Why, explain
from bdi.intentions import NOT_WORKED_OUT, RUNNING, Event, Intention, Means, StepFailed
from bdi.loading import check_program
from bdi.logic import Frame, Solve
from bdi.messages import Finished, Message
from bdi.outcome import QUIET, Outcome
from bdi.parser import literal_from, term_from
from bdi.percepts import Change
from bdi.performatives import sourced
from bdi.plans import CompiledPlan, Compiler
from bdi.recovery import action_failure
from bdi.sensing import Letter, Sensing
from bdi.syntax import BELIEF_ADDED, BELIEF_REMOVED, GOAL_ADDED, Belief, Program, Trigger
from bdi.terms import Term
from bdi.trace import Deliberated, Stepped, TraceEntry
from bdi.unify import undo

BELIEF_EVENTS = (BELIEF_ADDED, BELIEF_REMOVED)
FAILURE_EVENTS = (Trigger.GOAL_FAILED, Trigger.TEST_FAILED)


class Agent(Sensing):
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
        last cycle, `now` a clock in seconds that never goes back. Terms may be given as text.

        Raises AgentSpeakSyntaxError for text that is none, NotALiteral for a term that is none, UnknownPerformative,
        and UnknownActionId for an action that was never started. Then nothing has happened: the agent is as before.
        """
        change = None if percepts is None else self.percepts.change(percepts)
        letters = [self.read(message) for message in messages] if messages else ()
        ended = [self.started(news) for news in finished] if finished else ()
        self.now = now
        self.cycles += 1
        self.sense(change, letters, ended)
        if self.events:
            self.deliberate()
        self.act()
        return self._take_outcome() if self._reported else QUIET

    def sense(self, change: Change | None, letters: Sequence[Letter], ended: Sequence[Finished]) -> None:
        if change is not None:
            self.perceive(change)
        if letters:
            self._mailbox.extend(letters)
        if self._mailbox:
            self.process_message(self._mailbox.popleft())
        if ended:
            self._feedback.extend(ended)
        if self.timers or self.waiters or self._asked:
            self.wake()

    # ---- deliberate ------------------------------------------------------------------------------------------------

    def deliberate(self) -> None:
        """Answer one event."""
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
        """First in, first out, passing over what no plan is about; while an atomic plan runs only its own events."""
        events = self.events
        if self.atomic is None:
            while events:
                event = events.popleft()
                if event.options or event.intention is not None or event.trigger not in BELIEF_EVENTS:
                    return event
            return None
        for event in events:
            if event.intention is self.atomic:
                events.remove(event)
                return event
        return None

    def select_plan(self, event: Event) -> tuple[CompiledPlan, Frame] | None:
        """The first plan in source order whose head and context hold, with its variables."""
        trail = self.logic.trail
        for plan in event.options:
            try:
                frame = plan.applicable(event)
            except NOT_WORKED_OUT:
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
            and event.trigger is GOAL_ADDED
            and top.event.trigger is GOAL_ADDED
            and not top.plan.atomic
        ):
            stack.pop()
            event.returns += top.event.returns

    # ---- act -------------------------------------------------------------------------------------------------------

    def act(self) -> None:
        if self._feedback:
            self.process_feedback(self._feedback.popleft())
        intention = self.selected = self.select_intention()
        if intention is not None:
            self.step(intention)
            if intention.state is RUNNING and self.clear_finished(intention) and not intention.held:
                self.running.append(intention)

    def process_feedback(self, finished: Finished) -> None:
        """An action is over: its intention goes on, or fails."""
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
            if self._is_reached(means):
                del intention.stack[height + 1 :]
                means.step = None
                return

    def _is_reached(self, means: Means) -> bool:
        condition: Solve | None = means.plan.condition
        try:
            return condition is not None and condition(means.frame)
        except NOT_WORKED_OUT:
            undo(self.logic.trail, 0)
            return False

    # ---- looking in ------------------------------------------------------------------------------------------------

    def ask(self, formula: Term | str) -> list[dict[str, Term]]:
        """All answers to a formula over the beliefs, each as name → value."""
        return self.logic.query(term_from(formula))

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
        return explain(self.intentions.values(), self.events, literal_from(goal))
