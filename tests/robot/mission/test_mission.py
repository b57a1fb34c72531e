"""The robot's obligations: told once, kept on the disk, answered by name."""

from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from typing import Any

import pytest

from protocol.parts import Leg, Part, Purpose, Stop, StopAction
from protocol.proofs import ShownCode
from protocol.to_robot import (
    Cancel,
    EmergencyStop,
    Grant,
    Mission,
    Pause,
    Recall,
    Resume,
    Revoke,
    Verifier,
    Verifiers,
)
from protocol.to_server import HandoverReceipt, Step
from robot.mission.memory import Incoming, Memory
from robot.mission.mission import MissionManager, NoSuchStop
from robot.mission.outbox import Outbox
from robot.mission.returns import is_own
from robot.mission.store import Store

NOW = datetime(2026, 1, 5, 9, tzinfo=UTC)
LOAD = Stop(id="s1", post="post1", action=StopAction.LOAD, order_id="o1")
RECEIVE = Stop(id="s2", post="post4", action=StopAction.RECEIVE, order_id="o1")
LETTER = Mission(id="m1", update=1, stops=(LOAD, RECEIVE))
TO_POST3, TO_POST4 = Leg(from_post="post2", to_post="post3"), Leg(from_post="post3", to_post="post4")


@dataclass
class FakeServer:
    """Hands over what a test puts in; what goes to the server waits in the outbox."""

    memory: Memory
    waiting: list[Incoming] = field(default_factory=list)

    def says(self, message: Part) -> None:
        if isinstance(message, Mission):
            self.memory.hold(message)
        if isinstance(message, Grant):
            self.memory.grant(message.legs)
        self.waiting.append(Incoming(message, "journal", len(self.waiting) + 1))

    def incoming(self) -> list[Incoming]:
        taken, self.waiting = self.waiting, []
        return taken

    def wake(self) -> None:
        pass

    online = True


@dataclass
class Desk:
    missions: MissionManager
    server: FakeServer

    def hears(self, message: Part) -> list[dict[str, Any]]:
        """Return what the robot has to say to this message."""
        before = len(self.told())
        self.server.says(message)
        self.missions.take_messages()
        return self.told()[before:]

    def told(self) -> list[dict[str, Any]]:
        messages = [kept.message for kept in self.missions.outbox.pending()]
        return [getattr(message, "happened", message).model_dump(mode="json") for message in messages]


@pytest.fixture
def desk(store: Store) -> Desk:
    server = FakeServer(Memory(store))
    return Desk(MissionManager(store, server.memory, Outbox(store), lambda: NOW, server), server)


def test_a_mission_is_accepted_once_however_often_it_comes(desk: Desk) -> None:
    assert [one["step"] for one in desk.hears(LETTER)] == ["accepted"]
    assert desk.hears(LETTER) == []
    assert desk.missions.held.stop == LOAD


def test_a_mission_that_goes_on_by_an_update_after_its_end_ends_once_more(desk: Desk) -> None:
    for update in (1, 2):
        desk.hears(LETTER.model_copy(update={"update": update}))
        for _ in range(2):
            desk.missions.finish_mission("m1", "post4")
    assert [(one["step"], one["update"]) for one in desk.told() if one["step"] == "done"] == [("done", 1), ("done", 2)]


def test_each_step_of_a_stop_is_told_once_and_each_post_passed_once(desk: Desk) -> None:
    desk.hears(LETTER)
    for _ in range(2):
        desk.missions.report(Step.DEPARTED, "s1", "post5")
        desk.missions.report(Step.PASSED, "s1", "post3")
        desk.missions.report(Step.PASSED, "s1", "post2")
    assert [(one["step"], one["post"]) for one in desk.told()[1:]] == [
        ("departed", "post5"),
        ("passed", "post3"),
        ("passed", "post2"),
    ]


def test_what_was_told_before_a_restart_is_not_told_again(desk: Desk, store: Store) -> None:
    desk.hears(LETTER)
    desk.missions.handed_over((LETTER, LOAD), Purpose.LOAD, "post1", shown("ab" * 32))
    again = MissionManager(store, Memory(store), Outbox(store), lambda: NOW)
    assert (again.held.cargo, again.held.stop) == (("o1",), RECEIVE)
    again.handed_over((LETTER, LOAD), Purpose.LOAD, "post1", shown("ab" * 32))
    again.report(Step.DEPARTED, "s2", "post1")
    assert [one["kind"] for one in desk.told()] == ["progress", "handover", "progress"]


def test_a_stop_that_nobody_knows_is_named(desk: Desk) -> None:
    desk.hears(LETTER)
    with pytest.raises(NoSuchStop, match="s9"):
        desk.missions.report(Step.ARRIVED, "s9", "post1")


