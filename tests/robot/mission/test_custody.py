"""Mail changes hands because a person confirmed it in the app; and every receipt is signed."""

import base64
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import pytest
from cryptography.exceptions import InvalidSignature
from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PublicKey

from protocol.parts import Part, Purpose, Stop, StopAction
from protocol.proofs import ShownCode
from protocol.to_robot import Cancel, Confirm, Mission, Recall, Verifier, Verifiers
from protocol.to_server import HandoverReceipt, Step
from robot.core.config import ConfigError
from robot.mission.custody import Waiting
from robot.mission.memory import Incoming, Memory
from robot.mission.mission import MissionManager
from robot.mission.outbox import Outbox
from robot.mission.signatures import new_key, signer
from robot.mission.store import Store

NOW = datetime(2026, 1, 5, 9, tzinfo=UTC)
SOON = NOW + timedelta(minutes=1)
LOAD = Stop(id="s1", post="post1", action=StopAction.LOAD, order_id="o1")
RECEIVE = Stop(id="s2", post="post4", action=StopAction.RECEIVE, order_id="o1")
LETTER = Mission(id="m1", update=1, stops=(LOAD, RECEIVE))
SENDERS, DELEGATES, RECIPIENTS = ("a" * 64, "d" * 64, "b" * 64)


def tap(**changes: Any) -> Confirm:
    wish = {"command_id": "c1", "order_id": "o1", "purpose": Purpose.LOAD, "how": "tap", "by": SENDERS}
    return Confirm.model_validate({**wish, "expires_at": SOON, **changes})


def codes(*known: tuple[Purpose, str]) -> Verifiers:
    return Verifiers(verifiers=tuple(Verifier(order_id="o1", purpose=p, sha256=c, expires_at=SOON) for p, c in known))


@dataclass
class Desk:
    """A robot with a letter to load, played by its duties alone."""

    store: Store
    missions: MissionManager

    def hears(self, *messages: Part) -> list[dict[str, Any]]:
        before = len(self.told())
        self.missions.join(_Saying(messages))
        self.missions.take_messages()
        return self.told()[before:]

    def told(self) -> list[dict[str, Any]]:
        messages = [kept.message for kept in self.missions.outbox.pending()]
        return [getattr(message, "happened", message).model_dump(mode="json") for message in messages]

    def waits_at(self, stop: Stop = LOAD) -> Waiting:
        waiting = Waiting((LETTER, stop), Purpose(stop.action), stop.post)
        self.missions.custody.wait(waiting)
        return waiting


@dataclass
class _Saying:
    messages: tuple[Part, ...]
    online: bool = True

    def incoming(self) -> list[Incoming]:
        return [Incoming(message, "journal", None) for message in self.messages]

    def wake(self) -> None:
        pass


def started(store: Store) -> Desk:
    return Desk(store, MissionManager(store, Memory(store), Outbox(store), lambda: NOW))


@pytest.fixture
def desk(store: Store) -> Desk:
    desk = started(store)
    desk.missions.memory.keep_verifiers(
        codes((Purpose.LOAD, SENDERS), (Purpose.LOAD, DELEGATES), (Purpose.RECEIVE, RECIPIENTS)), NOW
    )
    desk.missions.give(LETTER)
    return desk


@pytest.mark.parametrize(("how", "by"), [("tap", SENDERS), ("digits", DELEGATES)])
def test_a_robot_that_waits_there_hands_over_and_its_receipt_says_how_and_why(desk: Desk, how: str, by: str) -> None:
    waiting = desk.waits_at()
    (receipt,) = desk.hears(tap(how=how, by=by))
    assert (receipt["kind"], receipt["how"], receipt["command_id"], receipt["code_sha256"]) == (
        "handover",
        how,
        "c1",
        by,
    )
    assert (desk.missions.held.cargo, desk.missions.held.stop, waiting.handed_over) == (("o1",), RECEIVE, True)
    assert desk.missions.codes("o1", Purpose.LOAD) == (), "used up, the delegate's too"
    assert desk.missions.codes("o1", Purpose.RECEIVE) == (RECIPIENTS,)


@pytest.mark.parametrize(
    ("wish", "reason"),
    [
        (tap(stop_id="s9"), "does not wait"),
        (tap(order_id="o2"), "does not wait"),
        (tap(purpose=Purpose.RECEIVE, by=RECIPIENTS), "does not wait"),
        (tap(expires_at=NOW), "too late"),
        (tap(by=RECIPIENTS), "opens nothing here"),
    ],
)
def test_what_does_not_fit_is_refused_with_a_reason(desk: Desk, wish: Confirm, reason: str) -> None:
    desk.waits_at()
    (answer,) = desk.hears(wish)
    assert (answer["kind"], answer["command_id"], answer["accepted"]) == ("answer", "c1", False)
    assert reason in answer["reason"]
    assert desk.missions.held.cargo == ()


