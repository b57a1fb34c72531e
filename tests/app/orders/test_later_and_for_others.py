"""Orders for later, for another person and with priority; and what time decides of those that wait."""

from typing import Any

import pytest
from fastapi import FastAPI

from app.models import RobotRow
from protocol.clock import SteppedClock
from tests.app.conftest import SENDER, STRANGER, Browser, Mailroom
from tests.app.orders.test_life_of_an_order import kinds, seen

HOUR_S = 3600.0


@pytest.fixture
def tick(app: FastAPI, mailroom: Mailroom) -> Any:
    return lambda: mailroom.call(app.state.parts.timer.tick)


def poll(app: FastAPI, mailroom: Mailroom) -> None:
    """Enrol a robot without waking dispatch."""
    mailroom.call(_put_online, app)
    mailroom.call(app.state.parts.traffic_service.poll)
    mailroom.call(app.state.parts.dispatcher.poll)


async def _put_online(app: FastAPI) -> None:
    async with app.state.parts.database.transaction() as session:
        robot = await session.get_one(RobotRow, "r1")
        robot.online, robot.battery_ratio = True, 0.9


def test_an_order_for_later_is_left_alone_until_then_and_has_its_window_after_it(
    app: FastAPI, sender: Browser, mailroom: Mailroom, clock: SteppedClock
) -> None:
    order = sender.order(not_before="2026-01-05T14:00:00Z").json()
    assert order["window"]["from"] > "2026-01-05T14:00:00Z"
    poll(app, mailroom)
    assert seen(sender, order["id"])["state"] == "queued"
    clock.advance(5 * HOUR_S)
    poll(app, mailroom)
    assert seen(sender, order["id"])["state"] == "assigned"


def test_a_dispatcher_orders_for_a_person_at_the_desk(dispatcher: Browser, sender: Browser) -> None:
    answer = dispatcher.order(on_behalf_of=SENDER)
    assert answer.json()["my_role"] == "dispatcher"
    order = seen(sender, answer.json()["id"])
    assert (order["my_role"], order["placed_by"]["email"]) == ("sender", STRANGER)
    assert [event["by"] for event in order["events"]] == ["dispatcher"]
    assert kinds(sender) == ["accepted"]
    assert dispatcher.order(on_behalf_of="eve@elsewhere.example").json()["code"] == "unknown_sender"


def test_only_dispatchers_order_for_others_or_with_high_priority(sender: Browser) -> None:
    for wish in ({"on_behalf_of": STRANGER}, {"priority": "high"}):
        answer = sender.order(**wish)
        assert (answer.status_code, answer.json()["code"]) == (403, "for_dispatchers")
    assert sender.order(priority="low").json()["priority"] == "low"


def test_the_important_is_fetched_first(app: FastAPI, dispatcher: Browser, sender: Browser, mailroom: Mailroom) -> None:
    first, second, third = [sender.order(from_post=f"post{n}", to_post="post4").json()["id"] for n in (1, 2, 3)]
    raised = dispatcher.put(f"/api/v1/orders/{third}/priority", json={"priority": "high"}).json()
    assert raised["priority"] == "high"
    assert [event["kind"] for event in raised["events"]] == ["moved", "priority_changed"]
    poll(app, mailroom)
    stops = {seen(sender, one)["state"] for one in (first, second, third)}
    assert seen(sender, third)["state"] == "assigned"
    assert "queued" in stops, "one robot cannot carry three"


def test_an_order_that_no_robot_fetched_in_a_day_expires_and_the_sender_is_told(
    sender: Browser, clock: SteppedClock, tick: Any
) -> None:
    order_id = sender.order().json()["id"]
    clock.advance(23 * HOUR_S)
    tick()
    assert seen(sender, order_id)["state"] == "queued"
    clock.advance(2 * HOUR_S)
    tick()
    tick()
    order = seen(sender, order_id)
    assert (order["state"], order["events"][-1]["by"]) == ("expired", "timer")
    assert order["events"][-1]["reason"] == "No robot has fetched it in time."
    assert kinds(sender).count("expired") == 1


def test_who_waits_too_long_is_told_once_and_sees_a_later_window(
    sender: Browser, recipient: Browser, mailroom: Mailroom, clock: SteppedClock, tick: Any
) -> None:
    mailroom.robot_connects()
    order = sender.order().json()
    clock.advance(HOUR_S)
    tick()
    tick()
    later = seen(sender, order["id"])
    assert later["window"]["to"] > order["window"]["to"]
    assert [event["kind"] for event in later["events"]] == ["moved", "delayed"]
    assert kinds(sender) == ["accepted", "delayed"]
    assert kinds(recipient) == [], "who was told nothing is not told that it is late"
    clock.advance(2 * HOUR_S)
    tick()
    assert kinds(sender) == ["accepted", "delayed"], "once"


def test_what_is_late_while_no_robot_can_come_is_told_without_a_time(
    sender: Browser, mailroom: Mailroom, clock: SteppedClock, tick: Any, app: FastAPI
) -> None:
    mailroom.robot_connects()
    order = sender.order().json()
    promised_to = order["window"]["to"]
    assert order["estimate"]["promised_to"] == promised_to
    mailroom.robot_connects(online=False)
    mailroom.call(app.state.parts.dispatcher.poll)
    clock.advance(HOUR_S)
    late = seen(sender, order["id"])
    assert (late["estimate"]["late"], late["estimate"]["promised_to"]) == (True, promised_to)
    tick()
    told = seen(sender, order["id"])
    assert (told["window"], told["estimate"]["from"], told["estimate"]["to"]) == (None, None, None)
    assert told["estimate"]["reason"] == "No robot is connected at the moment."
    assert told["estimate"]["late"] is True
    assert kinds(sender) == ["accepted", "delayed"]
    delayed = next(one for one in sender.get("/api/v1/notices").json()["items"] if one["kind"] == "delayed")
    assert "A new time is not known yet" in delayed["body"]


def test_nothing_is_promised_while_no_robot_can_come_and_the_first_time_that_is_known_is_the_promise(
    sender: Browser, mailroom: Mailroom, app: FastAPI
) -> None:
    order = sender.order().json()
    estimate = order["estimate"]
    assert (order["window"], estimate["to"], estimate["promised_to"]) == (None, None, None)
    assert estimate["reason"] == "No robot is connected at the moment."
    (accepted,) = sender.get("/api/v1/notices").json()["items"]
    assert "between" not in accepted["body"]
    assert "not known yet" in accepted["body"]
    mailroom.robot_connects()
    mailroom.call(app.state.parts.dispatcher.poll)
    known = seen(sender, order["id"])
    assert known["estimate"]["reason"] == "Every robot is busy."
    assert known["estimate"]["promised_to"] == known["estimate"]["to"] == known["window"]["to"]
