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

import random
from collections import deque
from collections.abc import Callable, Iterable
from heapq import heappop
from typing import Any, NamedTuple

from bdi.arithmetic import ArithmeticFailure
from bdi.beliefs import PERCEPT, SELF, Beliefs
from bdi.builtin import find_builtin
from bdi.builtin_actions import event_named
from bdi.builtin_values import text_of
from bdi.errors import AgentSpeakSyntaxError, Place, UnknownActionId, UnknownPerformative
from bdi.explain import Why, explain
from bdi.intentions import FAILURE_OF, Event, Fork, Intention, Means, State, Step, StepFailed
from bdi.loading import check_program, is_known_action
from bdi.logic import Builtin, Frame, Logic
from bdi.messages import Finished, Message
from bdi.parser import parse_literal, parse_term
from bdi.performatives import PERFORMATIVES, sourced
from bdi.plans import CompiledPlan, Compiler, Options, relevant
from bdi.syntax import Belief, Plan, Program, Trigger
from bdi.terms import Atom, Literal, String, Structure, Term, Var, atom, literal_of, show, structure
from bdi.trace import Deliberated, Failed, Stepped, TraceEntry
from bdi.unify import FIXED, is_ground, renamed, resolve, resolve_all, undo, unify
from bdi.waiting import Waiter

REMEMBERED_TEXTS = 20_000  # percepts and messages given as text are parsed once; then the memory starts again
BELIEF_EVENTS = (Trigger.BELIEF_ADDED, Trigger.BELIEF_REMOVED)
FAILURE_EVENTS = (Trigger.GOAL_FAILED, Trigger.TEST_FAILED)


class Action(NamedTuple):
    """An action that was started. Its intention (a number) waits until `Finished(id)` comes in."""

    id: int
    term: Literal
    intention: int

    def __str__(self) -> str:
        return show(self.term)


class GoalFailure(NamedTuple):
    """A goal that no plan could rescue: its intention was dropped."""

    goal: str
    error: str
    message: str

    def __str__(self) -> str:
        return f"{self.goal}: {self.error} ({self.message})"


class Outcome(NamedTuple):
    """What one cycle did to the outside."""

    actions: tuple[Action, ...] = ()
    cancelled: tuple[int, ...] = ()
    messages: tuple[Message, ...] = ()
    printed: tuple[str, ...] = ()
    failures: tuple[GoalFailure, ...] = ()
    trace: tuple[TraceEntry, ...] = ()


QUIET = Outcome()


class _Percept:
    """A percept with everything that adding and removing it needs, looked up once."""

    __slots__ = ("annots", "literal", "on_added", "on_removed", "relation")

    def __init__(self, literal: Literal, agent: "Agent") -> None:
        self.literal = literal
        self.relation = agent.beliefs.relation(literal.predicate)
        self.annots = (*literal.annots, PERCEPT)
        self.on_added = agent.relevant_plans(Trigger.BELIEF_ADDED, literal)
        self.on_removed = agent.relevant_plans(Trigger.BELIEF_REMOVED, literal)


