"""The estimate of an order over HTTP: what is over is never expected, whatever lies in the database."""

from datetime import timedelta

import pytest
from fastapi import FastAPI

from app.models import RobotRow
from protocol.clock import SteppedClock
from tests.app.conftest import Browser, Mailroom


@pytest.mark.parametrize(
    ("states", "reasons"),
    [
        ((), ("A robot is being chosen.", "No robot is connected at the moment.")),  # before dispatch has looked, after
        (("assigned", "to_sender", "at_sender", "carrying"), ("The robot has no network at the moment.",)),
    ],
)
def test_an_interval_that_is_over_is_not_given_and_what_is_waited_for_is_said(
    app: FastAPI,
    sender: Browser,
    mailroom: Mailroom,
    clock: SteppedClock,
    states: tuple[str, ...],
    reasons: tuple[str, ...],
) -> None:
    order_id = sender.order(not_before="2026-01-05T10:00:00Z").json()["id"]
    mailroom.move(order_id, *states)
    path = f"/api/v1/orders/{order_id}"
    known = sender.get(path).json()
    assert known["window"]["to"] == known["estimate"]["to"] > "2026-01-05T10"
    assert known["estimate"]["late"] is False
    clock.advance(70 * 60.0)  # and not so late that a delay is told of
    for order in (sender.get(path).json(), sender.get("/api/v1/orders").json()["items"][0]):
        estimate = order["estimate"]
        assert (order["window"], estimate["from"], estimate["to"]) == (None, None, None)
        assert estimate["reason"].startswith(reasons)
        assert estimate["reason_words"]["key"].startswith("why.")
        assert (estimate["late"], estimate["promised_to"]) == (True, known["estimate"]["promised_to"])


def test_there_is_no_estimate_once_the_robot_is_there_or_the_mail_goes_back(
    sender: Browser, mailroom: Mailroom
) -> None:
    mailroom.robot_connects()
    order_id = sender.order().json()["id"]
    mailroom.move(order_id, "assigned", "to_sender", "at_sender", "carrying", "at_recipient")
    for state in ("at_recipient", "returning"):
        mailroom.move(order_id, state)
        order = sender.get(f"/api/v1/orders/{order_id}").json()
        assert (order["estimate"], order["window"]) == (None, None), state


def test_a_robot_is_not_expected_at_a_time_that_is_over(
    app: FastAPI, sender: Browser, mailroom: Mailroom, clock: SteppedClock
) -> None:
    mailroom.call(_drives, app)
    (robot,) = sender.get("/api/v1/robots").json()["items"]
    assert robot["expected"]["post"] == "post2"
    clock.advance(timedelta(hours=1).total_seconds())
    (robot,) = sender.get("/api/v1/robots").json()["items"]
    assert (robot["expected"], robot["towards"]) == (None, "post2")


async def _drives(app: FastAPI) -> None:
    async with app.state.parts.database.transaction() as session:
        robot = await session.get_one(RobotRow, "r1")
        robot.post, robot.towards, robot.seen_at = "post1", "post2", app.state.parts.clock.utc()
