"""Times in words, as the pages write them: both go by the locale that the catalogue of a language names.

A mail does not know which kind of English or French its reader's phone is set to, and a page must not say 1:57 p.m.
where the mail said 13:57.
"""

from datetime import datetime, time, tzinfo
from functools import cache
from typing import Final

from babel import Locale
from babel.dates import format_skeleton, format_time

from app.core.texts import text

THIN_SPACE: Final = "\u202f"
NO_BREAK_SPACE: Final = "\u00a0"


def locale_of(language: str) -> Locale:
    return Locale.parse(text(language, "time.locale"), sep="-")


def clock_time(language: str, at: datetime) -> str:
    """As "1:57 p.m." or "13 h 57", by the clock of the zone that `at` is in; never broken at the end of a line."""
    return _clock_time(language, at.hour, at.minute)


@cache
def _clock_time(language: str, hour: int, minute: int) -> str:
    """Kept, since each mail tells times, and babel takes a tenth of a millisecond for one."""
    locale = locale_of(language)
    pattern = locale.time_formats["short"].pattern.replace("HH", "H")  # 9 h 05, as the pages' `hour: "numeric"`
    said = format_time(time(hour, minute), pattern, locale=locale)
    return said.replace(THIN_SPACE, NO_BREAK_SPACE).replace(" ", NO_BREAK_SPACE)


def day_and_time(language: str, at: datetime, now: datetime) -> str:
    """As "Nov 23, 1:57 p.m.", "le 23 nov. à 13 h 57" in a sentence; on the day of `now` the time alone."""
    said = clock_time(language, at)
    if at.date() == now.astimezone(at.tzinfo).date():
        return said
    day = format_skeleton("MMMd", at, tzinfo=at.tzinfo, locale=locale_of(language))
    return text(language, "notice.on_day", {"day": day.replace(" ", NO_BREAK_SPACE), "time": said})


def as_fact(at: datetime, zone: tzinfo | None) -> str:
    """Return a time as the facts of a notice have it, which is worded when it is read: with its zone's distance from
    UTC."""
    return at.astimezone(zone).isoformat(timespec="minutes")


def of_fact(fact: str) -> datetime | None:
    """None for what holds no time: there is none to be told, or the notice is of an older service that wrote words."""
    try:
        return datetime.fromisoformat(fact)
    except ValueError:
        return None
