"""Custody is confirmed by what only the shown code gives, and never by what any robot could have made up."""

from datetime import timedelta
from hashlib import sha256
from typing import Any

import pytest

from app.models import Alarm, Handover, Notification, RefusedReceipt, RobotRow, Role
from app.robots.service import new_token
from protocol.clock import SteppedClock
from protocol.envelope import YOUNGER
from protocol.parts import Activity, Battery, Position, Stop
from protocol.proofs import ShownCode
from protocol.to_robot import Confirm, Mission
from protocol.to_server import CommandAnswer, Event, HandoverReceipt, Snapshot, Step
from tests.app.handover.conftest import Campus
from tests.app.handover.test_receipts import give_key, signed

CLAIMED = "handover_claimed"


async def code_of(campus: Campus, who: str) -> str:
    """The QR code as its page shows it."""
    return str((await (await campus.browser(who)).get(f"{campus.path}/code")).json()["text"])


async def begin(campus: Campus, understands: tuple[str, ...] = YOUNGER) -> None:
    """A robot with a key waits for the sender."""
    await campus.connect(understands=understands)
    await give_key(campus)
    campus.mission = await campus.robot.mission()
    await campus.robot.ends(await campus.robot.report(campus.mission, Step.ARRIVED, campus.load))


async def load(campus: Campus) -> None:
    """The sender shows their code."""
    assert campus.mission
    told = campus.robot.proved_receipt(campus.mission, campus.load, await code_of(campus, "sender"))
    await campus.robot.ends(await campus.robot.say(signed(told)))


async def arrive(campus: Campus) -> None:
    assert campus.mission
    await campus.robot.ends(await campus.robot.report(campus.mission, Step.ARRIVED, campus.receive))


def made_up(campus: Campus, stop: Stop, **facts: Any) -> Event:
    """Make up what a stolen robot can report: it has its messages, and its key."""
    assert campus.mission
    receipt = campus.robot.receipt(stop, mission_id=campus.mission.id, number=9, **facts)
    return signed(receipt)


def changed(event: Event, **facts: Any) -> Event:
    assert isinstance(event.happened, HandoverReceipt)
    return signed(Event(happened=event.happened.model_copy(update={**facts, "signature": None})))


async def links(campus: Campus, who: str = "sender") -> list[dict[str, Any]]:
    custody: list[dict[str, Any]] = (await (await campus.browser(who)).get(campus.path)).json()["custody"]
    return custody


async def told(campus: Campus) -> set[str]:
    return {str(one.kind) for one in await campus.service.rows(Notification, order_id=campus.order_id)}


async def is_claimed(campus: Campus, problem: str) -> None:
    """No person is notified of receiving it; the robot answers for it, and a person is called."""
    assert await campus.state() == "attention"
    assert "delivered" not in await told(campus)
    *chain, claim = await links(campus)
    assert [(one["holder"], one["evidence"], one["to"]) for one in chain[1:]] == [("robot", "proof", None)]
    assert (claim["holder"], claim["evidence"], claim["confirmed_by"]) == ("recipient", "claimed", None)
    written = (await campus.service.rows(Handover, order_id=campus.order_id))[-1]
    assert (written.problem, written.person_id, written.settled) == (problem, None, None)
    alarm = await campus.service.row(Alarm, name=CLAIMED)
    assert (campus.order_id in alarm.reason, alarm.cleared_at) == (True, None)


async def test_an_honest_robot_that_has_read_both_codes_is_confirmed(campus: Campus) -> None:
    await begin(campus)
    await load(campus)
    await arrive(campus)
    assert campus.mission
    receipt = campus.robot.proved_receipt(campus.mission, campus.receive, await code_of(campus, "recipient"))
    await campus.robot.ends(await campus.robot.say(signed(receipt)))
    assert await campus.state() == "delivered"
    assert [(one["holder"], one["evidence"]) for one in (await links(campus))[1:]] == [
        ("robot", "proof"),
        ("recipient", "proof"),
    ]
    assert await campus.service.rows(Alarm, name=CLAIMED) == []


