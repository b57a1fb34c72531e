"""A recipient without account follows their one order by the link in their mail, and opens nothing else with it."""

import re
from collections.abc import Iterator
from contextlib import contextmanager
from email.message import EmailMessage
from typing import Any

import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient
from sqlalchemy import Engine, event

from app.core.settings import Settings
from app.models import Person
from protocol.clock import SteppedClock
from tests.app.conftest import RECIPIENT, SENDER, Browser, Mailroom, Mails, SignedIn

OUTSIDE = "guest@elsewhere.example"
ORDER = "/api/v1/link/order"


@pytest.fixture
def settings(settings: Settings) -> Settings:
    return settings.model_copy(update={"allow_outside_recipients": True})


def link_in(mail: EmailMessage) -> str:
    body = mail.get_body(("plain",))
    assert body
    found = re.search(r"https://mail\.campus\.example/one-order\.html#([A-Za-z0-9_-]{43})\b", body.get_content())
    assert found, body.get_content()
    return found[1]


def on_its_way(sender: Browser, mailroom: Mailroom, to: str) -> str:
    """An order whose mail is aboard: its recipient has been told."""
    order_id: str = sender.order(recipient=to).json()["id"]
    mailroom.move(order_id, "assigned", "to_sender", "at_sender", "carrying")
    mailroom.send_mails()
    return order_id


def said(answer: Any) -> tuple[int, str]:
    return answer.status_code, answer.json()["code"]


def test_the_mail_to_a_person_outside_holds_a_link_to_their_order(
    anonymous: TestClient, sender: Browser, mailroom: Mailroom, mails: Mails
) -> None:
    order_id = on_its_way(sender, mailroom, OUTSIDE)
    token = link_in(mails.to(OUTSIDE)[0])
    opened = anonymous.post(ORDER, json={"token": token})
    assert opened.status_code == 200
    assert (opened.json()["id"], opened.json()["my_role"]) == (order_id, "recipient")
    assert anonymous.get("/api/v1/orders", headers={"Authorization": f"Bearer {token}"}).status_code == 401
    assert anonymous.get("/api/v1/orders", headers={"Cookie": f"session={token}"}).status_code == 401


def test_each_order_has_its_own_link_and_every_mail_about_it_the_same(
    sender: Browser, mailroom: Mailroom, mails: Mails
) -> None:
    first = on_its_way(sender, mailroom, OUTSIDE)
    mailroom.move(first, "at_recipient")
    mailroom.send_mails()
    again = on_its_way(sender, mailroom, OUTSIDE)
    links = [link_in(mail) for mail in mails.to(OUTSIDE)]
    assert (first != again, len(links), len(set(links))) == (True, 3, 2)


def test_a_wrong_or_old_link_opens_nothing(
    anonymous: TestClient, sender: Browser, mailroom: Mailroom, mails: Mails, clock: SteppedClock
) -> None:
    on_its_way(sender, mailroom, OUTSIDE)
    token = link_in(mails.to(OUTSIDE)[0])
    assert said(anonymous.post(ORDER, json={"token": "A" * 43})) == (401, "link_refused")
    assert anonymous.post(ORDER, json={"token": token[:-1]}).status_code == 422
    assert anonymous.get(ORDER, params={"token": token}).status_code == 405, (
        "it acts by POST alone: scanners open links"
    )
    clock.advance(14 * 86400)
    assert said(anonymous.post(ORDER, json={"token": token})) == (401, "link_refused")


def test_another_site_cannot_use_a_link_and_neither_does_plain_http(app: FastAPI, anonymous: TestClient) -> None:
    wish = {"token": "A" * 43}
    assert said(anonymous.post(ORDER, json=wish, headers={"Origin": "https://evil.example"})) == (403, "cross_site")
    remote = TestClient(app, base_url="http://mail.campus.example")
    remote.portal = anonymous.portal
    assert said(remote.post(ORDER, json=wish)) == (403, "https_required")


def test_a_recipient_with_an_account_signs_in_and_gets_no_link(
    signed_in: SignedIn, sender: Browser, mailroom: Mailroom, mails: Mails
) -> None:
    signed_in(RECIPIENT)
    on_its_way(sender, mailroom, RECIPIENT)
    (mail,) = [mail for mail in mails.to(RECIPIENT) if not mail["Message-ID"].startswith("<sign-in")]
    body = mail.get_body(("plain",))
    assert body
    assert "one-order.html" not in body.get_content()
    assert "follow.html" in body.get_content()


