"""Validation of a schedule: rule by rule, with nothing of what made it.

Every schedule is looked at before it counts, so a mistake of the search costs a plan and not a deadlock.
"""

from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations, pairwise

from fleet.schedule.journey import Journey, Leg, Start, Task, standing, stays
from fleet.schedule.network import Network

SLACK_S = 1e-5
"""Sums of times are not exact."""


def problems(network: Network, tasks: Mapping[str, Task], journeys: Mapping[str, Journey]) -> list[str]:
    """Every rule that is broken, as a sentence; none if it can be carried out."""
    return [
        *(f"{robot} has no journey" for robot in tasks.keys() - journeys.keys()),
        *(problem for robot in tasks.keys() & journeys.keys() for problem in _alone(network, robot, tasks, journeys)),
        *_in_corridors(network, tasks, journeys),
        *_on_crossings(network, tasks, journeys),
        *_in_bays(network, tasks, journeys),
    ]


def _alone(network: Network, robot: str, tasks: Mapping[str, Task], journeys: Mapping[str, Journey]) -> Iterator[str]:
    task, legs = tasks[robot], journeys[robot].legs
    yield from (f"{robot} {problem}" for problem in _ways(network, task, legs))
    yield from (f"{robot} {problem}" for problem in _goals(task, journeys[robot]))
    if task.home is not None and not (legs[-1].at_home and legs[-1].post == task.home):
        yield f"{robot} does not come home"
    for leg in legs[1:]:
        if leg.at_home and leg.post != task.home:
            yield f"{robot} is at home where another is"


def _ways(network: Network, task: Task, legs: Sequence[Leg]) -> Iterator[str]:
    start, first = task.start, legs[0]
    if (first.post, first.at_home, first.lane) != (start.post, start.at_home, start.lane):
        yield "does not begin where it is"
    if first.arrive_s < start.arrives_s - SLACK_S:
        yield "is at the end of its corridor before it can be"
    if first.ready_s < start.ready_s - SLACK_S and not _goes_straight_on(network, first):
        yield "begins before it is ready"
    for leg, following in pairwise(legs):
        lane = following.lane
        if lane is None and following.at_home and following.post == leg.post == task.home:
            if following.enter_s < leg.ready_s - SLACK_S:
                yield "goes to its home place before it is ready"
        elif (
            lane is None or lane.start != leg.post or lane.end != following.post or lane not in network.lanes[leg.post]
        ):
            yield f"has no way from {network.posts[leg.post]} to {network.posts[following.post]}"
        elif following.enter_s < leg.ready_s - SLACK_S:
            yield f"leaves {network.posts[leg.post]} before it is ready"
        elif following.arrive_s < following.enter_s + network.crossing_s[lane.start] + lane.travel_s - SLACK_S:
            yield f"is too fast on its way to {network.posts[following.post]}"
    yield from _crosses(network, start, legs)


def _crosses(network: Network, start: Start, legs: Sequence[Leg]) -> Iterator[str]:
    """Each leg ends with a move over a crossing, into a bay or home place or straight on."""
    for number, leg in enumerate(legs):
        post = network.posts[leg.post]
        if number == 0 and leg.lane is None:
            continue
        if not _goes_straight_on(network, leg):
            if leg.over_s < network.crossing_s[leg.post] - SLACK_S:
                yield f"is too fast over the crossing of {post}"
        elif leg.goals or number + 1 == len(legs) or (number == 0 and start.crosses):
            yield f"does not come in at {post}, where it is to stop"
        elif legs[number + 1].lane is None or abs(legs[number + 1].enter_s - leg.arrive_s) > SLACK_S:
            yield f"stops on the line before {post}"


def _goes_straight_on(network: Network, leg: Leg) -> bool:
    return leg.lane is not None and leg.over_s == 0.0 < network.crossing_s[leg.post]


def _goals(task: Task, journey: Journey) -> Iterator[str]:
    ahead = list(task.goals)
    for at, leg in enumerate(journey.legs):
        now_s = task.start.ready_s if at == 0 else leg.arrive_s + leg.over_s
        for _ in range(leg.goals):
            if not ahead or ahead[0].post != leg.post:
                yield f"serves what is not to be served at leg {at}"
                return
            goal = ahead.pop(0)
            now_s = max(now_s, goal.not_before_s) + goal.handling_s
        if (leg.goals or at) and leg.ready_s < now_s - SLACK_S:
            yield f"has not served all at leg {at} when it is said to be ready"
    if ahead:
        yield f"leaves {len(ahead)} of its goals unserved"


