"""The search for one robot finds the quickest way there is: it is compared with trying everything, half second by half
second."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from math import inf
from random import Random
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fleet.schedule.journey import Goal, Leg, Start, Task, stays
from fleet.schedule.network import Lane, Network
from fleet.schedule.occupied import Occupied
from fleet.schedule.planning import first_plan
from fleet.schedule.search import find_home, find_work

SLOT_S = 0.5
LATEST = 400


def slots(seconds: float) -> int:
    return round(seconds / SLOT_S)


def whole_seconds(rng: Random, *, crossing: bool) -> Network:
    """A connected map of 2 to 5 posts with 1 or 2 bays; everything lasts whole seconds, the clearance half a one. Some
    crossings take no time."""
    posts = rng.randint(2, 5)
    edges = {(rng.randrange(post), post) for post in range(1, posts)}
    if posts > 2:
        edges.add(tuple(sorted(rng.sample(range(posts), 2))))  # type: ignore[arg-type]
    lanes: list[list[Lane]] = [[] for _ in range(posts)]
    for number, (a, b) in enumerate(sorted(edges)):
        travel_s = float(rng.randint(1, 5))
        lanes[a].append(Lane(number, 0, a, b, travel_s))
        lanes[b].append(Lane(number, 1, b, a, travel_s))
    names = tuple(f"p{post}" for post in range(posts))
    bays = tuple(rng.randint(1, 2) for _ in names)
    crossing_s = tuple(float(rng.randint(0, 2)) if crossing else 0.0 for _ in names)
    corridors = tuple(f"{a}-{b}" for a, b in sorted(edges))
    return Network(names, bays, corridors, tuple(map(tuple, lanes)), SLOT_S, crossing_s)


def some_goals(rng: Random, network: Network, most: int) -> tuple[Goal, ...]:
    posts = range(len(network.posts))
    return tuple(Goal(rng.choice(posts), float(rng.randint(1, 4)), rng.randint(0, 8)) for _ in range(most))


_State = tuple[int, bool, int, int | None]
"""Post, at home, goals done; and, at the end of a corridor before its crossing, the corridor."""


@dataclass
class EveryWay:
    """Where a robot could be, slot by slot, if it tried everything."""

    network: Network
    others: Sequence[Sequence[Leg]]
    goals: Sequence[Goal]
    home: int
    done: dict[int, dict[_State, int]] = field(default_factory=dict)
    """Of each slot: each state that can be reached in it, with the earliest slot by which its goals can be done."""

    def __post_init__(self) -> None:
        self._shut: dict[int, list[tuple[int, int]]] = {}
        self._over: dict[int, list[tuple[int, int]]] = {}
        self._cross = [slots(over_s) for over_s in self.network.crossing_s]
        standing: dict[int, list[int]] = {post: [0] * (LATEST + 2) for post in range(len(self.network.posts))}
        for legs in self.others:
            for leg, until_s in stays(legs):
                if leg.lane is not None:
                    passages = self._shut.setdefault(leg.lane.corridor, [])
                    passages.append((slots(leg.enter_s), slots(leg.arrive_s)))
                    self._over.setdefault(leg.lane.start, []).append(self._move(leg.lane.start, leg.enter_s))
                if leg.over_s:
                    self._over.setdefault(leg.post, []).append(self._move(leg.post, leg.arrive_s))
                if not leg.at_home:
                    last = LATEST if until_s > LATEST * SLOT_S else slots(until_s) + self._cross[leg.post]
                    for slot in range(slots(leg.enter_s), last + 1):  # and the clearance
                        standing[leg.post][slot] += 1
        self._full = {post: [count >= self.network.bays[post] for count in counts] for post, counts in standing.items()}

    def _move(self, post: int, at_s: float) -> tuple[int, int]:
        return slots(at_s), slots(at_s) + self._cross[post]

    def _may_cross(self, post: int, slot: int) -> bool:
        over = self._cross[post]
        return not over or all(slot > out or slot + over < into for into, out in self._over.get(post, ()))

    def end_first(self, start: Start, *, at_home_only: bool) -> int | None:
        """Home: when. Work: when it is done, if the robot may stay where it is then, or comes to where it may."""
        first = slots(start.ready_s)
        self._note(first, (start.post, start.at_home, 0, None), first)
        ends = []
        for slot in range(first, LATEST):
            self._dock(slot)
            for state, done in self.done.get(slot, {}).items():
                if state[2] == len(self.goals) and self._may_end(slot, state, at_home_only=at_home_only):
                    ends.append(slot if at_home_only else done)
                for at, after, done_then in self._moves(slot, state, done):
                    self._note(at, after, done_then)
        return min(ends, default=None)

    def _dock(self, slot: int) -> None:
        """From the bay to the place beside it, in no time where no crossing lies between."""
        for (post, at_home, served, ends), done in list(self.done.get(slot, {}).items()):
            free = not any(self._full[post][slot : slot + self._cross[post] + 1]) and self._may_cross(post, slot)
            if post == self.home and not at_home and ends is None and free:
                self._note(slot + self._cross[post], (post, True, served, None), done)

    def _note(self, slot: int, state: _State, done: int) -> None:
        known = self.done.setdefault(slot, {})
        known[state] = min(done, known.get(state, LATEST))

    def _may_end(self, slot: int, state: _State, *, at_home_only: bool) -> bool:
        post, at_home, _, ends = state
        if ends is not None:
            return False
        return at_home or (not at_home_only and not any(self._full[post][slot:LATEST]))

    def _moves(self, slot: int, state: _State, done: int) -> Iterator[tuple[int, _State, int]]:
        post, at_home, served, came_by = state
        over = self._cross[post]
        if came_by is not None:
            if self._may_cross(post, slot) and (at_home or not any(self._full[post][slot : slot + over + 1])):
                yield slot + over, (post, at_home, served, None), done
                for lane in self.network.lanes[post]:
                    if lane.corridor != came_by:
                        yield from self._drives(slot, lane, served, done)
            return
        if served < len(self.goals) and self.goals[served].post == post:
            ends = max(slot, slots(self.goals[served].not_before_s)) + slots(self.goals[served].handling_s)
            if at_home or not any(self._full[post][slot:ends]):
                yield ends, (post, at_home, served + 1, None), ends
        if at_home or not self._full[post][slot]:
            yield slot + 1, state, done
        if self._may_cross(post, slot) and (at_home or not any(self._full[post][slot : slot + over + 1])):
            for lane in self.network.lanes[post]:
                yield from self._drives(slot, lane, served, done)

    def _drives(self, slot: int, lane: Lane, served: int, done: int) -> Iterator[tuple[int, _State, int]]:
        arrives = slot + self._cross[lane.start] + slots(lane.travel_s)
        ends = lane.corridor if self._cross[lane.end] else None
        if all(slot > out or arrives < into for into, out in self._shut.get(lane.corridor, ())):
            if lane.end == self.home:
                yield arrives, (lane.end, True, served, ends), done
            if not any(self._full[lane.end][slot:arrives]):
                yield arrives, (lane.end, False, served, ends), done


def others_at_work(rng: Random, network: Network) -> list[tuple[Leg, ...]]:
    posts = range(len(network.posts))
    tasks = {}
    for number in range(rng.randint(0, 3)):
        home = rng.choice(posts)
        tasks[f"r{number}"] = Task(Start(home, True, 0.0, 0.0), some_goals(rng, network, rng.randint(1, 3)), home)
    found = first_plan(network, tasks, rng)
    assert found is not None
    return [found.journeys[robot].legs for robot in sorted(tasks)]


@settings(max_examples=40)
@given(st.randoms(use_true_random=False), st.integers(1, 3), st.booleans())
@pytest.mark.slow
def test_no_way_is_quicker_than_the_one_that_is_found(rng: Random, most: int, crossing: bool) -> None:
    network = whole_seconds(rng, crossing=crossing)
    others, goals = others_at_work(rng, network), some_goals(rng, network, most)
    home = rng.randrange(len(network.posts))
    taken, start = Occupied(network), Start(home, True, 0.0, 0.0)
    for number, legs in enumerate(others):
        taken.put(f"r{number}", legs)
    work = find_work(network, taken, start, goals, home)
    assert work is not None
    best = EveryWay(network, others, goals, home).end_first(start, at_home_only=False)
    assert best is not None
    assert work.done_s == pytest.approx(best * SLOT_S, abs=1e-4)
    last = work.legs[-1]
    if not last.at_home:
        back = Start(last.post, False, last.ready_s, last.enter_s)
        way_home = find_home(network, taken, back, home)
        soonest = EveryWay(network, others, (), home).end_first(back, at_home_only=True)
        assert way_home is not None
        assert soonest is not None
        assert way_home.legs[-1].stands_s == pytest.approx(soonest * SLOT_S, abs=1e-4)


@pytest.mark.parametrize("towards", [(), ("p1",)])
def test_where_no_way_leads_the_search_ends_also_where_robots_could_go_round_and_round(
    towards: tuple[str, ...],
) -> None:
    """On a ring, where another robot stands at home's post for ever and one comes by each hour."""
    network = replace(ring(5), crossing_s=(5.0,) * 6)
    taken = Occupied(network)
    taken.put("stands", (Leg(None, 0.0, -inf, 5, False, 0, 0.0),))
    for hour in range(1, 40):
        by = network.lane(2, 3)
        taken.put(f"comes by {hour}", (Leg(by, 3600.0 * hour, 3600.0 * hour + 15.0, 3, True, 0, 3600.0 * hour, 5.0),))
    start = Start(0, False, 0.0, 0.0)
    if towards:
        lane = network.lane(0, 1)
        start = Start(1, False, 105.0, 0.0, lane, 100.0)
    assert find_work(network, taken, start, (Goal(5, 5.0),), None) is None


