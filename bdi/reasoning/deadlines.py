"""Goals that must be reached in time.

`!g[hard_deadline(MS)]` fails with `error(deadline_reached)` when it is not reached after so many milliseconds of the
clock that the agent is given, whatever it waits for by then; a started action is cancelled. `!g[soft_deadline(MS)]`
goes on, and raises `^!g[state(late)]`. A goal that ends before has no deadline any more, nor has the plan `-!g` that
takes care of its failure. Time goes on while a goal is suspended.
"""

from collections.abc import Iterable
from typing import NamedTuple

from bdi.language.terms import Structure, predicate, show, structure
from bdi.language.unify import resolve
from bdi.model.goal_states import raise_state
from bdi.model.intentions import Event, Intention, Means, StepFailed
from bdi.reasoning.outcome import GoalFailure
from bdi.reasoning.recovery import Recovery

HARD, SOFT = predicate("hard_deadline", 1), predicate("soft_deadline", 1)


class Deadline(NamedTuple):
    moment_s: float
    milliseconds: float
    is_hard: bool


class Deadlines(Recovery):
    """An agent whose goals may have deadlines: `deadlines` holds those of goals that are still pursued."""

    __slots__ = ("deadlines",)

    def __init__(self, name: str, actions: Iterable[str] | None, random_seed: int | None) -> None:
        super().__init__(name, actions, random_seed)
        self.deadlines: dict[Event, list[Deadline]] = {}

    def set_deadlines(self, goal: Event) -> None:
        """Of a goal that is new. One that is no number is reported, and the goal has none."""
        written = [each for each in goal.annots if type(each) is Structure and each.predicate in (HARD, SOFT)]
        if written:
            found = [self._deadline(goal, annot) for annot in written]
            self.watches_clock = True
            self.deadlines[goal] = [deadline for deadline in found if deadline is not None]

    def _deadline(self, goal: Event, annot: Structure) -> Deadline | None:
        milliseconds = resolve(annot.args[0])
        if isinstance(milliseconds, int | float):
            return Deadline(self.now + milliseconds / 1000, milliseconds, annot.predicate is HARD)
        problem = f"{annot.functor} takes milliseconds, not {show(milliseconds)}"
        self._report(GoalFailure(str(goal), "wrong_arguments", problem))
        return None

    def check_deadlines(self) -> None:
        """Those whose time is over: outer goals first."""
        for goal, deadlines in list(self.deadlines.items()):
            if not self._is_pursued(goal):
                del self.deadlines[goal]
                continue
            due = [deadline for deadline in deadlines if deadline.moment_s <= self.now]
            for deadline in due:
                deadlines.remove(deadline)
                self._is_late(goal, deadline)
            if not deadlines:
                del self.deadlines[goal]

    def _pursuing(self, goal: Event) -> Intention | None:
        return next((each for each in self.intentions.values() if _pursues(each.stack, goal)), None)

    def _is_pursued(self, goal: Event) -> bool:
        return goal in self.events or goal in self.held_events or self._pursuing(goal) is not None

    def _is_late(self, goal: Event, deadline: Deadline) -> None:
        intention = self._pursuing(goal)
        if not deadline.is_hard:
            raise_state(self, goal, "late", structure("soft_deadline", deadline.milliseconds))
            return
        failure = StepFailed("deadline_reached", f"{goal} was not reached in {show(deadline.milliseconds)} ms")
        if intention is None:
            self.give_up_waiting(goal, failure)
        else:
            self.give_up_goal(intention, lambda means: means.event is goal, failure)


def _pursues(stack: list[Means], goal: Event) -> bool:
    return any(means.event is goal for means in stack)
