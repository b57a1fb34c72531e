"""Carrying a schedule out: its order counts, not its clock.

At every corridor and at every post robots enter in the order of the schedule. Of all entries to come the earliest can
always be made: all before it have been made, and what they hold is given back without anybody else's doing. So delays
never end in a deadlock, they only move the times (`retimed`).
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from math import inf

from fleet.schedule.journey import Goal, Journey, Leg, Start, Task, ready_after, without_first
from fleet.schedule.network import Lane, Network

Travel = Callable[[str, Lane], float]
"""How long a robot takes through a lane."""


class OutOfOrderError(ValueError):
    """In this order a robot enters a post before another has left a bay there."""


def may_enter(
    network: Network, starts: Mapping[str, Start], journeys: Mapping[str, Journey], robot: str, now_s: float
) -> bool:
    """Tell if a robot that is ready may enter the next corridor of its journey now.

    `starts`: where every robot is, those included that have no journey (they are dead where they are).
    """
    legs = journeys[robot].legs
    return len(legs) > 1 and next(waits_for(network, starts, journeys, robot, now_s), None) is None


def waits_for(
    network: Network, starts: Mapping[str, Start], journeys: Mapping[str, Journey], robot: str, now_s: float
) -> Iterator[str]:
    """Return the robots that must go on before this one may enter its next corridor: none, if it may."""
    mine = journeys[robot].legs[1]
    for other, start in starts.items():
        if other == robot:
            continue
        coming = journeys[other].legs[1:] if other in journeys else ()
        held = (start, *start.on_the_way())
        if any(_goes_before((leg, other), (mine, robot)) for leg in coming) or any(
            _is_in_the_way(one, mine, now_s) for one in held
        ):
            yield other
    if not mine.at_home:
        there = [
            other
            for other, start in starts.items()
            for one in (start, *start.on_the_way())
            if other != robot and _stands_at(one, mine.post)
        ]
        if len(there) >= network.bays[mine.post]:
            yield from there


def retimed(
    network: Network, tasks: Mapping[str, Task], journeys: Mapping[str, Journey], travel_s: Travel | None = None
) -> dict[str, Journey]:
    """The same ways in the same order, as early as they can be from where the robots are now.

    Nothing is begun that was not begun: the first leg of each journey is where its robot's task starts. Raises
    OutOfOrderError for what no check would let through.
    """
    course = _Course(network, tasks, journeys, travel_s or (lambda _, lane: lane.travel_s))
    to_come = [(leg.enter_s, robot) for robot, journey in journeys.items() for leg in journey.legs[1:]]
    for _, robot in sorted(to_come):
        course.enter_next(robot)
    return {robot: course.journey(robot) for robot in journeys}


def caught_up(
    network: Network, tasks: Mapping[str, Task], journeys: Mapping[str, Journey]
) -> dict[str, Journey] | None:
    """Without the legs that have begun since, and as late as it is now; None if a robot is where its journey does not
    lead, or in the way of it."""
    if journeys.keys() != tasks.keys():
        return None
    left = {name: _from_start(tasks[name].start, journey) for name, journey in journeys.items()}
    known = {name: journey for name, journey in left.items() if journey is not None}
    try:
        return retimed(network, tasks, known) if len(known) == len(left) else None
    except OutOfOrderError:
        return None


def _from_start(start: Start, journey: Journey) -> Journey | None:
    while True:
        first = journey.legs[0]
        if (first.post, first.at_home) == (start.post, start.at_home):
            return journey
        if len(journey.legs) == 1:
            return None
        journey = without_first(journey)


def one_behind_the_other(tasks: Mapping[str, Task]) -> dict[str, Task]:
    """Robots that follow each other in a corridor arrive in that order, however late the first is: none overtakes."""
    expected, last_s = dict(tasks), dict[tuple[int, int], float]()
    for robot, task in sorted(tasks.items(), key=lambda one: (one[1].start.entered_s, one[1].start.arrives_s)):
        start, lane = task.start, task.start.lane
        if lane is None or lane.following_s is None:
            continue
        way = lane.corridor, lane.backwards
        arrives_s = max(start.arrives_s, last_s.get(way, -inf) + lane.following_s)
        last_s[way] = arrives_s
        expected[robot] = replace(task, start=replace(start, arrives_s=arrives_s, ready_s=arrives_s))
    return expected


class _Course:
    """The course so far, entry by entry."""

    def __init__(
        self, network: Network, tasks: Mapping[str, Task], journeys: Mapping[str, Journey], travel_s: Travel
    ) -> None:
        self._network, self._tasks, self._journeys, self._travel_s = network, tasks, journeys, travel_s
        self._legs = {robot: [_first(tasks[robot], journey)] for robot, journey in journeys.items()}
        self._goals = {robot: tasks[robot].goals[legs[0].goals :] for robot, legs in self._legs.items()}
        self._entered_s = [-inf] * len(network.posts)
        self._passages: dict[int, list[Leg]] = {}
        self._bays_from_s = [[-inf] * bays for bays in network.bays]
        for task in tasks.values():
            self._take_first(task.start)
        for task in tasks.values():
            for start in task.start.on_the_way():
                self._take_first(start)
                if not start.at_home:
                    self._bays_from_s[start.post].append(start.ready_s + network.clearance_s)

    def enter_next(self, robot: str) -> None:
        legs = self._legs[robot]
        before, planned = legs[-1], self._journeys[robot].legs[len(legs)]
        travel_s, enter_s = 0.0, before.ready_s
        if planned.lane is not None:
            travel_s = self._travel_s(robot, planned.lane)
            enter_s = max(enter_s, self._corridor_from_s(planned.lane, travel_s))
        if not planned.at_home:
            enter_s = max(enter_s, self._entered_s[planned.post], self._take_bay(planned.post))
            self._entered_s[planned.post] = enter_s
        if not before.at_home:
            self._bays_from_s[before.post].append(enter_s + self._network.clearance_s)
        arrive_s = enter_s + travel_s
        ready_s = ready_after(arrive_s, self._next_goals(robot, planned.goals))
        leg = planned._replace(enter_s=enter_s, arrive_s=arrive_s, ready_s=ready_s)
        legs.append(leg)
        if planned.lane is not None:
            self._passages.setdefault(planned.lane.corridor, []).append(leg)

    def journey(self, robot: str) -> Journey:
        legs, planned = tuple(self._legs[robot]), self._journeys[robot]
        work = len(planned.work)
        served = [leg.ready_s for leg in legs if leg.goals]
        return Journey(legs[:work], legs[work:], served[-1] if served else legs[0].ready_s)

    def _take_first(self, start: Start) -> None:
        if not start.at_home and self._bays_from_s[start.post]:
            self._bays_from_s[start.post].remove(min(self._bays_from_s[start.post]))
        if start.lane is not None:
            leg = Leg(start.lane, start.entered_s, start.arrives_s, start.post, start.at_home, 0, start.ready_s)
            self._passages.setdefault(start.lane.corridor, []).append(leg)

    def _take_bay(self, post: int) -> float:
        """Return the time from which a bay is free: one that another robot has left before in the order of the
        schedule."""
        free = self._bays_from_s[post]
        if not free:
            raise OutOfOrderError(f"no bay at {self._network.posts[post]}")
        from_s = min(free)
        free.remove(from_s)
        return from_s

    def _corridor_from_s(self, lane: Lane, travel_s: float) -> float:
        clear_s = self._network.clearance_s
        from_s = -inf
        for leg in self._passages.get(lane.corridor, ()):
            if lane.following_s is not None and leg.lane is not None and leg.lane.backwards == lane.backwards:
                from_s = max(from_s, max(leg.enter_s, leg.arrive_s - travel_s) + lane.following_s)
            else:
                from_s = max(from_s, leg.arrive_s + clear_s)
        return from_s

    def _next_goals(self, robot: str, count: int) -> tuple[Goal, ...]:
        goals = self._goals[robot]
        self._goals[robot] = goals[count:]
        return goals[:count]


def _first(task: Task, journey: Journey) -> Leg:
    """Where the robot is, with those goals that no later leg serves."""
    start = task.start
    goals = len(task.goals) - sum(leg.goals for leg in journey.legs[1:])
    ready_s = ready_after(start.ready_s, task.goals[:goals])
    return Leg(start.lane, start.entered_s, start.arrives_s, start.post, start.at_home, goals, ready_s)


def _goes_before(theirs: tuple[Leg, str], mine: tuple[Leg, str]) -> bool:
    """Tell if another's entry to come is before mine, at the same corridor or at the same post. Entries of one moment
    do not need each other; they go by name, so that the order is one."""
    (leg, other), (my_leg, me) = theirs, mine
    if (leg.enter_s, other) > (my_leg.enter_s, me):
        return False
    same_post = leg.post == my_leg.post and not leg.at_home and not my_leg.at_home
    same_corridor = leg.lane is not None and my_leg.lane is not None and leg.lane.corridor == my_leg.lane.corridor
    return same_post or same_corridor


def _is_in_the_way(start: Start, mine: Leg, now_s: float) -> bool:
    if start.lane is None or mine.lane is None or start.lane.corridor != mine.lane.corridor:
        return False
    after_s = mine.lane.following_s
    if after_s is None or start.lane.backwards != mine.lane.backwards:
        return True
    late_s = max(start.entered_s, start.arrives_s - mine.lane.travel_s)
    return now_s < late_s + after_s


def _stands_at(start: Start, post: int) -> bool:
    return start.post == post and not start.at_home
