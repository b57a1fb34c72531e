"""Our agent on a map with bays: it stands in bays, and only passes on crossings."""

from tests.robot.agent.stage import Stage
from tests.robot.agent.test_mission import HOME, MISSION

CARRYING = (*HOME, *MISSION, "next_stop(1)", "carrying(o1)")


def at_the_crossing_of_its_stop() -> Stage:
    stage = Stage(*CARRYING, "crossing(post4)")
    stage.does("report(departed,s2)", "set_destination(post4)", "claim(post4)")
    return stage


def test_at_the_post_of_its_stop_it_goes_on_into_the_bay() -> None:
    stage = at_the_crossing_of_its_stop()
    stage.expect("follow_line")
    stage.leaves()
    stage.perceives(without=("crossing(post4)",))
    stage.reaches("post4_bay1", "at(post4)")
    stage.does("report(arrived,s2)")
    stage.expect("wait_handover(receive,o1,s2,600)")
    assert "report(passed,s2)" not in stage.done


def test_before_a_crossing_that_others_have_it_waits_and_then_goes_on() -> None:
    stage = Stage(*CARRYING, "at(post3)")
    stage.does("report(departed,s2)", "set_destination(post4)", "claim(post4)")
    stage.expect("follow_line")
    stage.leaves()
    stage.fails("follow_line", "must_wait")
    stage.does("wait_to_cross")
    stage.expect("follow_line")


def test_where_nothing_lets_it_cross_it_asks_again() -> None:
    stage = Stage(*CARRYING, "at(post3)")
    stage.does("report(departed,s2)", "set_destination(post4)", "claim(post4)")
    stage.expect("follow_line")
    stage.fails("follow_line", "must_wait")
    stage.expect("wait_to_cross")
    stage.fails("wait_to_cross", "way_closed")
    stage.does("rest(15)", "wait_to_cross")


def test_sent_back_from_a_crossing_on_which_another_stands_it_turns_round() -> None:
    stage = Stage(*CARRYING, "at(post3)")
    stage.does("report(departed,s2)", "set_destination(post4)", "claim(post4)")
    stage.expect("follow_line")
    stage.leaves()
    stage.fails("follow_line", "must_wait")
    stage.expect("wait_to_cross")
    stage.fails("wait_to_cross", "turn_back")
    stage.does("turn(behind)")
    stage.expect("follow_line")


def test_told_to_wait_it_leaves_the_crossing_first() -> None:
    stage = Stage(*HOME, "crossing(post3)", "paused")
    stage.does("set_destination(post3)", "claim(post3)")
    stage.expect("follow_line")
    stage.perceives(without=("crossing(post3)",))
    stage.reaches("post3_bay1", "at(post3)")
    stage.does("release")
    stage.settle()
    assert stage.waiting == {}


def test_with_no_way_on_from_a_crossing_it_waits_at_home() -> None:
    stage = at_the_crossing_of_its_stop()
    stage.expect("follow_line")
    stage.fails("follow_line", "blocked")
    stage.does("mark_blocked(blocked)", "turn(behind)", "follow_line")
    stage.does("set_destination(post4)")
    stage.expect("claim(post4)")
    stage.fails("claim(post4)", "way_closed")
    stage.does('raise_fault(no_way,"every way is blocked or denied")', "set_destination(post5)", "claim(post5)")


def test_a_home_without_a_dock_is_a_place_to_rest() -> None:
    stage = Stage("home(post4_bay2)", "dockless", "battery(ok)", "watch(0)", "at(post3_bay1)", "at(post3)")
    stage.does("set_destination(post4_bay2)", "claim(post4_bay2)")
    stage.expect("follow_line")
    stage.reaches("post4_bay2", "at(post4)")
    stage.does("release")
    stage.settle()
    assert stage.waiting == {}
    assert "dock" not in stage.done


def test_it_charges_in_the_bay_with_the_dock() -> None:
    mission = ("mission(m2,1)", "stop(0,c1,post5,dock,none,600)", "next_stop(0)", "fill(c1,wanted)")
    stage = Stage(*HOME, *mission, "dock_bay(post5,post5_bay2)", "at(post3_bay1)", "at(post3)")
    stage.does("report(departed,c1)", "set_destination(post5_bay2)", "claim(post5_bay2)")
