"""Paging: every item once, whatever comes and goes between two pages, and no cursor but those that were given out."""

from typing import Any

import pytest

from protocol.clock import SteppedClock
from tests.app.conftest import Browser

ORDERS = "/api/v1/orders"


def ids(answer: Any) -> list[str]:
    return [item["id"] for item in answer.json()["items"]]


def test_what_is_ordered_in_the_meantime_doubles_and_hides_nothing(sender: Browser, clock: SteppedClock) -> None:
    made = []
    for _ in range(4):
        made.append(sender.order().json()["id"])  # two at each moment: the id tells them apart
        clock.advance(len(made) % 2)
    first = sender.get(ORDERS, params={"limit": 2})
    sender.order()
    second = sender.get(ORDERS, params={"limit": 2, "cursor": first.json()["next"]})
    assert sorted(ids(first) + ids(second)) == sorted(made)
    assert second.json()["next"] is None


def test_the_link_header_leads_to_the_next_page_with_the_same_question(sender: Browser) -> None:
    made = {sender.order().json()["id"] for _ in range(3)}
    first = sender.get(ORDERS, params={"limit": 2, "role": "sent"})
    second = sender.get(first.links["next"]["url"])
    assert "role=sent" in first.links["next"]["url"]
    assert {*ids(first), *ids(second)} == made
    assert "Link" not in second.headers


@pytest.mark.parametrize("spoilt", [lambda c: c[:-2] + "xx", lambda c: c[1:], lambda c: c + "AAAA", lambda c: "é" + c])
def test_a_cursor_that_was_changed_is_refused(sender: Browser, spoilt: Any) -> None:
    sender.order(), sender.order()
    cursor = sender.get(ORDERS, params={"limit": 1}).json()["next"]
    answer = sender.get(ORDERS, params={"cursor": spoilt(cursor)})
    assert (answer.status_code, answer.json()["code"]) == (400, "bad_cursor")


def test_the_cursor_of_one_list_is_none_of_another(sender: Browser) -> None:
    sender.order(), sender.order()
    cursor = sender.get("/api/v1/notices", params={"limit": 1}).json()["next"]
    answer = sender.get(ORDERS, params={"cursor": cursor})
    assert (answer.status_code, answer.json()["code"]) == (400, "bad_cursor")


def test_notices_are_listed_page_by_page_newest_first(sender: Browser) -> None:
    made = [sender.order().json()["id"] for _ in range(3)]
    listed, cursor = [], ""
    while cursor is not None:
        page = sender.get("/api/v1/notices", params={"limit": 2, "cursor": cursor}).json()
        listed += [notice["order_id"] for notice in page["items"]]
        assert page["unread"] == 3, "all of them are counted, not only those shown"
        cursor = page["next"]
    assert listed == made[::-1]
