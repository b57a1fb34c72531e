"""Our agent when the battery is low, when the line is lost, and when a person stops it."""

from tests.robot.agent.stage import Stage
from tests.robot.agent.test_mission import HOME, MISSION, drive

CARRYING = (*HOME, *MISSION, "next_stop(1)", "carrying(o1)")


def on_its_way_with_mail() -> Stage:
    """Between post2 and post3."""
    stage = Stage(*CARRYING, "at(post2)")
    stage.does("report(departed,s2)", "set_destination(post4)", "claim(post4)")
    stage.expect("follow_line")
    stage.leaves()
    return stage


def becomes_low(stage: Stage) -> None:
    stage.perceives("battery(low)", without=("battery(ok)",))


def test_a_low_battery_interrupts_the_mission_charges_until_full_and_takes_it_up_again() -> None:
    stage = on_its_way_with_mail()
    becomes_low(stage)
    stage.does("report_charge(low)")
    stage.expect_cancelled("follow_line")
    stage.expect("follow_line")  # interrupted between posts: on to the next marker
    stage.reaches("post3")
    stage.does("set_destination(post5)", "claim(post5)")
    stage.perceives("direction(post5,left)")
    stage.does("turn(left)")
    stage.expect("follow_line")
    stage.reaches("post5")
    stage.expect("dock")
    stage.perceives("docked", "battery(ok)", without=("battery(low)",))
    stage.succeeds("dock")
    stage.does("release", "report_charge(charging)")
    stage.settle()
    assert stage.waiting == {}, "ok is not full: it goes on charging"
    stage.perceives("battery(full)", without=("battery(ok)",))
    stage.does("report_charge(charged)", "report(departed,s2)", "set_destination(post4)", "claim(post4)")
    stage.expect("undock")
    stage.perceives(without=("docked",))
    stage.succeeds("undock")
    drive(stage, "post4", "forward", "post3", "post4")
    stage.does("report(arrived,s2)")
    stage.expect("wait_handover(receive,o1,s2,600)")
    assert stage.failures == []


def test_low_is_told_once_even_if_the_battery_trembles() -> None:
    stage = on_its_way_with_mail()
    for _ in range(3):
        becomes_low(stage)
        stage.settle(10)
        stage.perceives("battery(ok)", without=("battery(low)",))
        stage.settle(10)
        if "report_charge(low)" in stage.waiting:
            stage.succeeds("report_charge(low)")
    assert stage.done.count("report_charge(low)") == 1


def test_a_mission_given_while_charging_waits_without_being_busy() -> None:
    stage = Stage(*HOME, "docked", "at(post5)")
    becomes_low(stage)
    stage.does("report_charge(low)", "release", "report_charge(charging)")
    stage.perceives(*MISSION, "next_stop(0)")
    stage.settle()
    assert stage.waiting == {}
    assert stage.agent.idle, "it waits for the percept, not by asking again and again"
    stage.perceives("battery(full)", without=("battery(low)",))
    stage.does("report_charge(charged)", "report(departed,s1)")


def test_a_dock_that_cannot_be_found_is_told_and_tried_again() -> None:
    stage = Stage(*HOME, "at(post5)")
    stage.expect("dock")
    stage.fails("dock", "no_dock")
    stage.does('raise_fault(no_dock,"no_dock")')
    stage.settle()
    stage.does(next(action for action in stage.waiting if action.startswith("raise_fault(trouble")))
    stage.does("rest(10)")
    stage.expect("dock")


def test_switched_off_half_way_out_of_its_dock_it_goes_back_in_and_comes_out_again() -> None:
    stage = Stage(*HOME, *MISSION, "next_stop(0)", "at(post5)", "beside_dock")
    stage.does("report(departed,s1)")
    stage.expect("dock")
    stage.perceives("docked", without=("beside_dock",))
    stage.succeeds("dock")
    stage.does("set_destination(post1)", "claim(post1)")
    stage.expect("undock")
    assert stage.failures == []


def test_beside_a_dock_that_gives_no_signal_it_looks_for_the_line() -> None:
    stage = Stage(*HOME, *MISSION, "next_stop(0)", "at(post5)", "beside_dock")
    stage.does("report(departed,s1)")
    stage.expect("dock")
    stage.fails("dock", "no_dock")
    stage.does("set_destination(post1)", "claim(post1)")
    stage.expect("follow_line")
    assert stage.failures == []


def test_a_line_that_is_lost_is_searched_with_growing_patience_then_people_are_told() -> None:
    stage = on_its_way_with_mail()
    for patience in (3, 6, 9):
        stage.fails("follow_line", "line_lost")
        stage.does(f"rest({patience})", "find_line")
        stage.expect("follow_line")
    stage.fails("follow_line", "line_lost")
    stage.does('raise_fault(stuck,"line_lost")', "say(refused)", "rest(30)", "find_line")
    stage.expect("follow_line")
    stage.reaches("post3")
    stage.does("report(passed,s2)", "set_destination(post4)")
    assert "clear_fault(stuck)" in stage.done


def test_a_turn_that_finds_no_line_searches_and_goes_on() -> None:
    stage = Stage(*CARRYING, "at(post3)")
    stage.does("report(departed,s2)", "set_destination(post4)", "claim(post4)")
    stage.perceives("direction(post4,right)")
    stage.expect("turn(right)")
    stage.fails("turn(right)", "line_lost")
    stage.does("find_line")
    stage.expect("follow_line")


def test_an_emergency_stop_drops_everything_and_rearming_takes_it_up_again() -> None:
    stage = on_its_way_with_mail()
    stage.perceives("halted", "fault(emergency_stop)")
    stage.does("say(refused)")
    stage.settle()
    assert stage.cancelled == ["follow_line"]
    assert stage.waiting == {}
    stage.perceives(without=("halted", "fault(emergency_stop)"))
    stage.does("report(departed,s2)")
    stage.expect("follow_line")


