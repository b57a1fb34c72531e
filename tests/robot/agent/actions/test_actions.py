"""Actions: what a program asks for is begun, refused by name, ended or cancelled; nothing vanishes."""

import math
from dataclasses import replace
from pathlib import Path

import pytest

from protocol.proofs import ShownCode
from robot.agent.actions.table import ACTIONS, PAPER_ACTIONS, STANDS_FOR_HANDS_S
from robot.core.config import PerceptMode
from robot.drivers.interfaces import LineReading
from robot.mission.store import Store
from robot.skills.interfaces import Done, Failed
from tests.robot.agent.actions.bench import MISSION, Bench


@pytest.mark.parametrize(
    ("asked", "reason"),
    [
        ("fly(post1)", "unknown_action"),
        ("turn(up)", "wrong_arguments"),
        ("turn", "wrong_arguments"),
        ("turn(left,now)", "wrong_arguments"),
        ("rest(soon)", "wrong_arguments"),
        ("set_destination(post9)", "unknown_post"),
        ("set_destination([post1])", "wrong_arguments"),
    ],
)
def test_what_cannot_be_done_fails_by_name_and_is_noted(bench: Bench, asked: str, reason: str) -> None:
    assert bench.result(asked) == reason
    assert len(bench.noted) == 2, "why, in words, and that it failed"
    assert bench.body.started == []


def test_an_action_lasts_as_long_as_its_skill(bench: Bench) -> None:
    id_ = bench.ask("follow_line")
    assert bench.actions.finished(1.0) == []
    bench.body.end("follow_line", Done("post2"))
    assert bench.actions.finished(2.0) == [(id_, None)]
    assert bench.actions.finished(3.0) == []


def test_a_skill_that_fails_ends_its_action_with_its_reason(bench: Bench) -> None:
    id_ = bench.ask("follow_line")
    bench.body.end("follow_line", Failed("line_lost"))
    assert bench.actions.finished(1.0) == [(id_, "line_lost")]


def test_an_undocked_robot_that_finds_no_line_looks_about_before_it_gives_up(bench: Bench) -> None:
    id_ = bench.ask("undock")
    bench.body.end("undock", Failed("line_lost"))
    assert bench.actions.finished(1.0) == []
    assert bench.body.started == ["undock", "find_line"]
    bench.body.end("find_line")
    assert bench.actions.finished(2.0) == [(id_, None)]


def test_an_undocking_that_never_began_is_not_rescued(bench: Bench) -> None:
    id_ = bench.ask("undock")
    bench.body.end("undock", Failed("not_docked"))
    assert bench.actions.finished(1.0) == [(id_, "not_docked")]


def test_a_long_corridor_is_given_the_time_it_takes(bench: Bench) -> None:
    bench.navigator.place("post1", "post2")
    bench.ask("follow_line")
    limit_s = next(iter(bench.body.running.values())).limit_s
    assert limit_s == pytest.approx(180 + 3 * 2.0 / 0.12)


def test_a_robot_whose_turn_was_interrupted_straightens_up_before_it_follows_the_line(bench: Bench) -> None:
    bench.navigator.place("post2", "post3")
    bench.result("set_destination(post3)")
    bench.body.turns(math.radians(-30))
    bench.navigator.look(bench.body.view)
    assert bench.navigator.way() == "forward"
    id_ = bench.ask("follow_line")
    assert bench.body.started == ["turn"]
    bench.body.end("turn")
    assert bench.actions.finished(1.0) == []
    assert bench.body.started == ["turn", "follow_line"]
    bench.body.end("follow_line", Done("post3"))
    assert bench.actions.finished(2.0) == [(id_, None)]


@pytest.mark.parametrize(
    ("aslant_deg", "begins"), [(-35, ["follow_line"]), (35, ["turn"])], ids=["no other line is near", "another is near"]
)
def test_a_line_under_its_diodes_is_followed_at_once_where_it_can_be_no_other(
    bench: Bench, aslant_deg: float, begins: list[str]
) -> None:
    """At post2 the line to post1 begins to the left of that to post3. The way it looks is known to some 15 degrees."""
    bench.navigator.place("post2", "post3")
    bench.result("set_destination(post3)")
    bench.body.turns(math.radians(aslant_deg))
    bench.body.view = replace(bench.body.view, reading=LineReading(True, False, False))
    bench.hands.view = bench.body.view
    bench.navigator.look(bench.body.view)
    bench.ask("follow_line")
    assert bench.body.started == begins


def test_a_second_motion_is_busy_and_the_first_goes_on(bench: Bench) -> None:
    bench.ask("follow_line")
    assert bench.result("turn(left)") == "busy"
    assert bench.actions.under_way == ("follow_line",)


def test_a_dropped_intention_cancels_its_skill_before_the_next_one_starts(bench: Bench) -> None:
    first = bench.ask("follow_line")
    bench.actions.cancel([first])
    second = bench.ask("turn(left)")
    assert bench.body.cancelled == ["follow_line"]
    bench.body.end("turn")
    assert bench.actions.finished(1.0) == [(second, None)], "nothing more is heard of the first"


