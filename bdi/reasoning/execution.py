"""One step of one intention, and the actions that have ended."""

from collections.abc import Iterable

from bdi.debug.trace import Stepped
from bdi.language.arithmetic import ArithmeticFailure
from bdi.language.errors import AgentSpeakError, UnknownActionId
from bdi.language.unify import undo
from bdi.model.intentions import NOT_WORKED_OUT, RUNNING, Intention, Means, StepFailed
from bdi.model.messages import Finished
from bdi.reasoning.circumstance import Circumstance
from bdi.reasoning.intention_base import IntentionBase
from bdi.reasoning.output import Output
from bdi.reasoning.recovery import Recovery, action_failure
from bdi.reasoning.selection import Selection


class Execution:
    """Takes one step a cycle."""

    __slots__ = ("agent", "intention_base", "output", "recovery", "selection")

    def __init__(
        self,
        agent: Circumstance,
        output: Output,
        intention_base: IntentionBase,
        recovery: Recovery,
        selection: Selection,
    ) -> None:
        self.agent = agent
        self.output = output
        self.intention_base = intention_base
        self.recovery = recovery
        self.selection = selection

    def started(self, finished: Iterable[Finished]) -> list[Finished]:
        """News of actions that were started. Raises UnknownActionId."""
        news = list(finished)
        for each in news:
            if not 0 < each.id <= self.agent.last_action:
                raise UnknownActionId(f"action {each.id} was never started by {self.agent.name}")
        return news

    def act(self) -> None:
        agent = self.agent
        if agent.has_conditions:
            self._leave_reached_goals()
        if agent.feedback:
            self.process_feedback(agent.feedback.popleft())
        intention = agent.selected = self.selection.selector.select_intention()
        if intention is not None:
            self.step(intention)
            if intention.state is RUNNING and not intention.suspended:
                goes_on = intention.stack[-1].step is not None and not intention.atomic  # most of the time
                if goes_on or self.intention_base.clear_finished(intention):
                    agent.running.append(intention)

    def process_feedback(self, finished: Finished) -> None:
        """An action is over: its intention goes on, or fails."""
        intention = self.agent.pending.pop(finished.id, None)
        if intention is None:
            return  # it was cancelled, and ended before the body heard of it
        intention.action = None
        if finished.failure is not None:
            self.recovery.fail(intention, action_failure(finished))
            return
        self.intention_base.go_on(intention)

    def step(self, intention: Intention) -> None:
        """The next step of the top plan."""
        agent = self.agent
        means = intention.stack[-1]
        step = means.step
        if step is None:
            return  # leaving a finished plan takes the cycle
        means.step = step.next
        intention.last = step
        agent.current = intention
        if self.output.listeners:
            self.output.trace(Stepped(agent.cycles, intention.number, step.source))
        try:
            step.run(intention, means)
        except StepFailed as failure:
            self.recovery.fail(intention, failure, step)
        except ArithmeticFailure as failure:
            self.recovery.fail(intention, StepFailed("arithmetic", str(failure)), step)
        except AgentSpeakError as failure:  # text that an internal action was to read
            self.recovery.fail(intention, StepFailed("wrong_arguments", str(failure)), step)
        except RecursionError:
            self.recovery.fail(intention, StepFailed("recursion", f"{step.source} goes too deep"), step)
        finally:
            agent.current = None

    def _leave_reached_goals(self) -> None:
        """`+!g <: condition`: once the condition holds, the goal counts as reached, and its action is cancelled."""
        guarded = [each for each in self.agent.intentions.values() if each.guarded]
        self.agent.has_conditions = bool(guarded)
        for intention in guarded:
            if not intention.suspended:
                self.recovery.reach_goal(intention, self._is_reached)

    def _is_reached(self, means: Means) -> bool:
        condition = means.plan.condition
        try:
            return condition is not None and condition(means.frame)
        except NOT_WORKED_OUT:
            undo(self.agent.logic.trail, 0)
            return False
