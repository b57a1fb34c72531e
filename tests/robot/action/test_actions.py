"""Actions: what a program asks for is begun, refused by name, ended or cancelled; nothing vanishes."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path

import pytest

from bdi import parse_term
from maps import builtin_map
from protocol.envelope import Envelope
from protocol.parts import Leg, Stop, StopAction
from protocol.proofs import ShownCode
from protocol.to_robot import Detour, Mission
from robot.action.actions import Actions, table_for
from robot.action.hands import Hands
from robot.action.table import ACTIONS, PAPER_ACTIONS, STANDS_FOR_HANDS_S
from robot.config import PerceptMode
from robot.duties import Duties
from robot.memory import Incoming, Memory
from robot.navigator import Navigator
from robot.outbox import Outbox
from robot.skills.interfaces import Done, Failed
from robot.store import Store
from tests.robot.fake_body import FakeBody

NOW = datetime(2026, 1, 5, 9, tzinfo=UTC)
MISSION = Mission(
    id="m1",
    update=1,
    stops=(
        Stop(id="s1", post="post1", action=StopAction.LOAD, order_id="o1"),
        Stop(id="s2", post="post4", action=StopAction.RECEIVE, order_id="o1"),
    ),
)


TO_POST1 = Leg(from_post="post2", to_post="post1")
TO_POST3, TO_POST4 = Leg(from_post="post2", to_post="post3"), Leg(from_post="post3", to_post="post4")


class SilentServer:
    """It grants nothing, and is never asked for anything else here."""

    online = False

    def incoming(self) -> list[Incoming]:
        return []

    def wake(self) -> None:
        pass


@dataclass
class Bench:
    """Actions over a fake body, with real duties in a file."""

    store: Store
    mode: PerceptMode = PerceptMode.LATEST
    body: FakeBody = field(default_factory=FakeBody)
    noted: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.duties = Duties(self.store, Memory(self.store), Outbox(self.store), lambda: NOW)
        self.navigator = Navigator(builtin_map("test_track"), "post5", self.duties, now=0.0)
        self.hands = Hands(self.body, self.navigator, self.duties, noted=self.noted.append)
        self.actions = Actions(self.hands, table_for(self.mode))
        self._next = 0

    def ask(self, text: str, now: float = 0.0) -> int:
        self._next += 1
        self.actions.begin(self._next, parse_term(text), now)
        return self._next

    def result(self, text: str, now: float = 0.0) -> str | None:
        """Why it failed at once; None for done."""
        id_ = self.ask(text, now)
        return dict(self.actions.finished(now))[id_]

    def told(self) -> list[str]:
        return [kept.message.model_dump_json() for kept in self.duties.outbox.pending()]


@pytest.fixture
def bench(tmp_path: Path) -> Iterator[Bench]:
    store = Store(tmp_path / "robot.db")
    yield Bench(store)
    store.close()


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


def test_a_way_that_is_closed_for_now_is_told_from_one_that_is_not_there(bench: Bench) -> None:
    bench.navigator.place("post1", "post2")
    bench.duties.claims.avoid = frozenset({TO_POST3})
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
    assert bench.duties.held.grants == (TO_POST3, TO_POST4)
    bench.result("reopen")
    assert bench.result("claim(post4)") is None, "it may go in again with nobody to ask"


def test_while_another_robot_is_in_its_way_it_lets_go_of_everything(bench: Bench) -> None:
    with_server(bench, TO_POST3, TO_POST4)
    bench.duties.claims.avoid = frozenset({TO_POST3})
    assert bench.result("claim(post4)") == "way_closed"
    assert bench.duties.held.grants == ()


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


def with_server(bench: Bench, *granted: Leg) -> None:
    bench.duties.join(SilentServer())
    bench.duties.memory.grant(granted)
    bench.duties.seen("post2")
    bench.navigator.place("post2", "post3")


def test_the_first_corridor_is_enough_to_go_on_and_the_rest_is_waited_for_at_the_next_post(bench: Bench) -> None:
    with_server(bench, TO_POST3)
    id_ = bench.ask("claim(post4)")
    assert bench.actions.finished(0.0) == [(id_, None)]
    assert '"post4"' in bench.told()[-1], "it asks for all of it"


def test_a_detour_gives_back_what_it_does_not_need_and_keeps_what_it_does(bench: Bench) -> None:
    with_server(bench, TO_POST3, TO_POST4)
    assert bench.result("claim(post5)") is None
    assert bench.duties.held.grants == (TO_POST3,)


def test_a_corridor_to_which_it_comes_only_later_is_given_back_though_it_is_on_the_way_home(bench: Bench) -> None:
    with_server(bench, TO_POST3)
    bench.ask("claim(post1)")
    claimed = next(told for told in bench.told() if '"goal":"post1"' in told)
    assert '{"from_post":"post2","to_post":"post3"}' in claimed, "it asks for the way back to its dock as well"
    assert bench.duties.held.grants == ()


def test_a_corridor_that_it_has_been_through_is_given_back_though_it_comes_there_again(bench: Bench) -> None:
    with_server(bench, Leg(from_post="post1", to_post="post2"))
    bench.ask("claim(post1)")
    assert bench.duties.held.grants == ()


def test_a_claim_that_is_answered_by_a_way_aside_ends_and_what_was_granted_with_it_is_kept(bench: Bench) -> None:
    with_server(bench)
    waiting = bench.ask("claim(post4)")
    assert bench.actions.finished(0.0) == [], "it waits at its post"
    sent(bench, TO_POST1)
    assert bench.actions.finished(0.1) == [(waiting, None)]
    assert bench.result("claim(post4)") is None, "asked again it is sent there again, and claims nothing meanwhile"
    assert bench.duties.held.grants == (TO_POST1,)
    assert [told for told in bench.told() if '"goal"' in told] == [bench.told()[0]]
    bench.navigator.place("post1", "post2")
    bench.ask("claim(post4)")
    assert bench.duties.held.grants == () and '"goal":"post4"' in bench.told()[-1], "from there it goes its own way"


def test_it_is_not_sent_into_a_corridor_in_which_it_has_turned_back(bench: Bench) -> None:
    with_server(bench)
    bench.navigator.closed.close(TO_POST1, now=0.0)
    sent(bench, TO_POST1)
    bench.ask("claim(post4)")
    assert bench.actions.finished(0.0) == []
    assert bench.duties.held.grants == (), "it gives back what was granted with it"


def sent(bench: Bench, leg: Leg) -> None:
    """The service has answered with another corridor than the one asked for."""
    detour = Detour(claim_id="c", legs=(leg,), reason="Robot r2 has to pass.")
    bench.duties.memory.resume("j", 1)
    bench.duties.memory.receive(Envelope(type="detour", robot="r1", journal="j", seq=1, at=NOW, body=detour))
    bench.duties.seen("post2")


def test_the_corridor_that_it_is_in_is_never_given_back(bench: Bench) -> None:
    with_server(bench, TO_POST3, TO_POST4)
    bench.navigator.leave()
    assert bench.result("release") is None
    assert bench.duties.held.grants == (TO_POST3,)


def test_mail_is_written_down_before_the_tune_promises_it(bench: Bench) -> None:
    bench.duties.give(MISSION)
    bench.ask("wait_handover(load,o1,s1,600)")
    bench.body.end("wait_handover", Done(shown=ShownCode("ab" * 32, b"key")))
    assert "say" not in bench.body.started
    bench.body.at_start = lambda skill: cargo.append((skill.name, bench.duties.held.cargo))
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
    bench.duties.give(MISSION)
    bench.navigator.place("post1", "post2")
    id_ = bench.ask("wait_handover(load,o1,s1,600)")
    bench.body.end("wait_handover", Done(shown=ShownCode("ab" * 32, b"key")))
    assert bench.actions.finished(1.0) == []
    assert (bench.duties.held.cargo, bench.duties.held.next_stop) == (("o1",), 1)
    assert [text for text in bench.told() if '"handover"' in text and "ab" * 32 in text]
    assert bench.duties.custody.handing_over
    assert bench.actions.finished(1.0 + STANDS_FOR_HANDS_S - 0.1) == [], "a hand may be in the box"
    assert bench.actions.finished(1.0 + STANDS_FOR_HANDS_S) == [(id_, None)]
    assert not bench.duties.custody.handing_over


def test_a_dropped_plan_does_not_wait_for_hands(bench: Bench) -> None:
    bench.duties.give(MISSION)
    id_ = bench.ask("wait_handover(load,o1,s1,600)")
    bench.body.end("wait_handover", Done(shown=ShownCode("ab" * 32, b"key")))
    bench.actions.finished(1.0)
    bench.actions.cancel([id_])
    assert not bench.duties.custody.handing_over
    assert bench.actions.finished(1.1) == []
    assert bench.actions.under_way == ()


def test_mail_handed_over_in_the_moment_its_plan_is_dropped_is_in_custody_all_the_same(bench: Bench) -> None:
    bench.duties.give(MISSION)
    id_ = bench.ask("wait_handover(load,o1,s1,600)")
    bench.body.end("wait_handover", Done(shown=ShownCode("ab" * 32, b"key")))
    bench.actions.cancel([id_])
    assert bench.actions.finished(1.0) == [], "the agent does not hear of it"
    assert bench.duties.held.cargo == ("o1",)


def test_a_step_of_a_mission_that_was_taken_back_fails_by_name(bench: Bench) -> None:
    for step in ("report(departed,s1)", "finish_stop(s1)", "wait_handover(load,o1,s1,600)"):
        assert bench.result(step) == "no_such_stop"


def test_nobody_coming_changes_no_custody(bench: Bench) -> None:
    bench.duties.give(MISSION)
    id_ = bench.ask("wait_handover(load,o1,s1,600)")
    bench.body.end("wait_handover", Failed("no_one_came"))
    assert bench.actions.finished(1.0) == [(id_, "no_one_came")]
    assert (bench.duties.held.cargo, bench.duties.held.next_stop) == ((), 0)


def test_a_report_is_told_once_however_often_it_is_made(bench: Bench) -> None:
    bench.duties.give(MISSION)
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
