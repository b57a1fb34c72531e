"""Handing over in the app: a wish that the robot's receipt makes true, or that is refused with a way out."""

import pytest

from app.core.settings import Settings
from app.models import Alarm, Handover, RobotCommand, Role
from app.orders.custody.codes import CONFIRM_LIFETIME_S
from protocol.clock import SteppedClock
from protocol.to_robot import Confirm
from protocol.to_server import CommandAnswer, Event, Step
from tests.app.handover.conftest import Campus
from tests.app.robots.playing import until


async def asked(campus: Campus) -> Confirm:
    confirm = (await campus.robot.hear("confirm")).body
    assert isinstance(confirm, Confirm)
    return confirm


async def test_a_tap_asks_the_robot_and_its_receipt_moves_custody(campus: Campus, settings: Settings) -> None:
    await campus.waits_for_load()
    sender = await campus.browser("sender")
    answer = await sender.post(f"{campus.path}/handover", json={})
    assert (answer.status_code, answer.json()["how"]) == (202, "tap")
    wish = await asked(campus)
    assert wish.by == campus.robot.codes(campus.load)[0]
    view = (await sender.get(campus.path)).json()
    assert view["handover_requested"]["how"] == "tap"
    assert (view["state"], view["my_code"]) == ("at_sender", "load"), "nothing has changed hands yet"
    again = await sender.post(f"{campus.path}/handover", json={})
    assert again.json() == answer.json(), "asked once, however often it is tapped"
    receipt = campus.robot.receipt(campus.load, code_sha256=wish.by, how="tap", command_id=wish.command_id)
    await campus.robot.ends(await campus.robot.say(receipt))
    view = (await sender.get(campus.path)).json()
    assert (view["state"], view["handover_requested"]) == ("carrying", None)
    written = await campus.service.row(Handover, order_id=campus.order_id)
    command = await campus.service.row(RobotCommand, kind="confirm")
    assert (written.how, written.holder, written.command_id) == ("tap", "sender", command.command_id)
    assert command.accepted


async def test_a_refused_tap_is_on_the_page_and_can_be_tried_again(campus: Campus) -> None:
    await campus.waits_for_load()
    sender = await campus.browser("sender")
    await sender.post(f"{campus.path}/handover", json={})
    wish = await asked(campus)
    now = campus.robot.clock.utc()
    refusal = CommandAnswer(command_id=wish.command_id, accepted=False, happened_at=now, reason="It does not wait.")
    await campus.robot.ends(await campus.robot.say(Event(happened=refusal)))
    view = (await sender.get(campus.path)).json()
    assert (view["state"], view["handover_requested"]) == ("at_sender", None)
    assert (view["events"][-1]["kind"], view["events"][-1]["reason"]) == ("confirm_refused", "It does not wait.")
    assert await campus.service.rows(Alarm, name="command_refused") == [], "no dispatcher has to look"
    assert (await sender.post(f"{campus.path}/handover", json={})).status_code == 202
    assert (await asked(campus)).command_id != wish.command_id


async def test_a_tap_that_was_not_answered_is_asked_again_when_it_is_too_old(
    campus: Campus, clock: SteppedClock, settings: Settings
) -> None:
    await campus.waits_for_load()
    sender = await campus.browser("sender")
    await sender.post(f"{campus.path}/handover", json={})
    first = await asked(campus)
    clock.advance(CONFIRM_LIFETIME_S)
    await sender.post(f"{campus.path}/handover", json={})
    assert (await asked(campus)).expires_at > first.expires_at


@pytest.mark.parametrize(
    ("who", "status", "code"),
    [("recipient", 409, "not_your_turn"), ("stranger", 404, "unknown_order"), ("dispatcher", 409, "not_your_turn")],
)
async def test_it_is_the_turn_of_one_person(campus: Campus, who: str, status: int, code: str) -> None:
    await campus.waits_for_load()
    browser = await campus.browser(who, *([Role.DISPATCHER] if who == "dispatcher" else []))
    answer = await browser.post(f"{campus.path}/handover", json={})
    assert (answer.status_code, answer.json()["code"]) == (status, code)
    assert await campus.service.rows(RobotCommand) == []


