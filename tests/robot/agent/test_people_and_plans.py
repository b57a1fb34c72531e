"""Our agent among people who are late, change their minds or call it back; with two orders, and at each moment."""

import pytest

from tests.robot.agent.stage import Stage
from tests.robot.agent.test_mission import HOME, MISSION

TWO_ORDERS = (
    "mission(m1,1)",
    "stop(0,s1,post1,load,o1,600)",
    "stop(1,s2,post1,load,o2,600)",
    "stop(2,s3,post3,receive,o2,600)",
    "stop(3,s4,post4,receive,o1,600)",
)


def hand_over(stage: Stage, number: int, what: str) -> None:
    """The mail changes hands, and the body knows."""
    stage.expect(f"wait_handover({what},600)")
    stage.mail_changes_hands(what, number)
    stage.settle()
    stage.people_step_back(what)


def done(stage: Stage, number: int, stop: str) -> None:
    stage.expect(f"finish_stop({stop})")
    stage.perceives(f"next_stop({number + 1})", without=(f"next_stop({number})",))
    stage.succeeds(f"finish_stop({stop})")


def drives(stage: Stage, goal: str) -> None:
    stage.does(f"set_destination({goal})", f"claim({goal})")
    stage.expect("follow_line")
    stage.reaches(goal)


def test_two_orders_are_loaded_at_one_post_and_delivered_in_the_order_of_the_stops() -> None:
    stage = Stage(*HOME, *TWO_ORDERS, "next_stop(0)", "at(post1)")
    stage.does("report(departed,s1)", "report(arrived,s1)")
    hand_over(stage, 0, "load,o1,s1")
    stage.does("report(departed,s2)", "report(arrived,s2)")
    hand_over(stage, 1, "load,o2,s2")
    assert "follow_line" not in stage.done, "it has not moved in between"
    stage.does("report(departed,s3)")
    drives(stage, "post3")
    stage.does("report(arrived,s3)")
    hand_over(stage, 2, "receive,o2,s3")
    stage.does("report(departed,s4)")
    drives(stage, "post4")
    stage.does("report(arrived,s4)")
    hand_over(stage, 3, "receive,o1,s4")
    stage.expect("finish_mission(m1)")
    assert stage.failures == []


def test_mail_that_one_recipient_does_not_take_is_carried_on_to_the_next_stop() -> None:
    stage = Stage(*HOME, *TWO_ORDERS, "next_stop(2)", "at(post3)", "carrying(o1)", "carrying(o2)")
    stage.does("report(departed,s3)", "report(arrived,s3)")
    stage.expect("wait_handover(receive,o2,s3,600)")
    stage.fails("wait_handover(receive,o2,s3,600)", "no_one_came")
    stage.does("report(gave_up,s3,no_one_came)")
    done(stage, 2, "s3")
    stage.does("report(departed,s4)", "set_destination(post4)")


def test_what_nobody_took_is_offered_where_it_came_from() -> None:
    way_back = ("mission(back,1)", "stop(0,s9,post1,return,o1,600)", "next_stop(0)", "carrying(o1)")
    stage = Stage(*HOME, *way_back, "at(post1)")
    stage.does("report(departed,s9)", "report(arrived,s9)")
    hand_over(stage, 0, "return,o1,s9")
    stage.expect("finish_mission(back)")


def test_nobody_takes_it_back_either_and_the_robot_is_not_kept() -> None:
    way_back = ("mission(back,1)", "stop(0,s9,post1,return,o1,600)", "next_stop(0)", "carrying(o1)")
    stage = Stage(*HOME, *way_back, "at(post1)")
    stage.does("report(departed,s9)", "report(arrived,s9)")
    stage.expect("wait_handover(return,o1,s9,600)")
    stage.fails("wait_handover(return,o1,s9,600)", "no_one_came")
    stage.does("report(gave_up,s9,no_one_came)")
    done(stage, 0, "s9")
    stage.expect("finish_mission(back)")
    stage.perceives(without=("mission(back,1)", "stop(0,s9,post1,return,o1,600)", "next_stop(1)"))
    stage.succeeds("finish_mission(back)")
    stage.does("set_destination(post5)")


def in_its_dock() -> Stage:
    stage = Stage(*HOME, *TWO_ORDERS, "next_stop(0)", "docked", "at(post5)")
    stage.does("report(departed,s1)", "set_destination(post1)")
    stage.expect("claim(post1)")
    return stage


