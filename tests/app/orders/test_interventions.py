"""When something is stuck: what a dispatcher can do with it, and what people can do who meet the robot."""

from datetime import timedelta
from typing import Any

import pytest
from fastapi import FastAPI
from sqlmodel import select

from app.models import Handover, MissionRow, OrderState, StopRow
from app.orders.service import Actor
from app.orders.transitions import By
from tests.app.conftest import Browser, Mailroom
from tests.app.orders.test_life_of_an_order import WAY, kinds, seen


@pytest.fixture
def order_id(sender: Browser) -> str:
    return str(sender.order().json()["id"])


def does(browser: Browser, order_id: str, what: str, **body: Any) -> Any:
    answer = browser.post(f"/api/v1/orders/{order_id}/{what}", json=body).json()
    return answer.get("state") or answer["code"]


def loaded(app: FastAPI, mailroom: Mailroom, order_id: str, *, is_waiting: bool = False) -> None:
    """Its mail is in robot r1, which has a mission to bring it."""

    async def write_it_down() -> None:
        async with app.state.parts.database.transaction() as session:
            now = app.state.parts.clock.utc()
            session.add(MissionRow(id="m1", robot="r1", told_update=1, created_at=now, accepted_at=now))
            await session.flush()
            stop = {"mission_id": "m1", "order_id": order_id, "position": 1}
            arrived_at = now if is_waiting else None
            session.add(StopRow(id="s2", post="post4", action="receive", arrived_at=arrived_at, **stop))
            receipt = {"order_id": order_id, "stop_id": "s1", "purpose": "load", "robot": "r1", "post": "post1"}
            session.add(Handover(**receipt, holder="sender", robot_at=now, at=now))

    mailroom.call(write_it_down)


def test_mail_that_a_person_fetched_by_hand_is_held_and_its_custody_says_so(
    app: FastAPI, sender: Browser, dispatcher: Browser, mailroom: Mailroom, order_id: str
) -> None:
    mailroom.move(order_id, *WAY[:4])
    loaded(app, mailroom, order_id)
    assert does(dispatcher, order_id, "hold") == "transition_refused", "no person takes mail out of a robot that drives"
    assert does(dispatcher, order_id, "attention", reason="It stands in the way.") == "attention"
    assert does(dispatcher, order_id, "resolve", to="queued") == "transition_refused", "its mail is aboard"
    assert does(dispatcher, order_id, "resolve", to="held", reason="Fetched.") == "held"
    links = seen(sender, order_id)["custody"]
    assert [(one["holder"], one["how"]) for one in links] == [
        ("sender", None),
        ("robot", "code"),
        ("mailroom", "dispatcher"),
    ]
    assert [one["to"] for one in links[:-1]] == [one["from"] for one in links[1:]]
    assert links[-1]["to"] is None
    assert "held" in kinds(sender)


def test_what_was_not_loaded_goes_into_the_queue_again_and_the_robot_is_told_to_drop_it(
    app: FastAPI, sender: Browser, dispatcher: Browser, mailroom: Mailroom, order_id: str
) -> None:
    mailroom.move(order_id, *WAY[:2])
    mailroom.move(order_id, "attention", reason="a wheel is off the floor")
    assert does(dispatcher, order_id, "resolve", to="returning") == "transition_refused", "there is nothing to return"
    assert does(dispatcher, order_id, "resolve", to="resume") == "nothing_to_resume"
    assert does(dispatcher, order_id, "resolve", to="queued") == "queued"
    order = seen(sender, order_id)
    assert (order["robot"], order["custody"][-1]["holder"]) == (None, "sender")


def test_mail_in_trouble_is_sent_back_by_a_mission_that_says_so(
    app: FastAPI, sender: Browser, dispatcher: Browser, mailroom: Mailroom, order_id: str
) -> None:
    mailroom.move(order_id, *WAY[:4])
    loaded(app, mailroom, order_id)
    mailroom.move(order_id, "attention", reason="a wheel is off the floor")
    assert does(dispatcher, order_id, "resolve", to="returning") == "returning"
    assert seen(sender, order_id)["return_post"] == "post1"

    async def stops() -> list[tuple[str, bool, str]]:
        async with app.state.parts.database.reading() as session:
            rows = (await session.exec(select(StopRow).order_by(StopRow.since_update))).all()
            return [(row.action, row.dropped_at is None, row.post) for row in rows]

    assert mailroom.call(stops) == [("receive", False, "post4"), ("return", True, "post1")]


