"""Notices reach people once, whatever crashes, in their own language."""

import string
from email.message import EmailMessage

import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient
from sqlalchemy import update
from sqlmodel import col, select

from app.core.mail import Mail, Spool
from app.core.settings import ROOT
from app.core.texts import LANGUAGES, catalogue
from app.models import Notification, NotificationKind, OutgoingNotification
from app.notifications.delivery.attempts import LONGEST_PAUSE_S, pause_s
from protocol.clock import SteppedClock
from tests.app.conftest import SENDER, Browser, Mailroom, Mails

pytestmark = pytest.mark.mailed_codes


def about_the_order(mails: Mails) -> list[EmailMessage]:
    return [mail for mail in mails.to(SENDER) if mail["Message-ID"].startswith("<mail.")]


def test_a_crash_between_sending_and_noting_it_down_sends_nothing_twice(
    app: FastAPI, sender: Browser, mailroom: Mailroom, mails: Mails
) -> None:
    sender.order()
    mailroom.send_mails()
    first = about_the_order(mails)

    async def forget_that_it_was_sent() -> None:
        async with app.state.parts.database.transaction() as session:
            await session.exec(
                update(OutgoingNotification).values(sent_at=None, next_try_at=OutgoingNotification.created_at)
            )

    mailroom.call(forget_that_it_was_sent)
    mailroom.send_mails()
    assert [mail.as_bytes() for mail in about_the_order(mails)] == [first[0].as_bytes()]


def test_what_cannot_be_spooled_is_tried_again_later_and_arrives(
    app: FastAPI, sender: Browser, mailroom: Mailroom, mails: Mails, clock: SteppedClock
) -> None:

    def stuck() -> OutgoingNotification:
        async def look() -> OutgoingNotification:
            async with app.state.parts.database.reading() as session:
                rows = (
                    await session.exec(select(OutgoingNotification).where(col(OutgoingNotification.tries) > 0))
                ).all()
                return list(rows)[-1]

        row: OutgoingNotification = mailroom.call(look)
        return row

    for file in mails.folder.iterdir():
        file.unlink()
    mails.folder.rmdir()
    mails.folder.write_text("a file where the folder should be")
    sender.order()
    mailroom.send_mails()
    assert stuck().sent_at is None
    assert "FileExistsError" in (stuck().problem or "") or "NotADirectory" in (stuck().problem or "")
    assert stuck().tries == 1, "not again before its time"
    mails.folder.unlink()
    clock.advance(pause_s(1))
    mailroom.send_mails()
    assert len(about_the_order(mails)) == 1
    assert stuck().problem is None


def test_a_mail_that_cannot_be_made_holds_up_no_other(
    app: FastAPI, sender: Browser, mailroom: Mailroom, mails: Mails
) -> None:
    mail = next(channel for channel in app.state.parts.outbox_worker.channels if channel.name == "mail")
    broken: list[str | None] = []

    def picture(notice: Notification) -> None:
        broken.extend([] if broken else [notice.order_id])
        if notice.order_id in broken:
            raise ValueError("no picture")

    mail.code_picture = picture
    sender.order()
    mailroom.send_mails()
    sender.order()
    mailroom.send_mails()
    assert len(broken) == 1
    assert len(about_the_order(mails)) == 1


def test_pauses_double_up_to_a_quarter_of_an_hour() -> None:
    assert [pause_s(tries) for tries in (1, 2, 3)] == [5.0, 10.0, 20.0]
    assert pause_s(50) == LONGEST_PAUSE_S


def test_a_mail_says_where_to_follow_the_order(sender: Browser, mailroom: Mailroom, mails: Mails) -> None:
    order_id = sender.order().json()["id"]
    mailroom.send_mails()
    (mail,) = about_the_order(mails)
    assert f"https://mail.campus.example/follow.html?order={order_id}" in mail.get_content()
    assert mail["Auto-Submitted"] == "auto-generated"


def test_reading_a_notice_lowers_the_count_and_only_for_oneself(sender: Browser, recipient: Browser) -> None:
    sender.order()
    notice = sender.get("/api/v1/notices").json()["items"][0]
    recipient.post("/api/v1/notices/read", json={"ids": [notice["id"]]})
    assert sender.get("/api/v1/notices").json()["unread"] == 1
    assert sender.get("/api/v1/me").json()["unread_notices"] == 1
    assert sender.post("/api/v1/notices/read", json={"ids": [notice["id"]]}).status_code == 204
    inbox = sender.get("/api/v1/notices").json()
    assert (inbox["unread"], inbox["items"][0]["read"]) == (0, True)
    assert sender.get("/api/v1/me").json()["unread_notices"] == 0


def test_a_person_who_reads_french_is_told_in_french(anonymous: TestClient, mails: Mails, mailroom: Mailroom) -> None:
    speaks_french = {"Accept-Language": "fr-CA,fr;q=0.9"}
    anonymous.headers.update({"Sec-Fetch-Site": "same-origin", **speaks_french})
    anonymous.post("/api/v1/sign-in/codes", json={"email": SENDER})
    anonymous.post("/api/v1/sign-in", json={"email": SENDER, "code": mails.newest_code(SENDER)})
    wish = {"from_post": "post1", "to_post": "post4", "recipient": "bob@campus.example"}
    anonymous.post("/api/v1/orders", json=wish, headers={"Idempotency-Key": "k"})
    assert anonymous.get("/api/v1/notices").json()["items"][0]["title"].startswith("Commande acceptée")
    mailroom.send_mails()
    assert about_the_order(mails)[0]["Subject"].startswith("Commande acceptée")


def gaps(text: str) -> set[str]:
    return {name for _, name, _, _ in string.Formatter().parse(text) if name}


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_language_has_the_same_texts_with_the_same_gaps(language: str) -> None:
    english, other = catalogue("en"), catalogue(language)
    assert set(other) == set(english)
    assert {key: gaps(text) for key, text in other.items()} == {key: gaps(text) for key, text in english.items()}


def test_the_service_has_no_text_that_it_does_not_use() -> None:
    code = "".join(file.read_text() for file in (ROOT / "app").rglob("*.py"))
    kinds = {f"notice.{kind}.{part}" for kind in NotificationKind for part in ("title", "body")}
    mine = {key for key in catalogue("en") if key.startswith(("email.", "notice."))}
    assert {key for key in mine - kinds if f'"{key}"' not in code} == set()


def test_every_kind_of_notice_has_its_words_and_no_title_has_room_for_a_code() -> None:
    for kind in NotificationKind:
        assert {f"notice.{kind}.title", f"notice.{kind}.body"} <= set(catalogue("en"))
        assert gaps(catalogue("en")[f"notice.{kind}.title"]) <= {
            "from_post",
            "to_post",
            "return_post",
            "sender",
            "robot",
        }


def test_a_mail_is_written_whole_or_not_at_all_and_for_its_owner_alone(tmp_path: object, clock: SteppedClock) -> None:
    folder = tmp_path / "spool"  # type: ignore[operator]
    spool = Spool(folder, "mail@campus.example")
    mail = Mail("a/../b", "ann@campus.example", "Größe", "Text", clock.utc())
    assert spool.send(mail) is True
    assert spool.send(mail) is False
    (file,) = folder.iterdir()
    assert file.name == "a_.._b.eml"
    assert file.stat().st_mode & 0o777 == 0o600
    assert folder.stat().st_mode & 0o777 == 0o700