def on_the_way() -> Stage:
    stage = Stage(*HOME, *TWO_ORDERS, "next_stop(0)", "at(post2)")
    stage.does("report(departed,s1)", "set_destination(post1)", "claim(post1)")
    stage.expect("follow_line")
    stage.leaves()
    return stage


def waiting_for_the_sender() -> Stage:
    stage = Stage(*HOME, *TWO_ORDERS, "next_stop(0)", "at(post1)")
    stage.does("report(departed,s1)", "report(arrived,s1)")
    stage.expect("wait_handover(load,o1,s1,600)")
    return stage


@pytest.mark.parametrize("moment", [in_its_dock, on_the_way, waiting_for_the_sender])
def test_a_cancelled_order_is_left_out_at_whatever_moment_and_the_other_is_served(moment: object) -> None:
    assert callable(moment)
    stage: Stage = moment()
    waited_for = next(iter(stage.waiting))
    stage.perceives("cancelled(o1)")
    stage.expect_cancelled(waited_for)
    done(stage, 0, "s1")
    stage.expect("report(departed,s2)")
    assert stage.failures == []


@pytest.mark.parametrize("moment", [in_its_dock, on_the_way, waiting_for_the_sender])
def test_a_pause_at_whatever_moment_ends_where_it_began(moment: object) -> None:
    assert callable(moment)
    stage: Stage = moment()
    stage.perceives("paused")
    stage.settle()
    assert set(stage.waiting) <= {"follow_line"}, "on to the next post, and nothing else"
    if "follow_line" in stage.waiting:
        stage.reaches("post2")
        stage.settle()
    assert stage.waiting == {}
    stage.perceives(without=("paused",))
    stage.expect("report(departed,s1)")


@pytest.mark.parametrize("moment", [in_its_dock, on_the_way, waiting_for_the_sender])
def test_a_recall_without_mail_sends_it_home(moment: object) -> None:
    assert callable(moment)
    stage: Stage = moment()
    waited_for = next(iter(stage.waiting))
    stage.perceives(without=(*TWO_ORDERS, "next_stop(0)"))
    stage.expect_cancelled(waited_for)
    stage.settle()
    if "docked" in stage.percepts:
        assert stage.waiting == {}
    else:
        stage.expect("claim(post5)" if moment is waiting_for_the_sender else "follow_line")


def test_a_recall_with_mail_aboard_takes_it_back_first() -> None:
    stage = Stage(*HOME, *MISSION, "next_stop(1)", "carrying(o1)", "at(post3)")
    stage.does("report(departed,s2)", "set_destination(post4)", "claim(post4)")
    stage.expect("follow_line")
    stage.perceives(
        *("mission(back,1)", "stop(0,s9,post1,return,o1,600)", "next_stop(0)"),
        without=(*MISSION, "next_stop(1)"),
    )
    stage.expect_cancelled("follow_line")
    stage.does("report(departed,s9)", "set_destination(post1)")


@pytest.mark.parametrize("moment", [in_its_dock, on_the_way, waiting_for_the_sender])
def test_a_stop_that_is_added_behind_the_next_one_disturbs_nobody(moment: object) -> None:
    assert callable(moment)
    stage: Stage = moment()
    under_way = set(stage.waiting)
    stage.perceives("mission(m1,2)", "stop(4,s5,post2,park,none,600)", without=("mission(m1,1)",))
    stage.settle()
    assert (set(stage.waiting), stage.cancelled) == (under_way, [])


def test_a_stop_that_is_put_before_the_next_one_is_served_first() -> None:
    stage = on_the_way()
    stage.perceives(
        *("mission(m1,2)", "stop(0,s0,post2,dock,none,600)", "stop(1,s1,post1,load,o1,600)"), without=TWO_ORDERS
    )
    stage.expect_cancelled("follow_line")
    stage.does("report(departed,s0)")
    stage.expect("follow_line")


def test_an_order_that_is_cancelled_later_on_the_way_disturbs_nobody_now() -> None:
    stage = waiting_for_the_sender()
    stage.perceives("cancelled(o2)")
    stage.settle()
    assert (set(stage.waiting), stage.cancelled) == ({"wait_handover(load,o1,s1,600)"}, [])
