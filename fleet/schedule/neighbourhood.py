"""Which robots are planned again, and in which order: the neighbourhoods of a large neighbourhood search.

Half of them begin with a robot that is late, and others that come where its shortest way leads: these may be what it
waits for (Li et al., "Anytime Multi-Agent Path Finding via Large Neighborhood Search", IJCAI 2021, have the agent-based
kind). The other half are drawn from all.
"""

from collections.abc import Mapping, Sequence
from random import Random
from typing import Final

from fleet.schedule.journey import Journey, Task
from fleet.schedule.network import Network

SOME_OF: Final = 4
"""So many robots at most, of many."""
ALL_OF: Final = 12
"""Of more robots never all are planned again: that takes as long as some tens of neighbourhoods of few."""
LATE: Final = 0.5
"""Share of the neighbourhoods that begin with a late robot."""
FIRST: Final = 0.7
"""Share of those in which it is planned first."""
ELSEWHERE: Final = 1e-3
"""Weight of a robot that comes nowhere where the late one's way leads."""
WORTH_S: Final = 1.0


def neighbourhood(
    network: Network, tasks: Mapping[str, Task], journeys: Mapping[str, Journey], order: Sequence[str], rng: Random
) -> list[str]:
    """Robots of `order`, the most favoured first, that are to be planned again round all others as they are."""
    if rng.random() < LATE:
        late_s = {name: _late_s(network, tasks[name], journeys[name]) for name in order if tasks[name].goals}
        late = [name for name, by_s in late_s.items() if by_s > WORTH_S]
        if late:
            (first,) = rng.choices(late, [late_s[name] for name in late])
            return _round_a_late_one(network, tasks[first], journeys, first, order, rng)
    return _of_all(order, rng)


def _late_s(network: Network, task: Task, journey: Journey) -> float:
    """By how much it is done later than alone on the campus."""
    at_s, post = task.start.ready_s, task.start.post
    for goal in task.goals:
        at_s = max(at_s + network.shortest_s[post][goal.post], goal.not_before_s) + goal.handling_s
        post = goal.post
    return journey.done_s - at_s


def _round_a_late_one(
    network: Network, task: Task, journeys: Mapping[str, Journey], first: str, order: Sequence[str], rng: Random
) -> list[str]:
    posts = _posts_on_its_way(network, task)
    others = [name for name in order if name != first]
    weights = [ELSEWHERE + sum(leg.post in posts for leg in journeys[name].work) for name in others]
    chosen = [first]
    for _ in range(min(len(others), rng.randint(1, SOME_OF - 1))):
        (at,) = rng.choices(range(len(others)), weights)
        chosen.append(others.pop(at))
        del weights[at]
    if rng.random() >= FIRST:
        rng.shuffle(chosen)
    return chosen


def _posts_on_its_way(network: Network, task: Task) -> set[int]:
    """To its goals, on empty corridors."""
    at = task.start.post
    posts = {at}
    for goal in task.goals:
        while at != goal.post:
            at = network.next_post(at, goal.post)
            posts.add(at)
    return posts


def _of_all(order: Sequence[str], rng: Random) -> list[str]:
    """All with one of them elsewhere in the order, or shuffled; of many also some few."""
    chosen = list(order)
    if len(chosen) > ALL_OF or (len(chosen) > SOME_OF and rng.random() < 0.5):
        return rng.sample(chosen, rng.randint(2, SOME_OF))
    if rng.random() < 0.6:
        moved = chosen.pop(rng.randrange(len(chosen)))
        chosen.insert(rng.randrange(len(chosen) + 1), moved)
    else:
        rng.shuffle(chosen)
    return chosen
