"""On a map with bays: what a robot asks for out of a bay and before a crossing, and where the answer sends it."""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path

import pytest

from maps import find_map
from maps.campus_map import build_map
from maps.map_file import load_map_file
from maps.scaling import scaled
from protocol.envelope import Envelope, type_of
from protocol.parts import Leg
from protocol.to_robot import Deny, Detour, Grant
from protocol.to_server import Claim
from robot.agent.actions.corridors import AWAITS_NETWORK_S, AskAhead
from robot.agent.navigator import Navigator
from robot.mission.memory import Incoming
from robot.mission.store import Store
from tests.robot.agent.actions.bench import MISSION, NOW, Bench

MAP = Path(__file__).parents[3] / "bays.toml"
TRACK = find_map(MAP).track


@dataclass
class Server:
    """The link, with what has come over it."""

    online: bool = True
    waiting: list[Incoming] = field(default_factory=list)

    def incoming(self) -> list[Incoming]:
        taken, self.waiting = self.waiting, []
        return taken

    def wake(self) -> None:
        pass


class BayBench(Bench):
    """The bench on the track with bays."""

    server: Server


def leg(from_post: str, to_post: str) -> Leg:
    return Leg(from_post=from_post, to_post=to_post)


@pytest.fixture
def bay_bench(tmp_path: Path) -> Iterator[BayBench]:
    store = Store(tmp_path / "robot.db")
    bench = BayBench(store)
    bench.navigator = bench.hands.navigator = Navigator(TRACK, "post5_bay2", bench.missions, now=0.0)
    bench.server = Server()
    bench.missions.join(bench.server)
    yield bench
    store.close()


def claims(bench: Bench) -> list[Claim]:
    messages = [kept.message for kept in bench.missions.outbox.pending()]
    return [message for message in messages if isinstance(message, Claim)]


def answered(bench: BayBench, answer: Grant | Detour | Deny) -> None:
    """It is received, and acted on at the next tick."""
    memory, seq = bench.missions.memory, bench.missions.memory.received().seq + 1
    if seq == 1:
        memory.resume("j", 1)
    memory.receive(Envelope(type=type_of(answer), robot="r1", journal="j", seq=seq, at=NOW, body=answer))
    bench.server.waiting += [one for one in memory.unhandled() if one.seq == seq]
    bench.missions.take_messages()


def in_corridor(bench: Bench, here: str, towards: str) -> None:
    bench.navigator.place(here, towards)
    bench.navigator.leave()


def test_out_of_a_bay_it_goes_only_together_with_what_comes_after_the_crossing(bay_bench: BayBench) -> None:
    bay_bench.navigator.place("post4_bay1", "post4")
    bay_bench.ask("claim(post3)")
    (asked,) = claims(bay_bench)
    assert asked.legs[:2] == (leg("post4_bay1", "post4"), leg("post4", "post3"))
    assert asked.legs[2] == leg("post3", "post3_bay1")
    answered(bay_bench, Grant(claim_id=asked.claim_id, legs=asked.legs[:1]))
    assert bay_bench.actions.finished(0.0) == []
    answered(bay_bench, Grant(claim_id=asked.claim_id, legs=asked.legs[1:2]))
    assert [failure for _, failure in bay_bench.actions.finished(0.0)] == [None]


@pytest.mark.parametrize(
    ("held", "taken"),
    [
        ([leg("post3_bay1", "post3")], None),
        ([leg("post3", "post4")], None),
        ([leg("post3_bay1", "post3"), leg("post3", "post3_bay1")], None),
        ([leg("post3_bay1", "post3"), leg("post3", "post4")], leg("post3", "post4")),
    ],
)
def test_out_of_a_bay_without_network_it_goes_only_where_a_corridor_leads_on(
    bay_bench: BayBench, held: list[Leg], taken: Leg | None
) -> None:
    bay_bench.navigator.place("post3_bay1", "post3")
    bay_bench.missions.memory.grant(held)
    bay_bench.missions._changed()
    bay_bench.server.online = False
    bay_bench.ask("claim(post5)")
    silence = replace(bay_bench.body.view, at_s=AWAITS_NETWORK_S, faults=frozenset({"link_loss"}))
    bay_bench.hands.view = bay_bench.body.view = silence
    assert [failure for _, failure in bay_bench.actions.finished(0.0)] == ([] if taken is None else [None])
    assert bay_bench.hands.navigator.detour == taken


