"""Which corridors a robot asks for, may enter, keeps and gives back; and where it goes instead."""

import math
from dataclasses import replace

import pytest

from protocol.envelope import Envelope
from protocol.parts import Leg
from protocol.to_robot import Detour
from robot.agent.actions.corridors import AWAITS_NETWORK_S
from robot.drivers.interfaces import LineReading
from tests.robot.agent.actions.bench import MISSION, NOW, TO_POST1, TO_POST3, TO_POST4, Bench, with_server


def test_a_way_that_is_closed_for_now_is_told_from_one_that_is_not_there(bench: Bench) -> None:
    bench.navigator.place("post1", "post2")
    bench.missions.claims.avoid = frozenset({TO_POST3})
    assert bench.result("set_destination(post4)") is None, "it will be open again"
    assert bench.result("claim(post4)") == "way_closed"
    assert bench.result("claim(post4)") is None, "what was denied is asked for again"
    bench.navigator.closed.close(TO_POST3, now=0.0)
    for _ in range(2):
        assert bench.result("claim(post4)") == "way_closed", "what stands there does not go away by asking"


def test_while_something_stands_in_its_way_it_keeps_what_it_was_granted(bench: Bench) -> None:
    with_server(bench, TO_POST3, TO_POST4)
    bench.navigator.closed.close(TO_POST3, now=0.0)
    assert bench.result("claim(post4)") == "way_closed"
    assert bench.missions.held.grants == (TO_POST3, TO_POST4)
    bench.result("reopen")
    assert bench.result("claim(post4)") is None, "it may go in again with no service to ask"


@pytest.mark.parametrize(("line", "first"), [(False, "find_line"), (True, "follow_line")])
def test_a_robot_that_may_look_anywhere_looks_round_for_the_line_unless_it_is_on_one(
    bench: Bench, line: bool, first: str
) -> None:
    bench.navigator.place("post2", None)
    bench.body.view = replace(bench.body.view, reading=LineReading(left=False, centre=line, right=False))
    bench.hands.view = bench.body.view
    bench.ask("follow_line")
    assert bench.body.started == [first]


@pytest.mark.parametrize("action", ["dock", "undock", "turn(left)"])
def test_what_would_leave_doubt_of_its_place_is_written_down_before_it_begins(bench: Bench, action: str) -> None:
    bench.navigator.place("post5", "post3")
    kept: list[str | None] = []
    bench.body.at_start = lambda _: kept.append(bench.missions.memory.moment())
    bench.ask(action)
    assert kept == ["turning" if action == "turn(left)" else "docking"]


def test_while_another_robot_is_in_its_way_it_lets_go_of_everything(bench: Bench) -> None:
    with_server(bench, TO_POST3, TO_POST4)
    bench.missions.claims.avoid = frozenset({TO_POST3})
    assert bench.result("claim(post4)") == "way_closed"
    assert bench.missions.held.grants == ()


def test_a_corridor_in_which_it_turned_back_is_told_by_name_and_closed_for_ten_minutes(bench: Bench) -> None:
    bench.navigator.place("post2", "post3")
    assert bench.result("mark_blocked(blocked)") == "not_in_a_corridor"
    bench.navigator.leave()
    assert bench.result("mark_blocked(blocked)", now=100.0) is None
    assert "from post2 to post3. Something stands in it." in bench.told()[-1]
    bench.body.passes_time(699.0)
    bench.navigator.look(bench.body.view)
    assert bench.navigator.closed.names == {"post2-post3"}
    bench.body.passes_time(700.0)
    bench.navigator.look(bench.body.view)
    assert not bench.navigator.closed.names


def test_the_first_corridor_is_enough_to_go_on_and_the_rest_is_waited_for_at_the_next_post(bench: Bench) -> None:
    with_server(bench, TO_POST3)
    id_ = bench.ask("claim(post4)")
    assert bench.actions.finished(0.0) == [(id_, None)]
    assert '"post4"' in bench.told()[-1], "it asks for all of it"


def test_a_detour_gives_back_what_it_does_not_need_and_keeps_what_it_does(bench: Bench) -> None:
    with_server(bench, TO_POST3, TO_POST4)
    assert bench.result("claim(post5)") is None
    assert bench.missions.held.grants == (TO_POST3,)


def test_a_corridor_to_which_it_comes_only_later_is_given_back_though_it_is_on_the_way_home(bench: Bench) -> None:
    with_server(bench, TO_POST3)
    bench.ask("claim(post1)")
    claimed = next(told for told in bench.told() if '"goal":"post1"' in told)
    assert '{"from_post":"post2","to_post":"post3"}' in claimed, "it asks for the way back to its dock as well"
    assert bench.missions.held.grants == ()


