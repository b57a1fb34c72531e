"""Every robot home, from wherever it stands: one robot moves at a time, and others step aside.

Slow but complete: where this finds nothing there is nothing. It is asked when planning one robot after the other has
found no schedule, as may be after a fault in which no older one is left; while one is kept it is never needed.
"""

import heapq
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import count
from typing import Final

from fleet.schedule.execution import retimed
from fleet.schedule.journey import Journey, Leg, Task, standing
from fleet.schedule.network import Lane, Network

AT_HOME: Final = -1
MOST_STATES: Final = 100_000
"""About two seconds of search. Some hundred are enough unless many robots stand in each other's way."""
_Places = tuple[int, ...]


@dataclass(frozen=True, slots=True)
class _Move:
    robot: int
    lane: Lane | None
    post: int
    at_home: bool
    before: "_Move | None"


def evacuate(network: Network, tasks: Mapping[str, Task], most_states: int = MOST_STATES) -> dict[str, Journey] | None:
    """Journeys home without any goal, for every robot that has a home to come to; None if none were found."""
    robots = sorted(tasks)
    moves = _search(network, [tasks[robot] for robot in robots], most_states)
    if moves is None:
        return None
    legs = {robot: [standing(tasks[robot].start)] for robot in robots}
    all_stand_s = max((task.start.ready_s for task in tasks.values()), default=0.0)
    for number, move in enumerate(moves, start=1):
        at_s, over_s = all_stand_s + number, network.crossing_s[move.post]
        legs[robots[move.robot]].append(Leg(move.lane, at_s, at_s, move.post, move.at_home, 0, at_s, over_s))
    untimed = {robot: Journey(tuple(ways[:1]), tuple(ways[1:]), 0.0) for robot, ways in legs.items()}
    idle = {robot: Task(task.start, (), task.home) for robot, task in tasks.items()}
    return retimed(network, idle, untimed)


def _search(network: Network, tasks: Sequence[Task], most_states: int) -> list[_Move] | None:
    """Best first by the ways that are left."""
    start = tuple(AT_HOME if _is_home(task) else task.start.post for task in tasks)
    number = count()
    known = {start}
    ahead: list[tuple[float, int, _Places, _Move | None]] = [
        (_left_s(network, tasks, start), next(number), start, None)
    ]
    while ahead and len(known) <= most_states:
        left_s, _, places, last = heapq.heappop(ahead)
        if left_s == 0:
            return list(_all_moves(last))
        for after, move in _moves(network, tasks, places, last):
            if after not in known:
                known.add(after)
                heapq.heappush(ahead, (_left_s(network, tasks, after), next(number), after, move))
    return None


def _is_home(task: Task) -> bool:
    return task.start.at_home and task.start.post == task.home


def _moves(
    network: Network, tasks: Sequence[Task], places: _Places, last: _Move | None
) -> Iterator[tuple[_Places, _Move]]:
    for robot, (task, place) in enumerate(zip(tasks, places, strict=True)):
        if place == AT_HOME:
            continue  # no robot has to come out for another to get home
        if place == task.home and place not in network.shut:
            yield _moved(places, robot, AT_HOME), _Move(robot, None, place, True, last)
        for lane in network.lanes[place]:
            if lane.end == task.home:
                yield _moved(places, robot, AT_HOME), _Move(robot, lane, lane.end, True, last)
            elif places.count(lane.end) < network.bays[lane.end]:
                yield _moved(places, robot, lane.end), _Move(robot, lane, lane.end, False, last)


def _moved(places: _Places, robot: int, to: int) -> _Places:
    return (*places[:robot], to, *places[robot + 1 :])


def _left_s(network: Network, tasks: Sequence[Task], places: _Places) -> float:
    """Return the length of the ways home, and something for each robot that stands in a bay at its own home."""
    return sum(
        max(network.shortest_s[place][task.home], 1.0)
        for task, place in zip(tasks, places, strict=True)
        if place != AT_HOME and task.home is not None
    )


def _all_moves(last: _Move | None) -> Iterator[_Move]:
    if last is not None:
        yield from _all_moves(last.before)
        yield last
