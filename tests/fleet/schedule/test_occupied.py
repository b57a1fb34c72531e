"""Free times between reservations, checked moment by moment."""

from dataclasses import replace
from math import inf
from random import Random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fleet.schedule.journey import Leg, Start
from fleet.schedule.network import Lane, Network
from fleet.schedule.occupied import Occupied, Span

TRAVEL_S, CLEARANCE_S, BAYS = 6.0, 0.5, 2
MOMENTS_S = [number / 4 for number in range(-20, 200)]


def two_posts(following_s: float | None) -> Network:
    lanes = tuple((Lane(0, at, at, 1 - at, TRAVEL_S, following_s),) for at in (0, 1))
    return Network(("a", "b"), (BAYS, BAYS), ("a-b",), lanes, CLEARANCE_S)


def some_passages(rng: Random, network: Network) -> dict[str, tuple[Leg, float]]:
    """Each with the stay behind it. Some robots are late: they have been in the corridor for longer."""
    found = {}
    for number in range(rng.randint(0, 5)):
        lane, enter_s = network.lanes[rng.randrange(2)][0], rng.randint(0, 60) / 2
        arrive_s = enter_s + TRAVEL_S + rng.choice((0.0, 0.0, 7.0))
        leg = Leg(lane, enter_s, arrive_s, lane.end, False, 0, arrive_s)
        found[f"r{number}"] = leg, arrive_s + rng.randint(0, 12) / 2
    return found


def may_enter(lane: Lane, at_s: float, other: Leg) -> bool:
    assert other.lane is not None
    if lane.following_s is not None and other.lane == lane:
        behind = at_s >= other.enter_s + lane.following_s and at_s + TRAVEL_S >= other.arrive_s + lane.following_s
        return behind or at_s + lane.following_s <= other.enter_s
    return at_s >= other.arrive_s + CLEARANCE_S or at_s + TRAVEL_S + CLEARANCE_S <= other.enter_s


def may_stand(since_s: float, until_s: float, stays: list[Span]) -> bool:
    """At no moment too many, each with the clearance behind him."""
    moments = [since_s, *(one for one, _ in stays if since_s < one < until_s + CLEARANCE_S)]
    return all(sum(one <= at_s < end_s + CLEARANCE_S for one, end_s in stays) < BAYS for at_s in moments)


def within(spans: list[Span], since_s: float, until_s: float) -> bool:
    return any(one - 1e-4 <= since_s and until_s <= end_s + 1e-4 for one, end_s in spans)


@settings(max_examples=60)
@given(st.randoms(use_true_random=False), st.sampled_from([None, 2.0]))
@pytest.mark.slow
def test_what_is_free_is_what_no_robot_has(rng: Random, following_s: float | None) -> None:
    network = two_posts(following_s)
    taken, there = Occupied(network), some_passages(rng, network)
    for robot, (leg, until_s) in there.items():
        taken.put(robot, (leg, leg._replace(lane=None, at_home=True, enter_s=until_s)))
        for lanes in network.lanes:  # asked in between, so that what has changed must be noticed
            taken.entries(lanes[0])
            taken.free(lanes[0].end)
    for robot in rng.sample(sorted(there), rng.randint(0, len(there))):
        taken.remove(robot)
        del there[robot]
    for (lane,) in network.lanes:
        spans, others = taken.entries(lane), [leg for leg, _ in there.values()]
        for at_s in MOMENTS_S:
            assert within(spans, at_s, at_s) == all(may_enter(lane, at_s, other) for other in others)
        stays = [(leg.enter_s, until_s) for leg, until_s in there.values() if leg.post == lane.end]
        for _ in range(40):
            since_s, until_s = sorted(rng.choices(MOMENTS_S, k=2))
            assert within(taken.free(lane.end), since_s, until_s) == may_stand(since_s, until_s, stays)


def test_a_robot_that_is_there_already_has_its_corridor_and_its_bay() -> None:
    network = two_posts(None)
    taken, lane = Occupied(network), network.lanes[0][0]
    for robot in ("r0", "r1"):
        taken.hold(robot, Start(1, False, 10.0, 0.0, lane, 10.0), 15.0)
    assert taken.entries(network.lanes[1][0])[-1] == (10.0 + CLEARANCE_S, inf)
    assert within(taken.free(1), 15.0 + CLEARANCE_S, inf)
    assert not within(taken.free(1), 15.0, 20.0)


def test_a_move_over_a_crossing_takes_it_and_the_bay_that_is_left_until_it_is_over() -> None:
    network = replace(two_posts(None), bays=(1, 1), crossing_s=(2.0, 2.0))
    taken, lane = Occupied(network), network.lanes[0][0]
    stays = Leg(None, 0.0, -inf, 0, False, 0, 10.0)
    drives = Leg(lane, 10.0, 18.0, 1, True, 0, 20.0, 2.0)
    taken.put("r0", (stays, drives))
    assert taken.begins(0) == [(-inf, pytest.approx(7.5, abs=1e-3)), (12.5, inf)]
    assert taken.begins(1) == [(-inf, pytest.approx(15.5, abs=1e-3)), (20.5, inf)]
    assert within(taken.free(0), 12.5, inf)
    assert not within(taken.free(0), 12.0, 13.0)
    assert taken.entries(network.lanes[1][0]) == [(-inf, pytest.approx(1.5, abs=1e-3)), (18.5, inf)]
    shut = Occupied(replace(network, shut=frozenset({0})))
    assert (shut.begins(0), shut.begins(1)) == ([], [(-inf, inf)])
