"""From queued to delivered, and everything that is not allowed on the way."""

from typing import Any

import pytest
from fastapi import FastAPI

from app.models import OrderEvent, OrderState
from app.models.orders.order_events import EventsAreAppendOnly
from app.orders.errors import TransitionRefused
from app.orders.transitions import By
from tests.app.conftest import RECIPIENT, SENDER, STRANGER, Browser, Mailroom, Mails, SignedIn
from tests.app.orders.conftest import make_dispatcher

WAY = ("assigned", "to_sender", "at_sender", "carrying", "at_recipient", "delivered")

pytestmark = pytest.mark.mailed_codes


@pytest.fixture
def order_id(sender: Browser) -> str:
    return str(sender.order().json()["id"])


def seen(browser: Browser, order_id: str) -> Any:
    return browser.get(f"/api/v1/orders/{order_id}").json()


def kinds(browser: Browser) -> list[str]:
    return sorted(notice["kind"] for notice in browser.get("/api/v1/notices").json()["items"])


def test_a_delivered_order_shows_its_whole_way_and_everybody_was_told_once(
    sender: Browser, recipient: Browser, mailroom: Mailroom, mails: Mails, order_id: str
) -> None:
    assert mailroom.move(order_id, *WAY) == [True] * 6
    order = seen(sender, order_id)
    assert [event["state"] for event in order["events"]] == ["queued", *WAY]
    assert order["version"] == 7
    assert order["robot"] is None, "after the delivery no person needs to know where the robot goes"
    assert kinds(sender) == ["accepted", "delivered", "robot_here", "robot_near"]
    assert kinds(recipient) == ["delivered", "on_its_way", "robot_here_for_you"]
    mailroom.send_mails()
    subjects = [mail["Subject"] for mail in mails.to(SENDER) + mails.to(RECIPIENT)]
    assert len(set(subjects)) == 7 - 1 + 1  # seven notices ("delivered" reads the same for both), one sign-in mail


def test_a_robot_that_repeats_itself_changes_nothing_and_notifies_no_person_again(
    sender: Browser, mailroom: Mailroom, order_id: str
) -> None:
    mailroom.move(order_id, *WAY[:4])
    before = seen(sender, order_id)
    assert mailroom.move(order_id, *WAY[1:4]) == [False] * 3
    assert seen(sender, order_id) == before
    assert kinds(sender) == ["accepted", "robot_here", "robot_near"]


def test_a_step_that_the_table_does_not_have_is_refused_by_name(
    sender: Browser, mailroom: Mailroom, order_id: str
) -> None:
    with pytest.raises(TransitionRefused, match="is queued: robot cannot make it delivered"):
        mailroom.move(order_id, "delivered")
    assert seen(sender, order_id)["state"] == "queued"


def test_after_a_fault_a_dispatcher_puts_the_order_back_where_it_was(
    sender: Browser, mailroom: Mailroom, order_id: str
) -> None:
    mailroom.move(order_id, *WAY[:4])
    mailroom.move(order_id, "attention", reason="a wheel is off the floor")
    assert seen(sender, order_id)["why"] == "a wheel is off the floor"
    with pytest.raises(TransitionRefused):
        mailroom.move(order_id, "at_sender", by=By.DISPATCHER)
    mailroom.move(order_id, "carrying", by=By.DISPATCHER)
    mailroom.move(order_id, "at_recipient", "delivered")
    assert seen(sender, order_id)["state"] == "delivered"


def test_events_are_never_changed_or_deleted(app: FastAPI, mailroom: Mailroom, order_id: str) -> None:
    async def rewrite_history() -> None:
        async with app.state.parts.database.transaction() as session:
            event = await session.get_one(OrderEvent, (order_id, 1))
            event.state = OrderState.DELIVERED

    with pytest.raises(EventsAreAppendOnly):
        mailroom.call(rewrite_history)


def test_a_queued_order_is_cancelled_at_once(sender: Browser, order_id: str) -> None:
    answer = sender.post(f"/api/v1/orders/{order_id}/cancel")
    assert (answer.status_code, answer.json()["state"]) == (200, "cancelled")
    assert sender.post(f"/api/v1/orders/{order_id}/cancel").json() == answer.json(), "a retry says the same"
    assert kinds(sender) == ["accepted", "cancelled"]