def test_a_robot_that_has_left_or_was_started_anew_refuses(desk: Desk) -> None:
    desk.missions.custody.leave(desk.waits_at())
    (answer,) = desk.hears(tap())
    assert (answer["accepted"], "does not wait" in answer["reason"]) == (False, True)
    desk.waits_at()
    (answer,) = started(desk.store).hears(tap(command_id="c2"))
    assert (answer["accepted"], "does not wait" in answer["reason"]) == (False, True)


def test_a_command_that_comes_again_changes_nothing_through_a_restart(desk: Desk) -> None:
    desk.waits_at()
    desk.hears(tap())
    again = started(desk.store)
    again.waits_at(RECEIVE)
    assert again.hears(tap()) == []
    assert again.missions.held.cargo == ("o1",)


def test_verifiers_take_the_place_of_all_codes_of_the_orders_that_they_name(desk: Desk) -> None:
    memory = desk.missions.memory
    others = Verifier(order_id="o2", purpose=Purpose.LOAD, sha256="f" * 64, expires_at=SOON)
    memory.keep_verifiers(Verifiers(verifiers=(others,)), NOW)
    memory.keep_verifiers(codes((Purpose.LOAD, SENDERS)), NOW)
    assert {(one.order_id, one.sha256) for one in memory.verifiers()} == {("o1", SENDERS), ("o2", "f" * 64)}


def test_a_robot_with_a_key_signs_each_receipt_and_nobody_can_change_it(store: Store, tmp_path: Path) -> None:
    pem, public = new_key()
    (tmp_path / "r1.key").touch(mode=0o600)
    (tmp_path / "r1.key").write_text(pem)
    missions = MissionManager(store, Memory(store), Outbox(store), lambda: NOW, sign=signer(tmp_path / "r1.key", "r1"))
    missions.give(LETTER)
    missions.handed_over((LETTER, LOAD), Purpose.LOAD, "post1", ShownCode(SENDERS, b"key"))
    receipt: HandoverReceipt = missions.outbox.pending()[-1].message.happened  # type: ignore[attr-defined]
    key = Ed25519PublicKey.from_public_bytes(base64.b64decode(public))
    key.verify(base64.b64decode(receipt.signature or ""), receipt.signed_by("r1"))
    for signed in (receipt.signed_by("r2"), receipt.model_copy(update={"code_sha256": None}).signed_by("r1")):
        with pytest.raises(InvalidSignature):
            key.verify(base64.b64decode(receipt.signature or ""), signed)


def test_a_key_that_others_may_read_or_that_is_none_is_named(tmp_path: Path) -> None:
    path = tmp_path / "r1.key"
    with pytest.raises(ConfigError, match="key_file: cannot be read: No such file"):
        signer(path, "r1")
    path.touch(mode=0o600)
    with pytest.raises(ConfigError, match="it holds no key"):
        signer(path, "r1")
    path.write_text(new_key()[0])
    path.chmod(0o644)
    with pytest.raises(ConfigError, match="others may read it"):
        signer(path, "r1")


def test_mail_that_a_person_has_taken_out_by_hand_is_forgotten(desk: Desk) -> None:
    desk.missions.handed_over((LETTER, LOAD), Purpose.LOAD, "post1", ShownCode(SENDERS, b"key"))
    (refused,) = desk.hears(Cancel(command_id="c1", order_id="o1"))
    assert (refused["accepted"], desk.missions.held.cargo) == (False, ("o1",))
    (done,) = desk.hears(Cancel(command_id="c2", order_id="o1", by_hand=True))
    assert (done["accepted"], desk.missions.held.cargo, desk.missions.held.mission) == (True, (), None)


def test_mail_loaded_while_its_mission_was_dropped_is_given_back_where_it_stands(desk: Desk) -> None:
    desk.hears(Cancel(command_id="c1", order_id="o1"))
    desk.missions.handed_over((LETTER, LOAD), Purpose.LOAD, "post1", ShownCode(SENDERS, b"key"))
    mission = desk.missions.held.mission
    assert mission
    assert [(stop.action, stop.post, stop.order_id) for stop in mission.stops] == [(StopAction.RETURN, "post1", "o1")]
    assert desk.missions.codes("o1", Purpose.RETURN) == (SENDERS,)


def test_each_update_of_a_mission_is_accepted_once_and_each_report_says_which_it_was_of(desk: Desk) -> None:
    back = Stop(id="s3", post="post1", action=StopAction.RETURN, order_id="o1")
    for _ in range(2):
        desk.missions.give(LETTER.model_copy(update={"update": 2, "stops": (LOAD, back)}))
    desk.missions.report(Step.DEPARTED, "s1", "post5")
    assert [(one["step"], one["update"]) for one in desk.told()] == [("accepted", 1), ("accepted", 2), ("departed", 2)]


def test_a_mission_that_came_after_a_recall_is_held_though_both_are_taken_in_one_go(desk: Desk) -> None:
    later = LETTER.model_copy(update={"id": "m2"})
    desk.missions.memory.hold(later)  # as the link does when it comes
    desk.hears(Recall(command_id="c1", reason="closing early"), later)
    assert desk.missions.held.mission == later
    assert (desk.told()[-1]["step"], desk.told()[-1]["mission_id"]) == ("accepted", "m2")
