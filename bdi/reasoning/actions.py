"""The effects of plan steps on the agent: the verbs of `plans.Effects`."""

from collections.abc import Callable
from typing import Any

from bdi.builtin.program_check import is_known_action
from bdi.debug.trace import Changed
from bdi.language.syntax import BELIEF_ADDED, BELIEF_REMOVED, GOAL_ADDED, Does, Trigger
from bdi.language.terms import (
    ANNOTATED,
    DEFAULT_SPACE,
    IN_SPACE,
    Atom,
    Code,
    Literal,
    Predicate,
    Structure,
    Term,
    Var,
    atom,
    in_space,
    literal_of,
    make,
)
from bdi.language.unify import FIXED, deref, is_ground, renamed, resolve_all, undo
from bdi.model.beliefs import FROM_SELF, SELF, Belief, annots_from_self
from bdi.model.intentions import (
    WAITS_FOR_ACTION,
    WAITS_FOR_EVENT,
    Event,
    Fork,
    Intention,
    Means,
    Step,
    StepFailed,
    event_of,
)
from bdi.model.logic import Builtin, Frame
from bdi.model.plans import Options
from bdi.model.waiting import reason_of
from bdi.reasoning.circumstance import Circumstance
from bdi.reasoning.deadlines import DeadlineWatch
from bdi.reasoning.event_queue import EventQueue
from bdi.reasoning.intention_base import IntentionBase
from bdi.reasoning.output import Action, Output
from bdi.reasoning.performatives import sourced

Arguments = tuple[Term, ...]
_new = object.__new__


