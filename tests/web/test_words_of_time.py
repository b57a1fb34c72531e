"""Pages and mails say a time in the same words, whatever kind of English or French a browser is set to."""

from datetime import UTC, datetime, timedelta
from zoneinfo import ZoneInfo

import pytest

from app.core.texts.times import clock_time, day_and_time

pytestmark = pytest.mark.browser

ZONE = "America/Toronto"
TIMES = [datetime(2026, month, 3, 5 * month % 24, 7 * month % 60, tzinfo=UTC) for month in range(1, 13)]
SAY = """async ({ language, times, now }) => {
  const [texts, words] = await Promise.all([import("/src/texts/texts.js"), import("/src/texts/times.js")]);
  await texts.loadTexts(language);
  return times.map((at) => [words.clockTime(at), words.dayAndTime(at, Date.parse(now))]);
}"""
ON_DAY = {"en": "{}, {}", "fr": "le {} à {}"}


async def test_a_page_and_a_mail_say_the_same_time(visit):
    ada = await visit("ada.king", signed_in=False, locale="en-GB", timezone_id=ZONE)
    await ada.page.goto("/")
    now = TIMES[0] - timedelta(days=1)
    for language in ("en", "fr"):
        asked = {"language": language, "times": [one.isoformat() for one in TIMES], "now": now.isoformat()}
        local = [one.astimezone(ZoneInfo(ZONE)) for one in TIMES]
        mailed = [(clock_time(language, one), plain(day_and_time(language, one, now))) for one in local]
        shown = [(clock, plain(day)) for clock, day in await ada.page.evaluate(SAY, asked)]
        in_a_sentence = [(clock, ON_DAY[language].format(*day.split(", "))) for clock, day in shown]
        assert mailed == in_a_sentence


def plain(said: str) -> str:
    return said.replace("\u00a0", " ")
