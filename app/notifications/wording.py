"""A notice in words, the same on every channel."""

from collections.abc import Iterator, Mapping
from typing import Final

from app.core.texts import text
from app.core.texts.reasons import in_words
from app.core.texts.times import day_and_time, of_fact
from app.models import Notification, NotificationKind

TIMES: Final = ("window_from", "window_to")
WITHOUT_TIME: Final[Mapping[NotificationKind, str]] = {
    NotificationKind.ACCEPTED: "notice.accepted.body_no_time",
    NotificationKind.ON_ITS_WAY: "notice.on_its_way.body_no_time",
    NotificationKind.DELAYED: "notice.delayed.body_no_time",
}
"""What is told while no time of arrival is known."""


def title_of(notice: Notification, language: str) -> str:
    """Never holds a hand-over code: a phone shows it on its locked screen."""
    return text(language, f"notice.{notice.kind}.title", notice.facts)


def body_of(notice: Notification, language: str) -> str:
    times = dict(_times(notice, language))
    key = f"notice.{notice.kind}.body"
    if not all(name in notice.facts for name in TIMES):
        key = WITHOUT_TIME.get(notice.kind, key)
    return text(language, key, {**in_words(language, notice.facts), **times})


def _times(notice: Notification, language: str) -> Iterator[tuple[str, str]]:
    """Each with its day, unless that is the day of which one reads already."""
    day = notice.at
    for name in TIMES:
        if at := of_fact(notice.facts.get(name, "")):
            yield name, day_and_time(language, at, day)
            day = at
