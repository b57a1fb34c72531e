"""The spool: many mails at once, each whole, and one that cannot be written is no other's concern."""

import asyncio
import os
import time
from email.message import EmailMessage
from email.policy import SMTP
from email.utils import format_datetime
from pathlib import Path

import pytest
from fastapi.testclient import TestClient

from app.composition import create_app
from app.core.mail import Mail, NotMailed, Spool, SpoolMailer
from app.core.mail.message import message_of
from app.core.settings import Settings
from protocol.clock import SteppedClock

FROM = "Campus Mail <mail@campus.example>"


def mail(key: str, clock: SteppedClock, subject: str = "Für Zoë: “post” → Bücherei") -> Mail:
    return Mail(key, "ann@campus.example", subject, "Größe\n", clock.utc())


def mails_in(folder: Path) -> set[str]:
    """And nothing unfinished."""
    assert not [file for file in folder.glob("*.tmp") if file.is_file()]
    return {file.name for file in folder.glob("*.eml")}


async def test_one_that_cannot_be_written_holds_up_none_of_its_batch(tmp_path: Path, clock: SteppedClock) -> None:
    (tmp_path / "b.eml.tmp").mkdir()
    mailer = SpoolMailer(Spool(tmp_path, FROM))
    outcomes = await asyncio.gather(*(mailer.send(mail(key, clock)) for key in "abc"), return_exceptions=True)
    assert [type(one) for one in outcomes] == [type(None), NotMailed, type(None)]
    assert "IsADirectoryError" in str(outcomes[1])
    assert mails_in(tmp_path) == {"a.eml", "c.eml"}


async def test_what_comes_while_a_batch_is_written_is_the_next(tmp_path: Path, clock: SteppedClock) -> None:
    mailer = SpoolMailer(Spool(tmp_path / "made" / "by it", FROM))
    first = asyncio.create_task(mailer.send(mail("first", clock)))
    await asyncio.sleep(0)
    await asyncio.gather(*(mailer.send(mail(f"then{number}", clock)) for number in range(40)))
    assert first.done()
    assert len(mails_in(tmp_path / "made" / "by it")) == 41


async def test_a_caller_that_waits_no_longer_stops_no_other_mail(tmp_path: Path, clock: SteppedClock) -> None:
    mailer = SpoolMailer(Spool(tmp_path, FROM))
    impatient = asyncio.create_task(mailer.send(mail("impatient", clock)))
    patient = asyncio.create_task(mailer.send(mail("patient", clock)))
    await asyncio.sleep(0)
    impatient.cancel()
    await patient
    await mailer.send(mail("later", clock))
    assert {"patient.eml", "later.eml"} <= mails_in(tmp_path)


async def test_a_second_time_changes_nothing(tmp_path: Path, clock: SteppedClock) -> None:
    mailer = SpoolMailer(Spool(tmp_path, FROM))
    await mailer.send(mail("a", clock))
    written = (tmp_path / "a.eml").stat()
    await mailer.send(mail("a", clock, "Another"))
    assert (tmp_path / "a.eml").stat() == written


@pytest.mark.parametrize("subject", ["Plain", "Für Zoë → Bücherei", "word " * 60, "é" * 200])
def test_headers_that_are_remembered_are_those_of_the_standard_library(clock: SteppedClock, subject: str) -> None:
    by_the_book = EmailMessage()
    by_the_book["From"], by_the_book["To"] = FROM, "ann@campus.example"
    by_the_book["Subject"], by_the_book["Date"] = subject.strip(), format_datetime(clock.utc())
    by_the_book["Message-ID"], by_the_book["Auto-Submitted"] = "<a@campus.example>", "auto-generated"
    by_the_book.set_content("Größe\n")
    for _ in range(3):
        assert message_of(mail("a", clock, subject), FROM).as_bytes() == by_the_book.as_bytes(policy=SMTP)


@pytest.mark.parametrize("address", ["ann@campus.example\nBcc: all@campus.example", "ann@campus.example\r\nX: y"])
def test_an_address_with_a_line_of_its_own_is_refused_each_time(clock: SteppedClock, address: str) -> None:
    for _ in range(2):
        with pytest.raises(ValueError, match="linefeed"):
            message_of(Mail("a", address, "Subject", "Text", clock.utc()), FROM)


def test_what_a_kill_left_half_written_is_gone_after_the_next_start_and_nothing_else(
    settings: Settings, clock: SteppedClock
) -> None:
    folder = settings.spool_folder
    folder.mkdir(parents=True)
    names = ("mail.o1.accepted.p1.eml.tmp", "mail.o1.accepted.p1.eml", "notes.tmp", "a b.eml.tmp", "young.eml.tmp")
    for name in names:
        (folder / name).write_text("To: ada")
        hours = 0.5 if name.startswith("young") else 2.0
        os.utime(folder / name, (0, time.time() - hours * 3600))
    (folder / "folder.eml.tmp").mkdir()
    with TestClient(create_app(settings, clock)):
        assert {file.name for file in folder.iterdir()} == {*names[1:], "folder.eml.tmp"}
