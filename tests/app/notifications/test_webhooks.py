"""Signed webhooks: a program knows who speaks, and a second delivery from a new one."""

import asyncio
import base64
import contextlib
import hmac
import json
import threading
from collections.abc import Iterator
from hashlib import sha256

import pytest
from pydantic import SecretStr

from app.core.errors import StartError
from app.core.http_client import HttpClient
from app.core.settings import Settings, load_settings
from app.models import Webhook
from app.notifications.channels.interface import NotSent
from app.notifications.channels.posting import post
from app.notifications.channels.webhook import secret_of
from app.notifications.delivery.attempts import pause_s
from protocol.clock import SteppedClock
from tests.app.conftest import SENDER
from tests.app.notifications.office import Office, running
from tests.app.notifications.receivers import Received, Receiver, receiving

SECRET = "a secret of the operator's own"
INSIDE = HttpClient(allow_private=True)


@pytest.fixture
def receiver() -> Iterator[Receiver]:
    with receiving() as receiver:
        yield receiver


async def with_webhook(office: Office, url: str) -> bytes:
    """A webhook of the sender's; what it is signed with."""
    sender = await office.person(SENDER)
    await office.add(Webhook(id="hook", person_id=sender.id, url=url, created_at=office.clock.utc()))
    shown = secret_of(office.state.server_key, "hook")
    assert shown.startswith("whsec_")
    return base64.b64decode(shown.removeprefix("whsec_"))


def is_signed(one: Received, secret: bytes) -> bool:
    """As a receiver checks it that follows Standard Webhooks."""
    signed = f"{one.headers['webhook-id']}.{one.headers['webhook-timestamp']}.".encode() + one.body
    expected = base64.b64encode(hmac.new(secret, signed, sha256).digest()).decode()
    return hmac.compare_digest(one.headers["webhook-signature"], f"v1,{expected}")


async def test_a_person_has_their_notices_posted_to_their_own_program(
    settings: Settings, clock: SteppedClock, receiver: Receiver
) -> None:
    async with running(settings, clock, INSIDE) as office:
        secret = await with_webhook(office, f"{receiver.url}/mine")
        order_id = await office.order()
        await office.move(order_id, "assigned", "to_sender", "at_sender", "carrying")
        await office.settle()
    kinds = [json.loads(one.body)["data"]["kind"] for one in receiver.received]
    assert kinds == ["accepted", "robot_near", "robot_here"], "what the recipient is told is not the sender's"
    assert all(is_signed(one, secret) for one in receiver.received)
    assert not is_signed(receiver.received[0], b"another")
    assert b"CM1:" not in b"".join(one.body for one in receiver.received)


async def test_the_operator_has_everything_posted_to_a_program_of_the_campus(
    settings: Settings, clock: SteppedClock, receiver: Receiver
) -> None:
    known = {"webhook_url": f"{receiver.url}/all", "webhook_secret": SecretStr(SECRET)}
    async with running(settings.model_copy(update=known), clock) as office:
        order_id = await office.order()
        await office.move(order_id, "assigned", "to_sender", "at_sender", "carrying")
        await office.settle()
    told = [json.loads(one.body)["data"] for one in receiver.received]
    assert [(one["kind"], one["person"]["name"]) for one in told] == [
        ("accepted", "Sender"),
        ("robot_near", "Sender"),
        ("robot_here", "Sender"),
        ("on_its_way", "Recipient"),
    ]
    assert all(is_signed(one, SECRET.encode()) for one in receiver.received)


async def test_a_program_that_is_down_gets_the_same_delivery_until_a_day_has_passed(
    settings: Settings, clock: SteppedClock, receiver: Receiver
) -> None:
    receiver.answers = [500, 302, 200, *[503] * 50]
    async with running(settings, clock, INSIDE) as office:
        secret = await with_webhook(office, receiver.url)
        await office.order()
        for tries in (1, 2, 3):
            await office.settle()
            clock.advance(pause_s(tries))
        assert (await office.sending("webhook")).sent_at
        assert len({one.headers["webhook-id"] for one in receiver.received}) == 1
        assert len({one.headers["webhook-timestamp"] for one in receiver.received}) == 3
        assert all(is_signed(one, secret) for one in receiver.received)

        await office.order()
        for _ in range(4):
            await office.settle()
            clock.advance(8 * 3600)
        assert (await office.sendings("webhook"))[1].gave_up_at


async def test_a_program_that_says_gone_is_told_nothing_more(
    settings: Settings, clock: SteppedClock, receiver: Receiver
) -> None:
    receiver.answers = [410]
    async with running(settings, clock, INSIDE) as office:
        await with_webhook(office, receiver.url)
        await office.order()
        await office.settle()
        await office.order()
        await office.settle()
    assert len(receiver.received) == 1


@pytest.mark.parametrize("scheme", ["http", "https"])
async def test_a_webhook_leads_to_no_machine_behind_the_walls(
    settings: Settings, clock: SteppedClock, receiver: Receiver, scheme: str
) -> None:
    async with running(settings, clock) as office:
        await with_webhook(office, receiver.url.replace("http", scheme))
        await office.order()
        await office.settle()
        assert not (await office.sending("webhook")).sent_at
    assert not receiver.received


async def test_what_hangs_holds_up_no_other_channel_and_no_other_receiver(
    settings: Settings, clock: SteppedClock, receiver: Receiver
) -> None:
    receiver.hangs = threading.Event()
    with receiving() as quick:
        known = {"webhook_url": quick.url, "webhook_secret": SecretStr(SECRET)}
        async with running(settings.model_copy(update=known), clock, INSIDE) as office:
            await with_webhook(office, receiver.url)
            for _ in range(3):
                await office.order()
            while len(quick.received) < 3 or not all(  # noqa: ASYNC110  # the channels ring no bell of ours
                one.sent_at for one in await office.sendings("mail")
            ):
                await asyncio.sleep(0.02)
            assert len(receiver.received) == 1, "to one that hangs, one at a time"
            receiver.hangs.set()
            await office.settle()
            assert len(receiver.received) == 3


def test_a_webhook_of_the_operators_needs_a_secret(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CAMPUS_MAIL_WEBHOOK_URL", "https://hooks.campus.example")
    with pytest.raises(StartError, match="webhook_secret"):
        load_settings()


async def test_a_receiver_that_answers_a_byte_at_a_time_holds_no_other_up() -> None:
    """Each byte comes in time, the answer never."""

    gone = asyncio.Event()

    async def drip(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        with contextlib.suppress(ConnectionError):
            writer.write(b"HTTP/1.1 200 OK\r\nX-Slow: ")
            while not reader.at_eof():
                writer.write(b"a")
                await writer.drain()
                await asyncio.sleep(0.05)
        writer.close()
        gone.set()

    async with await asyncio.start_server(drip, "127.0.0.1", 0) as server, INSIDE.client() as client:
        url = f"http://127.0.0.1:{server.sockets[0].getsockname()[1]}/"
        async with asyncio.timeout(10):
            with pytest.raises(NotSent, match="no answer: TimeoutError"):
                await post(client, url, b"{}", {}, within_s=0.5)
            await gone.wait()
