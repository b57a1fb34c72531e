"""The reasoning cycle.

    cycle ─ sense ──────── perceive                what the body sees: deletions, then additions
          │              └ process_message         one a cycle
          ├ wake                                   what waited for a moment or an event; deadlines
          ├ deliberate ─── select_event            first in, first out
          │              ├ select_plan             relevant plans, the first applicable in source order
          │              └ add_means               on a new intention, or on the one that waits for this event
          └ act ────────── process_feedback        one finished action a cycle
                         ├ select_intention        round robin
                         └ step                    one step of one plan body

Nothing here knows a clock, a thread or a device: all comes in by `cycle` and goes out by its answer.
"""

from collections.abc import Callable, Iterable, Sequence
from typing import Any

from bdi.builtin import Table
from bdi.debug.explain import Why, explain
from bdi.debug.trace import Stepped, TraceEntry
from bdi.debug.verdicts import deliberated
from bdi.language.arithmetic import ArithmeticFailure
from bdi.language.errors import AgentSpeakError
from bdi.language.parser import Includes, literal_from, term_from
from bdi.language.syntax import BELIEF_ADDED, BELIEF_REMOVED, GOAL_ADDED, Belief, Function, Plan, Program, Trigger
from bdi.language.terms import Term
from bdi.language.unify import undo
from bdi.model.beliefs import SELF
from bdi.model.intentions import NOT_WORKED_OUT, RUNNING, Event, Intention, Means, StepFailed
from bdi.model.logic import Frame
from bdi.model.messages import Finished, Message
from bdi.model.plans import CompiledPlan, Compiler, Options
from bdi.model.subplans import Scopes
from bdi.reasoning.loading import check_program
from bdi.reasoning.message_handling import Letter
from bdi.reasoning.outcome import QUIET, Outcome
from bdi.reasoning.percepts import Change
from bdi.reasoning.performatives import sourced
from bdi.reasoning.priorities import Priorities, Selector, table_of
from bdi.reasoning.recovery import action_failure
from bdi.reasoning.sensing import Sensing

BELIEF_EVENTS = (BELIEF_ADDED, BELIEF_REMOVED)
PURSUED = (GOAL_ADDED, Trigger.TEST_ADDED)
_new = object.__new__
FAILURE_EVENTS = (Trigger.GOAL_FAILED, Trigger.TEST_FAILED)


