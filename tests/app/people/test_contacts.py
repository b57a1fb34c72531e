"""The address book: whom somebody exchanged mail with, and whom they saved."""

from typing import Any

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
    assert emails(recipient) == [SENDER], "whom one only received from counts too, and nobody else's contacts do"


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
    assert book(recipient)[0]["label"] == "", "a label is nobody else's business"
    unknown = sender.put(f"{CONTACTS}/{RECIPIENT}", json={"post": "post99"})
    assert (unknown.status_code, unknown.json()["code"]) == (422, "unknown_post")
    assert sender.delete(f"{CONTACTS}/{RECIPIENT}").status_code == 204
    assert sender.delete(f"{CONTACTS}/{RECIPIENT}").json()["code"] == "unknown_contact"
    assert emails(sender) == [RECIPIENT], "the mail was exchanged all the same"
