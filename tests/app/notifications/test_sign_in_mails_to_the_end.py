"""A sign-in mail is tried for as long as its code is good, and not longer."""

import asyncio
from datetime import UTC, datetime
from itertools import accumulate, takewhile
from pathlib import Path

from app.core.mail.message import Mail
from app.core.mail.smtp import SmtpServer
from app.core.mail.soon import SentSoon, pauses_s
from app.core.mail.spool import Spool
from app.core.settings import Settings
from tests.app.notifications.test_killed_while_sending import free_port

MAIL = Mail("k1", "ada@campus.example", "Your code", "12345678", datetime(2026, 11, 25, 9, tzinfo=UTC))


def test_the_last_try_is_in_the_last_minute_in_which_the_code_is_good() -> None:
    lifetime_s = Settings().sign_in_code_lifetime_s
    tries_s = list(takewhile(lambda at_s: at_s < lifetime_s, accumulate(pauses_s())))
    assert lifetime_s - 60.0 <= tries_s[-1]
    assert tries_s[:3] == [0.0, 5.0, 25.0]


async def test_a_mail_whose_code_is_no_good_any_more_is_given_up(tmp_path: Path) -> None:
    waiting = Spool(tmp_path, "mail@campus.example")
    nowhere = SmtpServer.of(Settings(smtp_host="127.0.0.1", smtp_port=free_port()))
    soon = SentSoon(nowhere, waiting, lifetime_s=0.2)
    await soon.send(MAIL)
    assert len(list(waiting.files())) == 1
    async with asyncio.timeout(5):
        while list(waiting.files()):  # noqa: ASYNC110  # it rings no bell
            await asyncio.sleep(0.02)
    assert await soon.finish(1.0) == 0