class Agent:
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
        self.name = name
        self.now = 0.0
        self.cycles = 0
        self.random = random.Random(random_seed)
        self.known_actions = None if actions is None else frozenset(actions)
        self.beliefs = Beliefs()
        self.logic = Logic(self.beliefs, self.builtin)
        self.compiler = Compiler(self, self.logic)
        self.library = self.compiler.library
        self.events: deque[Event] = deque()
        self.intentions: dict[int, Intention] = {}
        self.running: deque[Intention] = deque()
        self.atomic: Intention | None = None
        self.current: Intention | None = None  # whose step is being taken
        self._builtins: dict[Any, Builtin | None] = {}
        self._mailbox: deque[Message] = deque()
        self._feedback: deque[Finished] = deque()
        self._pending: dict[int, Intention] = {}
        self.timers: list[tuple[float, int, Intention]] = []
        self.waiters: list[Waiter] = []
        self._asked: dict[str, tuple[Intention, Term, float | None]] = {}
        self._percepts: frozenset[Any] = frozenset()
        self._seen: dict[Any, _Percept] = {}
        self._read: dict[str, Literal] = {}
        self._mixed = False  # whether one percept may come written in several ways
        self._last_action = 0
        self._last_intention = 0
        self._last_message = 0
        self._listeners: list[Callable[[TraceEntry], None]] = []
        self._reset_outcome()
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

    def builtin(self, key: Any) -> Builtin | None:
        """The internal action or function filed under this predicate, bound to this agent."""
        if key not in self._builtins:
            self._builtins[key] = find_builtin(key, self)
        return self._builtins[key]

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
            # The same percept in two notations must stay one percept: from now on compare terms, not texts.
            if type(percept) is not str or show(literal) != percept:
                self._mixed = self._mixed or type(percept) is str or any(type(key) is str for key in self._seen)
            elif not self._mixed and any(type(key) is not str for key in self._seen):
                self._mixed = True
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

    def _go_on(self, intention: Intention) -> None:
        """What it waited for is here: on with the next step, or back to the plan below."""
        intention.state = State.RUNNING
        intention.waits_for = None
        if self.clear_finished(intention):
            self._resume(intention)

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
            except (ArithmeticFailure, StepFailed, RecursionError):
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

    def _new_intention(self) -> Intention:
        self._last_intention += 1
        intention = self.intentions[self._last_intention] = Intention(self._last_intention)
        return intention

    def _resume(self, intention: Intention) -> None:
        """It can go on; unless somebody suspended it."""
        intention.state = State.RUNNING
        intention.waits_for = None
        if not intention.held:
            self.running.append(intention)

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
            self.fail(intention, _action_failure(finished))
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
        except RecursionError:
            self.fail(intention, StepFailed("recursion", f"{step.source} goes too deep"), step)
        finally:
            self.current = None

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

    def _leave_reached_goals(self, intention: Intention) -> None:
        """`+!g <: condition`: once the condition holds, the goal counts as reached."""
        for height, means in enumerate(intention.stack):
            condition = means.plan.condition
            if condition is not None and condition(means.frame):
                del intention.stack[height + 1 :]
                means.step = None
                return

    def _end_atomic(self, intention: Intention) -> None:
        intention.atomic = any(means.plan.atomic for means in intention.stack)
        if self.atomic is intention and not intention.atomic:
            self.atomic = None

    def _end(self, intention: Intention) -> None:
        intention.state = State.DONE
        self.intentions.pop(intention.number, None)
        if self.atomic is intention:
            self.atomic = None

    # ---- what steps do (the verbs of plans.Doer) -------------------------------------------------------------------

    def start_action(self, intention: Intention, term: Literal) -> None:
        """drive(forward)"""
        if not is_known_action(term, self.known_actions):
            raise StepFailed("unknown_action", f"the body has no action {term.predicate!r}")
        self._last_action += 1
        self._pending[self._last_action] = intention
        intention.action = self._last_action
        intention.state = State.ACTION
        intention.waits_for = term
        self._actions.append(Action(self._last_action, term, intention.number))
        self._reported = True

    def call_internal(self, intention: Intention, builtin: Builtin, args: tuple[Any, ...]) -> bool:
        """.print(X)"""
        trail = self.logic.trail
        answer = builtin.ask(args)
        if answer is not True and answer is not False and answer is not None:
            answer = next(iter(answer), None) is not None
        if answer:
            trail.clear()
            return True
        undo(trail, 0)
        return False

    def achieve(self, intention: Intention, goal: Literal, options: Options) -> None:
        """!g"""
        if self._scoped:
            options = self._scoped_options(intention, goal, options)
        goal, returns = _with_own_variables(goal)
        self._wait_for_event(intention, Event(Trigger.GOAL_ADDED, goal, options, intention, returns=returns))

    def _scoped_options(self, intention: Intention, goal: Literal, options: Options) -> Options:
        """Sub-plans of the plans that led here go before those of the agent."""
        for means in reversed(intention.stack):
            if means.plan.subplans is not None:
                found: Options = means.plan.subplans.options(Trigger.GOAL_ADDED, goal.predicate)
                if found:
                    return found
        return options

    def _wait_for_event(self, intention: Intention, event: Event) -> None:
        intention.state = State.EVENT
        self.events.append(event)

    def achieve_apart(self, goal: Literal, options: Options | None = None) -> None:
        """!!g"""
        if options is None:
            options = self.library.options(Trigger.GOAL_ADDED, goal.predicate)
        goal, _ = _with_own_variables(goal)
        self.events.append(Event(Trigger.GOAL_ADDED, goal, options))

    def ask_plans(self, intention: Intention, goal: Literal, options: Options) -> None:
        """?g that no belief answers"""
        goal, returns = _with_own_variables(goal)
        self._wait_for_event(intention, Event(Trigger.TEST_ADDED, goal, options, intention, returns=returns))

    def believe(self, literal: Literal, intention: Intention | None, last: bool = False) -> None:
        """+b: waits for its event; ++b does not"""
        literal = sourced(literal, SELF)
        key = literal.predicate
        if self.beliefs.relation(key).add(literal.args, literal.annots, last):
            self._react(Trigger.BELIEF_ADDED, literal, intention)

    def forget(self, literal: Literal, intention: Intention | None) -> None:
        """-b: the newest belief of our own that unifies"""
        gone = self._take_back(sourced(literal, SELF))
        if gone is not None:
            self._react(Trigger.BELIEF_REMOVED, gone, intention)

    def update(self, literal: Literal, intention: Intention) -> None:
        """-+b: one belief of this predicate goes, whatever its arguments"""
        anything = Structure(literal.predicate, tuple([Var() for _ in literal.args]))
        self.forget(anything, None)
        self.believe(literal, intention)

    def _take_back(self, literal: Literal) -> Literal | None:
        """Remove the annotations (the source among them) of the newest belief that unifies; what it was, or None."""
        relation = self.beliefs.relation(literal.predicate)
        trail = self.logic.trail
        found = relation.find(literal.args, literal.annots, trail)
        if found is None:
            undo(trail, 0)
            return None
        gone = literal_of(literal.predicate, found.args, found.annots)
        relation.take_back(found.args, resolve_all(literal.annots))
        trail.clear()
        return gone

    def _react(self, trigger: Trigger, literal: Literal, intention: Intention | None) -> None:
        """Post the event of a changed belief. A plan that made the change waits for it, even if nobody reacts."""
        if intention is None:
            self.notice(trigger, literal)
        else:
            options = self.library.options(trigger, literal.predicate)
            self._wait_for_event(intention, Event(trigger, literal, options, intention))
            self._tell_waiters(trigger, literal)

    def notice(self, trigger: Trigger, literal: Literal, options: Options | None = None) -> None:
        """An event of the world."""
        if options is None:
            options = self.relevant_plans(trigger, literal)
        if options:
            self.events.append(Event(trigger, literal, options))
        self._tell_waiters(trigger, literal)

    def relevant_plans(self, trigger: Trigger, literal: Literal) -> Options:
        return relevant(self.library.options(trigger, literal.predicate), literal)

    def add_plan(self, plan: Plan, first: bool = False) -> None:
        """.add_plan, tellHow"""
        self.library.add(plan, first)
        self._seen.clear()

    def remove_plan(self, label: str) -> bool:
        """Whether there was one with this label."""
        self._seen.clear()
        return self.library.remove(label)

    def _tell_waiters(self, trigger: Trigger, literal: Literal) -> None:
        for waiter in self.waiters:
            waiter.notice(trigger, literal, self)

    def fork(self, intention: Intention, branches: list[Step | None], wait_for_all: bool) -> None:
        """a |&| b, a ||| b: every branch becomes an intention with the same plans below."""
        fork = Fork(wait_for_all, len(intention.stack), intention.fork)
        *below, top = intention.stack
        for first in branches:
            branch = self._new_intention()
            means = Means(top.plan, top.frame, top.event)
            means.step, means.loops = first, top.loops[:]
            branch.stack = [*below, means]
            branch.fork, branch.guarded = fork, intention.guarded
            fork.branches.append(branch)
            self.running.append(branch)
            if intention.atomic:
                branch.atomic, self.atomic = True, branch
        self.intentions.pop(intention.number, None)
        intention.state = State.DONE

    def join(self, intention: Intention) -> None:
        """The end of a branch: the last one goes on, or the first one alone."""
        fork = intention.fork
        if fork is None:
            return
        fork.branches.remove(intention)
        if fork.wait_for_all and fork.branches:
            self._end(intention)
            return
        self._drop_branches(fork)
        intention.fork = fork.outer

    def _drop_branches(self, fork: Fork) -> None:
        for branch in fork.branches:
            self.drop(branch)
        fork.branches = []

    # ---- failure ---------------------------------------------------------------------------------------------------

    def fail(self, intention: Intention, failure: StepFailed, step: Step | None = None) -> None:
        """A step failed: look down the stack for a plan `-!g` that takes care of it."""
        self._withdraw(intention)
        code = show(step.source.term) if step is not None and hasattr(step.source, "term") else ""
        place = getattr(step.source, "place", None) if step is not None else None
        annots = _failure_annots(failure, code or str(intention.waits_for or ""), place)
        if not self._fail_below(intention, len(intention.stack), annots):
            self._give_up(intention, failure)

    def _fail_below(self, intention: Intention, height: int, annots: tuple[Term, ...]) -> bool:
        """Post the failure of the topmost goal below this height that somebody has a plan for. False: nobody has."""
        for place in range(height - 1, -1, -1):
            means = intention.stack[place]
            trigger = FAILURE_OF.get(means.event.trigger)
            if trigger is None:
                continue
            if self._post_failure(intention, means.event, trigger, place, annots):
                return True
        return False

    def _post_failure(
        self, intention: Intention | None, goal: Event, trigger: Trigger, place: int, annots: tuple[Term, ...]
    ) -> bool:
        options = self.library.options(trigger, goal.key)
        if not options:
            return False
        for _, inner in goal.returns:
            inner.ref = None  # what the failed plan found out does not count
        literal = Structure(goal.key, resolve_all(goal.args), (*goal.annots, *annots))
        event = Event(trigger, literal, options, intention, returns=goal.returns, under=place)
        if intention is None:
            self.events.append(event)
        else:
            self._wait_for_event(intention, event)
        return True

    def _fail_event(self, event: Event) -> None:
        """A goal that no plan is for, or none whose context holds."""
        known = bool(relevant(event.options, event.literal))
        error = "no_applicable" if known else "no_relevant"
        problem = "no plan has a context that holds" if known else "there is no plan"
        failure = StepFailed(error, f"{problem} for {event}")
        trigger = FAILURE_OF.get(event.trigger)
        intention = event.intention
        height = len(intention.stack) if intention is not None else 0
        if trigger is None:  # the failure plan itself did not apply: search on where it came from
            height, annots = event.under, event.annots
        else:
            annots = _failure_annots(failure, str(event), None)
            if self._post_failure(intention, event, trigger, height, annots):
                return
        if intention is None:
            self._report(GoalFailure(str(event), error, failure.message))
        elif not self._fail_below(intention, height, annots[-len(annots) :]):
            self._give_up(intention, failure, event)

    def _give_up(self, intention: Intention, failure: StepFailed, event: Event | None = None) -> None:
        goal = intention.stack[0].event if intention.stack else event
        self._report(GoalFailure(str(goal), failure.error, failure.message))
        if intention.fork is not None:
            self._drop_branches(intention.fork)
        self.drop(intention)

    def _report(self, failure: GoalFailure) -> None:
        self._failures.append(failure)
        self._reported = True
        if self._listeners:
            self._trace(Failed(self.cycles, *failure))

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

    # ---- dropping --------------------------------------------------------------------------------------------------

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

    def hold(self, intention: Intention) -> None:
        """It takes no more steps; what it waits for may still come in."""
        intention.held = True
        if intention in self.running:
            self.running.remove(intention)

    def release(self, intention: Intention) -> None:
        if intention.held:
            intention.held = False
            if intention.state is State.RUNNING:
                self.running.append(intention)

    def reach_goal(self, intention: Intention, is_goal: Callable[[Means], bool]) -> None:
        """The lowest goal like this counts as reached: what was done for it is dropped."""
        place = _place_of(intention, is_goal)
        if place is None:
            return
        self._interrupt(intention)
        del intention.stack[place + 1 :]
        intention.stack[place].step = None
        if self.clear_finished(intention) and intention is not self.current:
            self._resume(intention)

    def give_up_goal(self, intention: Intention, is_goal: Callable[[Means], bool], annots: tuple[Term, ...]) -> None:
        """The lowest goal like this counts as failed."""
        place = _place_of(intention, is_goal)
        if place is None:
            return
        self._interrupt(intention)
        del intention.stack[place + 1 :]
        self.fail(intention, StepFailed("goal_failed", "given up by .fail_goal", annots))

    def forget_all(self, pattern: Literal) -> None:
        """.abolish"""
        relation = self.beliefs.relation(pattern.predicate)
        for belief in list(relation):
            if relation.find_in(belief, pattern.args, pattern.annots, self.logic.trail):
                relation.discard(belief.args)
                self._react(Trigger.BELIEF_REMOVED, literal_of(pattern.predicate, belief.args, belief.annots), None)

    def _interrupt(self, intention: Intention) -> None:
        """Nothing that it waits for matters any more."""
        self._withdraw(intention)
        self.events = deque(event for event in self.events if event.intention is not intention)
        intention.state = State.RUNNING

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

    def _trace(self, entry: TraceEntry) -> None:
        self._entries.append(entry)
        self._reported = True
        for listener in self._listeners:
            listener(entry)

    def why(self, goal: Term | str) -> Why:
        """Why a goal is not reached yet, in words and as data."""
        return explain(self.intentions.values(), self.events, as_literal(goal))

    # ---- outcome ---------------------------------------------------------------------------------------------------

    def say(self, line: str) -> None:
        """.print"""
        self._printed.append(line)
        self._reported = True

    def new_message_id(self) -> str:
        self._last_message += 1
        return f"{self.name}-{self._last_message}"

    def wait_for_answer(self, intention: Intention, message_id: str, answer: Term, deadline_s: float | None) -> None:
        intention.state = State.ANSWER
        intention.waits_for = f"the answer to {message_id}"
        self._asked[message_id] = (intention, answer, deadline_s)

    def event_in(self, text: String) -> tuple[Trigger, Any]:
        trigger, literal = event_named(text)
        return trigger, literal.predicate

    def send(self, message: Message) -> None:
        """.send"""
        self._messages.append(message)
        self._reported = True

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


