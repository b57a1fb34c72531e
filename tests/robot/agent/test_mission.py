"""Our agent carries out a mission: stop by stop, confirmed, each report once asked for, nothing blocked."""

from tests.robot.agent.stage import Stage

HOME = ("home(post5)", "nearest_dock(post5)", "battery(ok)", "watch(0)")
MISSION = (
    "mission(m1,1)",
    "stop(0,s1,post1,load,o1,600)",
    "stop(1,s2,post4,receive,o1,600)",
)


def idle_in_dock() -> Stage:
    stage = Stage(*HOME, "docked", "at(post5)")
    stage.settle()
    assert stage.waiting == {}
    return stage


def at_the_sender() -> Stage:
    """Arrived at post1, not loaded yet."""
    stage = Stage(*HOME, *MISSION, "next_stop(0)", "at(post1)")
    stage.does("report(departed,s1)", "report(arrived,s1)")
    return stage


def drive(stage: Stage, goal: str, way: str, *posts: str) -> None:
    """From post to post until the goal, straight on everywhere but at first."""
    for post in posts:
        stage.does(f"set_destination({goal})", f"claim({goal})")
        stage.perceives(f"direction({goal},{way})")
        if way in ("left", "right", "behind"):
            stage.does(f"turn({way})")
        stage.expect("follow_line")
        stage.reaches(post)
        if post != goal:
            stage.does("report(passed,s1)" if "next_stop(0)" in stage.percepts else "report(passed,s2)")
        way = "forward"


def test_without_anything_to_do_it_stays_in_its_dock() -> None:
    stage = idle_in_dock()
    stage.perceives("watch(1)", without=("watch(0)",))
    stage.settle()
    assert (stage.done, stage.waiting, stage.failures) == (["release"], {}, [])


def test_a_mission_takes_it_out_of_the_dock_and_to_the_first_stop() -> None:
    stage = idle_in_dock()
    stage.perceives(*MISSION, "next_stop(0)")
    stage.does("report(departed,s1)", "set_destination(post1)", "claim(post1)")
    stage.expect("undock")
    stage.perceives(without=("docked",))
    stage.succeeds("undock")
    drive(stage, "post1", "forward", "post3", "post2", "post1")
    stage.does("report(arrived,s1)")
    stage.expect("wait_handover(load,o1,s1,600)")


def test_loading_is_waited_for_and_then_the_recipient_is_next() -> None:
    stage = at_the_sender()
    stage.expect("wait_handover(load,o1,s1,600)")
    stage.settle()
    assert "wait_handover(load,o1,s1,600)" in stage.waiting, "nothing is assumed"
    stage.mail_changes_hands("load,o1,s1", 0)
    stage.settle()
    assert list(stage.waiting) == ["wait_handover(load,o1,s1,600)"], "a hand is in its box"
    stage.people_step_back("load,o1,s1")
    stage.does("report(departed,s2)")
    drive(stage, "post4", "behind", "post2", "post3", "post4")
    stage.does("report(arrived,s2)")
    stage.expect("wait_handover(receive,o1,s2,600)")


def test_a_finished_mission_is_reported_and_the_robot_goes_home_and_rests() -> None:
    stage = Stage(*HOME, *MISSION, "next_stop(2)", "at(post4)")
    stage.expect("finish_mission(m1)")
    stage.perceives(without=(*MISSION, "next_stop(2)"))
    stage.succeeds("finish_mission(m1)")
    drive_home = ("set_destination(post5)", "claim(post5)")
    stage.does(*drive_home)
    stage.perceives("direction(post5,behind)")
    stage.does("turn(behind)")
    stage.expect("follow_line")
    stage.reaches("post5")
    stage.expect("dock")
    stage.perceives("docked")
    stage.succeeds("dock")
    stage.does("release")
    stage.settle()
    assert (stage.waiting, stage.failures) == ({}, [])


def test_a_sender_who_never_comes_is_given_up_and_nothing_is_brought_to_the_recipient() -> None:
    stage = at_the_sender()
    stage.expect("wait_handover(load,o1,s1,600)")
    stage.fails("wait_handover(load,o1,s1,600)", "no_one_came")
    stage.does("report(gave_up,s1,no_one_came)")
    stage.expect("finish_stop(s1)")
    stage.perceives("next_stop(1)", without=("next_stop(0)",))
    stage.succeeds("finish_stop(s1)")
    stage.expect("finish_stop(s2)")
    assert "report(departed,s2)" not in stage.done


def test_mail_that_came_aboard_before_a_power_cut_is_not_asked_for_again() -> None:
    stage = Stage(*HOME, *MISSION, "next_stop(0)", "at(post1)", "carrying(o1)")
    stage.expect("finish_stop(s1)")
    assert stage.done == []


def test_after_a_restart_between_posts_it_drives_on_to_the_next_marker_and_delivers() -> None:
    stage = Stage(*HOME, *MISSION, "next_stop(1)", "carrying(o1)")
    stage.does("report(departed,s2)")
    stage.expect("follow_line")
    stage.reaches("post3")
    stage.does("report(passed,s2)", "set_destination(post4)")


