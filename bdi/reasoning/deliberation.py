"""The choice of a plan for one event, and its place on a stack."""

from bdi.debug.verdicts import deliberated
from bdi.language.syntax import BELIEF_ADDED, BELIEF_REMOVED, GOAL_ADDED, Trigger
from bdi.model.intentions import RUNNING, Event, Intention, Means
from bdi.model.logic import Frame
from bdi.model.plans import CompiledPlan, Options
from bdi.reasoning.circumstance import Circumstance
from bdi.reasoning.intention_base import IntentionBase
from bdi.reasoning.output import Output
from bdi.reasoning.recovery import Recovery
from bdi.reasoning.selection import Selection

BELIEF_EVENTS = (BELIEF_ADDED, BELIEF_REMOVED)
PURSUED = (GOAL_ADDED, Trigger.TEST_ADDED)
FAILURE_EVENTS = (Trigger.GOAL_FAILED, Trigger.TEST_FAILED)
_new = object.__new__


class Deliberation:
    """Answers one event a cycle."""

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

    def deliberate(self) -> None:
        """Answer one event."""
        agent = self.agent
        event = self.selection.selector.select_event()
        if event is None:
            return
        agent.considered = event
        options: Options = event.options
        chosen = options.choose(event) if options else None  # the first plan whose head and context hold
        if self.output.listeners:
            self.output.trace(deliberated(agent, event, chosen[0] if chosen else None, self.output.explains))
        if chosen is not None:
            plan, frame = chosen
            self._add_means(event, plan, frame)
        elif event.trigger in BELIEF_EVENTS:
            if event.intention is not None:
                self.intention_base.make_ready(event.intention)
        else:
            self.recovery.fail_event(event)

    def _add_means(self, event: Event, plan: CompiledPlan, frame: Frame) -> None:
        """The plan becomes the top of the waiting intention, or a new intention."""
        agent = self.agent
        intention = event.intention
        level = None if self.selection.priorities is None else self.selection.priorities.settle(event, plan)
        if intention is None:
            intention = self.intention_base.new_intention()
        elif event.trigger is not GOAL_ADDED and event.trigger in FAILURE_EVENTS:
            self.intention_base.unwind(intention, event)  # type: ignore[arg-type]  # by its trigger
        means = intention.stack[-1] if intention.stack else None
        if (
            means is not None
            and means.step is None
            and event.key is means.event.key
            and event.trigger is GOAL_ADDED
            and means.plan.makes_room
            and not (agent.deadlines and means.event in agent.deadlines)
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
        if plan.is_special or agent.goal_states is not None:
            self._begin_specially(intention, event, plan)
        intention.state = RUNNING
        if not intention.suspended:
            agent.running.append(intention)

    def _begin_specially(self, intention: Intention, event: Event, plan: CompiledPlan) -> None:
        """Begin an atomic plan or one with a goal condition, or report the state of the goal."""
        agent = self.agent
        if agent.goal_states is not None and event.trigger in PURSUED:
            agent.goal_states.tell(event, "executing", None, intention)
        if plan.atomic:
            intention.atomic = True
            agent.atomic = intention
        if plan.condition is not None:
            intention.guarded = agent.has_conditions = True
