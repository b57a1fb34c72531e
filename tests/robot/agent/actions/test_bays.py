"""On a map with bays: what a robot asks for out of a bay and before a crossing, and where the answer sends it."""

from pathlib import Path

import pytest

from maps import find_map
from protocol.parts import Leg
from protocol.to_robot import Deny, Detour, Grant
from protocol.to_server import Claim
from robot.agent.actions.corridors import AskAhead, detour
from robot.agent.navigator import Navigator
from robot.mission.store import Store
from tests.robot.agent.actions.bench import Bench, with_server

TRACK = find_map(Path(__file__).parents[3] / "bays.toml").track


def leg(from_post: str, to_post: str) -> Leg:
    return Leg(from_post=from_post, to_post=to_post)


@pytest.fixture
def bay_bench(store: Store) -> Bench:
    bench = Bench(store)
    bench.navigator = bench.hands.navigator = Navigator(TRACK, "post5_bay2", bench.missions, now=0.0)
    with_server(bench)
    return bench


def claims(bench: Bench) -> list[Claim]:
    messages = [kept.message for kept in bench.missions.outbox.pending()]
    return [message for message in messages if isinstance(message, Claim)]


def answered(bench: Bench, answer: Grant | Detour | Deny) -> None:
    """As memory and mission take it in."""
    memory = bench.missions.memory
    if isinstance(answer, Grant | Detour):
        memory.grant(answer.legs)
    if isinstance(answer, Detour):
        memory.turn_aside(answer.legs[-1])
    bench.missions.claims.hear(answer)
    bench.missions._changed()


def in_corridor(bench: Bench, here: str, towards: str) -> None:
    bench.navigator.place(here, towards)
    bench.navigator.leave()


def test_out_of_a_bay_it_goes_only_together_with_what_comes_after_the_crossing(bay_bench: Bench) -> None:
    bay_bench.navigator.place("post4_bay1", "post4")
    bay_bench.ask("claim(post3)")
    (asked,) = claims(bay_bench)
    assert asked.legs[:2] == (leg("post4_bay1", "post4"), leg("post4", "post3"))
    assert asked.legs[2] == leg("post3", "post3_bay1")
    answered(bay_bench, Grant(claim_id=asked.claim_id, legs=asked.legs[:1]))
    assert bay_bench.actions.finished(0.0) == []
    answered(bay_bench, Grant(claim_id=asked.claim_id, legs=asked.legs[1:2]))
    assert [failure for _, failure in bay_bench.actions.finished(0.0)] == [None]


def test_on_a_crossing_it_asks_for_nothing_beyond_the_corridor_that_it_may_enter(bay_bench: Bench) -> None:
    """What it asked for here would be kept from others for as long as it takes through the corridor."""
    bay_bench.navigator.place("post3", "post4")
    bay_bench.missions.memory.grant((leg("post3", "post4"),))
    bay_bench.missions._changed()
    bay_bench.ask("claim(post4)")
    assert [failure for _, failure in bay_bench.actions.finished(0.0)] == [None]
    assert claims(bay_bench) == []


def test_on_its_way_it_asks_once_for_what_comes_after_the_crossing_ahead(bay_bench: Bench) -> None:
    in_corridor(bay_bench, "post2", "post3")
    bay_bench.navigator.destination = "post4"
    ask = AskAhead(bay_bench.hands)
    ask()
    ask()
    (asked,) = claims(bay_bench)
    assert asked.goal == "post4"
    assert asked.legs == (leg("post3", "post4"), leg("post4", "post4_bay1"))
    answered(bay_bench, Grant(claim_id=asked.claim_id, legs=asked.legs[:1]))
    assert bay_bench.navigator.may_cross()


def test_what_it_holds_of_the_corridor_that_it_is_in_lets_it_not_back_over_the_post(bay_bench: Bench) -> None:
    in_corridor(bay_bench, "post2", "post3")
    answered(bay_bench, Grant(claim_id="c1", legs=(leg("post2", "post3"),)))
    bay_bench.navigator.turned()
    assert bay_bench.navigator.waits_before == "post2"
    assert not bay_bench.navigator.may_cross()


def test_before_a_crossing_it_waits_until_it_may_drive_on(bay_bench: Bench) -> None:
    in_corridor(bay_bench, "post2", "post3")
    bay_bench.navigator.destination = "post4"
    bay_bench.ask("wait_to_cross")
    assert bay_bench.actions.finished(0.0) == []
    (asked,) = claims(bay_bench)
    answered(bay_bench, Grant(claim_id=asked.claim_id, legs=asked.legs[:1]))
    assert [failure for _, failure in bay_bench.actions.finished(0.0)] == [None]


def test_refused_the_way_on_it_asks_for_a_bay_of_the_post_ahead(bay_bench: Bench) -> None:
    in_corridor(bay_bench, "post2", "post3")
    bay_bench.navigator.destination = "post4"
    bay_bench.ask("wait_to_cross")
    bay_bench.actions.finished(0.0)
    (asked,) = claims(bay_bench)
    answered(bay_bench, Deny(claim_id=asked.claim_id, avoid=(leg("post3", "post4"),), reason="Others have to pass."))
    assert bay_bench.actions.finished(0.0) == []
    assert claims(bay_bench)[-1].legs == (leg("post3", "post3_bay1"),)


def test_refused_the_corridor_that_it_is_in_it_turns_back(bay_bench: Bench) -> None:
    in_corridor(bay_bench, "post2", "post3")
    bay_bench.navigator.destination = "post4"
    bay_bench.ask("wait_to_cross")
    bay_bench.actions.finished(0.0)
    (asked,) = claims(bay_bench)
    answered(bay_bench, Deny(claim_id=asked.claim_id, avoid=(leg("post2", "post3"),), reason="One stands there."))
    assert [failure for _, failure in bay_bench.actions.finished(0.0)] == ["turn_back"]


def test_sent_elsewhere_out_of_a_bay_it_goes_where_the_last_leg_leads(bay_bench: Bench) -> None:
    bay_bench.navigator.place("post3_bay1", "post3")
    bay_bench.ask("claim(post4)")
    (asked,) = claims(bay_bench)
    aside = (leg("post3_bay1", "post3"), leg("post3", "post2"))
    answered(bay_bench, Detour(claim_id=asked.claim_id, legs=aside, reason="Others have to pass."))
    assert detour(bay_bench.hands) == aside[-1]
    assert [failure for _, failure in bay_bench.actions.finished(0.0)] == [None]


def test_the_bay_that_it_was_granted_is_the_one_it_goes_to(bay_bench: Bench) -> None:
    bay_bench.navigator.place("post4", "post3")
    bay_bench.ask("claim(post4)")
    (asked,) = claims(bay_bench)
    assert asked.legs[0] == leg("post4", "post4_bay1")
    answered(bay_bench, Grant(claim_id=asked.claim_id, legs=(leg("post4", "post4_bay2"),)))
    assert bay_bench.navigator.bay_for("post4") == "post4_bay2"


def test_in_any_bay_of_its_destination_it_has_arrived(bay_bench: Bench) -> None:
    bay_bench.navigator.place("post4_bay2", None)
    bay_bench.navigator.destination = "post4"
    assert bay_bench.navigator.way() == "arrived"


def test_reports_name_the_post_of_a_bay(bay_bench: Bench) -> None:
    bay_bench.navigator.place("post4_bay2", None)
    assert bay_bench.hands.place == "post4"