def test_with_a_robot_on_its_way_cancelling_waits_for_its_answer(
    sender: Browser, mailroom: Mailroom, order_id: str
) -> None:
    mailroom.move(order_id, "assigned", "to_sender")
    order = sender.post(f"/api/v1/orders/{order_id}/cancel").json()
    assert (order["state"], order["cancel_requested"], order["can_cancel"]) == ("to_sender", True, False)
    mailroom.move(order_id, "cancelled")
    assert seen(sender, order_id)["state"] == "cancelled"


@pytest.mark.parametrize("steps", [4, 5])
def test_with_the_mail_aboard_a_wish_to_cancel_calls_it_back_on_the_robots_word(
    sender: Browser, mailroom: Mailroom, order_id: str, steps: int
) -> None:
    mailroom.move(order_id, *WAY[:steps])
    assert seen(sender, order_id)["can_cancel"] is True
    order = sender.post(f"/api/v1/orders/{order_id}/cancel").json()
    assert (order["state"], order["cancel_requested"], order["return_requested"]) == (WAY[steps - 1], True, True)
    assert order["return_post"] == "post1"
    assert sender.post(f"/api/v1/orders/{order_id}/cancel").json()["version"] == order["version"], "asked for once"
    mailroom.move(order_id, "returning", "at_return", "returned")
    order = seen(sender, order_id)
    assert (order["state"], order["can_cancel"], order["cancel_requested"]) == ("returned", False, False)
    assert "called_back" in kinds(sender)


def test_what_was_delivered_is_not_cancelled(sender: Browser, mailroom: Mailroom, order_id: str) -> None:
    mailroom.move(order_id, *WAY)
    answer = sender.post(f"/api/v1/orders/{order_id}/cancel")
    assert (answer.status_code, answer.json()["code"]) == (409, "not_cancellable")
    assert seen(sender, order_id)["can_cancel"] is False


def test_a_wish_to_cancel_that_came_too_late_is_not_said_to_be_granted(
    sender: Browser, recipient: Browser, mailroom: Mailroom, order_id: str
) -> None:
    mailroom.move(order_id, *WAY[:2])
    cancel = f"/api/v1/orders/{order_id}/cancel"
    assert sender.post(cancel).json()["cancel_requested"] is True
    assert sender.post(cancel).json()["version"] == seen(sender, order_id)["version"], "asked for once"
    mailroom.move(order_id, *WAY[2:4])
    assert seen(sender, order_id)["cancel_requested"] is False
    mailroom.move(order_id, *WAY[4:])
    assert sender.post(cancel).json()["code"] == "not_cancellable"


def test_only_the_sender_cancels(recipient: Browser, order_id: str) -> None:
    assert recipient.post(f"/api/v1/orders/{order_id}/cancel").json()["code"] == "not_cancellable"
    assert seen(recipient, order_id)["can_cancel"] is False


def test_who_read_an_older_version_cannot_cancel_the_newer_one(
    sender: Browser, mailroom: Mailroom, order_id: str
) -> None:
    etag = sender.get(f"/api/v1/orders/{order_id}").headers["ETag"]
    mailroom.move(order_id, "assigned")
    answer = sender.post(f"/api/v1/orders/{order_id}/cancel", headers={"If-Match": etag})
    assert (answer.status_code, answer.json()["code"]) == (412, "order_changed")
    assert sender.post(f"/api/v1/orders/{order_id}/cancel", headers={"If-Match": '"2"'}).status_code == 200


def test_while_the_robot_drives_its_order_says_where_it_was_seen(
    app: FastAPI, sender: Browser, mailroom: Mailroom, order_id: str
) -> None:
    mailroom.move(order_id, "assigned")
    robot = seen(sender, order_id)["robot"]
    assert (robot["name"], robot["online"]) == ("r1", False)


def test_no_person_sees_an_order_that_is_not_theirs_unless_dispatcher(
    app: FastAPI, sender: Browser, mailroom: Mailroom, signed_in: SignedIn, order_id: str
) -> None:
    stranger = signed_in(STRANGER)
    paths = [f"/api/v1/orders/{order_id}{end}" for end in ("", "/code", "/code.svg")]
    for path in paths:
        assert stranger.get(path).json()["code"] == "unknown_order"
    assert stranger.post(f"/api/v1/orders/{order_id}/cancel").json()["code"] == "unknown_order"
    assert stranger.get("/api/v1/orders").json()["items"] == []
    mailroom.call(make_dispatcher, app, STRANGER)
    assert seen(stranger, order_id)["my_role"] == "dispatcher"
    assert [order["id"] for order in stranger.get("/api/v1/orders").json()["items"]] == [order_id]