def test_a_corridor_that_it_has_been_through_is_given_back_though_it_comes_there_again(bench: Bench) -> None:
    with_server(bench, Leg(from_post="post1", to_post="post2"))
    bench.ask("claim(post1)")
    assert bench.missions.held.grants == ()


def test_a_claim_that_is_answered_by_a_way_aside_ends_and_what_was_granted_with_it_is_kept(bench: Bench) -> None:
    with_server(bench)
    waiting = bench.ask("claim(post4)")
    assert bench.actions.finished(0.0) == [], "it waits at its post"
    sent(bench, TO_POST1)
    assert bench.actions.finished(0.1) == [(waiting, None)]
    assert bench.result("claim(post4)") is None, "asked again it is sent there again, and claims nothing meanwhile"
    assert bench.missions.held.grants == (TO_POST1,)
    assert [told for told in bench.told() if '"goal"' in told] == [bench.told()[0]]
    bench.navigator.place("post1", "post2")
    bench.ask("claim(post4)")
    assert bench.missions.held.grants == () and '"goal":"post4"' in bench.told()[-1], "from there it goes its own way"


def test_it_is_not_sent_into_a_corridor_in_which_it_has_turned_back(bench: Bench) -> None:
    with_server(bench)
    bench.navigator.closed.close(TO_POST1, now=0.0)
    sent(bench, TO_POST1)
    bench.ask("claim(post4)")
    assert bench.actions.finished(0.0) == []
    assert bench.missions.held.grants == (), "it gives back what was granted with it"


def out_of_network(bench: Bench, at_s: float) -> None:
    bench.hands.view = bench.body.view = replace(bench.body.view, at_s=at_s, faults=frozenset({"link_loss"}))


def test_out_of_network_it_keeps_what_it_was_granted_and_leaves_by_it(bench: Bench) -> None:
    with_server(bench, TO_POST3, TO_POST4, online=False)
    waiting = bench.ask("claim(post1)")
    out_of_network(bench, AWAITS_NETWORK_S - 1)
    assert bench.actions.finished(0.0) == [], "the network may come back at once"
    assert bench.missions.held.grants == (TO_POST3, TO_POST4)
    out_of_network(bench, AWAITS_NETWORK_S)
    assert bench.actions.finished(0.1) == [(waiting, None)]
    assert bench.navigator.detour == TO_POST3
    assert bench.told()[-1].startswith('{"claim_id"'), "what it asked for it takes back"
    bench.navigator.destination = "post3"
    assert bench.result("claim(post3)") is None
    bench.navigator.place("post3", "post4")
    assert bench.navigator.detour is None, "from there it goes its own way"


def test_out_of_network_it_leaves_by_no_corridor_in_which_it_has_turned_back(bench: Bench) -> None:
    with_server(bench, TO_POST3, online=False)
    bench.navigator.closed.close(TO_POST3, now=0.0)
    bench.ask("claim(post1)")
    out_of_network(bench, AWAITS_NETWORK_S)
    assert bench.actions.finished(0.1) == []


def test_out_of_network_it_waits_for_no_other_way_than_it_has(bench: Bench) -> None:
    with_server(bench, TO_POST3, online=False)
    out_of_network(bench, AWAITS_NETWORK_S)
    assert bench.result("claim(post3)") is None
    assert bench.navigator.detour is None


def crosses(bench: Bench, here: str, there: str) -> None:
    bench.navigator.place(here, there)
    bench.navigator.leave()
    bench.body.rolls(1700.0)
    bench.navigator.look(bench.body.view)
    bench.navigator.reached(there)
    assert bench.navigator.at == there


TO_POST2 = Leg(from_post="post3", to_post="post2")


def test_out_of_network_it_may_go_again_where_it_has_been(bench: Bench) -> None:
    with_server(bench, TO_POST2, TO_POST3, TO_POST4, online=False)
    crosses(bench, "post3", "post2")
    crosses(bench, "post2", "post3")
    assert bench.missions.held.grants == (TO_POST2, TO_POST3, TO_POST4), "no one would hear of it"
    assert bench.result("claim(post2)") is None
    assert bench.result("claim(post4)") is None


def test_out_of_network_it_does_not_drive_to_and_fro(bench: Bench) -> None:
    with_server(bench, TO_POST2, TO_POST3, online=False)
    crosses(bench, "post3", "post2")
    for_post1 = bench.ask("claim(post1)")
    out_of_network(bench, AWAITS_NETWORK_S)
    assert bench.actions.finished(0.1) == [(for_post1, None)] and bench.navigator.detour == TO_POST3
    crosses(bench, "post2", "post3")
    crosses(bench, "post3", "post2")
    assert bench.navigator.detour is None, "it has been there"
    bench.ask("claim(post1)")
    out_of_network(bench, 3 * AWAITS_NETWORK_S)
    assert bench.actions.finished(0.1) == [], "it would only come back"