def test_safety_comes_before_the_battery() -> None:
    stage = Stage(*HOME, "halted", "at(post3)")
    becomes_low(stage)
    stage.does("report_charge(low)")
    stage.settle()
    assert not {"follow_line", "set_destination(post5)"} & {*stage.waiting, *stage.done}


def test_a_robot_pulled_out_of_its_dock_drives_back() -> None:
    stage = Stage(*HOME, "docked", "at(post5)")
    stage.settle()
    stage.perceives(without=("docked",))
    stage.expect("dock")


def test_a_robot_that_was_switched_off_in_its_dock_goes_on_charging_until_it_is_full() -> None:
    stage = Stage(*HOME, *MISSION, "next_stop(0)", "docked", "at(post5)", "recharging")
    stage.does("release", "report_charge(charging)")
    stage.settle()
    assert stage.waiting == {}
    stage.perceives("battery(full)", without=("battery(ok)",))
    stage.does("report_charge(charged)", "report(departed,s1)")


def test_work_is_begun_with_enough_charge_only() -> None:
    stage = Stage(*HOME, "docked", "at(post5)", "weak")
    stage.perceives(*MISSION, "next_stop(0)")
    stage.settle()
    assert (stage.waiting, stage.done) == ({}, ["release"])
    stage.perceives(without=("weak",))
    stage.expect("report(departed,s1)")


def test_mail_that_is_aboard_does_not_wait_in_a_dock_for_more_charge_than_it_takes() -> None:
    stage = Stage(*CARRYING, "docked", "at(post5)", "weak")
    stage.expect("report(departed,s2)")


def test_where_no_way_leads_to_a_dock_it_stops_at_a_post_and_says_so_until_one_does() -> None:
    stage = on_its_way_with_mail()
    stage.perceives(without=("nearest_dock(post5)",))
    becomes_low(stage)
    stage.does("report_charge(low)")
    stage.expect("follow_line")
    stage.reaches("post3")
    stage.does('raise_fault(no_dock_open,"no way leads to any dock that is open")')
    stage.settle()
    assert stage.waiting == {}
    stage.perceives("nearest_dock(post5)")
    stage.does("set_destination(post5)", "claim(post5)")
    assert "clear_fault(no_dock_open)" in stage.done


def test_another_dock_is_driven_to_when_the_way_to_the_first_is_closed() -> None:
    stage = on_its_way_with_mail()
    becomes_low(stage)
    stage.does("report_charge(low)")
    stage.expect("follow_line")
    stage.reaches("post3")
    stage.does("set_destination(post5)")
    stage.expect("claim(post5)")
    stage.perceives("nearest_dock(post7)", without=("nearest_dock(post5)",))
    stage.expect_cancelled("claim(post5)")
    stage.does("set_destination(post7)")


def test_charging_comes_before_a_pause_and_a_pause_before_the_mission() -> None:
    stage = Stage(*CARRYING, "at(post3)", "paused")
    stage.settle()
    assert stage.waiting == {}
    becomes_low(stage)
    stage.does("report_charge(low)", "set_destination(post5)")


CHARGE_STOP = ("mission(m2,1)", "stop(0,c1,post7,dock,none,600)", "next_stop(0)")


def filling_up(*more: str) -> Stage:
    """In the dock of post7 on the service's word."""
    stage = Stage(*HOME, *CHARGE_STOP, *more, "fill(c1,wanted)", "at(post7)")
    stage.does("report(departed,c1)", "report(arrived,c1)")
    stage.expect("dock")
    stage.perceives("docked")
    stage.succeeds("dock")
    stage.does("release")
    return stage


def test_at_a_stop_to_charge_it_stays_in_the_dock_until_it_has_what_is_asked_for() -> None:
    stage = filling_up()
    stage.settle()
    assert stage.waiting == {}
    stage.perceives("fill(c1,reached)", without=("fill(c1,wanted)",))
    stage.does("report(done,c1)", "finish_stop(c1)")


def test_a_stop_to_charge_that_is_taken_away_is_left_for_what_is_to_be_done_instead() -> None:
    stage = filling_up()
    stage.perceives(
        "mission(m2,2)", "stop(0,s1,post1,load,o1,600)", without=(*CHARGE_STOP[:2], "fill(c1,wanted)", "at(post5)")
    )
    stage.does("report(departed,s1)", "set_destination(post1)", "claim(post1)")
    stage.expect("undock")
    assert "report(done,c1)" not in stage.done


def test_a_robot_pulled_out_of_the_dock_it_charges_in_docks_again() -> None:
    stage = filling_up()
    stage.settle()
    stage.perceives(without=("docked",))
    stage.does("report(departed,c1)", "report(arrived,c1)")  # which are told once
    stage.expect("dock")


def test_its_own_battery_plan_comes_before_a_stop_to_charge_which_is_not_driven_to_for_nothing() -> None:
    stage = Stage(*HOME, *CHARGE_STOP, "fill(c1,wanted)", "at(post3)")
    stage.does("report(departed,c1)", "set_destination(post7)")
    becomes_low(stage)
    stage.does("report_charge(low)", "set_destination(post5)", "claim(post5)")
    stage.perceives("docked", "at(post5)", without=("at(post3)",))
    stage.settle()
    stage.perceives("battery(full)", "fill(c1,reached)", without=("battery(low)", "fill(c1,wanted)"))
    stage.does("report_charge(charged)", "report(done,c1)", "finish_stop(c1)")
    assert "undock" not in stage.done