LIES: dict[str, Any] = {
    "no_proof": lambda campus, shown: {},
    "wrong_proof, made of the verifier": lambda campus, shown: {
        "proof": made_up(campus, campus.receive).happened.proved_with(  # type: ignore[union-attr]
            bytes.fromhex(campus.robot.codes(campus.receive)[0])
        )
    },
    "wrong_proof, that of the loading": lambda campus, shown: {"proof": shown.proof},
}


@pytest.mark.parametrize("lie", LIES)
@pytest.mark.slow
async def test_a_stolen_robot_that_has_all_but_the_code_confirms_nothing(campus: Campus, lie: str) -> None:
    await begin(campus)
    await load(campus)
    shown = (await campus.service.row(Handover, order_id=campus.order_id)).evidence
    assert shown == "proof"
    await arrive(campus)
    receipt = campus.robot.proved_receipt(campus.mission, campus.load, await code_of(campus, "recipient")).happened  # type: ignore[arg-type]
    await campus.robot.ends(
        await campus.robot.say(made_up(campus, campus.receive, how="code", **LIES[lie](campus, receipt)))
    )
    await is_claimed(campus, lie.partition(",")[0])
    await campus.robot.ends(await campus.robot.report(campus.mission, Step.DONE, campus.receive))  # type: ignore[arg-type]
    await campus.robot.ends(await campus.robot.report(campus.mission, Step.ARRIVED, campus.receive))  # type: ignore[arg-type]
    await is_claimed(campus, lie.partition(",")[0])


@pytest.mark.parametrize("what", ["happened_at", "number", "mission_id", "post"])
@pytest.mark.slow
async def test_a_proof_is_of_one_hand_over_alone(campus: Campus, what: str) -> None:
    await begin(campus)
    await load(campus)
    await arrive(campus)
    assert campus.mission
    honest = campus.robot.proved_receipt(campus.mission, campus.receive, await code_of(campus, "recipient"))
    other = {
        "happened_at": campus.robot.clock.utc() + timedelta(seconds=1),
        "number": 77,
        "mission_id": "another",
        "post": "post3",
    }
    await campus.robot.ends(await campus.robot.say(changed(honest, **{what: other[what]})))
    await is_claimed(campus, "wrong_proof")


async def test_a_robot_that_calls_the_codes_verifier_the_button_confirms_nothing(campus: Campus) -> None:
    await begin(campus)
    await load(campus)
    await arrive(campus)
    await campus.robot.ends(await campus.robot.say(made_up(campus, campus.receive, how="button")))
    await is_claimed(campus, "no_proof")


async def test_a_request_that_the_robot_refused_opens_nothing_later(campus: Campus) -> None:
    await begin(campus)
    sender = await campus.browser("sender")
    await sender.post(f"{campus.path}/handover", json={})
    wish = (await campus.robot.hear("confirm")).body
    assert isinstance(wish, Confirm)
    no = CommandAnswer(
        command_id=wish.command_id, accepted=False, happened_at=campus.robot.clock.utc(), reason="It does not wait."
    )
    await campus.robot.ends(await campus.robot.say(Event(happened=no)))
    late = made_up(campus, campus.load, how="tap", code_sha256=wish.by, command_id=wish.command_id)
    await campus.robot.ends(await campus.robot.say(late))
    assert await campus.state() == "at_sender"
    assert (await campus.service.row(RefusedReceipt, order_id=campus.order_id)).problem == "used_command"


async def test_a_load_that_is_only_claimed_goes_on_quietly_and_is_settled_by_a_proved_delivery(campus: Campus) -> None:
    await begin(campus)
    await campus.robot.ends(await campus.robot.say(made_up(campus, campus.load, how="code")))
    assert await campus.state() == "carrying"
    assert "on_its_way" not in await told(campus), "the service does not know that it is"
    assert [(one["holder"], one["evidence"]) for one in await links(campus)][1:] == [("robot", "claimed")]
    assert (await campus.service.row(Alarm, name=CLAIMED)).cleared_at is None
    await arrive(campus)
    assert campus.mission
    receipt = campus.robot.proved_receipt(campus.mission, campus.receive, await code_of(campus, "recipient"))
    await campus.robot.ends(await campus.robot.say(signed(receipt)))
    assert await campus.state() == "delivered"
    assert [(one["holder"], one["evidence"]) for one in await links(campus)][1:] == [
        ("robot", "settled"),
        ("recipient", "proof"),
    ]
    assert (await campus.service.row(Alarm, name=CLAIMED)).cleared_at


