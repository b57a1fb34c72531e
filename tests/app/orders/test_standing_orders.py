"""Orders that come again: made once each when their time comes, whatever stands still meanwhile."""

from datetime import UTC, datetime
from typing import Any

import pytest
from fastapi import FastAPI

from app.models import StandingOrder
from app.orders.standing.standing import StandingOrders
from app.orders.timer import Timer
from protocol.clock import SteppedClock
from tests.app.conftest import RECIPIENT, STRANGER, Browser, Mailroom, SignedIn

HOUR_S = 3600.0
WISH = {"from_post": "post1", "to_post": "post4", "recipient": RECIPIENT, "at": "10:30", "zone": "UTC"}


def placed(browser: Browser, **changes: Any) -> Any:
    return browser.post("/api/v1/standing-orders", json={**WISH, "weekdays": [0, 1, 2, 3, 4], **changes})


@pytest.fixture
def tick(app: FastAPI, mailroom: Mailroom) -> Any:
    """Do what the timer does each second."""
    return lambda: mailroom.call(app.state.parts.timer.tick)


def orders_of(browser: Browser) -> list[Any]:
    return list(browser.get("/api/v1/orders").json()["items"])


def test_each_occurrence_becomes_an_order_of_its_own(sender: Browser, clock: SteppedClock, tick: Any) -> None:
    answer = placed(sender, description="The daily post")
    standing = answer.json()
    assert answer.status_code == 201
    assert answer.headers["Location"] == f"/api/v1/standing-orders/{standing['id']}"
    assert standing["next_at"] == "2026-01-05T10:30:00Z", "today is Monday, and it is nine"
    tick()
    assert orders_of(sender) == []
    for _ in range(2):
        clock.advance(2 * HOUR_S)
        tick()
        tick()
        clock.advance(22 * HOUR_S)
    made = orders_of(sender)
    assert [(one["standing_order_id"], one["description"]) for one in made] == [(standing["id"], "The daily post")] * 2
    assert made[0]["events"][0]["by"] == "timer"
    kinds = [notice["kind"] for notice in sender.get("/api/v1/notices").json()["items"]]
    assert kinds.count("accepted") == 2


def test_two_that_look_at_once_and_a_restart_make_no_order_twice(
    app: FastAPI, sender: Browser, clock: SteppedClock, mailroom: Mailroom, tick: Any
) -> None:
    standing_id = placed(sender).json()["id"]
    clock.advance(2 * HOUR_S)
    tick()

    async def as_if_it_had_not_been_planned_on() -> None:
        async with app.state.parts.database.transaction() as session:
            row = await session.get_one(StandingOrder, standing_id)
            row.next_at = datetime(2026, 1, 5, 10, 30, tzinfo=UTC)

    made = [order["id"] for order in orders_of(sender)]
    assert len(made) == 1
    mailroom.call(as_if_it_had_not_been_planned_on)
    state = app.state.parts
    anew = Timer(state.database, state.orders, StandingOrders(state.orders.placing, state.clock))
    mailroom.call(anew.tick)
    assert [order["id"] for order in orders_of(sender)] == made


def test_what_came_round_while_the_service_stood_still_is_made_up_for_unless_it_is_too_late(
    sender: Browser, clock: SteppedClock, tick: Any
) -> None:
    placed(sender)
    clock.advance(5 * HOUR_S)
    tick()
    assert len(orders_of(sender)) == 1
    clock.advance(24 * HOUR_S + 4 * HOUR_S)  # Tuesday's would be seven and a half hours late
    tick()
    assert len(orders_of(sender)) == 1
    assert sender.get("/api/v1/standing-orders").json()["items"][0]["next_at"] == "2026-01-07T10:30:00Z"


def test_while_it_is_paused_nothing_comes_and_nothing_is_made_up_for(
    sender: Browser, clock: SteppedClock, tick: Any
) -> None:
    path = f"/api/v1/standing-orders/{placed(sender).json()['id']}"
    assert sender.post(f"{path}/pause").json()["next_at"] is None
    clock.advance(2 * HOUR_S)
    tick()
    assert orders_of(sender) == []
    assert sender.post(f"{path}/resume").json()["next_at"] == "2026-01-06T10:30:00Z"
    tick()
    assert orders_of(sender) == []
    ended = sender.post(f"{path}/end").json()
    assert (ended["ended"], ended["next_at"]) == (True, None)
    assert sender.post(f"{path}/resume").json()["code"] == "standing_order_ended"


def test_it_ends_with_its_last_day(sender: Browser, clock: SteppedClock, tick: Any) -> None:
    path = f"/api/v1/standing-orders/{placed(sender, until='2026-01-05').json()['id']}"
    clock.advance(2 * HOUR_S)
    tick()
    assert len(orders_of(sender)) == 1
    assert sender.get(path).json()["ended"] is True


@pytest.mark.parametrize(
    ("changes", "code"),
    [
        ({"to_post": "post9"}, "unknown_post"),
        ({"zone": "Mars/Olympus"}, "invalid_request"),
        ({"weekdays": []}, "invalid_request"),
        ({"at": "24:00"}, "invalid_request"),
        ({"priority": "high"}, "for_dispatchers"),
    ],
)
def test_what_cannot_come_round_is_refused_by_name(sender: Browser, changes: dict[str, Any], code: str) -> None:
    assert placed(sender, **changes).json()["code"] == code


def test_a_standing_order_is_its_senders_alone(sender: Browser, signed_in: SignedIn) -> None:
    path = f"/api/v1/standing-orders/{placed(sender).json()['id']}"
    stranger = signed_in(STRANGER)
    assert stranger.get(path).json()["code"] == "unknown_standing_order"
    assert stranger.post(f"{path}/end").json()["code"] == "unknown_standing_order"
    assert stranger.get("/api/v1/standing-orders").json()["items"] == []


def test_one_whose_post_is_gone_is_paused_and_says_why(
    app: FastAPI, sender: Browser, clock: SteppedClock, mailroom: Mailroom, tick: Any
) -> None:
    standing_id = placed(sender).json()["id"]

    async def rename() -> None:
        async with app.state.parts.database.transaction() as session:
            (await session.get_one(StandingOrder, standing_id)).to_post = "post9"

    mailroom.call(rename)
    clock.advance(2 * HOUR_S)
    tick()
    view = sender.get(f"/api/v1/standing-orders/{standing_id}").json()
    assert view["paused"] is True
    assert "post9" in view["why"]
