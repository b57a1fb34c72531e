"""Mail through a real mail server: encrypted, signed in, tried again when that helps, given up when it does not."""

from collections.abc import AsyncIterator
from pathlib import Path

import pytest
from pydantic import SecretStr

from app.core.errors import StartError
from app.core.settings import Settings, load_settings
from app.notifications.delivery.attempts import pause_s
from protocol.clock import SteppedClock
from tests.app.conftest import RECIPIENT, SENDER
from tests.app.notifications.office import running
from tests.app.notifications.receivers import PASSWORD, USER, MailServer, certificate

DAY_S = 86_400


@pytest.fixture
async def server(tmp_path: Path) -> AsyncIterator[MailServer]:
    _, tls = certificate(tmp_path)
    async with MailServer(tls).listening() as server:
        yield server


@pytest.fixture
def smtp(settings: Settings, tmp_path: Path, server: MailServer) -> Settings:
    return settings.model_copy(
        update={
            "smtp_host": "127.0.0.1",
            "smtp_port": server.port,
            "smtp_user": USER,
            "smtp_password": SecretStr(PASSWORD),
            "smtp_ca_file": tmp_path / "server.pem",
            "smtp_timeout_s": 5.0,
        }
    )


async def test_a_notice_goes_out_encrypted_and_signed_in_with_its_code(
    smtp: Settings, server: MailServer, clock: SteppedClock
) -> None:
    async with running(smtp, clock) as office:
        order_id = await office.order()
        await office.move(order_id, "assigned", "to_sender", "at_sender")
        await office.settle()
    kinds = {mail["Message-ID"].split(".")[2]: mail for mail in server.taken}
    assert set(kinds) == {"accepted", "robot_near", "robot_here"}
    accepted, here = kinds["accepted"], kinds["robot_here"]
    assert accepted["To"] == here["To"] == SENDER
    assert accepted["Message-ID"].startswith(f"<mail.{order_id}.accepted.")
    assert accepted["Auto-Submitted"] == "auto-generated"
    assert [part.get_filename() for part in here.iter_attachments()] == ["load-code.png"]
    assert "CM1:" not in here.as_string(), "only in the picture"
    assert not smtp.spool_folder.exists()


async def test_a_server_that_is_encrypted_from_the_first_byte_is_spoken_to_as_well(
    smtp: Settings, tmp_path: Path, clock: SteppedClock
) -> None:
    _, tls = certificate(tmp_path)
    async with MailServer(tls, at_once=True).listening() as server:
        known = {"smtp_tls": "tls", "smtp_port": server.port}
        async with running(smtp.model_copy(update=known), clock) as office:
            await office.order()
            await office.settle()
            assert (await office.sending("mail")).problem is None
        assert len(server.taken) == 1


async def test_a_full_mailbox_is_tried_again_and_an_unknown_one_given_up(
    smtp: Settings, server: MailServer, clock: SteppedClock
) -> None:
    server.says = ["452 the mailbox is full"]
    async with running(smtp, clock) as office:
        await office.order()
        await office.settle()
        waiting = await office.sending("mail")
        assert (waiting.sent_at, waiting.gave_up_at, waiting.tries) == (None, None, 1)
        assert waiting.problem == "452 the mailbox is full"
        await office.settle()
        assert server.tries == 1, "not before its time"
        clock.advance(pause_s(1))
        await office.settle()
        sent = await office.sending("mail")
        assert sent.sent_at and sent.problem is None
        assert len(server.taken) == 1

        server.says = ["550 nobody of this name"]
        await office.order()
        await office.settle()
        given_up = (await office.sendings("mail"))[1]
        assert given_up.gave_up_at and given_up.tries == 1
        assert given_up.problem == "550 nobody of this name"
        clock.advance(DAY_S)
        await office.settle()
        assert (await office.sendings("mail"))[1].tries == 1


@pytest.mark.parametrize(("cut", "copies"), [("in data", 1), ("after data", 2)])
async def test_a_connection_that_is_cut_loses_no_mail_and_a_second_copy_shows_that_it_is_one(
    smtp: Settings, server: MailServer, clock: SteppedClock, cut: str, copies: int
) -> None:
    server.cuts = [cut]
    async with running(smtp, clock) as office:
        await office.order()
        await office.settle()
        assert not (await office.sending("mail")).sent_at
        clock.advance(pause_s(1))
        await office.settle()
        assert (await office.sending("mail")).sent_at
    assert len(server.taken) == copies
    assert len({mail["Message-ID"] for mail in server.taken}) == 1, "by this a mailbox keeps one of them"
    assert len({mail.as_bytes().split(b"boundary")[0] for mail in server.taken}) == 1


async def test_a_wrong_password_is_the_servers_concern_and_loses_no_mail(
    smtp: Settings, server: MailServer, clock: SteppedClock
) -> None:
    wrong = smtp.model_copy(update={"smtp_password": SecretStr("another")})
    async with running(wrong, clock) as office:
        await office.order()
        await office.settle()
        waiting = await office.sending("mail")
        assert waiting.gave_up_at is None
        assert "535" in (waiting.problem or "") and "another" not in (waiting.problem or "")
    clock.advance(pause_s(1))
    async with running(smtp, clock) as office:
        await office.settle()
    assert len(server.taken) == 1


async def test_a_server_that_proves_nothing_is_sent_nothing(
    smtp: Settings, server: MailServer, clock: SteppedClock
) -> None:
    async with running(smtp.model_copy(update={"smtp_ca_file": None}), clock) as office:
        await office.order()
        await office.settle()
        problem = (await office.sending("mail")).problem or ""
    assert "certificate" in problem.lower()
    assert server.tries == 0


async def test_mail_that_is_refused_for_a_day_is_given_up(
    smtp: Settings, server: MailServer, clock: SteppedClock
) -> None:
    server.says = ["451 later"] * 20
    async with running(smtp, clock) as office:
        await office.order()
        for _ in range(3):
            await office.settle()
            clock.advance(DAY_S / 2)
        await office.settle()
        # It is not fetched either, of which its sender is told meanwhile.
        given_up = (await office.sendings("mail"))[0]
        assert given_up.gave_up_at and given_up.tries == 3


async def test_a_sign_in_code_goes_by_the_server_too_and_no_request_waits_for_it(
    smtp: Settings, server: MailServer, clock: SteppedClock
) -> None:
    server.hangs = True
    async with running(smtp, clock) as office:
        desk = office.state.sign_in_service
        async with office.state.database.transaction() as session:
            row, code = await desk.make_code(session, RECIPIENT, clock.utc())
        await desk.mail_code(row, code, "fr")
        assert not server.taken
        server.hangs = False
        while not server.taken:
            await office.settle()
    (mail,) = server.taken
    assert code in mail.get_content()
    assert mail["Subject"] == "Votre code de connexion à Campus Mail"


def test_a_password_does_not_travel_in_the_open(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    (tmp_path / "campus_mail_smtp_password").write_text("keep it quiet")
    monkeypatch.setenv("CAMPUS_MAIL_SECRETS_DIR", str(tmp_path))
    monkeypatch.setenv("CAMPUS_MAIL_SMTP_HOST", "mail.campus.example")
    monkeypatch.setenv("CAMPUS_MAIL_SMTP_TLS", "none")
    with pytest.raises(StartError, match="another machine") as refused:
        load_settings()
    assert "keep it quiet" not in str(refused.value)
    monkeypatch.setenv("CAMPUS_MAIL_SMTP_TLS", "tls")
    settings = load_settings()
    assert settings.smtp_password.get_secret_value() == "keep it quiet"
    assert "keep it quiet" not in repr(settings)