def test_mail_is_written_down_before_the_tune_promises_it(bench: Bench) -> None:
    bench.missions.give(MISSION)
    bench.ask("wait_handover(load,o1,s1,600)")
    bench.body.end("wait_handover", Done(shown=ShownCode("ab" * 32, b"key")))
    assert "say" not in bench.body.started
    bench.body.at_start = lambda skill: cargo.append((skill.name, bench.missions.held.cargo))
    cargo: list[tuple[str, tuple[str, ...]]] = []
    bench.actions.finished(1.0)
    assert cargo == [("say", ("o1",))]


def test_rest_ends_after_its_time(bench: Bench) -> None:
    id_ = bench.ask("rest(5)", now=10.0)
    assert bench.actions.finished(14.9) == []
    assert bench.actions.finished(15.0) == [(id_, None)]


def test_without_a_server_the_robot_may_drive_where_it_likes(bench: Bench) -> None:
    bench.navigator.place("post1", "post2")
    assert bench.result("claim(post4)") is None


def test_a_confirmed_handover_is_kept_and_told_in_one_go(bench: Bench) -> None:
    bench.missions.give(MISSION)
    bench.navigator.place("post1", "post2")
    id_ = bench.ask("wait_handover(load,o1,s1,600)")
    bench.body.end("wait_handover", Done(shown=ShownCode("ab" * 32, b"key")))
    assert bench.actions.finished(1.0) == []
    assert (bench.missions.held.cargo, bench.missions.held.next_stop) == (("o1",), 1)
    assert [text for text in bench.told() if '"handover"' in text and "ab" * 32 in text]
    assert bench.missions.custody.handing_over
    assert bench.actions.finished(1.0 + STANDS_FOR_HANDS_S - 0.1) == [], "a hand may be in the box"
    assert bench.actions.finished(1.0 + STANDS_FOR_HANDS_S) == [(id_, None)]
    assert not bench.missions.custody.handing_over


def test_a_dropped_plan_does_not_wait_for_hands(bench: Bench) -> None:
    bench.missions.give(MISSION)
    id_ = bench.ask("wait_handover(load,o1,s1,600)")
    bench.body.end("wait_handover", Done(shown=ShownCode("ab" * 32, b"key")))
    bench.actions.finished(1.0)
    bench.actions.cancel([id_])
    assert not bench.missions.custody.handing_over
    assert bench.actions.finished(1.1) == []
    assert bench.actions.under_way == ()


def test_mail_handed_over_in_the_moment_its_plan_is_dropped_is_in_custody_all_the_same(bench: Bench) -> None:
    bench.missions.give(MISSION)
    id_ = bench.ask("wait_handover(load,o1,s1,600)")
    bench.body.end("wait_handover", Done(shown=ShownCode("ab" * 32, b"key")))
    bench.actions.cancel([id_])
    assert bench.actions.finished(1.0) == [], "the agent does not hear of it"
    assert bench.missions.held.cargo == ("o1",)


def test_a_step_of_a_mission_that_was_taken_back_fails_by_name(bench: Bench) -> None:
    for step in ("report(departed,s1)", "finish_stop(s1)", "wait_handover(load,o1,s1,600)"):
        assert bench.result(step) == "no_such_stop"


def test_nobody_coming_changes_no_custody(bench: Bench) -> None:
    bench.missions.give(MISSION)
    id_ = bench.ask("wait_handover(load,o1,s1,600)")
    bench.body.end("wait_handover", Failed("no_one_came"))
    assert bench.actions.finished(1.0) == [(id_, "no_one_came")]
    assert (bench.missions.held.cargo, bench.missions.held.next_stop) == ((), 0)


def test_a_report_is_told_once_however_often_it_is_made(bench: Bench) -> None:
    bench.missions.give(MISSION)
    for _ in range(3):
        assert bench.result("report(departed,s1)") is None
    assert len([text for text in bench.told() if '"departed"' in text]) == 1


def test_a_trouble_is_told_once_until_it_is_cleared(bench: Bench) -> None:
    for _ in range(2):
        bench.result("raise_fault(way_blocked,line_lost)")
    bench.result("clear_fault(way_blocked)")
    bench.result("clear_fault(way_blocked)")
    assert len(bench.told()) == 2


def test_a_program_that_drains_means_the_papers_turn(tmp_path: Path) -> None:
    store = Store(tmp_path / "robot.db")
    bench = Bench(store, PerceptMode.DRAIN)
    bench.ask("turn(left)")
    assert type(next(iter(bench.body.running.values()))).__name__ == "PaperTurn"
    assert bench.result("turn(behind)") == "wrong_arguments"
    store.close()


def test_every_action_says_what_it_does() -> None:
    assert [action.name for action in (*ACTIONS, *PAPER_ACTIONS) if not action.about] == []
