"""The course of a schedule: the same ways in the same order, as early as they can be, move by move.

Moves are entries into corridors, from where a robot stands or straight on, and moves into a bay or home place at the
end of a corridor. At each place they come in the order of the schedule.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from math import inf

from fleet.schedule.journey import Journey, Leg, Start, Task, ready_after
from fleet.schedule.network import Lane, Network

Travel = Callable[[str, Lane], float]
"""How long a robot takes through a lane."""


class OutOfOrderError(ValueError):
    """In this order a robot enters a post before another has left a bay there."""

    def __init__(self, robot: str, post: str) -> None:
        super().__init__(f"{robot} finds no bay at {post}")
        self.robot = robot


@dataclass(slots=True)
class _Passage:
    lane: Lane
    enter_s: float
    leave_s: float


class Course:
    """The course so far."""

    def __init__(
        self, network: Network, tasks: Mapping[str, Task], journeys: Mapping[str, Journey], travel_s: Travel
    ) -> None:
        self._network, self._tasks, self._journeys, self._travel_s = network, tasks, journeys, travel_s
        self._legs = {robot: [self._first(robot)] for robot in journeys}
        self._goals = {robot: tasks[robot].goals[legs[0].goals :] for robot, legs in self._legs.items()}
        self._serves = {robot: tasks[robot].goals[: legs[0].goals] for robot, legs in self._legs.items()}
        self._entered_s = [-inf] * len(network.posts)
        self._passages: dict[int, list[_Passage]] = {}
        self._passage_of: dict[str, _Passage] = {}
        self._bays_from_s = [[-inf] * bays for bays in network.bays]
        self._crossing_from_s = [-inf] * len(network.posts)
        in_order = sorted(tasks, key=lambda robot: (tasks[robot].start.entered_s, tasks[robot].start.arrives_s))
        for robot in in_order:
            self._take_first(robot, tasks[robot].start)
        for robot in in_order:
            self._take_on_the_way(robot, tasks[robot].start)

    def run(self) -> dict[str, Journey]:
        """Every move in the order of the schedule. Raises OutOfOrderError."""
        for _, robot, number, comes_in in sorted(self._moves()):
            if comes_in:
                self._come_in(robot)
            else:
                self._enter(robot, self._journeys[robot].legs[number])
        return {robot: self._journey(robot) for robot in self._journeys}

    def _moves(self) -> Iterator[tuple[float, str, int, bool]]:
        crossing_s = self._network.crossing_s
        for robot, journey in self._journeys.items():
            for number, leg in enumerate(journey.legs):
                if number:
                    yield leg.enter_s, robot, number, False
                if crossing_s[leg.post] and self._is_to_come_in(robot, number, leg):
                    yield leg.arrive_s, robot, number, True

    def _is_to_come_in(self, robot: str, number: int, leg: Leg) -> bool:
        if number:
            return leg.lane is not None and leg.over_s > 0.0
        start = self._tasks[robot].start
        return start.lane is not None and not start.crosses and not self._goes_straight_on(self._legs[robot][0])

    def _goes_straight_on(self, leg: Leg) -> bool:
        return leg.lane is not None and not leg.over_s and self._network.crossing_s[leg.post] > 0.0

    def _enter(self, robot: str, planned: Leg) -> None:
        """Over the crossing, out of where it stands or straight on, and into the next corridor, or aside."""
        before, lane = self._legs[robot][-1], planned.lane
        over_s, in_s = self._network.crossing_s[before.post], self._network.crossing_s[planned.post]
        travel_s = 0.0 if lane is None else over_s + self._travel_s(robot, lane)
        enter_s = max(before.ready_s, self._crossing_from_s[before.post])
        if lane is not None:
            enter_s = max(enter_s, self._corridor_from_s(lane, travel_s))
        if self._goes_straight_on(before):
            enter_s = max(enter_s, self._behind_s(robot))
        if not planned.at_home:
            enter_s = max(enter_s, self._entered_s[planned.post], self._take_bay(robot, planned.post))
            self._entered_s[planned.post] = enter_s
        if self._goes_straight_on(before):
            self._leaves_corridor(robot, before._replace(arrive_s=enter_s, ready_s=enter_s))
        if not before.at_home:
            self._bays_from_s[before.post].append(enter_s + over_s + self._network.clearance_s)
        self._cross(before.post, enter_s)
        self._arrive(robot, planned, enter_s, enter_s + travel_s, 0.0 if self._goes_straight_on(planned) else in_s)

    def _arrive(self, robot: str, planned: Leg, enter_s: float, arrive_s: float, over_s: float) -> None:
        goals = self._goals[robot]
        self._serves[robot], self._goals[robot] = goals[: planned.goals], goals[planned.goals :]
        ready_s = ready_after(arrive_s + over_s, self._serves[robot])
        leg = planned._replace(enter_s=enter_s, arrive_s=arrive_s, ready_s=ready_s, over_s=over_s)
        self._legs[robot].append(leg)
        if leg.lane is not None:
            self._enters_corridor(robot, leg.lane, enter_s, arrive_s)

    def _come_in(self, robot: str) -> None:
        """From the end of its corridor over the crossing, to where it stops."""
        leg = self._legs[robot][-1]
        arrive_s = max(leg.arrive_s, self._crossing_from_s[leg.post], self._behind_s(robot))
        self._cross(leg.post, arrive_s)
        ready_s = ready_after(arrive_s + leg.over_s, self._serves[robot])
        self._leaves_corridor(robot, leg._replace(arrive_s=arrive_s, ready_s=ready_s))

    def _cross(self, post: int, from_s: float) -> None:
        over_s = self._network.crossing_s[post]
        if over_s:
            self._crossing_from_s[post] = from_s + over_s + self._network.clearance_s

    def _journey(self, robot: str) -> Journey:
        legs, planned = tuple(self._legs[robot]), self._journeys[robot]
        work = len(planned.work)
        served = [leg.ready_s for leg in legs if leg.goals]
        return Journey(legs[:work], legs[work:], served[-1] if served else legs[0].ready_s)

    def _first(self, robot: str) -> Leg:
        """Where the robot is, with those goals that no later leg serves."""
        task, planned = self._tasks[robot], self._journeys[robot].legs
        start, goals = task.start, len(task.goals) - sum(leg.goals for leg in planned[1:])
        over_s = 0.0 if start.lane is None else self._network.crossing_s[start.post]
        first = Leg(start.lane, start.entered_s, start.arrives_s, start.post, start.at_home, goals, 0.0, over_s)
        goes_on = self._goes_straight_on(planned[0]) and len(planned) > 1 and planned[1].lane is not None
        if over_s and goes_on and not goals and not start.crosses:
            return first._replace(ready_s=start.arrives_s, over_s=0.0)
        return first._replace(ready_s=ready_after(start.ready_s, task.goals[:goals]))

    def _take_first(self, robot: str, start: Start) -> None:
        if not start.at_home and self._bays_from_s[start.post]:
            self._bays_from_s[start.post].remove(min(self._bays_from_s[start.post]))
        if start.lane is not None:
            self._enters_corridor(robot, start.lane, start.entered_s, start.arrives_s)

    def _take_on_the_way(self, robot: str, start: Start) -> None:
        clear_s, own = self._network.clearance_s, self._passage_of.get(robot)
        for one in start.on_the_way():
            self._take_first(robot, one)
            if not one.at_home:
                self._bays_from_s[one.post].append(one.ready_s + clear_s)
        for post, until_s in start.crossings():
            self._crossing_from_s[post] = max(self._crossing_from_s[post], until_s + clear_s)
        if own is not None:
            self._passage_of[robot] = own

    def _enters_corridor(self, robot: str, lane: Lane, enter_s: float, leave_s: float) -> None:
        self._passage_of[robot] = passage = _Passage(lane, enter_s, leave_s)
        self._passages.setdefault(lane.corridor, []).append(passage)

    def _leaves_corridor(self, robot: str, leg: Leg) -> None:
        """Its last leg as it has become, now that it is out of the corridor."""
        self._legs[robot][-1] = leg
        self._passage_of[robot].leave_s = leg.arrive_s

    def _take_bay(self, robot: str, post: int) -> float:
        """Return the time from which a bay is free: one that another robot has left before in the order of the
        schedule."""
        free = self._bays_from_s[post]
        if not free:
            raise OutOfOrderError(robot, self._network.posts[post])
        from_s = min(free)
        free.remove(from_s)
        return from_s

    def _corridor_from_s(self, lane: Lane, travel_s: float) -> float:
        clear_s = self._network.clearance_s
        from_s = -inf
        for passage in self._passages.get(lane.corridor, ()):
            follows = None not in (lane.following_s, passage.lane.following_s)
            if lane.following_s is not None and follows and passage.lane.backwards == lane.backwards:
                from_s = max(from_s, max(passage.enter_s, passage.leave_s - travel_s) + lane.following_s)
            else:
                from_s = max(from_s, passage.leave_s + clear_s)
        return from_s

    def _behind_s(self, robot: str) -> float:
        """When those that were let into its corridor before it have left it for so long that it may."""
        mine, from_s = self._passage_of[robot], -inf
        for passage in self._passages[mine.lane.corridor]:
            if passage is mine:
                break
            if passage.lane.backwards == mine.lane.backwards:
                from_s = max(from_s, passage.leave_s + (mine.lane.following_s or self._network.clearance_s))
        return from_s