def test_a_person_outside_can_be_sent_mail_and_still_not_sign_in(anonymous: TestClient, sender: Browser) -> None:
    assert sender.order(recipient=OUTSIDE).status_code == 201
    assert said(anonymous.post("/api/v1/sign-in/codes", json={"email": OUTSIDE})) == (422, "address_not_allowed")


def test_by_the_link_a_guest_gets_their_code_names_a_delegate_and_says_not_now(
    anonymous: TestClient, sender: Browser, mailroom: Mailroom, mails: Mails
) -> None:
    order_id = on_its_way(sender, mailroom, OUTSIDE)
    link = {"token": link_in(mails.to(OUTSIDE)[0])}

    def act(what: str, **wish: str) -> Any:
        return anonymous.post(f"/api/v1/link/{what}", json={**link, **wish})

    code = act("code")
    assert code.headers["Cache-Control"] == "no-store"
    assert (code.json()["purpose"], len(code.json()["digits"]), "<svg" in code.json()["svg"]) == ("receive", 6, True)
    named = act("delegate", name="Porter")
    assert (named.status_code, named.json()["delegate"]["name"]) == (201, "Porter")
    assert named.json()["code"]["text"] != code.json()["text"], "a code of their own"
    assert said(act("handover")) == (409, "robot_not_there")
    gone_back = act("not-now")
    assert (gone_back.status_code, gone_back.json()["return_requested"]) == (200, True)
    assert sender.get(f"/api/v1/orders/{order_id}").json()["return_requested"] is True


def test_wrong_digits_by_a_link_count_as_anybodys(
    anonymous: TestClient, sender: Browser, mailroom: Mailroom, mails: Mails
) -> None:
    order_id = on_its_way(sender, mailroom, OUTSIDE)
    mailroom.move(order_id, "at_recipient")
    link = {"token": link_in(mails.to(OUTSIDE)[0])}
    right = anonymous.post("/api/v1/link/code", json=link).json()["digits"]
    wrong = f"{(int(right) + 1) % 10**6:06d}"
    tries = [anonymous.post("/api/v1/link/handover", json={**link, "digits": wrong}) for _ in range(5)]
    assert [said(one)[1] for one in tries] == ["wrong_digits"] * 4 + ["digits_locked"]
    assert anonymous.post("/api/v1/link/code", json=link).json()["digits_locked"] is True


LINKED = {"outside": True, "porter": True, SENDER: False, "signed in": False, "stranger": False, "let go": False}


def test_whether_a_person_needs_a_link_is_one_question(
    app: FastAPI, signed_in: SignedIn, sender: Browser, mailroom: Mailroom
) -> None:
    """For each mail there is; only what is not there yet, or too old, is written besides."""
    order_id = sender.order(recipient="outside@elsewhere.example").json()["id"]
    to_a_member = sender.order(recipient=RECIPIENT).json()["id"]
    signed_in(RECIPIENT)
    for name in ("porter", "let go"):
        wish = {"name": name, "email": f"{name.replace(' ', '-')}@elsewhere.example"}
        named = sender.post(f"/api/v1/orders/{order_id}/delegates", json=wish)
        if name == "let go":
            assert sender.delete(named.headers["Location"].removesuffix("/code")).status_code == 204
    mailroom.send_mails()  # whose writer asks the same
    emails = {"signed in": RECIPIENT, SENDER: SENDER}
    got: dict[str, tuple[bool, int]] = {}
    for who in LINKED:
        email = emails.get(who, f"{who.replace(' ', '-')}@elsewhere.example")
        person = mailroom.call(_person, app, email)
        about = to_a_member if who == "signed in" else order_id
        first = mailroom.call(app.state.parts.links.url_for, person, about)
        with questions() as asked:
            again = mailroom.call(app.state.parts.links.url_for, person, about)
        assert again == first
        got[who] = (again is not None, len(asked))
    assert got == {who: (is_linked, 1) for who, is_linked in LINKED.items()}
    assert mailroom.call(app.state.parts.links.url_for, person, "no such order") is None


async def _person(app: FastAPI, email: str) -> Person:
    async with app.state.parts.database.transaction() as session:
        person: Person = await app.state.parts.sign_in_service.person(session, email, app.state.parts.clock.utc())
        return person


@contextmanager
def questions() -> Iterator[list[str]]:
    """About links, in this time: what else the service asks meanwhile does not count."""
    asked: list[str] = []

    def note(_connection: Any, _cursor: Any, statement: str, *_: Any) -> None:
        if any(table in statement for table in ("order_links", "delegates", "identities", "sessions")):
            asked.append(statement)

    event.listen(Engine, "before_cursor_execute", note)
    try:
        yield asked
    finally:
        event.remove(Engine, "before_cursor_execute", note)
