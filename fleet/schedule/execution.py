"""Carrying a schedule out: its order counts, not its clock.

At every corridor and at every post robots enter in the order of the schedule. Of all entries to come the earliest can
always be made: all before it have been made, and what they hold is given back without anybody else's doing. So delays
never end in a deadlock, they only move the times (`retimed`).

A crossing is held only by who has been let into what lies behind it, so that it is always given back. No order is
needed there for the schedule to be carried out; a robot that is about to come is let over first if it is to be first,
but for one that is late no other waits (`waits_for`).
"""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import islice
from math import inf

from fleet.schedule.course import Course, OutOfOrderError, Travel
from fleet.schedule.journey import Journey, Leg, Start, Task, staying, without_first
from fleet.schedule.network import Network


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
        goes_before = other in journeys and _goes_before(journeys[other], other, mine, robot)
        if goes_before or any(_is_in_the_way(network, one, mine, now_s) for one in (start, *start.on_the_way())):
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
    yield from waits_to_cross(
        network, starts, journeys, robot, mine.post if mine.lane is None else mine.lane.start, now_s
    )


def waits_to_cross(
    network: Network, starts: Mapping[str, Start], journeys: Mapping[str, Journey], robot: str, post: int, now_s: float
) -> Iterator[str]:
    """Return the robots whose the crossing of this post is, or that come to it before this one would be over and are
    to go first."""
    over_s = network.crossing_s[post]
    if not over_s:
        return
    mine_s = next_move_s(starts[robot], journeys.get(robot))
    for other, start in starts.items():
        if other == robot:
            continue
        if any(crossing == post for crossing, _ in start.crossings()):
            yield other
        elif start.lane is not None and start.post == post and not start.is_on_its_way:
            comes_soon = now_s <= start.arrives_s < now_s + over_s
            is_first = next_move_s(start, journeys.get(other)) < mine_s
            if _is_ahead(start, starts[robot]) or (comes_soon and is_first):
                yield other


def _is_ahead(one: Start, other: Start) -> bool:
    """Tell if both are in one lane, this one nearer to its end."""
    was_first = (one.entered_s, one.arrives_s) < (other.entered_s, other.arrives_s)
    return one.lane is not None and one.lane == other.lane and was_first


def next_move_s(start: Start, journey: Journey | None) -> float:
    """When it is next to begin to cross by its journey: at the end of its corridor, or from where it stands."""
    if journey is None:
        return inf
    if start.lane is not None:
        return journey.legs[0].arrive_s
    return journey.legs[1].enter_s if len(journey.legs) > 1 else inf


def moves_over(network: Network, journey: Journey, post: int) -> Iterator[float]:
    """When each move over the crossing of this post begins by the journey, where that takes time."""
    if not network.crossing_s[post]:
        return
    for number, leg in enumerate(journey.legs):
        if leg.post == post and leg.over_s:
            yield leg.arrive_s
        if number and leg.lane is not None and leg.lane.start == post:
            yield leg.enter_s


def retimed(
    network: Network, tasks: Mapping[str, Task], journeys: Mapping[str, Journey], travel_s: Travel | None = None
) -> dict[str, Journey]:
    """The same ways in the same order, as early as they can be from where the robots are now.

    Nothing is begun that was not begun: the first leg of each journey is where its robot's task starts. Raises
    OutOfOrderError for what no check would let through.
    """
    return Course(network, tasks, journeys, travel_s or (lambda _, lane: lane.travel_s)).run()


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
        ready_s = arrives_s + start.ready_s - start.arrives_s
        expected[robot] = replace(task, start=replace(start, arrives_s=arrives_s, ready_s=ready_s))
    return expected


def in_turn(tasks: Mapping[str, Task], journeys: Mapping[str, Journey]) -> dict[str, Task]:
    """Those in corridors at the end of theirs when they come to the crossing there by these journeys, retimed: there
    is one move at a time over it, so that whatever is planned can be planned round these."""
    return {robot: _at_its_end(task, journeys[robot].legs[0]) for robot, task in tasks.items()}


def standing_in_turn(network: Network, tasks: Mapping[str, Task]) -> dict[str, Task]:
    """The same when there is no schedule: each robot comes in where it is let in, first come, first served."""
    journeys = {robot: staying(task.start) for robot, task in tasks.items()}
    still = {robot: Task(task.start, (), task.home) for robot, task in tasks.items()}
    return in_turn(tasks, retimed(network, still, journeys))


def _at_its_end(task: Task, leg: Leg) -> Task:
    start = task.start
    if start.lane is None or start.crosses or start.arrives_s == leg.arrive_s:
        return task
    by_s = leg.arrive_s - start.arrives_s
    return replace(task, start=replace(start, arrives_s=leg.arrive_s, ready_s=start.ready_s + by_s))


def _goes_before(journey: Journey, other: str, my_leg: Leg, me: str) -> bool:
    """Tell if an entry of another's to come is before mine, at the same corridor or at the same post. Entries of one
    moment do not need each other; they go by name, so that the order is one."""
    for leg in islice(journey.legs, 1, None):
        if (leg.enter_s, other) > (my_leg.enter_s, me):
            return False  # and so are all behind it
        same_post = leg.post == my_leg.post and not leg.at_home and not my_leg.at_home
        same_corridor = leg.lane is not None and my_leg.lane is not None and leg.lane.corridor == my_leg.lane.corridor
        if same_post or same_corridor:
            return True
    return False


def _is_in_the_way(network: Network, start: Start, mine: Leg, now_s: float) -> bool:
    if start.lane is None or mine.lane is None or start.lane.corridor != mine.lane.corridor:
        return False
    after_s = mine.lane.following_s
    if after_s is None or start.lane.following_s is None or start.lane.backwards != mine.lane.backwards:
        return True
    late_s = max(start.entered_s, start.arrives_s - network.takes_s(mine.lane))
    return now_s < late_s + after_s


def _stands_at(start: Start, post: int) -> bool:
    return start.post == post and not start.at_home