def test_not_now_sends_the_mail_back_and_is_the_recipients_alone_to_say(
    app: FastAPI, sender: Browser, recipient: Browser, mailroom: Mailroom, order_id: str
) -> None:
    assert does(recipient, order_id, "not-now") == "not_recallable", "nothing is coming yet"
    mailroom.move(order_id, *WAY[:4])
    loaded(app, mailroom, order_id)
    assert does(sender, order_id, "not-now") == "not_recallable"
    assert does(recipient, order_id, "not-now") == "carrying", "until the robot says that it has turned"
    order = seen(recipient, order_id)
    assert order["return_requested"] is True
    assert [event["kind"] for event in order["events"]][-1] == "return_requested"
    version = order["version"]
    assert does(recipient, order_id, "not-now") == "carrying"
    assert seen(recipient, order_id)["version"] == version, "asked for once"
    assert does(recipient, order_id, "recall") == "not_recallable", "calling back is the sender's"


def test_the_person_that_the_robot_waits_for_may_ask_for_more_time_but_not_for_ever(
    app: FastAPI, sender: Browser, recipient: Browser, dispatcher: Browser, mailroom: Mailroom, order_id: str
) -> None:
    assert does(sender, order_id, "wait") == "not_waiting"
    mailroom.move(order_id, *WAY[:4])
    loaded(app, mailroom, order_id, is_waiting=True)
    mailroom.call(arrive, app, order_id)
    first = seen(recipient, order_id)["wait_until"]
    assert does(sender, order_id, "wait") == "not_waiting", "not for the sender"
    assert does(recipient, order_id, "wait", extend_s=301) == "waited_long_enough"
    assert [does(recipient, order_id, "wait") for _ in range(3)] == ["at_recipient"] * 2 + ["waited_long_enough"]
    assert does(dispatcher, order_id, "wait", extend_s=7201) == "invalid_request", "two hours at a time"
    assert does(dispatcher, order_id, "wait", extend_s=7200) == "at_recipient"
    order = seen(recipient, order_id)
    assert order["wait_until"] > first
    assert [event["kind"] for event in order["events"]].count("wait_extended") == 3


async def arrive(app: FastAPI, order_id: str) -> None:

    async with app.state.parts.database.transaction() as session:
        actor, until = Actor(By.ROBOT, robot="r1"), app.state.parts.clock.utc() + timedelta(seconds=600)
        await app.state.parts.orders.ledger.move(session, order_id, OrderState.AT_RECIPIENT, actor, until)


def test_another_robot_fetches_what_a_dispatcher_gives_to_it(
    sender: Browser, dispatcher: Browser, mailroom: Mailroom, order_id: str
) -> None:
    assert does(dispatcher, order_id, "reassign", robot="r9") == "unknown_robot"
    mailroom.move(order_id, "assigned")
    assert does(dispatcher, order_id, "reassign") == "assigned", "until the robot has let go"
    mailroom.move(order_id, "queued")
    assert [event["kind"] for event in seen(sender, order_id)["events"]] == ["moved", "moved", "reassigned", "moved"]
    mailroom.move(order_id, *WAY[:4])
    assert does(dispatcher, order_id, "reassign") == "not_reassignable"


def test_the_chain_of_custody_of_a_delivery(app: FastAPI, sender: Browser, mailroom: Mailroom, order_id: str) -> None:
    mailroom.move(order_id, *WAY[:4])
    loaded(app, mailroom, order_id)
    order = seen(sender, order_id)
    assert [(one["holder"], one["name"], one["how"]) for one in order["custody"]] == [
        ("sender", None, None),
        ("robot", "r1", "code"),
    ]
    assert order["custody"][0]["from"] == order["created_at"]
