"""A robot as the traffic knows it, what of its work can be planned for now, and what is open for everybody."""

from collections.abc import Collection
from dataclasses import dataclass, replace
from math import isinf

from app.traffic.journey import Goal, Start, Task
from app.traffic.network import Lane, Network
from app.traffic.under_way import all_held, expected


@dataclass
class Participant:
    """`claim`: the corridor that it has asked for. `frozen`: dead or paused, it stays where it is."""

    home: int | None
    start: Start
    goals: tuple[Goal, ...] = ()
    claim: Lane | None = None
    frozen: bool = False
    goals_wait: bool = False
    """No timetable was found with its goals."""
    stays: bool = False
    """None was found that leads it home."""

    def task(self, network: Network, now_s: float) -> Task:
        """As it is now: of its goals those that can be reached."""
        start, way_s = self.start, network.shortest_s[self.start.post]
        if start.lane is not None:
            start = expected(start, now_s)
        elif start.ready_s < now_s:
            start = replace(start, ready_s=now_s)
        home = self.home if self.home is not None and not isinf(way_s[self.home]) else None
        goals = tuple(goal for goal in self.goals if not isinf(way_s[goal.post]) and self._can_stop(network, goal.post))
        return Task(start, () if self.goals_wait else goals, None if self.stays else home)

    def lacks(self, network: Network) -> bool:
        """Whether some goal, or home, is not in its task."""
        task = self.task(network, self.start.ready_s)
        return len(task.goals) < len(self.goals) or task.home != self.home

    def _can_stop(self, network: Network, post: int) -> bool:
        return network.bays[post] > 0 or post in (self.home, self.start.post)


def open_network(whole: Network, closed: Collection[str], robots: Collection[Participant]) -> Network:
    """Without these corridors, and without what frozen robots stand in."""
    frozen = [start for robot in robots if robot.frozen for start in all_held(robot.start)]
    blocked = {whole.corridors[start.lane.corridor] for start in frozen if start.lane is not None}
    bays = list(whole.bays)
    for start in frozen:
        if not start.at_home:
            bays[start.post] -= 1
    return replace(whole.without({*closed, *blocked}), bays=tuple(bays))


def is_full(whole: Network, post: int, robots: Collection[Participant]) -> bool:
    """Whether every bay of a post is somebody's."""
    held = [start for robot in robots for start in all_held(robot.start)]
    return sum(1 for start in held if start.post == post and not start.at_home) >= whole.bays[post]
