"""Exhaustively: on small maps, every order in which robots' reports can come, through the real controller.

What is looked at after each step: no two bodies are in one corridor, crossing or bay; something can still happen; and
from everywhere all goals can still be served and all robots come home. Reports come late and twice, the service begins
anew from its records, a robot stands still for a while and goes on. States that differ in times alone count as one.
"""

import copy
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass, replace
from random import Random
from typing import Any, Final, Self

from benchmarks.body.report import Wanted, say
from benchmarks.fleet.bodies import Floor, MeetingError, standing_bodies
from benchmarks.fleet.samples import Samples
from benchmarks.fleet.small_maps import Edges, network_on
from fleet.schedule.controller import TrafficController
from fleet.schedule.network import Network

CROSSING_S: Final = 3.0
MOST_STATES: Final = 200_000
WANTED = [
    *(Wanted(figure, at_most=0) for figure in ("met", "stuck", "unfinished")),
    Wanted("states", at_least=1),
    Wanted("finished", at_least=1),
]


class StuckError(AssertionError):
    """Nothing can happen any more, or nothing comes to an end."""


@dataclass(frozen=True, slots=True)
class Case:
    """`twice`, `restarts`, `dies`: how often that may happen in one run. `in_bays`: robots begin in bays at their home
    posts; `far`: they are let into several corridors at once."""

    name: str
    posts: int
    edges: Edges
    bays: int
    homes: tuple[int, ...]
    goals: tuple[int | None, ...]
    twice: int = 0
    restarts: int = 0
    dies: int = 0
    in_bays: bool = False
    far: bool = False


LINE_2: Final[Edges] = frozenset({(0, 1)})
LINE_3: Final[Edges] = frozenset({(0, 1), (1, 2)})
LINE_4: Final[Edges] = frozenset({(0, 1), (1, 2), (2, 3)})
STAR: Final[Edges] = frozenset({(0, 1), (0, 2), (0, 3)})
RING: Final[Edges] = frozenset({(0, 1), (1, 2), (0, 2)})
CASES: Final = (
    Case("swap", 2, LINE_2, 1, (0, 1), (1, 0)),
    Case("swap, said twice", 2, LINE_2, 1, (0, 1), (1, 0), twice=1),
    Case("swap, a restart", 2, LINE_2, 1, (0, 1), (1, 0), restarts=1),
    Case("swap, one stands still", 2, LINE_2, 1, (0, 1), (1, 0), dies=1),
    Case("swap, from bays", 2, LINE_2, 1, (0, 1), (1, 0), in_bays=True),
    Case("swap, from bays, all goes wrong", 2, LINE_2, 1, (0, 1), (1, 0), 1, 1, 1, in_bays=True),
    Case("one home", 2, LINE_2, 1, (0, 0), (1, 1)),
    Case("line", 3, LINE_3, 1, (0, 2), (2, 0)),
    Case("line, a restart", 3, LINE_3, 1, (0, 2), (2, 0), restarts=1),
    Case("line, one stands still", 3, LINE_3, 1, (0, 2), (2, 0), dies=1),
    Case("line, far", 3, LINE_3, 1, (0, 2), (2, 0), far=True),
    Case("line, far, a restart", 3, LINE_3, 1, (0, 2), (2, 0), restarts=1, far=True),
    Case("line, far, one stands still", 3, LINE_3, 2, (0, 2), (2, 0), dies=1, far=True),
    Case("line, two bays, twice and a restart", 3, LINE_3, 2, (0, 2), (2, 0), twice=1, restarts=1),
    Case("line of four, far", 4, LINE_4, 1, (0, 3), (3, 0), twice=1, far=True),
    Case("line, home in the middle", 3, LINE_3, 1, (1, 0), (0, 2)),
    Case("ring", 3, RING, 1, (0, 1), (2, 0)),
    Case("star", 4, STAR, 1, (1, 2), (3, 1)),
    Case("star, three", 4, STAR, 1, (1, 2, 3), (2, 3, None)),
)


@dataclass
class Seen:
    """`met`: ways in which two bodies met; `stuck`: states in which nothing can happen and not all is done;
    `unfinished`: states from which no way leads to where all is done; `cut`: states that were not gone on from."""

    states: int = 0
    steps: int = 0
    finished: int = 0
    met: int = 0
    stuck: int = 0
    unfinished: int = 0
    cut: int = 0

    def add(self, other: "Seen") -> None:
        for name, value in asdict(other).items():
            setattr(self, name, getattr(self, name) + value)


def measure(samples: Samples) -> dict[str, Any]:
    seen, by_case = Seen(), {}
    for case, of_case in zip(CASES, samples.each(look_at, CASES), strict=True):
        seen.add(of_case)
        by_case[case.name] = asdict(of_case)
        say(f"  {case.name}: {by_case[case.name]}")
    return {**asdict(seen), "by_case": by_case}


def look_at(case: Case, most_states: int = MOST_STATES) -> Seen:
    return Explorer(case).explore(most_states)