class Actions:
    """Carries out the steps of plans: the `Effects` of one agent."""

    __slots__ = ("agent", "deadline_watch", "event_queue", "intention_base", "learn", "output", "step")

    def __init__(
        self,
        agent: Circumstance,
        output: Output,
        event_queue: EventQueue,
        intention_base: IntentionBase,
        deadline_watch: DeadlineWatch,
    ) -> None:
        self.agent = agent
        self.output = output
        self.event_queue = event_queue
        self.intention_base = intention_base
        self.deadline_watch = deadline_watch
        self.step: Callable[[Intention], None]  # the next step of this intention: see `execution`
        self.learn: Callable[[Code, Does], None]  # +{ plan }: see `plan_base`

    # ---- actions -----------------------------------------------------------------------------------------------------

    def start_action(self, intention: Intention, term: Literal) -> None:
        """drive(forward)"""
        agent = self.agent
        if agent.known_actions is not None and not is_known_action(term, agent.known_actions):
            raise StepFailed("unknown_action", f"the body has no action {term.predicate!r}")
        number = agent.last_action = agent.last_action + 1
        agent.pending[number] = intention
        intention.action = number
        intention.state = WAITS_FOR_ACTION
        intention.waits_for = term
        if agent.goal_states is not None:
            agent.goal_states.tell_all(intention, "waiting", reason_of(intention))
        self.output.actions.append(make(Action, (number, term, intention.number)))

    def call_internal(self, intention: Intention, builtin: Builtin, args: tuple[Any, ...]) -> bool:
        """.print(X)"""
        trail = self.agent.logic.trail
        answer = builtin.ask(args)
        if answer is not True and answer is not False and answer is not None:
            answer = next(iter(answer), None) is not None
        if answer:
            trail.clear()
            return True
        undo(trail, 0)
        return False

    # ---- goals -------------------------------------------------------------------------------------------------------

    def achieve(
        self, intention: Intention, key: Predicate, args: Arguments, annots: Arguments, options: Options
    ) -> None:
        """!g"""
        args, returns = _with_own_variables(args)
        self.post_goal(intention, key, args, annots, options, returns)

    def post_goal(
        self,
        intention: Intention,
        key: Predicate,
        args: Arguments,
        annots: Arguments,
        options: Options,
        returns: tuple[tuple[Var, Var], ...] = (),
    ) -> None:
        """!g with nothing in it that is still free"""
        agent = self.agent
        intention.state = WAITS_FOR_EVENT
        event = _new(Event)  # as a call of Event, in half the time
        event.trigger = GOAL_ADDED
        event.key = key
        event.args = args
        event.annots = annots
        event.options = options
        event.intention = intention
        event.returns = returns
        agent.events.append(event)
        if annots is not FROM_SELF or agent.watches_clock or agent.attentive:
            self._announce(event)

    def with_subplans(
        self, intention: Intention, trigger: Trigger, goal: Term, options: Options | None
    ) -> Options | None:
        """Sub-plans of the plans that led here go before those of the agent."""
        if self.agent.scopes is None or not isinstance(goal, Atom | Structure):
            return options
        return self.agent.scopes.options(intention.stack, trigger, goal) or options

    def achieve_apart(self, goal: Literal, options: Options | None = None) -> None:
        """!!g"""
        if options is None:
            options = self.agent.library.options(GOAL_ADDED, goal.predicate)
        args, _ = _with_own_variables(goal.args)
        event = Event(GOAL_ADDED, goal.predicate, args, annots_from_self(goal.annots), options)
        self.agent.events.append(event)
        if event.annots or self.agent.waiters or self.agent.goal_states is not None:
            self._announce(event)

    def ask_plans(self, intention: Intention, goal: Literal, options: Options) -> None:
        """?g that no belief answers"""
        args, returns = _with_own_variables(goal.args)
        annots = annots_from_self(goal.annots)
        event = Event(Trigger.TEST_ADDED, goal.predicate, args, annots, options, intention, returns)
        self.event_queue.wait_for_event(intention, event)
        if event.annots or self.agent.waiters or self.agent.goal_states is not None:
            self._announce(event)

    def _announce(self, goal: Event) -> None:
        """Announce a goal: sub-plans go before plans, its deadlines begin, waiters and meta plans are notified."""
        if self.agent.scopes is not None and goal.intention is not None and goal.trigger is GOAL_ADDED:
            goal.options = self.with_subplans(goal.intention, GOAL_ADDED, goal.literal, goal.options)
        self.deadline_watch.set(goal)
        if self.agent.waiters:
            self.event_queue.tell_waiters(goal.trigger, goal.literal)
        if self.agent.goal_states is not None:
            self.agent.goal_states.tell(goal, "pending")

    # ---- beliefs -----------------------------------------------------------------------------------------------------

    def believe(self, literal: Literal, intention: Intention | None, last: bool = False) -> None:
        """+b: waits for its event; ++b does not"""
        literal = fact = sourced(literal, SELF)
        for arg in literal.args:
            if type(arg) not in FIXED and not is_ground(arg):  # what the plan finds out later is not believed
                literal, fact = _apart(literal), _apart(literal)
                break
        relation = self.agent.beliefs.relation(fact.predicate)
        known = relation.facts.get(fact.args)
        before = known.annots if type(known) is Belief else ()
        if relation.add(fact.args, fact.annots, last):
            if before:  # the event tells only what is new
                new = tuple([annot for annot in literal.annots if annot not in before])
                literal = literal_of(literal.predicate, literal.args, new)
            self._react(BELIEF_ADDED, literal, intention)

    def forget(self, literal: Literal, intention: Intention | None) -> None:
        """-b: the newest belief of our own that unifies"""
        gone = self._take_back(literal, annots_from_self(literal.annots))
        if gone is not None:
            self._react(BELIEF_REMOVED, gone, intention)

    def update(self, literal: Literal, intention: Intention) -> None:
        """-+b: replaces one belief of this predicate with these annotations and any arguments"""
        anything = Structure(literal.predicate, tuple([Var() for _ in literal.args]), literal.annots)
        self.forget(anything, None)
        self.believe(literal, intention)

    def forget_all(self, pattern: Literal) -> None:
        """.abolish"""
        if pattern.predicate is ANNOTATED:  # _[source(bob)]
            pattern = in_space(atom(DEFAULT_SPACE), pattern)
        if pattern.predicate is IN_SPACE:
            for found in list(self.agent.logic.in_any_space(pattern)):
                self.forget_all(found)  # type: ignore[arg-type]
            return
        relation = self.agent.beliefs.relation(pattern.predicate)
        for belief in list(relation):
            if relation.find_in(belief, pattern.args, pattern.annots, self.agent.logic.trail):
                relation.discard(belief.args)
                self._react(BELIEF_REMOVED, literal_of(pattern.predicate, belief.args, belief.annots), None)

    def _take_back(self, literal: Literal, annots: Arguments) -> Literal | None:
        """Remove these annotations (the source among them) of the newest belief that unifies; what it was, or None."""
        relation = self.agent.beliefs.relation(literal.predicate)
        trail = self.agent.logic.trail
        found = relation.find(literal.args, annots, trail)
        if found is None:
            undo(trail, 0)
            return None
        annots = annots if annots is FROM_SELF else resolve_all(annots)
        gone = literal_of(literal.predicate, found.args, annots)
        relation.take_back(found.args, annots)
        trail.clear()
        return gone

    def _react(self, trigger: Trigger, literal: Literal, intention: Intention | None) -> None:
        """Post the event of a changed belief. A plan that made the change waits for it, even if no plan reacts."""
        if self.output.listeners:
            self.output.trace(Changed(self.agent.cycles, trigger, literal))
        if intention is None:
            self.event_queue.notice(trigger, literal)
        else:
            options = self.with_subplans(
                intention, trigger, literal, self.agent.library.options(trigger, literal.predicate)
            )
            self.event_queue.wait_for_event(intention, event_of(trigger, literal, options, intention))
            self.event_queue.tell_waiters(trigger, literal)

    # ---- branches ----------------------------------------------------------------------------------------------------

    def fork(self, intention: Intention, branches: list[Step | None], wait_for_all: bool) -> None:
        """a |&| b, a ||| b: every branch becomes an intention with the same plans below."""
        fork = Fork(wait_for_all, len(intention.stack), intention.fork)
        *below, top = intention.stack
        for first in branches:
            branch = self.intention_base.new_intention()
            means = Means(top.plan, top.frame[:], top.event)
            means.step, means.loops = first, top.loops
            branch.stack = [*below, means]
            branch.fork, branch.guarded = fork, intention.guarded
            branch.atomic = intention.atomic
            fork.branches.append(branch)
            self.agent.running.append(branch)
        if fork.outer is not None:
            outer = fork.outer.branches
            outer[outer.index(intention)] = fork
        self.intention_base.end(intention)

    def join(self, intention: Intention) -> None:
        """The end of a branch: the last one goes on, or the first one alone."""
        fork = intention.fork
        if fork is None:
            return
        frame = intention.stack[-1].frame
        if fork.wait_for_all and len(fork.branches) > 1:
            fork.branches.remove(intention)
            fork.frames.append(frame)
            self.intention_base.end(intention)
        else:
            for other in fork.frames:
                _take_over(frame, other)
            self.intention_base.leave_fork(intention, fork)


def _take_over(frame: Frame, other: Frame) -> None:
    """Copy the values that another branch has found and this one has not."""
    for slot, (mine, theirs) in enumerate(zip(frame, other, strict=False)):
        if theirs is not None and (mine is None or type(deref(mine)) is Var):
            frame[slot] = theirs


def _apart(literal: Literal) -> Literal:
    """The literal with variables of its own."""
    return renamed(literal, {})  # type: ignore[return-value]


def _with_own_variables(args: Arguments) -> tuple[Arguments, tuple[tuple[Var, Var], ...]]:
    """The arguments as the plan for a goal sees them: free variables are the plan's own until it is done, so that a
    plan that fails leaves no trace. The pairs say which variable of the caller gets the value of which."""
    for arg in args:
        if type(arg) not in FIXED:
            break
    else:
        return args, ()
    names: dict[Var, Term] = {}
    args = tuple([renamed(arg, names) for arg in args])
    pairs = [(outer, inner) for outer, inner in names.items() if type(inner) is Var]
    return args, tuple(pairs)
