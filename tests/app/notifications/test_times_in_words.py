"""Times in notices: the words of the reader's language, by the campus's clock, with a day where it is another one."""

from datetime import UTC, datetime, timedelta
from email import message_from_bytes, policy
from zoneinfo import ZoneInfo

import pytest

from app.core.settings import Settings
from app.core.texts.times import as_fact, clock_time
from app.models import Notification, NotificationKind
from app.notifications.wording import body_of
from app.orders.views.schemas import NewOrder
from protocol.clock import SteppedClock
from tests.app.conftest import RECIPIENT, SENDER
from tests.app.notifications.office import running
from tests.app.placed import placed

TORONTO = ZoneInfo("America/Toronto")
AT = datetime(2026, 11, 22, 18, 57, tzinfo=UTC)
ENDS = AT + timedelta(minutes=7)
PEOPLE = {"sender": "Ada", "recipient": "Ben", "from_post": "Post 1", "to_post": "Post 4"}


def told(language: str, window_from: str, window_to: str, at: datetime = AT) -> str:
    facts = {**PEOPLE, "window_from": window_from, "window_to": window_to}
    body = body_of(Notification(key="k", kind=NotificationKind.DELAYED, person_id="p", at=at, facts=facts), language)
    return body.replace("\u00a0", " ")


@pytest.mark.parametrize(
    ("language", "days", "words"),
    [
        ("en", 0, "between 1:57 p.m. and 2:04 p.m. (estimated)"),
        ("fr", 0, "entre 13 h 57 et 14 h 04 (estimation)"),
        ("en", 1, "between Nov 22, 1:57 p.m. and 2:04 p.m. (estimated)"),
        ("fr", 1, "entre le 22 nov. à 13 h 57 et 14 h 04 (estimation)"),
    ],
)
def test_a_window_is_said_as_people_write_it_with_its_day_once_if_that_is_another(
    language: str, days: int, words: str
) -> None:
    window = as_fact(AT, TORONTO), as_fact(ENDS, TORONTO)
    assert words in told(language, *window, at=AT - timedelta(days=days))


def test_a_day_begins_at_the_midnight_of_the_campus() -> None:
    late = datetime(2026, 11, 23, 3, 0, tzinfo=UTC)
    window = as_fact(late, TORONTO), as_fact(late + timedelta(hours=2, minutes=1), TORONTO)
    assert "between 10:00 p.m. and Nov 23, 12:01 a.m." in told("en", *window)


def test_a_time_is_never_broken_at_the_end_of_a_line() -> None:
    assert [clock_time(one, AT) for one in ("en", "fr")] == ["6:57\u00a0p.m.", "18\u00a0h\u00a057"]


def test_what_was_written_in_words_by_an_older_service_is_told_as_it_was_written() -> None:
    assert "between 13:57 and ? (estimated)" in told("en", "13:57", "?")


async def test_an_order_for_tomorrow_is_accepted_by_mail_with_the_day_and_by_the_clock_of_the_campus(
    settings: Settings, clock: SteppedClock
) -> None:
    tomorrow = clock.utc() + timedelta(days=1)
    async with running(settings.model_copy(update={"time_zone": "America/Toronto"}), clock) as office:
        sender = await office.person(SENDER, language="fr")
        async with office.state.database.transaction() as session:
            wish = NewOrder(from_post="post1", to_post="post4", recipient=RECIPIENT, not_before=tomorrow)
            await placed(office.state.orders, session, sender, wish)
        await office.settle()
        (mail,) = office.state.settings.spool_folder.glob("mail.*.accepted.*.eml")
    body = message_from_bytes(mail.read_bytes(), policy=policy.default).get_content().replace("\u00a0", " ")
    local = tomorrow.astimezone(TORONTO)
    assert f"entre le {local.day} janv. à {local.hour} h " in body
