"""What the steps of a plan do to the agent: the verbs that `plans.Doer` asks for."""

from typing import Any

from bdi.beliefs import SELF
from bdi.intentions import WAITS_FOR_ACTION, Event, Fork, Intention, Means, State, Step, StepFailed
from bdi.loading import is_known_action
from bdi.logic import Builtin
from bdi.outcome import Action
from bdi.performatives import sourced
from bdi.plans import Options
from bdi.recovery import Recovery
from bdi.syntax import BELIEF_ADDED, BELIEF_REMOVED, GOAL_ADDED, Trigger
from bdi.terms import Literal, Structure, Term, Var, literal_of
from bdi.unify import FIXED, renamed, resolve_all, undo


class Doing(Recovery):
    """An agent that can take steps."""

    _scoped = False  # whether some plan has sub-plans

    # ---- actions ---------------------------------------------------------------------------------------------------

    def start_action(self, intention: Intention, term: Literal) -> None:
        """drive(forward)"""
        if not is_known_action(term, self.known_actions):
            raise StepFailed("unknown_action", f"the body has no action {term.predicate!r}")
        self._last_action += 1
        self._pending[self._last_action] = intention
        intention.action = self._last_action
        intention.state = WAITS_FOR_ACTION
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

    def wait_for_answer(self, intention: Intention, message_id: str, answer: Term, deadline_s: float | None) -> None:
        intention.state = State.ANSWER
        intention.waits_for = f"the answer to {message_id}"
        self._asked[message_id] = (intention, answer, deadline_s)

    # ---- goals -----------------------------------------------------------------------------------------------------

    def achieve(self, intention: Intention, goal: Literal, options: Options) -> None:
        """!g"""
        if self._scoped:
            options = self._scoped_options(intention, goal, options)
        goal, returns = _with_own_variables(goal)
        self._wait_for_event(intention, Event(GOAL_ADDED, goal, options, intention, returns=returns))

    def _scoped_options(self, intention: Intention, goal: Literal, options: Options) -> Options:
        """Sub-plans of the plans that led here go before those of the agent."""
        for means in reversed(intention.stack):
            if means.plan.subplans is not None:
                found: Options = means.plan.subplans.options(GOAL_ADDED, goal.predicate)
                if found:
                    return found
        return options

    def achieve_apart(self, goal: Literal, options: Options | None = None) -> None:
        """!!g"""
        if options is None:
            options = self.library.options(GOAL_ADDED, goal.predicate)
        goal, _ = _with_own_variables(goal)
        self.events.append(Event(GOAL_ADDED, goal, options))

    def ask_plans(self, intention: Intention, goal: Literal, options: Options) -> None:
        """?g that no belief answers"""
        goal, returns = _with_own_variables(goal)
        self._wait_for_event(intention, Event(Trigger.TEST_ADDED, goal, options, intention, returns=returns))

    # ---- beliefs ---------------------------------------------------------------------------------------------------

    def believe(self, literal: Literal, intention: Intention | None, last: bool = False) -> None:
        """+b: waits for its event; ++b does not"""
        literal = sourced(literal, SELF)
        key = literal.predicate
        if self.beliefs.relation(key).add(literal.args, literal.annots, last):
            self._react(BELIEF_ADDED, literal, intention)

    def forget(self, literal: Literal, intention: Intention | None) -> None:
        """-b: the newest belief of our own that unifies"""
        gone = self._take_back(sourced(literal, SELF))
        if gone is not None:
            self._react(BELIEF_REMOVED, gone, intention)

    def update(self, literal: Literal, intention: Intention) -> None:
        """-+b: one belief of this predicate goes, whatever its arguments"""
        anything = Structure(literal.predicate, tuple([Var() for _ in literal.args]))
        self.forget(anything, None)
        self.believe(literal, intention)

    def forget_all(self, pattern: Literal) -> None:
        """.abolish"""
        relation = self.beliefs.relation(pattern.predicate)
        for belief in list(relation):
            if relation.find_in(belief, pattern.args, pattern.annots, self.logic.trail):
                relation.discard(belief.args)
                self._react(BELIEF_REMOVED, literal_of(pattern.predicate, belief.args, belief.annots), None)

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

    # ---- branches --------------------------------------------------------------------------------------------------

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