def test_what_it_was_to_take_first_is_forgotten_once_it_has_come_through(bench: Bench) -> None:
    server = with_server(bench, TO_POST3, online=False)
    bench.missions.memory.turn_aside(TO_POST3)
    crosses(bench, "post2", "post3")
    server.online = True
    bench.navigator.give_back_crossed()
    assert (bench.missions.held.grants, bench.missions.held.detour) == ((), None)
    bench.navigator.place("post2", "post1")
    bench.ask("claim(post1)")
    assert bench.actions.finished(0.0) == [], "it has to be granted"


def test_what_it_has_crossed_out_of_network_it_gives_back_at_the_next_post_with_network(bench: Bench) -> None:
    came_by = (Leg(from_post="post4", to_post="post3"), TO_POST2)
    server = with_server(bench, *came_by, TO_POST1, online=False)
    crosses(bench, "post4", "post3")
    server.online = True
    crosses(bench, "post3", "post2")
    assert bench.missions.held.grants == (TO_POST1,)
    assert len(bench.told()) == 2 and all('"leg"' in told for told in bench.told()), "each once"


def test_network_that_comes_back_after_a_claim_takes_nothing_from_under_its_wheels(bench: Bench) -> None:
    server = with_server(bench, TO_POST2, TO_POST3, online=False)
    crosses(bench, "post3", "post2")
    crosses(bench, "post2", "post3")
    assert bench.result("claim(post2)") is None
    server.online = True
    bench.navigator.look(bench.body.view)
    assert TO_POST2 in bench.missions.held.grants
    crosses(bench, "post3", "post2")
    assert bench.missions.held.grants == ()


@pytest.mark.parametrize("started_anew", [False, True])
def test_network_that_comes_back_while_it_waits_for_a_person_lets_others_in_behind_it(
    bench: Bench, started_anew: bool
) -> None:
    server = with_server(bench, TO_POST2, online=False)
    bench.missions.give(MISSION)
    crosses(bench, "post3", "post2")
    bench.navigator.crossed = () if started_anew else bench.navigator.crossed
    bench.ask("wait_handover(load, o1, s1, 90)")
    assert bench.actions.finished(0.0) == []
    assert bench.missions.held.grants == (TO_POST2,)
    server.online = True
    assert bench.actions.finished(0.1) == []
    assert bench.missions.held.grants == ()


def test_on_its_way_back_it_does_not_release_the_corridor_that_it_is_in(bench: Bench) -> None:
    with_server(bench, TO_POST3, TO_POST4)
    bench.navigator.place("post3", "post2")
    bench.navigator.leave()
    bench.result("release")
    assert bench.missions.held.grants == (TO_POST3,)


def pushed_away(bench: Bench, *granted: Leg) -> None:
    """From post2 into the corridor to post3."""
    with_server(bench, *granted)
    bench.body.rolls(150.0)
    bench.navigator.look(bench.body.view)
    assert bench.navigator.towards == "post3"


def test_in_a_corridor_that_it_came_into_ungranted_it_only_goes_back(bench: Bench) -> None:
    pushed_away(bench)
    assert bench.result("follow_line") == "not_granted"
    bench.body.turns(math.pi)
    bench.navigator.look(bench.body.view)
    bench.navigator.turned()
    bench.ask("follow_line")
    assert bench.body.started == ["follow_line"]


@pytest.mark.parametrize("granted", [TO_POST3, Leg(from_post="post3", to_post="post2")])
def test_in_a_corridor_that_it_was_granted_either_way_it_goes_on(bench: Bench, granted: Leg) -> None:
    pushed_away(bench, granted)
    bench.ask("follow_line")
    assert bench.body.started == ["follow_line"]


def sent(bench: Bench, leg: Leg) -> None:
    """The service has answered with another corridor than the one asked for."""
    detour = Detour(claim_id="c", legs=(leg,), reason="Robot r2 has to pass.")
    bench.missions.memory.resume("j", 1)
    bench.missions.memory.receive(Envelope(type="detour", robot="r1", journal="j", seq=1, at=NOW, body=detour))
    bench.missions.seen("post2")


def test_the_corridor_that_it_is_in_is_never_given_back(bench: Bench) -> None:
    with_server(bench, TO_POST3, TO_POST4)
    bench.navigator.leave()
    assert bench.result("release") is None
    assert bench.missions.held.grants == (TO_POST3,)