async def test_what_cannot_reach_the_robot_says_that_the_qr_code_works(campus: Campus) -> None:
    await campus.connect(understands=())
    sender = await campus.browser("sender")
    campus.mission = await campus.robot.mission()
    tap = await sender.post(f"{campus.path}/handover", json={})
    assert (tap.status_code, tap.json()["code"]) == (409, "robot_not_there")
    await campus.robot.ends(await campus.robot.report(campus.mission, Step.ARRIVED, campus.load))
    tap = await sender.post(f"{campus.path}/handover", json={})
    assert (tap.status_code, tap.json()["code"]) == (409, "robot_takes_no_taps")
    assert "QR" in tap.json()["detail"]
    assert campus.robot.socket
    await campus.robot.socket.close()

    async def told_offline() -> bool:
        answer = await sender.post(f"{campus.path}/handover", json={})
        return bool(answer.json()["code"] == "robot_offline" and "QR" in answer.json()["detail"])

    await until(told_offline)


async def test_digits_open_for_all_who_see_the_order_and_say_whose_they_are(campus: Campus) -> None:
    await campus.waits_for_recipient()
    recipient, dispatcher = await campus.browser("recipient"), await campus.browser("desk", Role.DISPATCHER)
    shown = (await recipient.get(f"{campus.path}/code")).json()
    assert (shown["purpose"], len(shown["digits"]), shown["digits_locked"]) == ("receive", 6, False)
    answer = await dispatcher.post(f"{campus.path}/handover", json={"digits": shown["digits"]})
    assert (answer.status_code, answer.json()["how"]) == (202, "digits")
    wish = await asked(campus)
    receipt = campus.robot.receipt(campus.receive, code_sha256=wish.by, how="digits", command_id=wish.command_id)
    await campus.robot.ends(await campus.robot.say(receipt))
    assert await campus.state() == "delivered"
    (_, taken) = await campus.service.rows(Handover, order_id=campus.order_id)
    assert (taken.how, taken.holder) == ("digits", "recipient")
    used = await dispatcher.post(f"{campus.path}/handover", json={"digits": shown["digits"]})
    assert (used.status_code, used.json()["code"]) == (409, "robot_not_there"), "codes are single use"


async def test_five_wrong_digits_lock_them_but_never_the_qr_until_a_dispatcher_releases_them(campus: Campus) -> None:
    await campus.waits_for_load()
    sender, desk = await campus.browser("sender"), await campus.browser("desk", Role.DISPATCHER)
    right = (await sender.get(f"{campus.path}/code")).json()["digits"]
    wrong = f"{(int(right) + 1) % 10**6:06d}"

    async def type_in(digits: str) -> tuple[int, str]:
        answer = await sender.post(f"{campus.path}/handover", json={"digits": digits})
        return answer.status_code, answer.json()["code"] if answer.is_error else ""

    stranger = await campus.browser("stranger")
    assert (await stranger.post(f"{campus.path}/handover", json={"digits": wrong})).status_code == 404
    assert [await type_in(wrong) for _ in range(5)] == [(422, "wrong_digits")] * 4 + [(409, "digits_locked")]
    assert await type_in(right) == (409, "digits_locked")
    assert (await sender.get(f"{campus.path}/code")).json()["digits_locked"]
    assert (await campus.service.row(Alarm, name="digits_locked")).cleared_at is None
    assert (await sender.post(f"{campus.path}/handover", json={})).status_code == 202, "a tap needs no digits"
    await campus.robot.ends(await campus.robot.say(campus.robot.receipt(campus.load)))
    assert await campus.state() == "carrying", "the QR code works"
    released = await desk.post(f"{campus.path}/digits/release")
    assert released.status_code == 200
    assert await campus.kinds() == ["digits_locked", "confirm_requested", "digits_released"]
    assert (await campus.service.row(Alarm, name="digits_locked")).cleared_at


async def test_expired_codes_open_nothing(campus: Campus, clock: SteppedClock, settings: Settings) -> None:
    await campus.waits_for_load()
    sender = await campus.browser("sender")
    digits = (await sender.get(f"{campus.path}/code")).json()["digits"]
    clock.advance(settings.handover_code_lifetime_s)
    sender = await campus.browser("sender")  # the session has ended, too
    for wish in ({}, {"digits": digits}):
        answer = await sender.post(f"{campus.path}/handover", json=wish)
        assert (answer.status_code, answer.json()["code"]) == (409, "codes_expired")
