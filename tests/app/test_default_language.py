"""The language of people who have chosen none."""

import pytest

from app.core.settings import Settings
from app.core.texts import text
from tests.app.conftest import RECIPIENT, SENDER, Browser, Mailroom, Mails

pytestmark = pytest.mark.mailed_codes


@pytest.fixture
def settings(settings: Settings) -> Settings:
    return settings.model_copy(update={"default_language": "fr"})


def test_mails_and_pages_are_in_the_language_of_the_campus_until_a_person_chooses(
    sender: Browser, mails: Mails
) -> None:
    assert sender.get("/api/v1/me").json()["language"] == "fr"
    [first] = mails.to(SENDER)
    assert first["Subject"] == text("fr", "email.sign_in.title")
    assert sender.patch("/api/v1/me", json={"language": "en"}).json()["language"] == "en"


def test_mail_to_a_recipient_who_was_never_here_is_in_the_language_of_the_campus(
    sender: Browser, mails: Mails, mailroom: Mailroom
) -> None:
    order_id = sender.order().json()["id"]
    mailroom.move(order_id, "assigned", "to_sender", "at_sender", "carrying")
    mailroom.send_mails()
    [told] = mails.to(RECIPIENT)
    assert told["Subject"] == text("fr", "notice.on_its_way.title", {"sender": sender.get("/api/v1/me").json()["name"]})
