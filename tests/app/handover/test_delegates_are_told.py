"""A delegate with a mail address gets a mail of their own: their code as a picture, and a link to that one order."""

import re
from email.message import EmailMessage
from typing import Any

import pytest
from fastapi.testclient import TestClient

from app.core.settings import Settings
from app.models import Notification, NotificationKind, RobotRow
from app.orders.custody.codes import code_png
from tests.app.conftest import RECIPIENT, SENDER, Browser, Mailroom, Mails, SignedIn

PORTER = "porter@campus.example"
OUTSIDE = "porter@elsewhere.example"


def about_mail(mails: Mails, email: str = PORTER) -> list[EmailMessage]:
    return [mail for mail in mails.to(email) if not mail["Message-ID"].startswith("<sign-in")]


def text_of(mail: EmailMessage) -> str:
    body = mail.get_body(("plain",))
    assert body
    return str(body.get_content())


def link_in(mail: EmailMessage) -> dict[str, str]:
    found = re.search(r"https://mail\.campus\.example/one-order\.html#([A-Za-z0-9_-]{43})\b", text_of(mail))
    assert found, text_of(mail)
    return {"token": found[1]}


def name(browser: Browser, order_id: str, email: str | None = PORTER, **wish: str) -> Any:
    return browser.post(f"/api/v1/orders/{order_id}/delegates", json={"name": "The porter", "email": email, **wish})


def code_of(browser: Browser, named: Any) -> dict[str, Any]:
    code: dict[str, Any] = browser.get(named.headers["Location"]).json()
    return code


@pytest.fixture
def order_id(sender: Browser, mailroom: Mailroom) -> str:
    found: str = sender.order(description="A secret gift").json()["id"]
    return found


def test_a_delegate_is_mailed_their_own_code_and_a_link_that_opens_where_it_is_and_nothing_else(
    anonymous: TestClient, sender: Browser, mailroom: Mailroom, mails: Mails, order_id: str
) -> None:
    named = name(sender, order_id)
    mailroom.send_mails()
    (mail,) = about_mail(mails)
    (picture,) = mail.iter_attachments()
    theirs = code_of(sender, named)
    assert picture.get_filename() == "load-code.png"
    assert picture.get_payload(decode=True) == code_png(theirs["text"]), "their own, not the sender's"
    assert theirs["text"] not in mail.as_string()
    assert mail["Subject"] == "You were named for mail from Sender"
    assert "Sender asked you to meet the robot at Post 1" in text_of(mail)
    link = link_in(mail)
    seen = anonymous.post("/api/v1/link/order", json=link).json()
    assert (seen["id"], seen["my_role"], seen["my_code"], seen["state"]) == (order_id, "delegate", None, "queued")
    assert (seen["sender"], seen["recipient"]["email"]) == ({"email": "", "name": "Sender"}, "")
    assert (seen["description"], seen["events"], seen["custody"]) == (None, [], [])
    mailroom.move(order_id, "assigned", "to_sender", "at_sender")
    assert anonymous.post("/api/v1/link/order", json=link).json()["my_code"] == "load"
    assert anonymous.post("/api/v1/link/code", json=link).json()["text"] == theirs["text"]
    for what, more in (("not-now", {}), ("delegate", {"name": "Another"})):
        answer = anonymous.post(f"/api/v1/link/{what}", json={**link, **more})
        assert (answer.status_code, answer.json()["code"]) == (404, "unknown_order"), what


WHERE_IT_IS = {
    *("id", "state", "version", "created_at", "updated_at", "from_post", "to_post", "priority", "estimate", "robot"),
    *("my_role", "sender", "recipient"),
}


def test_why_it_waits_is_not_for_a_delegate_who_is_shown_what_is_listed_and_no_more(
    anonymous: TestClient, sender: Browser, mailroom: Mailroom, mails: Mails, order_id: str
) -> None:
    """A dispatcher's sentence and a robot's own may name anybody."""
    name(sender, order_id)
    mailroom.send_mails()
    (mail,) = about_mail(mails)
    mailroom.call(_says_why, mailroom)
    mailroom.move(order_id, "assigned", "to_sender", "attention", reason="The mailroom holds it back.")
    assert sender.get(f"/api/v1/orders/{order_id}").json()["why"] == "The mailroom holds it back."
    answer = anonymous.post("/api/v1/link/order", json=link_in(mail))
    assert {field for field, shown in answer.json().items() if shown} == WHERE_IT_IS
    assert answer.json()["robot"]["name"] == "r1"
    for hidden in ("holds it back", "wheel", "gift", "@"):
        assert hidden not in answer.text, hidden


async def _says_why(mailroom: Mailroom) -> None:
    async with mailroom.app.state.parts.database.transaction() as session:
        (await session.get_one(RobotRow, "r1")).why = "A person took its wheel."