def test_on_a_crossing_it_asks_for_nothing_beyond_the_corridor_that_it_may_enter(bay_bench: BayBench) -> None:
    """What it asked for here would be kept from others for as long as it takes through the corridor."""
    bay_bench.navigator.place("post3", "post4")
    bay_bench.missions.memory.grant((leg("post3", "post4"),))
    bay_bench.missions._changed()
    bay_bench.ask("claim(post4)")
    assert [failure for _, failure in bay_bench.actions.finished(0.0)] == [None]
    assert claims(bay_bench) == []


def test_on_its_way_it_asks_once_for_what_comes_after_the_crossing_ahead(bay_bench: BayBench) -> None:
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


def test_what_it_holds_of_the_corridor_that_it_is_in_lets_it_not_back_over_the_post(bay_bench: BayBench) -> None:
    in_corridor(bay_bench, "post2", "post3")
    answered(bay_bench, Grant(claim_id="c1", legs=(leg("post2", "post3"),)))
    bay_bench.navigator.turned()
    assert bay_bench.navigator.waits_before == "post2"
    assert not bay_bench.navigator.may_cross()


def test_before_a_crossing_it_waits_until_it_may_drive_on(bay_bench: BayBench) -> None:
    in_corridor(bay_bench, "post2", "post3")
    bay_bench.navigator.destination = "post4"
    bay_bench.ask("wait_to_cross")
    assert bay_bench.actions.finished(0.0) == []
    (asked,) = claims(bay_bench)
    answered(bay_bench, Grant(claim_id=asked.claim_id, legs=asked.legs[:1]))
    assert [failure for _, failure in bay_bench.actions.finished(0.0)] == [None]


def test_refused_the_way_on_it_asks_for_a_bay_of_the_post_ahead(bay_bench: BayBench) -> None:
    in_corridor(bay_bench, "post2", "post3")
    bay_bench.navigator.destination = "post4"
    bay_bench.ask("wait_to_cross")
    bay_bench.actions.finished(0.0)
    (asked,) = claims(bay_bench)
    answered(bay_bench, Deny(claim_id=asked.claim_id, avoid=(leg("post3", "post4"),), reason="Others have to pass."))
    assert bay_bench.actions.finished(0.0) == []
    assert claims(bay_bench)[-1].legs == (leg("post3", "post3_bay1"),)


def test_refused_the_corridor_that_it_is_in_it_turns_back(bay_bench: BayBench) -> None:
    in_corridor(bay_bench, "post2", "post3")
    bay_bench.navigator.destination = "post4"
    bay_bench.ask("wait_to_cross")
    bay_bench.actions.finished(0.0)
    (asked,) = claims(bay_bench)
    answered(bay_bench, Deny(claim_id=asked.claim_id, avoid=(leg("post2", "post3"),), reason="One stands there."))
    assert [failure for _, failure in bay_bench.actions.finished(0.0)] == ["turn_back"]


def turned_round_on_its_way_into_a_bay(bay_bench: BayBench) -> None:
    in_corridor(bay_bench, "post3", "post3_bay1")
    answered(bay_bench, Grant(claim_id="c1", legs=(leg("post3", "post3_bay1"),)))
    bay_bench.navigator.turned()
    bay_bench.navigator.destination = "post4"