def test_a_cancelled_order_is_answered_and_its_mission_gone(desk: Desk) -> None:
    desk.hears(LETTER)
    (answer,) = desk.hears(Cancel(command_id="c1", order_id="o1"))
    assert (answer["command_id"], answer["accepted"]) == ("c1", True)
    assert desk.missions.held.mission is None


def test_an_order_whose_mail_is_aboard_is_not_cancelled_and_says_why(desk: Desk) -> None:
    desk.hears(LETTER)
    desk.missions.handed_over((LETTER, LOAD), Purpose.LOAD, "post1", shown("ab" * 32))
    (answer,) = desk.hears(Cancel(command_id="c1", order_id="o1"))
    assert (answer["accepted"], answer["reason"]) == (False, "The mail is aboard.")
    assert desk.missions.held.stop == RECEIVE


def test_pause_resume_and_recall_are_each_answered(desk: Desk) -> None:
    desk.hears(LETTER)
    assert desk.hears(Pause(command_id="c1", reason="fire drill"))[0]["accepted"]
    assert desk.missions.held.paused
    assert desk.hears(Resume(command_id="c2"))[0]["accepted"]
    assert not desk.missions.held.paused
    assert desk.hears(Recall(command_id="c3", reason="service"))[0]["accepted"]
    assert desk.missions.held.mission is None


def test_a_fault_is_told_when_it_begins_and_when_it_ends(desk: Desk) -> None:
    for cleared in (False, False, True, True):
        desk.missions.report_fault("bump", "Something stands in the way.", "post3", cleared)
    assert [one["cleared"] for one in desk.told()] == [False, True]


def again_of(store: Store) -> MissionManager:
    """The same robot after a power cut."""
    return MissionManager(store, Memory(store), Outbox(store), lambda: NOW)


def test_a_paused_robot_is_paused_after_a_restart(desk: Desk, store: Store) -> None:
    desk.hears(Pause(command_id="c1", reason="fire drill"))
    assert again_of(store).held.paused
    desk.hears(Resume(command_id="c2"))
    assert not again_of(store).held.paused


def test_an_order_that_was_cancelled_is_not_served_after_a_restart(desk: Desk, store: Store) -> None:
    other = Stop(id="s3", post="post2", action=StopAction.LOAD, order_id="o2")
    desk.hears(Mission(id="m1", update=1, stops=(LOAD, RECEIVE, other)))
    desk.hears(Cancel(command_id="c1", order_id="o1"))
    assert again_of(store).held.cancelled == {"o1"}
    desk.missions.finish_mission("m1", "post2")
    assert again_of(store).held.cancelled == frozenset()


def test_an_order_that_was_dropped_and_is_given_again_is_served(desk: Desk) -> None:
    other = Stop(id="s3", post="post2", action=StopAction.LOAD, order_id="o2")
    desk.hears(Mission(id="m1", update=1, stops=(LOAD, RECEIVE, other)))
    desk.hears(Cancel(command_id="c1", order_id="o1"))
    desk.hears(Mission(id="m1", update=2, stops=(other,)))
    assert desk.missions.held.cancelled == {"o1"}
    again = LOAD.model_copy(update={"id": "s4"})
    desk.hears(Mission(id="m1", update=3, stops=(other, again)))
    assert desk.missions.held.cancelled == frozenset()


def test_a_fault_that_was_told_is_known_after_a_restart_and_told_to_be_over_once(desk: Desk, store: Store) -> None:
    desk.missions.report_fault("way_blocked", "The robot met a problem: line_lost.", "post3")
    again = again_of(store)
    again.report_fault("way_blocked", "The robot met a problem: line_lost.", "post3")
    again.report_fault("way_blocked", "It is over.", "post3", cleared=True)
    assert [one["cleared"] for one in desk.told()] == [False, True]


def shown(sha256: str) -> ShownCode:
    return ShownCode(sha256, b"key")


def verifier(purpose: Purpose, text: str, expires_at: datetime = NOW + timedelta(hours=1)) -> Verifier:
    return Verifier(order_id="o1", purpose=purpose, sha256=text * 64, expires_at=expires_at)


def test_only_the_code_of_this_order_and_purpose_that_has_not_expired_opens(desk: Desk) -> None:
    desk.missions.memory.keep_verifiers(
        Verifiers(verifiers=(verifier(Purpose.LOAD, "a", NOW), verifier(Purpose.RECEIVE, "b"))), NOW
    )
    desk.hears(LETTER)
    assert desk.missions.codes("o1", Purpose.LOAD) == (), "it has just expired"
    assert desk.missions.codes("o1", Purpose.RECEIVE) == ("b" * 64,)
    assert desk.missions.codes("o2", Purpose.RECEIVE) == (), "another order"