def ring(posts: int) -> Network:
    """Posts in a ring, and one more beside post 0."""
    lanes: list[list[Lane]] = [[] for _ in range(posts + 1)]
    edges = [*((post, (post + 1) % posts) for post in range(posts)), (0, posts)]
    for number, (a, b) in enumerate(edges):
        lanes[a].append(Lane(number, 0, a, b, 10.0))
        lanes[b].append(Lane(number, 1, b, a, 10.0))
    names = tuple(f"p{post}" for post in range(posts + 1))
    return Network(names, (1,) * (posts + 1), tuple(f"{a}-{b}" for a, b in edges), tuple(map(tuple, lanes)))


class Looked(tuple[tuple[Lane, ...], ...]):
    """Lanes by post, and how often any were looked at."""

    times = 0

    def __getitem__(self, post: Any) -> Any:
        self.times += 1
        return super().__getitem__(post)


def grid(wide: int) -> Network:
    """All corridors take equally long, so that very many ways do."""
    posts = range(wide * wide)
    edges = [(post, post + 1) for post in posts if (post + 1) % wide]
    edges += [(post, post + wide) for post in posts if post + wide < len(posts)]
    lanes: list[list[Lane]] = [[] for _ in posts]
    for number, (a, b) in enumerate(edges):
        lanes[a].append(Lane(number, 0, a, b, 100.0))
        lanes[b].append(Lane(number, 1, b, a, 100.0))
    names, bays = tuple(f"p{post}" for post in posts), (2,) * len(posts)
    return Network(names, bays, tuple(map(str, edges)), tuple(map(tuple, lanes)), 0.1, (15.0,) * len(posts))


def test_of_very_many_ways_that_are_equally_quick_few_are_looked_at() -> None:
    """Others come by everywhere at times of their own, so that each way is free for another while."""
    rng, looked = Random(1), Looked(grid(10).lanes)
    network = replace(grid(10), lanes=looked)
    taken = Occupied(network)
    for lane in [lane for out in grid(10).lanes for lane in out]:
        for number in range(2):
            at_s = rng.uniform(0.0, 10_000.0)
            by = Start(lane.end, True, at_s + 130.0, at_s, lane, at_s + 115.0)
            taken.hold(f"{lane.corridor} {lane.backwards} {number}", by, at_s + 130.0)
    start, goals = Start(0, True, 0.0, 0.0), (Goal(99, 60.0), Goal(9, 60.0))
    assert network.shortest_s[0][99] < inf
    looked.times = 0
    assert find_work(network, taken, start, goals, 0) is not None
    assert looked.times < len(network.posts)
