"""Search among the orders that a person may see."""

from typing import Any

import pytest
from fastapi import FastAPI

from protocol.clock import SteppedClock
from tests.app.conftest import RECIPIENT, SENDER, Browser, Mailroom, SignedIn
from tests.app.orders.conftest import make_dispatcher

ORDERS = "/api/v1/orders"


def found(browser: Browser, **asked: Any) -> list[str]:
    """Return the descriptions of the listed orders, one page after the other."""
    whats, page = [], browser.get(ORDERS, params={"limit": 2, **asked})
    while True:
        assert page.status_code == 200, page.text
        whats += [item["description"] for item in page.json()["items"]]
        if "next" not in page.links:
            return whats
        page = browser.get(page.links["next"]["url"])


@pytest.fixture
def dispatcher(app: FastAPI, signed_in: SignedIn, mailroom: Mailroom) -> Browser:
    browser = signed_in("dispatcher@campus.example")
    mailroom.call(make_dispatcher, app, "dispatcher@campus.example")
    return browser


@pytest.fixture
def mail(sender: Browser, recipient: Browser, clock: SteppedClock) -> None:
    """Five letters from the sender, of which every second was cancelled, and one for the sender."""
    for number in range(5):
        clock.advance(1)
        order = sender.order(description=f"Letter {number}").json()
        if number % 2:
            sender.post(f"{ORDERS}/{order['id']}/cancel")
    clock.advance(1)
    recipient.order(recipient=SENDER, description="100 % Été", from_post="post2", to_post="post3")


def test_what_goes_on_and_what_has_ended_are_listed_apart_page_by_page(
    mail: None, sender: Browser, dispatcher: Browser
) -> None:
    going_on = ["Letter 4", "Letter 2", "Letter 0"]
    for asked, mine, everybodys in (
        ({"role": "sent", "state": "open"}, going_on, []),
        ({"role": "sent", "state": "ended"}, ["Letter 3", "Letter 1"], []),
        ({"role": "coming", "state": "open"}, ["100 % Été"], []),
        ({"state": "open"}, ["100 % Été", *going_on], ["100 % Été", *going_on]),
        ({"state": "ended"}, ["Letter 3", "Letter 1"], ["Letter 3", "Letter 1"]),
    ):
        assert (found(sender, **asked), found(dispatcher, **asked)) == (mine, everybodys), asked
    assert sender.get(ORDERS, params={"state": "lost"}).json()["code"] == "invalid_request"


def test_what_waits_for_a_dispatcher_is_found_however_much_goes_on(
    mail: None, sender: Browser, dispatcher: Browser, mailroom: Mailroom
) -> None:
    oldest = sender.get(ORDERS, params={"role": "sent", "state": "open"}).json()["items"][-1]
    assert all(mailroom.move(oldest["id"], "assigned", "attention"))
    for browser in (sender, dispatcher):
        assert found(browser, state="attention") == ["Letter 0"]
        assert "Letter 0" in found(browser, state="open"), "which goes on all the same"


def test_mail_is_found_by_what_it_is_whose_it_is_and_its_posts(mail: None, sender: Browser) -> None:
    summer, all_others = ["100 % Été"], [f"Letter {number}" for number in (4, 3, 2, 1, 0)]
    for search, letters in {
        " LETTER 3 ": ["Letter 3"],
        "été": summer,
        "0 % é": summer,
        "%": summer,
        "_": [],
        "POST 2": summer,
        "post3": summer,
        RECIPIENT[:9].upper(): [*summer, *all_others],
        SENDER: [],
    }.items():
        assert found(sender, search=search) == letters, search


def test_search_narrows_each_side_and_a_dispatcher_finds_both_sides(
    mail: None, sender: Browser, dispatcher: Browser
) -> None:
    assert found(sender, role="coming", search=RECIPIENT) == ["100 % Été"]
    assert found(sender, role="sent", state="ended", search=RECIPIENT) == ["Letter 3", "Letter 1"]
    assert len(found(dispatcher, search=SENDER)) == 6


def test_a_search_that_no_database_can_store_is_refused(sender: Browser) -> None:
    for path in (ORDERS, "/api/v1/me/contacts"):
        assert sender.get(path, params={"search": "a\0b"}).json()["code"] == "invalid_request"
