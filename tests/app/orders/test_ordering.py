"""Placing an order: what is answered, what is refused, and that a retry is the same order."""

import asyncio
import threading
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import httpx
import pytest
from fastapi import FastAPI

from app.orders.idempotency import Running
from protocol.clock import SteppedClock
from tests.app.conftest import RECIPIENT, SENDER, STRANGER, Browser, Mailroom, Mails, Served, SignedIn


def refused(answer: Any) -> tuple[int, str]:
    assert answer.headers["content-type"] == "application/problem+json"
    return answer.status_code, answer.json()["code"]


def test_an_order_is_accepted_with_a_window_and_its_place(sender: Browser, mailroom: Mailroom) -> None:
    mailroom.robot_connects()
    answer = sender.order(description="A letter")
    order = answer.json()
    assert answer.status_code == 201
    assert answer.headers["Location"] == f"/api/v1/orders/{order['id']}"
    assert answer.headers["ETag"] == '"1"'
    assert (order["state"], order["my_role"], order["description"]) == ("queued", "sender", "A letter")
    assert order["window"]["assumed"] is True
    assert order["window"]["from"] < order["window"]["to"]
    assert [event["by"] for event in order["events"]] == ["sender"]
    found = sender.get(answer.headers["Location"]).json()
    waits = {"why", "why_words", "estimate"}  # dispatch may have said meanwhile why it waits
    assert found.keys() == order.keys()
    assert all(found[name] == order[name] for name in found.keys() - waits)


@pytest.mark.parametrize(
    ("changes", "code"),
    [
        ({"to_post": "post9"}, "unknown_post"),
        ({"from_post": "nowhere"}, "unknown_post"),
        ({"to_post": "post1"}, "same_post"),
        ({"recipient": "eve@elsewhere.example"}, "unknown_recipient"),
        ({"recipient": "no address"}, "invalid_request"),
        ({"colour": "blue"}, "invalid_request"),
    ],
)
@pytest.mark.slow
def test_what_cannot_be_delivered_is_refused_by_name(sender: Browser, changes: dict[str, str], code: str) -> None:
    assert refused(sender.order(**changes)) == (422, code)
    assert sender.get("/api/v1/orders").json()["items"] == []
    assert sender.get("/api/v1/notices").json()["items"] == []


def test_an_unknown_post_is_answered_with_the_nearest_spelling(sender: Browser) -> None:
    assert "Did you mean 'post4'?" in sender.order(to_post="pots4").json()["detail"]


def test_a_recipient_who_never_signed_in_finds_the_order_when_they_do(sender: Browser, signed_in: SignedIn) -> None:
    order_id = sender.order().json()["id"]
    theirs = signed_in(RECIPIENT).get(f"/api/v1/orders/{order_id}").json()
    assert theirs["my_role"] == "recipient"


def test_an_order_without_a_key_is_refused(sender: Browser) -> None:
    body = {"from_post": "post1", "to_post": "post4", "recipient": RECIPIENT}
    assert refused(sender.post("/api/v1/orders", json=body)) == (422, "invalid_request")


def test_the_same_key_and_body_is_the_same_order(sender: Browser) -> None:
    first, second = sender.order("k1"), sender.order("k1")
    assert "Idempotency-Replayed" not in first.headers
    assert second.headers["Idempotency-Replayed"] == "true"
    assert (second.status_code, second.json()) == (201, first.json())
    assert [second.headers[name] for name in ("Location", "ETag")] == [first.headers[n] for n in ("Location", "ETag")]
    assert len(sender.get("/api/v1/orders").json()["items"]) == 1


def test_the_same_key_with_another_body_is_refused(sender: Browser) -> None:
    sender.order("k1")
    assert refused(sender.order("k1", to_post="post3")) == (422, "idempotency_key_reused")


def test_another_persons_key_is_another_key(sender: Browser, recipient: Browser) -> None:
    assert sender.order("k1").json()["id"] != recipient.order("k1", recipient=SENDER).json()["id"]


def test_after_a_day_a_key_is_forgotten(sender: Browser, clock: SteppedClock) -> None:
    first = sender.order("k1").json()["id"]
    clock.advance(24 * 3600 + 1)
    assert sender.order("k1").json()["id"] != first


def test_a_key_whose_first_request_still_runs_is_told_so(app: FastAPI, sender: Browser) -> None:
    running: Running = app.state.parts.order_batcher.running
    person_id = sender.get("/api/v1/me").json()["id"]
    with running.only_once(person_id, "k1"):
        assert refused(sender.order("k1")) == (409, "still_running")
    assert sender.order("k1").status_code == 201


