"""A robot as the traffic knows it, what of its work can be planned for now, and what is open for everybody."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from math import isinf

from fleet.schedule.journey import Goal, Start, Task
from fleet.schedule.network import Lane, Network
from fleet.schedule.under_way import LATE_S, all_held, expected


@dataclass
class Participant:
    """`start`: where it is, and since when it does there what it does. `claim`: the corridor that it has asked for.
    `frozen`: dead or paused, it stays where it is."""

    home: int | None
    start: Start
    goals: tuple[Goal, ...] = ()
    claim: Lane | None = None
    asks_in: bool = False
    """It waits to come in at the end of its corridor, or to go aside."""
    turns: bool = False
    """In its corridor it turns round, or has: it comes in where it came from, and does not go straight on there."""
    frozen: bool = False
    goals_wait: bool = False
    """No schedule was found with its goals."""
    stays: bool = False
    """None was found that leads it home."""
    is_shut_in: bool = False
    """It is in a corridor at whose end it cannot come in, and cannot turn round now."""

    @property
    def stands_still(self) -> bool:
        """Nothing can be planned for it."""
        return self.frozen or self.is_shut_in

    def task(self, network: Network, now_s: float) -> Task:
        """As it is now: of its goals those that can be reached."""
        start = self.start
        if not start.rests:
            start = expected(start, now_s)
        elif start.ready_s < now_s:
            start = replace(start, ready_s=now_s)
        if start.lane is not None:
            start = replace(start, ready_s=start.arrives_s + network.crossing_s[start.post])
        home = self.home if self._comes_home(network) else None
        return Task(start, self._planned(network, self._left(now_s)), None if self.stays else home)

    def planned_goals(self, network: Network) -> tuple[Goal, ...]:
        """Those of its goals that the schedule serves."""
        return self._planned(network, self.goals)

    def wants(self, goals: Sequence[Goal], now_s: float) -> None:
        """These from now on. What it has begun goes on; something else begins now."""
        if not (goals and self.goals and goals[0].key == self.goals[0].key):
            self.begins(now_s)
        self.goals = tuple(goals)

    def begins(self, now_s: float) -> None:
        if self.start.rests:
            self.start = replace(self.start, ready_s=now_s)

    def as_told(self, goals: Sequence[Goal]) -> tuple[Goal, ...]:
        """The same goals, the one that it has begun in its whole length."""
        told = {goal.key: goal for goal in self.goals}
        return tuple(told.get(goal.key, goal) for goal in goals)

    def _left(self, now_s: float) -> tuple[Goal, ...]:
        """Return its goals: one that it has begun takes only the rest of its time; one that should be done by now, a
        moment more."""
        start = self.start
        if not start.rests or not self.goals or self.goals[0].post != start.post:
            return self.goals
        first = self.goals[0]
        begun_s = min(now_s, max(start.ready_s, first.not_before_s))
        left_s = max(first.handling_s - (now_s - begun_s), min(first.handling_s, LATE_S))
        return (first._replace(handling_s=left_s), *self.goals[1:])

    def lacks(self, network: Network) -> bool:
        """Tell if some goal, or home, is not in its task."""
        task = self.task(network, self.start.ready_s)
        return len(task.goals) < len(self.goals) or task.home != self.home

    def _comes_home(self, network: Network) -> bool:
        start = self.start
        if self.home is None or isinf(network.shortest_s[start.post][self.home]):
            return False
        return start.post != self.home or start.at_home or start.post not in network.shut

    def _planned(self, network: Network, goals: Sequence[Goal]) -> tuple[Goal, ...]:
        return () if self.goals_wait else tuple(goal for goal in goals if self._can_reach(network, goal.post))

    def _can_reach(self, network: Network, post: int) -> bool:
        has_room = network.bays[post] > 0 or post in (self.home, self.start.post)
        return has_room and not isinf(network.shortest_s[self.start.post][post])


def open_network(whole: Network, closed: Collection[str], robots: Collection[Participant]) -> Network:
    """Without these corridors, and without what robots that stand still are in: a crossing that one of them may be on
    is shut."""
    still = [robot.start for robot in robots if robot.stands_still]
    frozen = [held for start in still for held in all_held(start)]
    shut = {post for start in still for post, _ in start.crossings()}
    blocked = {whole.corridors[start.lane.corridor] for start in frozen if start.lane is not None}
    bays = list(whole.bays)
    for start in frozen:
        if not start.at_home:
            bays[start.post] -= 1
    return replace(whole.without({*closed, *blocked}, shut), bays=tuple(bays))


def is_full(whole: Network, post: int, robots: Collection[Participant]) -> bool:
    """Tell if every bay of a post is a robot's."""
    held = [start for robot in robots for start in all_held(robot.start)]
    return sum(1 for start in held if start.post == post and not start.at_home) >= whole.bays[post]
