"""Everybody's way home, when all work is planned: needed to be sure that there is one.

Ways home that were planned before stay as they are. Only those that new work may be in the way of are planned again:
looking for all of them was most of what a decision took.
"""

from collections import defaultdict
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import inf
from typing import Final, NamedTuple

from fleet.schedule.journey import Journey, Leg, Start, Task, stays
from fleet.schedule.network import Network
from fleet.schedule.occupied import Occupied
from fleet.schedule.search import find_home

Journeys = Mapping[str, Journey]
TRIES: Final = 2


@dataclass
class WaysHome:
    """`work`: of each robot, and in `taken`, where those that are away stand for ever. `pause`: see
    `planning.Pause`."""

    network: Network
    tasks: Mapping[str, Task]
    taken: Occupied
    work: Journeys
    pause: Callable[[], None]
    _found_none: str | None = None

    def plan(self, kept: Journeys) -> dict[str, Journey] | None:
        """`kept`: what robots whose work is as it was did so far, ways home included. None if a robot finds no way."""
        away = [robot for robot in self.work if self.must_go_home(robot)]
        away.sort(key=lambda robot: self.work[robot].work[-1].ready_s)
        known = {robot: kept[robot] for robot in away if robot in kept and self._leads_home(robot, kept[robot])}
        as_they_were = undisturbed(self.network, self.work, known)
        found = self._beside(as_they_were, away) if as_they_were else None
        return found or self._anew(away)

    def must_go_home(self, robot: str) -> bool:
        return self.tasks[robot].home is not None and not self._leads_home(robot, self.work[robot])

    def way_home(self, robot: str) -> Journey | None:
        """From where its work ends, round all that is taken."""
        done, home = self.work[robot], self.tasks[robot].home
        last = done.work[-1]
        self.taken.free_last(robot, last)
        start = Start(last.post, last.at_home, last.ready_s, last.enter_s)
        found = None if home is None else find_home(self.network, self.taken, start, home)
        way_home = () if found is None else found.legs[1:]
        self.taken.go_on(robot, last, way_home)
        return None if found is None else Journey(done.work, way_home, done.done_s)

    def _beside(self, as_they_were: Journeys, away: Sequence[str]) -> dict[str, Journey] | None:
        """Those that stay as they were, and the others round them."""
        for robot, journey in as_they_were.items():
            self.taken.free_last(robot, journey.work[-1])
            self.taken.go_on(robot, journey.work[-1], journey.way_home)
        found = self._one_by_one([robot for robot in away if robot not in as_they_were])
        if found is None:
            self._stand(as_they_were)
            return None
        return {**self.work, **as_they_were, **found}

    def _anew(self, away: list[str]) -> dict[str, Journey] | None:
        """Plan anew: the robot that is done first goes first; one that finds no way home then goes when all others have
        gone, or before them if it came last."""
        for _ in range(TRIES):
            found = self._one_by_one(away)
            if found is not None:
                return {**self.work, **found}
            others = [robot for robot in away if robot != self._found_none]
            left = [robot for robot in away if robot == self._found_none]
            away = [*left, *others] if away[-1:] == left else [*others, *left]
        return None

    def _one_by_one(self, away: Sequence[str]) -> dict[str, Journey] | None:
        found: dict[str, Journey] = {}
        for robot in away:
            self.pause()
            journey = self.way_home(robot)
            if journey is None:
                self._stand(away)
                self._found_none = robot
                return None
            found[robot] = journey
        return found

    def _stand(self, robots: Collection[str]) -> None:
        """As it was: all of them stand where their work ends."""
        for robot in robots:
            self.taken.remove(robot)
            self.taken.put(robot, self.work[robot].work)

    def _leads_home(self, robot: str, journey: Journey) -> bool:
        last = journey.legs[-1]
        return last.at_home and last.post == self.tasks[robot].home


class _Visit(NamedTuple):
    """One leg and the stay after it. `on_way_home`: of a way home that was planned before."""

    robot: str
    leg: Leg
    until_s: float
    on_way_home: bool


def undisturbed(network: Network, work: Journeys, kept: Journeys) -> Journeys:
    """Of the `kept` journeys those whose ways home no other's `work` may be in the way of. Looked at roughly: what is
    at one place at about one time may be."""
    passages: defaultdict[int, list[_Visit]] = defaultdict(list)
    standing: defaultdict[int, list[_Visit]] = defaultdict(list)
    crossing: defaultdict[int, list[_Visit]] = defaultdict(list)
    for visit in _visits(network, work, kept):
        if visit.leg.lane is not None:
            passages[visit.leg.lane.corridor].append(visit)
        if not visit.leg.at_home:
            standing[visit.leg.post].append(visit)
        for post, at_s in _crossed(network, visit.leg) if network.has_crossings else ():
            crossing[post].append(visit._replace(leg=visit.leg._replace(enter_s=at_s, arrive_s=at_s)))
    disturbed: set[str] = set()
    for through in passages.values():
        disturbed.update(_met(through, kept, network.clearance_s))
    for post, over in crossing.items():
        disturbed.update(_met(over, kept, network.crossing_s[post] + network.clearance_s))
    for post, there in standing.items():
        disturbed.update(_crowded_out(there, kept, network.bays[post]))
    return {robot: journey for robot, journey in kept.items() if robot not in disturbed}


def _crossed(network: Network, leg: Leg) -> Iterator[tuple[int, float]]:
    """Each post whose crossing the leg leads over, with the time at which that begins."""
    if leg.lane is not None and network.crossing_s[leg.lane.start]:
        yield leg.lane.start, leg.enter_s
    if leg.over_s:
        yield leg.post, leg.arrive_s


def _visits(network: Network, work: Journeys, kept: Journeys) -> Iterator[_Visit]:
    for robot, planned in work.items():
        journey = kept.get(robot, planned)
        for at, (leg, until_s) in enumerate(stays(journey.legs)):
            # Who has no way home yet will be gone in time, or all ways home are planned again.
            ends_s = leg.ready_s if until_s == inf else until_s + network.crossing_s[leg.post]
            yield _Visit(robot, leg, ends_s, at >= len(journey.work))


def _met(through: Collection[_Visit], kept: Journeys, clearance_s: float) -> Iterator[str]:
    for new in through:
        if new.robot not in kept:
            apart_s = max(clearance_s, (new.leg.lane and new.leg.lane.following_s) or 0.0)
            since_s, until_s = new.leg.enter_s - apart_s, new.leg.arrive_s + apart_s
            for other in through:
                if other.on_way_home and other.leg.enter_s <= until_s and other.leg.arrive_s >= since_s:
                    yield other.robot


def _crowded_out(there: Collection[_Visit], kept: Journeys, bays: int) -> Iterator[str]:
    for new in there:
        if new.robot not in kept:
            beside = [other for other in there if other.leg.enter_s <= new.until_s and other.until_s >= new.leg.enter_s]
            if len(beside) > bays:
                yield from (other.robot for other in beside if other.on_way_home)