@dataclass(frozen=True)
class State:
    floor: Floor
    twice: int
    restarts: int
    dies: int

    def actions(self) -> Iterator[tuple[str, str]]:
        for what, name in self.floor.actions():
            yield what, name
            if what == "hear" and self.twice:
                yield "hear_twice", name
        dead = [name for name, body in self.floor.bodies.items() if body.is_dead]
        yield from (("go_on", name) for name in dead)
        if self.dies and not dead and not self.floor.is_done():
            yield from (("die", name) for name in self.floor.bodies)
        if self.restarts and not self.floor.is_done():
            yield "restart", ""

    def after(self, what: str, name: str, new: TrafficController) -> Self:
        """The floor itself is changed. Raises MeetingError."""
        if what == "restart":
            self.floor.restart(new)
        else:
            self.floor.act(what, name)
        return replace(
            self,
            twice=self.twice - (what == "hear_twice"),
            restarts=self.restarts - (what == "restart"),
            dies=self.dies - (what == "die"),
        )


class Explorer:
    """Breadth first, over all states of one case."""

    def __init__(self, case: Case) -> None:
        self._network = network_of(case)
        self._first = first_state(case, self._network)
        self.meetings: list[str] = []

    def explore(self, most_states: int) -> Seen:
        seen, known, ahead = Seen(), {_key(self._first): 0}, [self._first]
        came_from: list[list[int]] = [[]]
        done: list[int] = []
        for number, state in enumerate(ahead):
            if state.floor.is_done():
                done.append(number)
            if len(known) >= most_states:
                seen.cut += 1
                continue
            following = list(self._following(state, seen))
            seen.steps += len(following)
            seen.stuck += not following and not state.floor.is_done()
            for after in following:
                key = _key(after)
                if key not in known:
                    known[key] = len(ahead)
                    ahead.append(after)
                    came_from.append([])
                came_from[known[key]].append(number)
            ahead[number] = self._first  # its memory
        seen.states, seen.finished = len(known), len(done)
        seen.unfinished = 0 if seen.cut else len(ahead) - len(_all_before(done, came_from))
        return seen

    def _following(self, state: State, seen: Seen) -> Iterator[State]:
        for what, name in state.actions():
            try:
                yield _forked(state).after(what, name, TrafficController(self._network, Random(0)))
            except MeetingError as error:
                seen.met += 1
                self.meetings.append(str(error))


def network_of(case: Case) -> Network:
    network = network_on(case.posts, case.edges, (case.bays,) * case.posts)
    return replace(network, crossing_s=(CROSSING_S,) * case.posts)


def first_state(case: Case, network: Network) -> State:
    bodies = standing_bodies(case.homes, case.goals, in_bays=case.in_bays)
    floor = Floor.at_rest(network, bodies, TrafficController(network, Random(0)), far=case.far)
    return State(floor, case.twice, case.restarts, case.dies)


def walk(state: State, rng: Random, most_steps: int, look: Callable[[Floor], None]) -> int:
    """Go on at random from a state until all is done. -> so many steps. Raises MeetingError."""
    for step in range(most_steps):
        look(state.floor)
        if state.floor.is_done():
            return step
        actions = list(state.actions())
        if not actions:
            raise StuckError(f"nothing can happen any more after {step} steps")
        state = state.after(*rng.choice(actions), TrafficController(state.floor.network, rng))
    raise StuckError(f"not done after {most_steps} steps")


def _forked(state: State) -> State:
    """What does not change is not copied."""
    floor = copy.copy(state.floor)
    floor.bodies, floor.records = dict(floor.bodies), dict(floor.records)
    floor.asked, floor.inside = dict(floor.asked), dict(floor.inside)
    controller = floor.controller = copy.copy(floor.controller)
    live = controller._live = copy.copy(controller._live)
    live.robots = {name: copy.copy(robot) for name, robot in live.robots.items()}
    live.planned, live._rng = dict(live.planned), copy.copy(live._rng)
    return replace(state, floor=floor)


def _key(state: State) -> int:
    """All but the times: of those the order in which the schedule has robots move. As a hash, since the whole fills the
    memory: that two of a hundred thousand states have the same one happens once in some billion times."""
    floor = state.floor
    robots = floor.controller._live.robots
    known = tuple(
        (
            name,
            one.start.post,
            one.start.at_home,
            one.start.lane,
            one.start.crosses,
            one.claim,
            one.asks_in,
            one.frozen,
            one.goals_wait,
            one.stays,
            one.is_shut_in,
            one.turns,
            tuple((t.lane, t.post, t.at_home) for t in one.start.before),
        )
        for name, one in robots.items()
    )
    legs = [
        (leg.enter_s, name, leg.lane, leg.post, leg.at_home, leg.goals, leg.over_s)
        for name, journey in floor.controller._live.planned.items()
        for leg in journey.legs[1:]
    ]
    order = tuple(leg[1:] for leg in sorted(legs, key=lambda leg: leg[:2]))
    asked = tuple(sorted((name, repr(move)) for name, move in floor.asked.items()))
    bodies = *floor.bodies.items(), *floor.inside.items()
    return hash((bodies, tuple(floor.records.items()), asked, known, order, state.twice, state.restarts, state.dies))


def _all_before(done: Sequence[int], came_from: Sequence[Sequence[int]]) -> set[int]:
    reached, ahead = set(done), list(done)
    for number in ahead:
        for before in came_from[number]:
            if before not in reached:
                reached.add(before)
                ahead.append(before)
    return reached
