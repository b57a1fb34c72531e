"""When each goal of a plan will be reached: the plan is carried out many times, each time with other durations.

Robots keep to the order of entry, so that a late one makes those late who come after it: waits for others are in it.
Charging is too: a charge is a goal at a dock, and how long it may take is the caller's to say, as of every goal.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import Final, NamedTuple

from fleet.eta.intervals import Interval, interval_of
from fleet.schedule.course import Travel
from fleet.schedule.execution import retimed
from fleet.schedule.journey import Goal, Journey, Start, Task, Through
from fleet.schedule.network import Lane, Network

DRAWS: Final = 60

Handling = Callable[[Goal], float]
"""How long a goal takes, the next time: from now on, for one that has begun."""
Arriving = Callable[[str, Lane, float], float]
"""When a robot leaves a lane that it is in or was let into, entered at this time."""


class Chance(NamedTuple):
    """The part that is drawn anew each time."""

    travel_s: Travel
    handling_s: Handling
    arrives_s: Arriving


def forecast(
    network: Network,
    tasks: Mapping[str, Task],
    journeys: Mapping[str, Journey],
    now_s: float,
    chance: Chance,
    draws: int = DRAWS,
) -> dict[str, Interval]:
    """For the key of each goal, in how many seconds from now the robot is there and it can begin."""
    reached: dict[str, list[float]] = {}
    for _ in range(draws):
        drawn = {robot: _drawn(robot, task, chance) for robot, task in tasks.items()}
        for robot, journey in retimed(network, drawn, journeys, chance.travel_s).items():
            for key, at_s in reached_s(drawn[robot], journey):
                reached.setdefault(key, []).append(max(0.0, at_s - now_s))
    return {key: interval_of(times) for key, times in reached.items()}


def reached_s(task: Task, journey: Journey) -> Iterator[tuple[str, float]]:
    """When each goal begins, by its key."""
    goals = iter(task.goals)
    at_s = task.start.ready_s
    for number, leg in enumerate(journey.legs):
        at_s = max(at_s, leg.stands_s) if number == 0 else leg.stands_s
        for _ in range(leg.goals):
            goal = next(goals)
            at_s = max(at_s, goal.not_before_s)
            yield goal.key, at_s
            at_s += goal.handling_s


def _drawn(robot: str, task: Task, chance: Chance) -> Task:
    goals = tuple(goal._replace(handling_s=chance.handling_s(goal)) for goal in task.goals)
    return replace(task, start=_drawn_start(robot, task.start, chance), goals=goals)


def _drawn_start(robot: str, start: Start, chance: Chance) -> Start:
    if start.lane is None:
        return start
    entered_s, before = start.entered_s, list[Through]()
    for one in start.before:  # let into several at once, it comes to one after the other
        arrives_s = one.arrives_s if one.lane is None else chance.arrives_s(robot, one.lane, entered_s)
        before.append(one._replace(arrives_s=arrives_s))
        entered_s = arrives_s + one.over_s
    arrives_s = chance.arrives_s(robot, start.lane, entered_s)
    ready_s = arrives_s + start.ready_s - start.arrives_s
    return replace(start, arrives_s=arrives_s, ready_s=ready_s, before=tuple(before))