def test_an_unknown_post_is_given_up_by_name_and_the_mission_goes_on() -> None:
    stage = Stage(*HOME, "mission(m1,1)", "stop(0,s1,nowhere,load,o1,600)", "next_stop(0)", "at(post1)")
    stage.does("report(departed,s1)")
    stage.expect("set_destination(nowhere)")
    stage.fails("set_destination(nowhere)", "unknown_post")
    stage.does("report(gave_up,s1,unknown_post)")
    stage.expect("finish_stop(s1)")


def test_a_mission_that_is_changed_on_the_way_is_taken_up_in_its_new_form() -> None:
    stage = Stage(*HOME, *MISSION, "next_stop(0)", "at(post2)")
    stage.does("report(departed,s1)", "set_destination(post1)", "claim(post1)")
    stage.expect("follow_line")
    stage.leaves()
    changed = ("mission(m1,2)", "stop(0,s9,post3,load,o9,600)")
    stage.perceives(*changed, without=MISSION)
    stage.expect("report(departed,s9)")
    assert stage.cancelled == ["follow_line"]


def test_a_cancelled_order_is_dropped_and_the_robot_goes_home() -> None:
    stage = Stage(*HOME, *MISSION, "next_stop(0)", "at(post2)")
    stage.does("report(departed,s1)", "set_destination(post1)", "claim(post1)")
    stage.expect("follow_line")
    stage.leaves()
    stage.perceives("cancelled(o1)", without=(*MISSION, "next_stop(0)"))
    stage.expect_cancelled("follow_line")
    stage.expect("follow_line")
    stage.reaches("post1")
    stage.does("set_destination(post5)")


def test_a_pause_is_kept_at_the_next_post_until_it_is_over() -> None:
    stage = Stage(*HOME, *MISSION, "next_stop(0)", "at(post3)")
    stage.does("report(departed,s1)", "set_destination(post1)", "claim(post1)")
    stage.expect("follow_line")
    stage.leaves()
    stage.perceives("paused")
    stage.settle()
    assert "follow_line" in stage.waiting, "on to the next post"
    stage.reaches("post2")
    stage.settle()
    assert stage.waiting == {}
    stage.perceives(without=("paused",))
    stage.expect("report(departed,s1)")


def test_an_errand_by_hand_ends_at_its_post_and_the_robot_goes_home() -> None:
    stage = Stage(*HOME, "at(post3)", "docked")
    stage.settle()
    stage.reads("achieve", "visit(post3)")
    stage.does("say(arrived)")


def test_an_errand_to_nowhere_is_told_and_forgotten() -> None:
    stage = idle_in_dock()
    stage.reads("achieve", "visit(nowhere)")
    stage.expect("set_destination(nowhere)")
    stage.fails("set_destination(nowhere)", "unknown_post")
    stage.does('raise_fault(errand,"unknown_post")')
    stage.settle()
    assert stage.waiting == {}


def test_a_mission_that_comes_in_the_last_moment_of_docking_is_served_before_the_dock() -> None:
    stage = Stage(*HOME, "mission(m1,1)", "stop(0,s1,post5,load,o1,600)", "next_stop(0)")
    stage.does("report(departed,s1)")
    stage.expect("follow_line")
    stage.perceives("docked", "at(post5)")
    stage.fails("follow_line", "docked")
    stage.does("report(arrived,s1)")
    stage.expect("undock")  # in a dock the base is passive: no person would hear whether their code was right
    stage.perceives(without=("docked",))
    stage.succeeds("undock")
    stage.expect("wait_handover(load,o1,s1,600)")
    assert "find_line" not in stage.waiting


def turning() -> Stage:
    stage = Stage(*HOME, *MISSION, "next_stop(0)", "at(post3)", "direction(post1,behind)")
    stage.does("report(departed,s1)", "set_destination(post1)", "claim(post1)")
    stage.expect("turn(behind)")
    stage.perceives("manoeuvring")
    return stage


def test_a_turn_ends_before_the_robot_changes_its_mind() -> None:
    stage = turning()
    stage.perceives("paused")
    stage.settle()
    assert "turn(behind)" in stage.waiting, "half way round it would stand beside the line"
    stage.perceives(without=("manoeuvring",))
    stage.succeeds("turn(behind)")
    stage.does("release")
    assert stage.waiting == {}


def test_so_does_one_that_is_to_begin_anew() -> None:
    stage = turning()
    stage.perceives("cancelled(o1)")
    stage.settle()
    assert "turn(behind)" in stage.waiting
    stage.perceives(without=("manoeuvring",))
    stage.succeeds("turn(behind)")
    stage.does("finish_stop(s1)")


def test_to_stand_still_no_turn_is_waited_for() -> None:
    stage = turning()
    stage.perceives("halted")
    stage.does("say(refused)")
    stage.expect_cancelled("turn(behind)")
