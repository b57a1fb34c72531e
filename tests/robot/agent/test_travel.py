"""Our agent on its way: what it may enter, what is in its way, and what it does when a person has carried it off."""

import pytest

from tests.robot.agent.stage import Stage
from tests.robot.agent.test_battery_and_safety import CARRYING, on_its_way_with_mail


def test_a_denied_corridor_is_asked_for_again_after_a_while() -> None:
    stage = Stage(*CARRYING, "at(post3)")
    stage.does("report(departed,s2)", "set_destination(post4)")
    stage.expect("claim(post4)")
    stage.fails("claim(post4)", "denied")
    stage.does("rest(15)")
    stage.expect("claim(post4)")


def test_where_no_way_is_open_it_waits_at_its_post_tells_and_asks_ever_more_rarely() -> None:
    stage = Stage(*CARRYING, "at(post3)")
    stage.does("report(departed,s2)", "set_destination(post4)")
    for patience_s in (30, 60, 120, 240, 480, 960, 1800, 1800):
        stage.expect("claim(post4)")
        stage.fails("claim(post4)", "way_closed")
        stage.does('raise_fault(no_way,"every way is blocked or denied")', *(("release",) if patience_s > 60 else ()))
        stage.does(f"rest({patience_s})", "reopen")
    stage.does("claim(post4)")
    stage.expect("follow_line")
    assert "clear_fault(no_way)" in stage.done


@pytest.mark.parametrize("reason", ["blocked", "virtual_wall", "post_missed"])
def test_from_a_blocked_corridor_it_goes_back_and_plans_another_way(reason: str) -> None:
    stage = on_its_way_with_mail()
    stage.fails("follow_line", reason)
    stage.does(f"mark_blocked({reason})", "turn(behind)")
    stage.expect("follow_line")
    stage.reaches("post2")
    stage.does("report(passed,s2)", "set_destination(post4)", "claim(post4)")
    stage.perceives("direction(post4,left)")
    stage.does("turn(left)")
    stage.expect("follow_line")
    assert stage.failures == []


def test_from_a_corridor_that_it_may_not_be_in_it_goes_back() -> None:
    stage = on_its_way_with_mail()
    stage.fails("follow_line", "not_granted")
    stage.does("turn(behind)")
    stage.expect("follow_line")
    stage.reaches("post2")
    stage.does("report(passed,s2)", "set_destination(post4)", "claim(post4)")
    assert stage.failures == []


def test_shut_in_from_both_sides_it_tells_people_and_tries_again() -> None:
    stage = on_its_way_with_mail()
    for _ in range(2):
        stage.fails("follow_line", "blocked")
        stage.does("mark_blocked(blocked)", "turn(behind)")
        stage.expect("follow_line")
        stage.fails("follow_line", "blocked")
        stage.does('raise_fault(stuck,"blocked")', "say(refused)", "rest(30)", "find_line")
        stage.expect("follow_line")
    assert stage.failures == []


def test_a_robot_that_was_carried_elsewhere_takes_note_and_plans_from_there() -> None:
    stage = on_its_way_with_mail()
    stage.perceives("at(post6)", "moved(post6)")
    stage.does("noted_move", "report(departed,s2)", "set_destination(post4)", "claim(post4)")
    stage.settle()
    assert stage.cancelled == ["follow_line"]
    assert stage.done.count("noted_move") == 1


def test_without_network_it_keeps_what_it_was_granted_however_long_it_waits_for_a_way() -> None:
    stage = Stage(*CARRYING, "at(post3)", "fault(link_loss)")
    stage.does("report(departed,s2)", "set_destination(post4)")
    for patience_s in (30, 60, 120, 240):
        stage.expect("claim(post4)")
        stage.fails("claim(post4)", "way_closed")
        stage.does('raise_fault(no_way,"every way is blocked or denied")', f"rest({patience_s})", "reopen")
    assert "release" not in stage.done


def test_gone_into_the_wrong_corridor_it_turns_round_and_begins_again_at_the_post() -> None:
    stage = Stage(*CARRYING)
    stage.does("report(departed,s2)")
    stage.expect("follow_line")
    stage.perceives("astray(post2)")
    stage.does("report(departed,s2)", "turn(behind)")
    stage.perceives(without=("astray(post2)",))
    stage.expect("follow_line")
    stage.reaches("post3")
    stage.does("report(passed,s2)", "set_destination(post4)")
    stage.expect("claim(post4)")


def test_out_of_network_it_waits_at_a_post_for_the_next_corridor_and_hands_over_where_it_has_got_to() -> None:
    stage = Stage(*CARRYING, "at(post3)")
    stage.does("report(departed,s2)", "set_destination(post4)")
    stage.expect("claim(post4)")
    stage.settle(200)
    assert set(stage.waiting) == {"claim(post4)"}, "it waits for the grant, and for nothing else"
    there = Stage(*CARRYING, "at(post4)")
    there.does("report(departed,s2)", "report(arrived,s2)")
    there.expect("wait_handover(receive,o1,s2,600)")


def test_a_corridor_that_opens_ends_the_waiting_for_a_way_but_no_waiting_for_people() -> None:
    stage = Stage(*CARRYING, "at(post3)", 'closed("post3-post4")')
    stage.does("report(departed,s2)", "set_destination(post4)")
    stage.expect("claim(post4)")
    stage.fails("claim(post4)", "way_closed")
    stage.does('raise_fault(no_way,"every way is blocked or denied")')
    stage.expect("rest(30)")
    stage.perceives(without=('closed("post3-post4")',))
    stage.does("report(departed,s2)", "set_destination(post4)", "claim(post4)")
    there = Stage(*CARRYING, "at(post4)", 'closed("post3-post4")')
    there.does("report(departed,s2)", "report(arrived,s2)")
    there.expect("wait_handover(receive,o1,s2,600)")
    there.perceives(without=('closed("post3-post4")',))
    there.settle()
    assert there.cancelled == []


def is_sent_aside(stage: Stage, place: str) -> None:
    """Have the service answer the claim for post4 with another place."""
    stage.does("report(departed,s2)", "set_destination(post4)")
    stage.expect("claim(post4)")
    stage.perceives(f"detour({place})")
    stage.succeeds("claim(post4)")
    stage.does(f"set_destination({place})", f"claim({place})")


def test_sent_aside_by_the_service_it_lets_others_pass_and_then_goes_on_by_its_own_plan() -> None:
    stage = Stage(*CARRYING, "at(post3)", "direction(post4,forward)")
    is_sent_aside(stage, "post5")
    stage.perceives("direction(post5,left)", without=("direction(post4,forward)",))
    stage.does("turn(left)")
    stage.expect("follow_line")
    stage.perceives(without=("detour(post5)",))
    stage.reaches("post5")
    stage.does("report(passed,s2)", "set_destination(post4)", "claim(post4)")
    stage.expect("follow_line")
    assert stage.failures == []


def test_sent_into_another_bay_of_the_post_where_it_was_going_it_stays_there() -> None:
    stage = Stage(*CARRYING, "crossing(post4)", "direction(post4,left)")
    is_sent_aside(stage, "post4_bay2")
    stage.expect("follow_line")
    stage.perceives(without=("detour(post4_bay2)", "crossing(post4)"))
    stage.reaches("post4_bay2", "at(post4)", "direction(post4,arrived)")
    stage.does("set_destination(post4)", "claim(post4)", "report(arrived,s2)")
    stage.expect("wait_handover(receive,o1,s2,600)")
    assert stage.done.count("follow_line") == 1 and stage.failures == []