class Agent(Sensing):
    """One AgentSpeak agent.

    `actions` declares the external actions that the body can do, as names or name/arity ("drive", "drive/1"); a plan
    with another one is then refused with UnknownAction. Without it every action is taken as known.
    `internal_actions` are those that this agent has beside ours (see `user_actions`). `includes` says what `.include`
    may read while the agent runs; without it, nothing.
    """

    __slots__ = ("_guarded", "priorities", "recorder", "selector")

    def __init__(
        self,
        program: Program,
        name: str = "agent",
        actions: Iterable[str] | None = None,
        random_seed: int | None = None,
        internal_actions: Table | None = None,
        *,
        includes: Includes | None = None,
    ) -> None:
        super().__init__(name, actions, random_seed)
        self.selector: Selector = self
        self.priorities: Priorities | None = None
        self.recorder: Any = None  # who is to be asked for a cycle instead, to write it down
        self._guarded = False  # whether an intention may have a goal condition
        self.internal_actions = internal_actions
        self.library = Compiler(self, self.logic).library
        self.includes = includes
        self._load(program)
        self.program = program

    def load(self, program: Program) -> None:
        """More of the program, while the agent is running: `.include`. Raises as the agent's making does."""
        self._load(program, self.program.functions)
        self.program = self.program.joined(program)
        self.plans_changed()

    def _load(self, program: Program, functions: Iterable[Function] = ()) -> None:
        check_program(program, self.known_actions, self.internal_actions, functions)
        table = table_of(program)
        if table is not None:
            self.selector = self.priorities = Priorities(table, self, otherwise=self)
        for function in program.functions:
            self.define(function)
        for plan in program.plans:
            self.add_plan(plan)
        self._heed_subplans(program.plans)
        for clause in reversed(program.beliefs):
            if isinstance(clause, Belief):
                self.believe(literal_from(clause.literal), None)
            else:
                self.beliefs.relation(clause.head.predicate).add_rule(self.logic.derivation(clause))
        for goal in program.goals:
            self.achieve_apart(sourced(goal.literal, SELF))

    def add_plan(self, plan: Plan, first: bool = False) -> None:
        super().add_plan(plan, first)
        self._heed_subplans((plan,))

    def _heed_subplans(self, plans: Iterable[Plan]) -> None:
        if self.scopes is None and any(plan.subplans for plan in plans):
            self.scopes, self.attentive = Scopes(self, self.selector), True
        if self.scopes is not None and self.selector is not self.scopes:
            self.scopes.selector, self.selector = self.selector, self.scopes

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
        ended = self.started(finished) if finished else ()
        self.now = now
        self.cycles += 1
        if change is not None or letters or ended or self._mailbox:
            self.sense(change, letters, ended)
        if self.watches_clock:
            self.wake()
        if self.events:
            self.deliberate()
        self.act()
        if self._reported:
            return self._take_outcome()
        return self._take_actions() if self._actions else QUIET

    def sense(self, change: Change | None, letters: Sequence[Letter], ended: Sequence[Finished]) -> None:
        if change is not None:
            self.perceive(change)
        if letters:
            self._mailbox.extend(letters)
        if self._mailbox:
            self.process_message(self._mailbox.popleft())
        if ended:
            self._feedback.extend(ended)

    # ---- deliberate ------------------------------------------------------------------------------------------------

    def deliberate(self) -> None:
        """Answer one event."""
        event = self.selector.select_event()
        if event is None:
            return
        self.considered = event
        chosen = self.select_plan(event)
        if self._listeners:
            self._trace(deliberated(self, event, chosen[0] if chosen else None, self._explains))
        if chosen is not None:
            plan, frame = chosen
            self.add_means(event, plan, frame)
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
                if self.scopes is not None and self.scopes.awaits(event):
                    return event
            return None
        for event in events:
            if event.intention is not None and event.intention.atomic:
                events.remove(event)
                return event
        return None

    def select_plan(self, event: Event) -> tuple[CompiledPlan, Frame] | None:
        """The first plan in source order whose head and context hold, with its variables."""
        options: Options = event.options
        return options.choose(event) if options else None

    def add_means(self, event: Event, plan: CompiledPlan, frame: Frame) -> None:
        """The plan becomes the top of the waiting intention, or a new intention."""
        intention = event.intention
        level = None if self.priorities is None else self.priorities.settle(event, plan)
        if intention is None:
            intention = self._new_intention()
        elif event.trigger is not GOAL_ADDED and event.trigger in FAILURE_EVENTS:
            self._unwind(intention, event)  # type: ignore[arg-type]  # by its trigger
        means = intention.stack[-1] if intention.stack else None
        if (
            means is not None
            and means.step is None
            and event.key is means.event.key
            and event.trigger is GOAL_ADDED
            and means.plan.makes_room
            and not (self.deadlines and means.event in self.deadlines)
        ):
            # Tail recursion does not grow the stack: a plan whose last step is its own goal again makes room, and so
            # does -!g <- !g.
            if means.event.returns:
                event.returns += means.event.returns
        else:
            means = _new(Means)  # in half the time of a call of Means
            means.loops, means.level = (), None
            intention.stack.append(means)
        means.plan = plan
        means.frame = frame
        means.event = event
        means.step = plan.first
        if level is not None:
            means.level = level
        if plan.is_special or self.goal_states is not None:
            self._begin_specially(intention, event, plan)
        intention.state = RUNNING
        if not intention.held:
            self.running.append(intention)

    def _begin_specially(self, intention: Intention, event: Event, plan: CompiledPlan) -> None:
        """An atomic plan, one with a goal condition, or somebody watches the states of goals."""
        if self.goal_states is not None and event.trigger in PURSUED:
            self.goal_states.tell(event, "executing", None, intention)
        if plan.atomic:
            intention.atomic = True
            self.atomic = intention
        if plan.condition is not None:
            intention.guarded = self._guarded = True

    # ---- act -------------------------------------------------------------------------------------------------------

    def act(self) -> None:
        if self._guarded:
            self._leave_reached_goals()
        if self._feedback:
            self.process_feedback(self._feedback.popleft())
        intention = self.selected = self.selector.select_intention()
        if intention is not None:
            self.step(intention)
            if intention.state is RUNNING and not intention.held and self.clear_finished(intention):
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
        for intention in self.running:
            if intention.atomic or intention is self.atomic:
                self.running.remove(intention)
                if not intention.atomic:
                    self.atomic = None
                return intention
        return None

    def step(self, intention: Intention) -> None:
        """The next step of the top plan."""
        means = intention.stack[-1]
        step = means.step
        if step is None:
            return  # leaving a finished plan takes the cycle
        means.step = step.next
        intention.last = step
        self.current = intention
        if self._listeners:
            self._trace(Stepped(self.cycles, intention.number, step.source))
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

    def _leave_reached_goals(self) -> None:
        """`+!g <: condition`: once the condition holds, the goal counts as reached. Whatever it waits for outside, it
        does no longer: its action is cancelled."""
        guarded = [each for each in self.intentions.values() if each.guarded]
        self._guarded = bool(guarded)
        for intention in guarded:
            if not intention.held:
                self.reach_goal(intention, self._is_reached)

    def _is_reached(self, means: Means) -> bool:
        condition = means.plan.condition
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
        busy = self.events or self.running or self._mailbox or self._feedback or self._pending
        ends = self.timers or self.deadlines
        return not busy and not ends and all(deadline_s is None for deadline_s in waits)

    def listen(self, callback: Callable[[TraceEntry], None], explain: bool = False) -> None:
        """Call this for everything that is chosen, and fill `outcome.trace`. Costs time only from here on; with
        `explain` each choice also says of every plan why it was or was not taken, which costs much more."""
        self._listeners.append(callback)
        self._explains = self._explains or explain

    def stop_listening(self, callback: Callable[[TraceEntry], None]) -> None:
        """From here on it costs nothing again, unless others listen too. What is remembered of choices goes with the
        last listener: nobody would add to it."""
        self._listeners.remove(callback)
        if not self._listeners:
            self._explains = False
            self.choices.clear()

    def why(self, goal: Term | str) -> Why:
        """Why a goal is not reached yet, in words and as data."""
        return explain(self, literal_from(goal))