def test_when_they_are_not_needed_any_more_they_are_told_and_the_link_opens_nothing(
    anonymous: TestClient, sender: Browser, mailroom: Mailroom, mails: Mails, order_id: str
) -> None:
    named = name(sender, order_id)
    mailroom.send_mails()
    path = f"/api/v1/orders/{order_id}/delegates/{named.json()['id']}"
    assert [sender.delete(path).status_code for _ in range(2)] == [204, 204]
    mailroom.send_mails()
    first, over = about_mail(mails)
    refused = anonymous.post("/api/v1/link/order", json=link_in(first))
    assert (refused.status_code, refused.json()["code"]) == (401, "link_refused")
    assert over["Subject"] == "You are not needed any more for mail from Sender"
    assert "http" not in text_of(over), "there is nothing for them to open"
    assert list(over.iter_attachments()) == []
    name(sender, order_id)
    assert anonymous.post("/api/v1/link/order", json=link_in(first)).status_code == 200, "named again"


def test_a_link_is_good_when_the_robot_comes_however_long_before_the_delegate_was_named(
    anonymous: TestClient, sender: Browser, mailroom: Mailroom, mails: Mails
) -> None:
    later_id = sender.order(not_before="2026-01-31T09:00:00Z").json()["id"]
    name(sender, later_id)
    mailroom.send_mails()
    (mail,) = about_mail(mails)
    mailroom.app.state.parts.clock.advance(26.5 * 86400)
    assert anonymous.post("/api/v1/link/order", json=link_in(mail)).json()["my_role"] == "delegate"
    mailroom.app.state.parts.clock.advance(30 * 86400)
    assert anonymous.post("/api/v1/link/order", json=link_in(mail)).status_code == 401, "for ever it is not"


def test_a_code_that_is_taken_back_before_its_mail_is_out_is_not_mailed(
    sender: Browser, mailroom: Mailroom, mails: Mails, order_id: str
) -> None:
    mail = next(channel for channel in mailroom.app.state.parts.outbox_worker.channels if channel.name == "mail")
    whole = mail.code_picture

    def fails_at_first(notice: Notification) -> Any:
        if notice.kind is not NotificationKind.DELEGATED:
            return whole(notice)
        mail.code_picture = whole
        raise OSError("no picture just now")

    mail.code_picture = fails_at_first
    named = name(sender, order_id)
    mailroom.send_mails()
    assert about_mail(mails) == []
    sender.delete(f"/api/v1/orders/{order_id}/delegates/{named.json()['id']}")
    mailroom.app.state.parts.clock.advance(3600)
    mailroom.send_mails()
    assert [one["Subject"] for one in about_mail(mails)] == ["You are not needed any more for mail from Sender"]


def test_a_recipient_without_account_names_a_delegate_by_their_own_link_who_is_mailed_too(
    anonymous: TestClient, sender: Browser, mailroom: Mailroom, mails: Mails, order_id: str
) -> None:
    mailroom.move(order_id, "assigned", "to_sender", "at_sender", "carrying")
    mailroom.send_mails()
    link = link_in(about_mail(mails, RECIPIENT)[0])
    named = anonymous.post("/api/v1/link/delegate", json={**link, "name": "Porter", "email": PORTER})
    mailroom.send_mails()
    (mail,) = about_mail(mails)
    (picture,) = mail.iter_attachments()
    assert picture.get_payload(decode=True) == code_png(named.json()["code"]["text"])
    assert "at Post 4" in text_of(mail)
    seen = anonymous.post("/api/v1/link/order", json=link_in(mail)).json()
    assert (seen["my_role"], seen["my_code"]) == ("delegate", "receive")
    assert anonymous.post("/api/v1/link/order", json=link).json()["my_role"] == "recipient"


def test_a_delegate_with_an_account_has_it_in_their_inbox_in_their_language_and_may_mute_the_mail(
    signed_in: SignedIn, sender: Browser, mailroom: Mailroom, mails: Mails, order_id: str
) -> None:
    porter = signed_in(PORTER)
    porter.patch("/api/v1/me", json={"language": "fr"})
    name(sender, order_id)
    mailroom.send_mails()
    (mail,) = about_mail(mails)
    assert link_in(mail), "the order's page is not theirs, signed in or not"
    assert mail["Subject"] == "On vous a désigné·e pour un envoi de Sender"
    (notice,) = porter.get("/api/v1/notices").json()["items"]
    assert (notice["kind"], notice["title"]) == ("delegated", mail["Subject"])
    porter.put("/api/v1/me/notices", json={"muted": {"mail": [NotificationKind.DELEGATED]}})
    name(sender, order_id)
    mailroom.send_mails()
    assert len(about_mail(mails)) == 1
    assert len(porter.get("/api/v1/notices").json()["items"]) == 2


def test_no_person_outside_the_campus_is_mailed_unless_that_is_allowed_and_without_address_none_is(
    settings: Settings, sender: Browser, mailroom: Mailroom, mails: Mails, order_id: str
) -> None:
    refused = name(sender, order_id, OUTSIDE)
    assert (refused.status_code, refused.json()["code"]) == (422, "address_not_allowed")
    assert sender.get(f"/api/v1/orders/{order_id}/delegates").json()["items"] == []
    assert name(sender, order_id, None).status_code == 201
    mailroom.send_mails()
    assert {mail["To"] for file in [mails.to(OUTSIDE), mails.to(PORTER), mails.to(SENDER)] for mail in file} == {SENDER}
