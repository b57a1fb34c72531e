"""Corridors that are asked for, granted, taken back and given back; and what comes too late."""

import pytest

from protocol.to_robot import Deny, Grant
from robot.mission.memory import Memory
from robot.mission.mission import MissionManager
from robot.mission.outbox import Outbox
from robot.mission.store import Store
from tests.robot.mission.test_mission import NOW, TO_POST3, TO_POST4, Desk, FakeServer


@pytest.fixture
def desk(store: Store) -> Desk:
    server = FakeServer(Memory(store))
    return Desk(MissionManager(store, server.memory, Outbox(store), lambda: NOW, server), server)


def test_corridors_are_claimed_once_and_entered_when_granted(desk: Desk) -> None:
    legs = (TO_POST3, TO_POST4)
    claim_id = desk.missions.claims.ask(legs)
    assert desk.missions.claims.ask(legs) == claim_id
    assert len(desk.told()) == 1
    assert not desk.missions.claims.may_enter(legs)
    desk.hears(Grant(claim_id=claim_id or "", legs=legs))
    assert desk.missions.claims.may_enter(legs)
    assert desk.missions.claims.ask(legs) is None, "nothing left to ask for"


def test_the_same_corridors_for_another_goal_are_another_claim(desk: Desk) -> None:
    """The service plans by the goal: without that it would go on planning for where the robot went before."""
    first = desk.missions.claims.ask((TO_POST3, TO_POST4), "post4")
    second = desk.missions.claims.ask((TO_POST3, TO_POST4), "post3")
    assert second != first
    assert [one["goal"] for one in desk.told()] == ["post4", "post3"]


def test_leaving_a_corridor_gives_it_back(desk: Desk) -> None:
    claim_id = desk.missions.claims.ask([TO_POST3, TO_POST4]) or ""
    desk.hears(Grant(claim_id=claim_id, legs=(TO_POST3, TO_POST4)))
    desk.missions.claims.clear([TO_POST3])
    assert desk.told()[-1]["leg"] == {"from_post": "post2", "to_post": "post3"}
    assert desk.missions.held.grants == (TO_POST4,)


def test_a_claim_that_waits_is_withdrawn_once_and_one_that_was_answered_never(desk: Desk) -> None:
    claim_id = desk.missions.claims.ask([TO_POST3]) or ""
    for _ in range(2):
        desk.missions.claims.withdraw()
    assert desk.told()[1:] == [{"claim_id": claim_id}]
    again = desk.missions.claims.ask([TO_POST3]) or ""
    assert again != claim_id
    desk.hears(Grant(claim_id=again, legs=(TO_POST3,)))
    desk.missions.claims.withdraw()
    assert len(desk.told()) == 3
    assert desk.missions.held.grants == (TO_POST3,)


def test_what_is_granted_too_late_is_given_back_at_once(desk: Desk) -> None:
    claim_id = desk.missions.claims.ask([TO_POST3, TO_POST4]) or ""
    desk.missions.claims.withdraw()
    given_back = desk.hears(Grant(claim_id=claim_id, legs=(TO_POST3, TO_POST4)))
    assert [one["leg"]["to_post"] for one in given_back] == ["post3", "post4"]
    assert desk.missions.held.grants == ()


def test_who_gives_something_back_still_waits_for_what_it_asked_for(desk: Desk) -> None:
    first = desk.missions.claims.ask([TO_POST3]) or ""
    desk.hears(Grant(claim_id=first, legs=(TO_POST3,)))
    second = desk.missions.claims.ask([TO_POST4]) or ""
    desk.missions.claims.clear([TO_POST3])
    assert desk.missions.claims.ask([TO_POST4]) == second
    assert desk.hears(Grant(claim_id=second, legs=(TO_POST4,))) == []
    assert desk.missions.held.grants == (TO_POST4,)


def test_a_corridor_that_it_has_been_through_is_asked_for_anew(desk: Desk) -> None:
    first = desk.missions.claims.ask([TO_POST3]) or ""
    desk.hears(Grant(claim_id=first, legs=(TO_POST3,)))
    desk.missions.claims.clear([TO_POST3])
    assert desk.missions.claims.ask([TO_POST3]) not in (first, None)


def test_what_comes_too_late_is_kept_on_the_way_and_while_it_waits_for_another(desk: Desk) -> None:
    """On the way it may be in it; while it waits one of the corridors may be of use."""
    desk.missions.heading_for("post3")
    assert desk.hears(Grant(claim_id="c0", legs=(TO_POST3,))) == []
    desk.missions.heading_for(None)
    desk.missions.claims.ask([TO_POST4])
    assert desk.hears(Grant(claim_id="c1", legs=(TO_POST4,))) == []
    assert desk.missions.held.grants == (TO_POST3, TO_POST4)


def test_a_denial_names_what_to_avoid_and_the_next_claim_is_a_new_one(desk: Desk) -> None:
    claim_id = desk.missions.claims.ask([TO_POST4]) or ""
    desk.hears(Deny(claim_id=claim_id, avoid=(TO_POST4,), reason="taken"))
    assert desk.missions.claims.denial(claim_id) is not None
    assert desk.missions.claims.avoid == {TO_POST4}
    assert desk.missions.claims.ask([TO_POST4]) != claim_id
