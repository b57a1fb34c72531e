"""Figures of a run: how each letter ended, how long the mission took against what it should take."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from itertools import pairwise
from typing import Any, Final

from maps import CampusMap, shortest_route
from robot.scenarios.actors.mail import WITH_RECIPIENT
from robot.scenarios.judging import Ending, Fate
from robot.scenarios.scenario import OrderRow, Scenario
from robot.scenarios.stage import Stage
from robot.scenarios.watching import Times

MISSION_SPEED_M_S: Final = 0.150


@dataclass(frozen=True)
class Figures:
    """One run of one robot. Times in s, ways in m.

    `mission_s` is from the moment in which the mission is ordered to the one in which the last recipient takes their
    mail, `None` unless everything was delivered. `way_m` is the shortest way by the map from the dock through the
    mission's posts in their order, and through every dock at which it charged on the way. `stops_s` is what it stood
    still for others in that time: waiting at a post for a person to hand over and for their hand to leave the box,
    standing in a dock, and standing in front of a person in its way. Turns, docking, searches, and waits for grants
    or for the network are no stops: they count against the robot.
    """

    seed: int
    fates: dict[str, str]
    whys: dict[str, str]
    without_faults: bool
    drive_s: float
    search_s: float
    bumps: int
    searches: int
    violations: list[str]
    home: bool
    ran_s: float
    mission_s: float | None
    way_m: float
    stops_s: float
    cruise_m_s: float
    """The robot's own, by its settings."""
    unexpected: list[str]
    """Letters that did not arrive although both people came."""

    @property
    def time_ratio(self) -> float | None:
        """Mission time ÷ (way ÷ 150 mm/s + stops)."""
        return None if self.mission_s is None else self.mission_s / (self.way_m / MISSION_SPEED_M_S + self.stops_s)

    @property
    def cruise_ratio(self) -> float | None:
        """Mission time ÷ (way ÷ cruise + stops): what turns, docks and slow stretches cost."""
        return None if self.mission_s is None else self.mission_s / (self.way_m / self.cruise_m_s + self.stops_s)

    def as_json(self) -> dict[str, Any]:
        return {**asdict(self), "time_ratio": self.time_ratio, "cruise_ratio": self.cruise_ratio}


class Stopwatch:
    """Looks at the first robot after every tick: when the last letter arrived, and what had been waited until then."""

    def __init__(self, stage: Stage) -> None:
        self._stage = stage
        self._docked = True
        self.charged_at: list[tuple[float, str]] = []
        self.delivered_s: float | None = None
        self.at_start: Times | None = None
        self.at_end: Times | None = None
        stage.watchers.append(self.look)

    def look(self, now: float) -> None:
        stage, actor = self._stage, self._stage.actors[0]
        times = stage.watch.times.get(actor.name, Times())
        if self.at_start is None and now >= min((one.at_s for one in stage.scenario.order), default=0.0):
            self.at_start = replace(times)
        if actor.body.docked and not self._docked and actor.posts:
            self.charged_at.append((now, actor.posts[-1][1]))
        self._docked = actor.body.docked
        letters = stage.letters.values()
        if self.delivered_s is None and letters and all(one.place == WITH_RECIPIENT for one in letters):
            self.delivered_s, self.at_end = now, replace(times)


def figures(stage: Stage, stopwatch: Stopwatch, ending: Ending) -> Figures:
    scenario, name = stage.scenario, stage.actors[0].name
    times = stage.watch.times.get(name, Times())
    begun_s = min((one.at_s for one in scenario.order), default=0.0)
    done_s = stopwatch.delivered_s
    return Figures(
        seed=scenario.seed,
        fates={one.order: one.fate.value for one in ending.verdicts},
        whys={one.order: one.why for one in ending.verdicts if one.why},
        without_faults=not (scenario.fault or scenario.deed),
        drive_s=times.drive_s,
        search_s=times.search_s,
        bumps=ending.bumps,
        searches=ending.searches,
        violations=ending.violations,
        home=ending.home,
        ran_s=stage.clock.now(),
        mission_s=None if done_s is None else done_s - begun_s,
        way_m=0.0 if done_s is None else _way_m(stage, stopwatch, done_s),
        stops_s=_stops_s(stopwatch),
        cruise_m_s=stage.actors[0].parts.mind.settings.drive.cruise_mm_s / 1000,
        unexpected=_unexpected(scenario, ending),
    )


def _stops_s(stopwatch: Stopwatch) -> float:
    begin, end = stopwatch.at_start or Times(), stopwatch.at_end or stopwatch.at_start or Times()
    return end.stops_s - begin.stops_s


def _way_m(stage: Stage, stopwatch: Stopwatch, done_s: float) -> float:
    """Through everything that the robot had to reach, in the order in which it did."""
    goals = [(at_s, post) for at_s, post in stopwatch.charged_at if at_s < done_s]
    for letter in stage.letters.values():
        posts = (letter.order.origin, letter.order.destination)
        goals += [(at_s, post) for (at_s, _), post in zip(letter.moved, posts, strict=False)]
    start = stage.service.interlocking.homes[stage.actors[0].name] or stage.actors[0].posts[0][1]
    return _length_m(stage.campus.track, [start, *(post for _, post in sorted(goals))])


def _length_m(track: CampusMap, places: Sequence[str]) -> float:
    return sum(shortest_route(track, a, b).length_m for a, b in pairwise(places))


def _unexpected(scenario: Scenario, ending: Ending) -> list[str]:
    came = {order.id: _both_come(order) for order in scenario.order}
    return [one.order for one in ending.verdicts if came[one.order] and one.fate is not Fate.DELIVERED]


def _both_come(order: OrderRow) -> bool:
    return "never" not in (order.sender.comes, order.recipient.comes)