def test_a_code_opens_once(desk: Desk) -> None:
    desk.missions.memory.keep_verifiers(
        Verifiers(verifiers=(verifier(Purpose.LOAD, "a"), verifier(Purpose.RECEIVE, "b"))), NOW
    )
    desk.hears(LETTER)
    desk.missions.handed_over((LETTER, LOAD), Purpose.LOAD, "post1", shown("a" * 64))
    assert desk.missions.codes("o1", Purpose.LOAD) == ()
    assert desk.missions.codes("o1", Purpose.RECEIVE) == ("b" * 64,)
    desk.missions.handed_over((LETTER, RECEIVE), Purpose.RECEIVE, "post4", shown("b" * 64))
    assert desk.missions.codes("o1", Purpose.RECEIVE) == ()


def test_mail_that_came_aboard_is_aboard_though_the_order_is_cancelled_in_that_moment(desk: Desk) -> None:
    desk.hears(LETTER)
    desk.hears(Cancel(command_id="c1", order_id="o1"))
    desk.missions.handed_over((LETTER, LOAD), Purpose.LOAD, "post1", shown("a" * 64))
    assert desk.missions.held.cargo == ("o1",)
    assert [one["kind"] for one in desk.told()[-2:]] == ["handover", "progress"], "and is brought back"


def with_mail(desk: Desk, code: str | None = "a" * 64) -> None:
    """The letter is aboard, and post4 is next."""
    desk.missions.memory.keep_verifiers(Verifiers(verifiers=(verifier(Purpose.RECEIVE, "b"),)), NOW)
    desk.hears(LETTER)
    desk.missions.handed_over((LETTER, LOAD), Purpose.LOAD, "post1", code and shown(code))


def way_back(desk: Desk) -> tuple[Mission, Stop]:
    mission = desk.missions.held.mission
    assert mission is not None
    assert is_own(mission)
    return mission, mission.stops[0]


def test_a_recalled_robot_brings_its_mail_back_to_where_it_was_loaded(desk: Desk, store: Store) -> None:
    with_mail(desk)
    (accepted, answer) = desk.hears(Recall(command_id="c1", reason="closing early"))
    assert (answer["accepted"], accepted["step"]) == (True, "accepted")
    mission, stop = way_back(desk)
    assert (stop.post, stop.action, stop.order_id) == ("post1", "return", "o1")
    assert again_of(store).held.mission == mission, "a power cut changes nothing"


def test_mail_that_nobody_took_is_brought_back_when_the_mission_is_done(desk: Desk) -> None:
    with_mail(desk)
    desk.missions.report(Step.GAVE_UP, "s2", "post4", "no_one_came")
    desk.missions.finish_stop("s2")
    desk.missions.finish_mission("m1", "post4")
    assert way_back(desk)[1].post == "post1"
    assert [one.get("step") for one in desk.told()[-2:]] == ["done", "accepted"]


def test_the_mailroom_takes_back_what_nobody_took(store: Store) -> None:
    server = FakeServer(Memory(store))
    desk = Desk(MissionManager(store, server.memory, Outbox(store), lambda: NOW, server, mailroom="post3"), server)
    with_mail(desk)
    desk.hears(Recall(command_id="c1", reason="closing early"))
    assert way_back(desk)[1].post == "post3"


def test_on_the_way_back_the_code_that_loaded_it_opens_and_so_does_the_recipients(desk: Desk) -> None:
    with_mail(desk)
    assert desk.missions.codes("o1", Purpose.RECEIVE) == ("b" * 64,), "to its recipient, the sender's code is none"
    assert set(desk.missions.codes("o1", Purpose.RETURN)) == {"a" * 64, "b" * 64}
    desk.hears(Recall(command_id="c1", reason="closing early"))
    place = way_back(desk)
    desk.missions.handed_over(place, Purpose.RETURN, "post1", shown("a" * 64))
    assert (desk.missions.held.cargo, desk.missions.codes("o1", Purpose.RETURN)) == ((), ())
    assert desk.told()[-1] | {"happened_at": ""} == {
        "kind": "handover",
        "purpose": "return",
        "order_id": "o1",
        "stop_id": "return-o1",
        "post": "post1",
        "happened_at": "",
        "code_sha256": "a" * 64,
        "how": "code",
        "command_id": None,
        "mission_id": place[0].id,
        "number": 2,
        "proof": HandoverReceipt.model_validate(desk.told()[-1]).proved_with(b"key"),
        "signature": None,
    }


def test_mail_loaded_by_a_button_is_given_back_only_for_a_code(desk: Desk) -> None:
    with_mail(desk, code=None)
    assert desk.missions.codes("o1", Purpose.RETURN) == ("b" * 64,)