def _in_corridors(network: Network, tasks: Mapping[str, Task], journeys: Mapping[str, Journey]) -> Iterator[str]:
    passages: dict[int, list[tuple[str, Leg, bool]]] = {}
    for robot, journey in journeys.items():
        for number, leg in enumerate(journey.legs):
            if leg.lane is not None:
                passages.setdefault(leg.lane.corridor, []).append((robot, leg, number == 0))
    for robot, task in tasks.items():
        for leg in map(standing, task.start.on_the_way()):
            if leg.lane is not None:
                passages.setdefault(leg.lane.corridor, []).append((robot, leg, True))
    for corridor, through in passages.items():
        through.sort(key=lambda passage: passage[1].enter_s)
        follows = any(leg.lane is not None and leg.lane.following_s is not None for _, leg, _ in through)
        follows |= sum(begun for _, _, begun in through) > 1
        # Where robots may not follow, each must be out before the next enters, so that comparing neighbours is enough.
        # How those came there who are in it now is no plan any more.
        for (robot, one, begun), (other, two, too) in combinations(through, 2) if follows else pairwise(through):
            if robot != other and not (begun and too) and not _apart(network, one, two):
                yield f"{robot} and {other} meet in {network.corridors[corridor]}"
            if robot != other and begun and too and _overtakes(network, one, two):
                yield f"{other} overtakes {robot} in {network.corridors[corridor]}"


def _overtakes(network: Network, first: Leg, second: Leg) -> bool:
    """Tell if of two in one lane the second, let in later, is over the crossing at its end before the first."""
    is_behind = first.lane == second.lane and first.enter_s < second.enter_s and network.crossing_s[first.post] > 0.0
    return is_behind and second.arrive_s < first.arrive_s - SLACK_S


def _apart(network: Network, first: Leg, second: Leg) -> bool:
    """Tell if two passages of one corridor, in the order of their entries, are far enough from each other."""
    if first.lane is None or second.lane is None:
        return True
    after_s = first.lane.following_s
    if after_s is None or first.lane.backwards != second.lane.backwards:
        return second.enter_s >= first.arrive_s + network.clearance_s - SLACK_S
    behind_s = min(second.enter_s - first.enter_s, second.arrive_s - first.arrive_s)
    return behind_s >= after_s - SLACK_S


def _on_crossings(network: Network, tasks: Mapping[str, Task], journeys: Mapping[str, Journey]) -> Iterator[str]:
    if not (network.shut or any(network.crossing_s)):
        return
    moves: dict[int, list[tuple[float, float, str, bool]]] = {}
    for robot, task in tasks.items():
        for post, until_s in task.start.crossings():
            moves.setdefault(post, []).append((task.start.entered_s, until_s, robot, True))
    for robot, journey in journeys.items():
        for post, since_s, until_s in _moves(network, journey.legs):
            moves.setdefault(post, []).append((since_s, until_s, robot, False))
    for post, over in moves.items():
        name, begun = network.posts[post], [one[3] for one in over]
        if post in network.shut and not all(begun):
            yield f"{over[begun.index(False)][2]} moves over the crossing of {name}, which is shut"
        if network.crossing_s[post] > 0.0:
            yield from (f"{one} and {other} meet on the crossing of {name}" for one, other in _met(network, over))


def _moves(network: Network, legs: Sequence[Leg]) -> Iterator[tuple[int, float, float]]:
    """Each move over a crossing that has not begun, with its times."""
    for number, leg in enumerate(legs):
        if number > 0 and leg.lane is not None:
            yield leg.lane.start, leg.enter_s, leg.enter_s + network.crossing_s[leg.lane.start]
        if (number > 0 or leg.lane is not None) and not _goes_straight_on(network, leg):
            yield leg.post, leg.arrive_s, leg.arrive_s + leg.over_s


def _met(network: Network, over: Sequence[tuple[float, float, str, bool]]) -> Iterator[tuple[str, str]]:
    for (_, until_s, robot, begun), (since_s, _, other, too) in combinations(sorted(over), 2):
        if robot != other and not (begun and too) and since_s < until_s + network.clearance_s - SLACK_S:
            yield robot, other


def _in_bays(network: Network, tasks: Mapping[str, Task], journeys: Mapping[str, Journey]) -> Iterator[str]:
    changes: dict[int, list[tuple[float, int, str]]] = {}
    for robot, task in tasks.items():
        for start in (one for one in task.start.on_the_way() if not one.at_home):
            changes.setdefault(start.post, []).extend([(start.entered_s, 1, robot), (start.ready_s, -1, robot)])
    for robot, journey in journeys.items():
        for leg, until_s in stays(journey.legs):
            if not leg.at_home:
                at_post = changes.setdefault(leg.post, [])
                at_post += [(leg.enter_s, 1, robot), (until_s + network.crossing_s[leg.post], -1, robot)]
    for post, at_post in changes.items():
        standing = 0
        # Of a leaving and an entering at one moment the entering is looked at first: leaving comes strictly before it.
        for at_s, change, robot in sorted(at_post, key=lambda one: (one[0], -one[1])):
            standing += change
            if standing > network.bays[post]:
                yield f"{robot} finds no bay at {network.posts[post]} at {at_s:.1f} s"