# ---- helpers of the cycle ------------------------------------------------------------------------------------------


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


def _with_own_variables(goal: Literal) -> tuple[Literal, tuple[tuple[Var, Var], ...]]:
    """The goal as its plan sees it: free variables are the plan's own until it is done, so that a plan that fails
    leaves no trace. The pairs say which variable of the caller gets the value of which."""
    args = goal.args
    for arg in args:
        if type(arg) not in FIXED:
            break
    else:
        return goal, ()
    names: dict[Var, Term] = {}
    args = tuple([renamed(arg, names) for arg in args])
    pairs = [(outer, inner) for outer, inner in names.items() if type(inner) is Var]
    return Structure(goal.predicate, args, resolve_all(goal.annots)), tuple(pairs)


def _place_of(intention: Intention, is_goal: Callable[[Means], bool]) -> int | None:
    return next((place for place, means in enumerate(intention.stack) if is_goal(means)), None)


def _action_failure(finished: Finished) -> StepFailed:
    """The reason as plans see it: -!g[error(action_failed), error_msg("…"), REASON, reason(REASON)]"""
    failure = finished.failure
    try:
        reason = as_term(failure) if failure is not None else String("")
    except AgentSpeakSyntaxError:
        reason = String(str(failure))  # a sentence, not a term
    message = finished.message or text_of(reason)
    plain: tuple[Term, ...] = (reason,) if isinstance(reason, Atom | Structure) else ()
    return StepFailed("action_failed", message, (*plain, structure("reason", reason)))


def _failure_annots(failure: StepFailed, code: str, place: Place | None) -> tuple[Term, ...]:
    """error(E), error_msg(M), what the failure adds, and where it happened."""
    annots = (structure("error", atom(failure.error)), structure("error_msg", String(failure.message)))
    where = (
        structure("code", String(code)),
        structure("code_src", String(place.source if place else "")),
        structure("code_line", place.line if place else 0),
    )
    return (*failure.annots, *annots, *where)