async def test_an_older_robots_receipt_counts_and_is_marked_as_weaker(campus: Campus) -> None:
    await begin(campus, understands=("confirm",))
    await campus.robot.ends(await campus.robot.say(signed(campus.robot.receipt(campus.load))))
    await arrive(campus)
    await campus.robot.ends(await campus.robot.say(signed(campus.robot.receipt(campus.receive))))
    assert await campus.state() == "delivered"
    assert [one["evidence"] for one in await links(campus)] == [None, "digest", "digest"]


async def test_a_stolen_robot_cannot_pass_for_an_older_one(campus: Campus) -> None:
    await begin(campus)
    await load(campus)
    await arrive(campus)
    assert campus.robot.socket
    await campus.robot.socket.close()
    await campus.connect(understands=("confirm",), received=campus.robot.received)
    await campus.robot.ends(await campus.robot.say(signed(campus.robot.receipt(campus.receive))))
    await is_claimed(campus, "no_proof")


async def test_a_robot_that_is_enrolled_again_may_be_an_older_one(campus: Campus) -> None:
    await begin(campus)
    assert (await campus.service.row(RobotRow, name="r1")).proves_since
    async with campus.service.app.state.parts.database.transaction() as session:
        await new_token(session, campus.robot.clock, "r1")
    assert (await campus.service.row(RobotRow, name="r1")).proves_since is None


async def test_what_was_told_before_the_robot_knew_of_proofs_counts_as_before(
    campus: Campus, clock: SteppedClock
) -> None:
    await begin(campus, understands=("confirm",))
    before = signed(campus.robot.receipt(campus.load))
    clock.advance(60)
    assert campus.robot.socket
    await campus.robot.socket.close()
    await campus.connect(received=campus.robot.received, understands=YOUNGER)
    await campus.robot.ends(await campus.robot.say(before))
    assert [one.evidence for one in await campus.service.rows(Handover)] == ["digest"]


async def test_a_faulty_robot_two_corridors_away_is_not_believed_even_with_the_code(
    campus: Campus, clock: SteppedClock
) -> None:
    await begin(campus)
    await load(campus)
    assert campus.mission
    loaded_at = clock.utc()
    receipt = campus.robot.proved_receipt(campus.mission, campus.receive, await code_of(campus, "recipient")).happened
    assert isinstance(receipt, HandoverReceipt)
    too_soon = receipt.model_copy(update={"happened_at": loaded_at + timedelta(milliseconds=0.17)})
    key = ShownCode.of(await code_of(campus, "recipient")).key
    told_so = signed(Event(happened=too_soon.model_copy(update={"proof": too_soon.proved_with(key)})))
    await campus.robot.ends(await campus.robot.say(told_so))
    await is_claimed(campus, "too_fast")
    assert (await campus.service.row(Alarm, name=CLAIMED)).post == "post4"


@pytest.mark.slow
async def test_digits_never_reach_a_robot_nor_can_be_found_from_what_does(campus: Campus) -> None:
    await begin(campus)
    await load(campus)
    await arrive(campus)
    recipient = await campus.browser("recipient")
    digits = (await recipient.get(f"{campus.path}/code")).json()["digits"]
    await recipient.post(f"{campus.path}/handover", json={"digits": digits})
    await campus.robot.hear("confirm")
    heard = "".join(one.to_text() for one in campus.robot.heard)
    assert f'"{digits}"' not in heard
    codes = {bytes.fromhex(code) for code in campus.robot.codes(campus.receive)}
    assert codes
    for before in ("", "CM1:"):
        assert not any(sha256(b"%s%06d" % (before.encode(), one)).digest() in codes for one in range(10**6))


async def resolved(campus: Campus, to: str) -> int:
    desk = await campus.browser("desk", Role.DISPATCHER)
    return (await desk.post(f"{campus.path}/resolve", json={"to": to})).status_code


async def claim(campus: Campus) -> None:
    await begin(campus)
    await load(campus)
    await arrive(campus)
    await campus.robot.ends(await campus.robot.say(made_up(campus, campus.receive, how="code")))