def test_one_that_turned_round_on_its_way_into_its_bay_goes_in(bay_bench: BayBench) -> None:
    """From there it is let out: on the crossing nothing but that bay is open to it."""
    turned_round_on_its_way_into_a_bay(bay_bench)
    bay_bench.ask("wait_to_cross")
    assert [failure for _, failure in bay_bench.actions.finished(0.0)] == ["turn_back"]


def test_one_that_turned_round_before_something_in_its_bay_asks_for_another(bay_bench: BayBench) -> None:
    turned_round_on_its_way_into_a_bay(bay_bench)
    bay_bench.ask("mark_blocked(blocked)")
    bay_bench.ask("wait_to_cross")
    assert [failure for _, failure in bay_bench.actions.finished(0.0)] == [None]
    assert claims(bay_bench) != []


def test_sent_elsewhere_out_of_a_bay_it_goes_where_the_last_leg_leads(bay_bench: BayBench) -> None:
    bay_bench.navigator.place("post3_bay1", "post3")
    bay_bench.ask("claim(post4)")
    (asked,) = claims(bay_bench)
    aside = (leg("post3_bay1", "post3"), leg("post3", "post2"))
    answered(bay_bench, Detour(claim_id=asked.claim_id, legs=aside, reason="Others have to pass."))
    assert bay_bench.navigator.detour == aside[-1]
    assert [failure for _, failure in bay_bench.actions.finished(0.0)] == [None]


def test_the_bay_that_it_was_granted_is_the_one_it_goes_to(bay_bench: BayBench) -> None:
    bay_bench.navigator.place("post4", "post3")
    bay_bench.ask("claim(post4)")
    (asked,) = claims(bay_bench)
    assert asked.legs[0] == leg("post4", "post4_bay1")
    answered(bay_bench, Grant(claim_id=asked.claim_id, legs=(leg("post4", "post4_bay2"),)))
    assert bay_bench.navigator.bay_for("post4") == "post4_bay2"


def test_in_any_bay_of_its_destination_it_has_arrived(bay_bench: BayBench) -> None:
    bay_bench.navigator.place("post4_bay2", None)
    bay_bench.navigator.destination = "post4"
    assert bay_bench.navigator.way() == "arrived"


def test_reports_name_the_post_of_a_bay(bay_bench: BayBench) -> None:
    bay_bench.navigator.place("post4_bay2", None)
    assert bay_bench.hands.place == "post4"


def test_far_from_a_crossing_it_asks_for_nothing_yet(bay_bench: BayBench) -> None:
    """Else the crossing would be kept from others for all the time that it takes there."""
    long_ways = build_map(scaled(load_map_file(MAP), 5.0)).track
    bay_bench.navigator = bay_bench.hands.navigator = Navigator(long_ways, "post5_bay2", bay_bench.missions, now=0.0)
    in_corridor(bay_bench, "post2", "post3")
    bay_bench.navigator.destination = "post4"
    AskAhead(bay_bench.hands)()
    assert claims(bay_bench) == []


def test_out_of_a_bay_it_has_passed_no_post(bay_bench: BayBench) -> None:
    bay_bench.missions.give(MISSION)
    before = len(bay_bench.told())
    in_corridor(bay_bench, "post4_bay1", "post4")
    bay_bench.navigator.reached("post4", unread=True)
    bay_bench.ask("report(passed,s2)")
    assert not [text for text in bay_bench.told()[before:] if '"passed"' in text]


def test_in_the_hands_of_a_person_it_forgets_what_it_has_reported(bay_bench: BayBench) -> None:
    """Put down in the same bay it has to say so anew: the service may have been told otherwise."""
    bay_bench.missions.occupies("bay", "post4_bay1", None, "marker", None)
    bay_bench.navigator.lose_place(bay_bench.hands.view)
    bay_bench.missions.occupies("bay", "post4_bay1", None, "marker", None)
    assert sum('"post4_bay1"' in text and '"evidence"' in text for text in bay_bench.told()) == 2