def test_two_requests_at_once_with_one_key_make_one_order(app: FastAPI, sender: Browser, mailroom: Mailroom) -> None:
    import httpx2

    body = {"from_post": "post1", "to_post": "post4", "recipient": RECIPIENT}
    headers = {"Idempotency-Key": "k1", "Sec-Fetch-Site": "same-origin"}
    cookies = {"session": sender.cookies["session"]}

    async def both() -> list[int]:
        transport = httpx2.ASGITransport(app)
        async with httpx2.AsyncClient(transport=transport, base_url="http://127.0.0.1", cookies=cookies) as client:
            asked = [client.post("/api/v1/orders", json=body, headers=headers) for _ in range(5)]
            return [answer.status_code for answer in await asyncio.gather(*asked)]

    assert set(mailroom.call(both)) <= {201, 409}
    assert len(sender.get("/api/v1/orders").json()["items"]) == 1


def test_two_connections_at_once_with_one_key_make_one_order(served: Served, sender: Browser) -> None:
    body = {"from_post": "post1", "to_post": "post4", "recipient": RECIPIENT}
    cookie = f"session={sender.cookies['session']}"
    headers = {"Idempotency-Key": "k1", "Sec-Fetch-Site": "same-origin", "Cookie": cookie}
    begin = threading.Barrier(8)

    def ask(_: int) -> httpx.Response:
        begin.wait()
        return httpx.post(f"{served.url}/api/v1/orders", json=body, headers=headers)

    with ThreadPoolExecutor(8) as people:
        answers = list(people.map(ask, range(8)))
    placed = [answer.json()["id"] for answer in answers if answer.status_code == 201]
    assert {answer.status_code for answer in answers} <= {201, 409}
    assert len(set(placed)) == 1
    assert sum("Idempotency-Replayed" not in a.headers for a in answers if a.status_code == 201) == 1
    assert [order["id"] for order in sender.get("/api/v1/orders").json()["items"]] == placed[:1]


def test_the_estimate_says_window_and_length_before_anything_is_ordered(sender: Browser, mailroom: Mailroom) -> None:
    answer = sender.get("/api/v1/estimate", params={"from_post": "post1", "to_post": "post4"}).json()
    assert answer["assumed"] is True
    assert answer["length_m"] > 1
    assert answer["window"]["from"] < answer["window"]["to"]
    assert answer["reason"] == "No robot is connected at the moment.", "how long it would take with one"
    mailroom.robot_connects()
    assert sender.get("/api/v1/estimate", params={"from_post": "post1", "to_post": "post4"}).json()["reason"] is None
    same = sender.get("/api/v1/estimate", params={"from_post": "post1", "to_post": "post1"})
    assert refused(same) == (422, "same_post")


def test_a_zero_byte_is_refused_as_any_other_mistake_before_a_database_refuses_it(sender: Browser) -> None:
    assert refused(sender.order(description="Keys\0.")) == (422, "invalid_request")
    assert sender.order(description="Keys, and a letter: é 漢.").status_code == 201


def test_orders_are_listed_page_by_page_newest_first(sender: Browser, recipient: Browser, clock: SteppedClock) -> None:
    made = []
    for _ in range(5):
        made.append(sender.order().json()["id"])
        clock.advance(1)
    for role, person in (("sent", sender), ("coming", recipient), ("all", sender)):
        listed, cursor = [], ""
        while cursor is not None:
            page = person.get("/api/v1/orders", params={"role": role, "limit": 2, "cursor": cursor}).json()
            listed += [order["id"] for order in page["items"]]
            cursor = page["next"]
        assert listed == made[::-1]
    assert sender.get("/api/v1/orders", params={"role": "coming"}).json()["items"] == []


@pytest.mark.parametrize("cursor", ["x", "eA==", "MjAyNi0wMS0wMSBv"])
def test_a_made_up_cursor_is_refused(sender: Browser, cursor: str) -> None:
    assert refused(sender.get("/api/v1/orders", params={"cursor": cursor})) == (400, "bad_cursor")


def test_the_sender_is_told_once_that_the_order_is_accepted(sender: Browser, mailroom: Mailroom, mails: Mails) -> None:
    sender.order("k1")
    sender.order("k1")
    assert [notice["kind"] for notice in sender.get("/api/v1/notices").json()["items"]] == ["accepted"]
    mailroom.send_mails()
    assert [mail["Subject"] for mail in mails.to(SENDER)].count("Order accepted: Post 1 to Post 4") == 1
    assert mails.to(STRANGER) == []