async def test_a_robot_that_claims_and_then_says_otherwise_does_not_lead_the_order_on(campus: Campus) -> None:
    await claim(campus)
    own = Mission(id="return-1", update=1, stops=())
    back = campus.receive.model_copy(update={"id": f"return-{campus.order_id}", "post": "post1"})
    for step, stop in ((Step.ACCEPTED, None), (Step.DEPARTED, back), (Step.ARRIVED, back)):
        await campus.robot.ends(await campus.robot.report(own, step, stop))
    await is_claimed(campus, "no_proof")


async def test_a_robot_that_was_seen_elsewhere_a_moment_ago_is_not_believed(
    campus: Campus, clock: SteppedClock
) -> None:
    await begin(campus)
    await load(campus)
    await arrive(campus)
    clock.advance(60)
    seen = Snapshot(
        position=Position(post="post1", seen_at=clock.utc()), activity=Activity.DRIVING, battery=Battery(ratio=0.8)
    )
    await campus.robot.say(seen)
    clock.advance(0.5)
    assert campus.mission
    code = await code_of(campus, "recipient")
    campus.robot.handed_over_at = None
    await campus.robot.ends(
        await campus.robot.say(signed(campus.robot.proved_receipt(campus.mission, campus.receive, code)))
    )
    await is_claimed(campus, "too_fast")


async def test_a_dispatcher_who_has_asked_says_that_it_was_handed_over(campus: Campus) -> None:
    await claim(campus)
    assert await resolved(campus, "handed_over") == 200
    assert await campus.state() == "delivered"
    assert "delivered" in await told(campus)
    assert [(one["holder"], one["evidence"]) for one in await links(campus)][1:] == [
        ("robot", "proof"),
        ("recipient", "settled"),
    ]
    assert (await campus.service.row(Alarm, name=CLAIMED)).cleared_at


@pytest.mark.parametrize(("to", "state"), [("resume", "at_recipient"), ("returning", "returning"), ("held", "held")])
@pytest.mark.slow
async def test_a_dispatcher_who_finds_the_mail_in_the_robot_says_so(campus: Campus, to: str, state: str) -> None:
    await claim(campus)
    assert await resolved(campus, to) == 200
    assert await campus.state() == state
    assert (await campus.service.rows(Handover, order_id=campus.order_id))[1].settled == "false"
    assert "recipient" not in [one["holder"] for one in await links(campus)]
    assert (await campus.service.row(Alarm, name=CLAIMED)).cleared_at


async def test_mail_that_never_came_aboard_goes_back_into_the_queue(campus: Campus) -> None:
    await begin(campus)
    await campus.robot.ends(await campus.robot.say(made_up(campus, campus.load, how="code")))
    desk = await campus.browser("desk", Role.DISPATCHER)
    assert (await desk.post(f"{campus.path}/attention", json={"reason": "She has it."})).status_code == 200
    assert await resolved(campus, "queued") == 200
    assert [one["holder"] for one in await links(campus)] == ["sender"]
    assert (await campus.robot.hear("cancel")).body.order_id == campus.order_id  # type: ignore[attr-defined]


async def test_mail_that_never_came_aboard_did_not_come_out_either(campus: Campus) -> None:
    await begin(campus)
    await campus.robot.ends(await campus.robot.say(made_up(campus, campus.load, how="code")))
    await arrive(campus)
    await campus.robot.ends(await campus.robot.say(made_up(campus, campus.receive, how="code")))
    assert [one["evidence"] for one in await links(campus)][1:] == ["claimed", "claimed"]
    assert await resolved(campus, "queued") == 200
    assert [one["holder"] for one in await links(campus)] == ["sender"]
    assert [one.settled for one in await campus.service.rows(Handover)] == ["false", "false"]
    assert [one for one in await campus.service.rows(Alarm, name=CLAIMED) if one.cleared_at is None] == []


async def test_nothing_is_believed_that_no_robot_has_claimed(campus: Campus) -> None:
    await begin(campus)
    await load(campus)
    desk = await campus.browser("desk", Role.DISPATCHER)
    await desk.post(f"{campus.path}/attention", json={"reason": "It smokes."})
    assert await resolved(campus, "handed_over") == 409
    assert await campus.state() == "attention"