def test_mail_that_is_not_taken_back_either_is_told_once_and_the_robot_is_free(desk: Desk) -> None:
    with_mail(desk)
    for command_id in ("c1", "c2"):
        desk.hears(Recall(command_id=command_id, reason="closing early"))
        mission, _stop = way_back(desk)
        desk.missions.finish_mission(mission.id, "post1")
    assert (desk.missions.held.mission, desk.missions.held.cargo) == (None, ("o1",))
    (fault,) = [one for one in desk.told() if one["kind"] == "fault"]
    assert (fault["name"], "o1" in fault["reason"]) == ("mail_aboard", True)
    desk.hears(Recall(command_id="c3", reason="a person waits now"))
    desk.missions.handed_over(way_back(desk), Purpose.RETURN, "post1", shown("a" * 64))
    assert [one["cleared"] for one in desk.told() if one["kind"] == "fault"] == [False, True]


def test_a_new_mission_comes_before_the_way_back_which_is_taken_up_again_after_it(desk: Desk) -> None:
    with_mail(desk)
    desk.hears(Recall(command_id="c1", reason="closing early"))
    other = Mission(id="m2", update=1, stops=(Stop(id="s9", post="post3", action=StopAction.LOAD, order_id="o9"),))
    desk.hears(other)
    assert desk.missions.held.mission == other
    desk.missions.finish_mission("m2", "post3")
    assert way_back(desk)[1].order_id == "o1"


def test_charging_is_told_once_a_step_and_remembered_through_a_power_cut(desk: Desk, store: Store) -> None:
    for step in ("low", "low", "charging"):
        desk.missions.report_charge(step, "post5", 0.2)
    again = again_of(store)
    assert again.held.recharging
    for step in ("charging", "charged", "charged"):
        again.report_charge(step, "post5", 0.99)
    assert [one["step"] for one in desk.told()] == ["low", "charging", "charged"]
    assert not again_of(store).held.recharging


def test_an_emergency_stop_is_answered_and_passed_on_and_resume_takes_it_back(desk: Desk) -> None:
    (answer,) = desk.hears(EmergencyStop(command_id="c1", reason="a child plays there"))
    assert (answer["command_id"], answer["accepted"], desk.missions.stop_asked) == ("c1", True, True)
    desk.hears(Resume(command_id="c2"))
    assert (desk.missions.stop_asked, desk.missions.rearm_asked) == (False, True)


def test_what_was_granted_is_void_once_and_for_all_when_others_have_got_it(desk: Desk, store: Store) -> None:
    desk.missions.seen("post1")
    first = desk.missions.claims.ask((TO_POST3, TO_POST4)) or ""
    desk.hears(Grant(claim_id=first, legs=(TO_POST3, TO_POST4)))
    revoke = Revoke(command_id="v1", reason="carried into the workshop")
    desk.missions.occupancy.report("bay", "post4_bay1", None, "marker")
    fault, answer = desk.hears(revoke)
    assert (fault["name"], answer["command_id"], answer["accepted"]) == ("revoked", "v1", True)
    assert (desk.missions.stop_asked, desk.missions.forget_place_asked) == (True, True)
    again = again_of(store)
    assert (again.held.revoked, again.held.grants, again.held.position.post) == (True, (), None), "after a restart, too"
    assert again.occupancy.report("bay", "post4_bay1", None, "marker"), "wherever it stands is news"
    second = desk.missions.claims.ask((TO_POST3,)) or ""
    desk.hears(Grant(claim_id=second, legs=(TO_POST3,)))
    assert desk.hears(revoke) == [], "the same one again"
    assert desk.missions.held.grants == (TO_POST3,)


def test_without_a_server_nobody_is_missed(store: Store) -> None:
    assert MissionManager(store, Memory(store), Outbox(store), lambda: NOW).online


def test_the_button_stands_for_an_order_only_where_no_other_is_to_be_loaded(desk: Desk) -> None:
    other = Stop(id="s3", post="post1", action=StopAction.LOAD, order_id="o2")
    elsewhere = Stop(id="s4", post="post3", action=StopAction.LOAD, order_id="o3")
    desk.hears(Mission(id="m1", update=1, stops=(LOAD, elsewhere, other)))
    assert not desk.missions.loads_nothing_else("o1", "post1")
    assert desk.missions.loads_nothing_else("o3", "post3")
    desk.hears(Cancel(command_id="c1", order_id="o2"))
    assert desk.missions.loads_nothing_else("o1", "post1"), "its sender has taken it back"


def test_of_two_senders_at_one_post_the_button_is_the_second_ones(desk: Desk) -> None:
    desk.hears(Mission(id="m1", update=1, stops=(LOAD, LOAD.model_copy(update={"id": "s3", "order_id": "o2"}))))
    desk.missions.finish_stop("s1")
    assert desk.missions.loads_nothing_else("o2", "post1")
