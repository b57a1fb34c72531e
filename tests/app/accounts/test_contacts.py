"""The address book: people with whom a person exchanged mail, and contacts that they saved."""

from typing import Any

import pytest

from protocol.clock import SteppedClock
from tests.app.conftest import RECIPIENT, SENDER, Browser

CONTACTS = "/api/v1/me/contacts"


def book(browser: Browser, **question: Any) -> list[dict[str, Any]]:
    items: list[dict[str, Any]] = browser.get(CONTACTS, params=question).json()["items"]
    return items


def emails(browser: Browser, **question: Any) -> list[str]:
    return [one["email"] for one in book(browser, **question)]


def test_whom_one_exchanged_mail_with_comes_first_and_newest_first(
    sender: Browser, recipient: Browser, clock: SteppedClock
) -> None:
    assert book(sender) == []
    for to in (RECIPIENT, "zoe@campus.example", RECIPIENT, "ann@campus.example"):
        clock.advance(60)
        sender.order(recipient=to)
    sender.put(f"{CONTACTS}/bob@campus.example", json={"label": "Bob, printing"})
    met = ["ann@campus.example", RECIPIENT, "zoe@campus.example"]
    assert emails(sender) == [*met, "bob@campus.example"]
    assert emails(sender, limit=2) == met[:2]
    assert book(sender)[0]["last_mail_at"] > book(sender)[1]["last_mail_at"]
    assert emails(recipient) == [SENDER], "whom one only received from counts too, and no other person's contacts do"


@pytest.mark.parametrize("limit", [1, 2, 3, 100])
@pytest.mark.slow
def test_a_long_address_book_comes_page_by_page_and_everybody_in_it_once(
    sender: Browser, clock: SteppedClock, limit: int
) -> None:
    met = [f"{name}@campus.example" for name in ("ann", "bob", "cy")]
    for to in (*met, SENDER):
        sender.order(recipient=to)  # all at one moment: the address tells them apart
    for email in ("bob@campus.example", "dee@campus.example", "eve@campus.example", "fay@campus.example", SENDER):
        sender.put(f"{CONTACTS}/{email}", json={"label": "Same"})
    pages, answer = [], sender.get(CONTACTS, params={"limit": limit})
    while "next" in answer.links:
        pages.append([one["email"] for one in answer.json()["items"]])
        clock.advance(1)
        answer = sender.get(answer.links["next"]["url"])
    pages.append([one["email"] for one in answer.json()["items"]])
    saved = [f"{name}@campus.example" for name in ("dee", "eve", "fay", "sender")]
    assert [email for page in pages for email in page] == [*reversed(met), *saved]
    assert {len(page) for page in pages[:-1]} <= {limit}
    assert answer.json()["next"] is None


def test_the_next_page_of_what_was_searched_for_is_searched_for_too_and_a_cursor_is_given_out_or_refused(
    sender: Browser,
) -> None:
    for name in ("ann", "bob", "ann.two", "ann.three"):
        sender.put(f"{CONTACTS}/{name}@campus.example", json={"label": name})
    first = sender.get(CONTACTS, params={"search": "ann", "limit": 2})
    second = sender.get(first.links["next"]["url"])
    found = [one["email"].partition("@")[0] for one in first.json()["items"] + second.json()["items"]]
    assert sorted(found) == ["ann", "ann.three", "ann.two"]
    assert sender.get(CONTACTS, params={"cursor": "made up"}).json()["code"] == "bad_cursor"


def test_a_contact_is_saved_with_a_label_and_a_post_found_by_them_and_forgotten(
    sender: Browser, recipient: Browser
) -> None:
    sender.order()
    recipient.patch("/api/v1/me", json={"usual_post": "post3"})
    assert (book(sender)[0]["post"], book(sender)[0]["saved"]) == ("post3", False), "where they usually are"
    saved = sender.put(f"{CONTACTS}/{RECIPIENT.upper()}", json={"label": "Aunt Ada", "post": "post2"})
    assert (saved.status_code, saved.json()["email"]) == (200, RECIPIENT)
    (known,) = book(sender, search="aunt")
    assert (known["email"], known["label"], known["post"], known["saved"]) == (RECIPIENT, "Aunt Ada", "post2", True)
    assert emails(sender, search="nobody") == []
    assert book(recipient)[0]["label"] == "", "a label is shown to its author alone"
    unknown = sender.put(f"{CONTACTS}/{RECIPIENT}", json={"post": "post99"})
    assert (unknown.status_code, unknown.json()["code"]) == (422, "unknown_post")
    assert sender.delete(f"{CONTACTS}/{RECIPIENT}").status_code == 204
    assert sender.delete(f"{CONTACTS}/{RECIPIENT}").json()["code"] == "unknown_contact"
    assert emails(sender) == [RECIPIENT], "the mail was exchanged all the same"
