"""Goals that must be reached in time.

`!g[hard_deadline(MS)]` fails with `error(deadline_reached)` when it is not reached after so many milliseconds of the
clock that the agent is given, even if it still waits; a started action is cancelled. `!g[soft_deadline(MS)]`
goes on, and raises `^!g[state(late)]`. A goal that ends before has no deadline any more, nor has the plan `-!g` that
takes care of its failure. Time goes on while a goal is suspended.
"""

from bdi.debug.trace import GoalFailure
from bdi.language.terms import Structure, predicate, show, structure
from bdi.language.unify import resolve
from bdi.model.goal_states import raise_state
from bdi.model.intentions import Event, Intention, Means, StepFailed
from bdi.model.waiting import Deadline
from bdi.reasoning.circumstance import Circumstance
from bdi.reasoning.output import Output
from bdi.reasoning.recovery import Recovery

HARD, SOFT = predicate("hard_deadline", 1), predicate("soft_deadline", 1)


class DeadlineWatch:
    """Sets the deadlines of new goals and fails goals that are late."""

    __slots__ = ("agent", "output", "recovery")

    def __init__(self, agent: Circumstance, output: Output, recovery: Recovery) -> None:
        self.agent = agent
        self.output = output
        self.recovery = recovery

    def set(self, goal: Event) -> None:
        """Set the deadlines of a new goal. One that is no number is reported and ignored."""
        written = [each for each in goal.annots if type(each) is Structure and each.predicate in (HARD, SOFT)]
        if written:
            found = [self._deadline(goal, annot) for annot in written]
            self.agent.watches_clock = True
            self.agent.deadlines[goal] = [deadline for deadline in found if deadline is not None]

    def _deadline(self, goal: Event, annot: Structure) -> Deadline | None:
        milliseconds = resolve(annot.args[0])
        if isinstance(milliseconds, int | float):
            return Deadline(self.agent.now + milliseconds / 1000, milliseconds, annot.predicate is HARD)
        problem = f"{annot.functor} takes milliseconds, not {show(milliseconds)}"
        self.output.report(GoalFailure(str(goal), "wrong_arguments", problem))
        return None

    def check(self) -> None:
        """Handle the deadlines whose time is over, outer goals first."""
        for goal, deadlines in list(self.agent.deadlines.items()):
            if not self._is_pursued(goal):
                del self.agent.deadlines[goal]
                continue
            due = [deadline for deadline in deadlines if deadline.moment_s <= self.agent.now]
            for deadline in due:
                deadlines.remove(deadline)
                self._is_late(goal, deadline)
            if not deadlines:
                del self.agent.deadlines[goal]

    def _pursuing(self, goal: Event) -> Intention | None:
        return next((each for each in self.agent.intentions.values() if _pursues(each.stack, goal)), None)

    def _is_pursued(self, goal: Event) -> bool:
        return goal in self.agent.events or goal in self.agent.suspended_events or self._pursuing(goal) is not None

    def _is_late(self, goal: Event, deadline: Deadline) -> None:
        intention = self._pursuing(goal)
        if not deadline.is_hard:
            raise_state(self.agent, goal, "late", structure("soft_deadline", deadline.milliseconds))
            return
        failure = StepFailed("deadline_reached", f"{goal} was not reached in {show(deadline.milliseconds)} ms")
        if intention is None:
            self.recovery.give_up_waiting(goal, failure)
        else:
            self.recovery.give_up_goal(intention, lambda means: means.event is goal, failure)


def _pursues(stack: list[Means], goal: Event) -> bool:
    return any(means.event is goal for means in stack)
