"""A receipt moves custody only if the robot that has the key wrote it, and for a code of that order."""

import base64
from collections.abc import Callable

import pytest
from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey

from app.models import Alarm, Handover, Order, RefusedReceipt, RobotRow
from protocol.to_server import Event, HandoverReceipt
from tests.app.handover.conftest import Campus

KEY = Ed25519PrivateKey.from_private_bytes(bytes(range(32)))
OTHER = Ed25519PrivateKey.from_private_bytes(bytes(32))


def signed(event: Event, key: Ed25519PrivateKey = KEY, robot: str = "r1") -> Event:
    receipt = event.happened
    assert isinstance(receipt, HandoverReceipt)
    signature = base64.b64encode(key.sign(receipt.signed_by(robot))).decode()
    return Event(happened=receipt.model_copy(update={"signature": signature}))


async def give_key(campus: Campus) -> None:
    async with campus.service.app.state.parts.database.transaction() as session:
        robot = await session.get(RobotRow, "r1")
        robot.public_key = base64.b64encode(KEY.public_key().public_bytes_raw()).decode()


async def test_a_signed_receipt_says_who_gave_the_mail_and_how(campus: Campus) -> None:
    await campus.waits_for_load()
    await give_key(campus)
    receipt = signed(campus.robot.receipt(campus.load))
    await campus.robot.ends(await campus.robot.say(receipt))
    order = await campus.service.row(Order, id=campus.order_id)
    written = await campus.service.row(Handover, order_id=campus.order_id)
    assert str(order.state) == "carrying"
    assert (written.holder, written.person_id, written.how) == ("sender", order.sender_id, "code")
    assert written.signature == receipt.happened.signature  # type: ignore[union-attr]
    link = (await (await campus.browser("sender")).get(campus.path)).json()["custody"][-1]
    assert (link["holder"], link["confirmed_by"], link["signed"]) == ("robot", "sender", True)


async def test_a_robot_without_a_key_is_believed_and_shown_as_unsigned(campus: Campus) -> None:
    await campus.waits_for_load()
    await campus.robot.ends(await campus.robot.say(signed(campus.robot.receipt(campus.load))))
    assert (await campus.service.row(Handover, order_id=campus.order_id)).signature is None
    link = (await (await campus.browser("sender")).get(campus.path)).json()["custody"][-1]
    assert (link["holder"], link["signed"]) == ("robot", False)
    assert await campus.state() == "carrying"


async def test_the_button_loads_and_identifies_no_person(campus: Campus) -> None:
    await campus.waits_for_load()
    await campus.robot.ends(await campus.robot.say(campus.robot.receipt(campus.load, code_sha256=None)))
    written = await campus.service.row(Handover, order_id=campus.order_id)
    assert (written.how, written.holder, written.person_id) == ("button", None, None)


def changed(event: Event, **facts: object) -> Event:
    return Event(happened=event.happened.model_copy(update=facts))


REFUSED: dict[str, Callable[[Event], Event]] = {
    "unsigned": lambda event: event,
    "bad_signature": lambda event: signed(event, OTHER),
    "bad_signature, of another robot": lambda event: signed(event, robot="r2"),
    "bad_signature, changed after": lambda event: changed(signed(event), post="post2"),
    "unknown_code": lambda event: signed(changed(event, code_sha256="a" * 64)),
    "unknown_command": lambda event: signed(changed(event, how="tap", command_id="confirm-made-up")),
}


@pytest.mark.parametrize("problem", REFUSED)
@pytest.mark.slow
async def test_what_proves_nothing_is_written_down_and_rings_and_moves_no_custody(campus: Campus, problem: str) -> None:
    await campus.waits_for_load()
    await give_key(campus)
    await campus.robot.ends(await campus.robot.say(REFUSED[problem](campus.robot.receipt(campus.load))))
    assert await campus.state() == "at_sender"
    assert await campus.service.rows(Handover) == []
    refused = await campus.service.row(RefusedReceipt, order_id=campus.order_id)
    assert refused.problem == problem.partition(",")[0]
    assert campus.order_id in (await campus.service.row(Alarm, name="receipt_refused")).reason


async def test_mail_is_not_received_without_a_code_nor_for_the_senders(campus: Campus) -> None:
    await campus.waits_for_recipient()
    sender_code = campus.robot.codes(campus.load)[0]
    for code in (None, sender_code):
        await campus.robot.ends(await campus.robot.say(campus.robot.receipt(campus.receive, code_sha256=code)))
    problems = [one.problem for one in await campus.service.rows(RefusedReceipt)]
    assert (problems, await campus.state()) == (["no_code", "unknown_code"], "at_recipient")
    await campus.robot.ends(await campus.robot.say(campus.robot.receipt(campus.receive)))
    assert await campus.state() == "delivered"
