"""Web Push: what leaves is for one browser alone, and a device that is gone is forgotten."""

import base64
import json
import os
from collections.abc import AsyncIterator, Iterator

import http_ece
import pytest
from cryptography.hazmat.primitives import serialization
from cryptography.hazmat.primitives.asymmetric import ec
from py_vapid import Vapid02

from app.core.errors import StartError
from app.core.http_client import HttpClient
from app.core.settings import Settings
from app.models import NotificationKind, PushSubscription
from app.notifications.channels.push import urgency_of
from app.notifications.delivery.attempts import pause_s
from app.notifications.push_key import open_push_key
from protocol.clock import SteppedClock
from tests.app.conftest import SENDER
from tests.app.notifications.office import Office, running
from tests.app.notifications.receivers import Received, Receiver, receiving


class BrowserKeys:
    """The keys that a browser makes when it subscribes, and reads its pushes with."""

    def __init__(self) -> None:
        self.private = ec.generate_private_key(ec.SECP256R1())
        self.auth = os.urandom(16)

    @property
    def public(self) -> str:
        form = (serialization.Encoding.X962, serialization.PublicFormat.UncompressedPoint)
        return text(self.private.public_key().public_bytes(*form))

    def read(self, one: Received) -> dict[str, str]:
        plain = http_ece.decrypt(one.body, private_key=self.private, auth_secret=self.auth, version="aes128gcm")
        read: dict[str, str] = json.loads(plain)
        return read


def text(raw: bytes) -> str:
    return base64.urlsafe_b64encode(raw).rstrip(b"=").decode()


@pytest.fixture
def push_service() -> Iterator[Receiver]:
    with receiving() as receiver:
        yield receiver


@pytest.fixture
async def office(settings: Settings, clock: SteppedClock) -> AsyncIterator[Office]:
    async with running(settings, clock, HttpClient(allow_private=True)) as office:
        yield office


async def subscribed(office: Office, push_service: Receiver, name: str = "phone") -> BrowserKeys:
    sender, keys = await office.person(SENDER), BrowserKeys()
    endpoint = f"{push_service.url}/{name}"
    now = office.clock.utc()
    row = PushSubscription(
        id=name, person_id=sender.id, endpoint=endpoint, p256dh=keys.public, auth=text(keys.auth), created_at=now
    )
    await office.add(row)
    return keys


async def test_a_notice_reaches_every_browser_of_its_reader_and_only_they_can_read_it(
    office: Office, push_service: Receiver
) -> None:
    phone, desk = await subscribed(office, push_service), await subscribed(office, push_service, "desk")
    order_id = await office.order()
    await office.settle()
    by_path = {one.path: one for one in push_service.received}
    assert set(by_path) == {"/phone", "/desk"}
    shown = phone.read(by_path["/phone"])
    assert shown["title"].startswith("Order accepted")
    assert (shown["order_id"], shown["tag"]) == (order_id, f"{order_id}.accepted")
    assert desk.read(by_path["/desk"]) == shown
    with pytest.raises(http_ece.ECEException):
        desk.read(by_path["/phone"])
    assert b"Order accepted" not in by_path["/phone"].body


async def test_the_push_service_learns_who_sends_how_urgent_it_is_and_nothing_else(
    office: Office, push_service: Receiver
) -> None:
    await subscribed(office, push_service)
    order_id = await office.order()
    await office.move(order_id, "assigned", "to_sender", "at_sender")
    await office.settle()
    assert [one.headers["urgency"] for one in push_service.received] == ["low", "normal", "high"]
    for one in push_service.received:
        signed, key = one.headers["authorization"].removeprefix("vapid t=").split(",k=")
        assert key == office.state.push_key.public
        claims = json.loads(base64.urlsafe_b64decode(signed.split(".")[1] + "=="))
        assert claims["aud"] == push_service.url
        assert claims["sub"] == "mailto:mail@campus.example"
        assert Vapid02.verify(one.headers["authorization"])
        assert int(one.headers["ttl"]) >= 1800
        assert order_id not in json.dumps(one.headers)
    assert len({one.headers["topic"] for one in push_service.received}) == 3


async def test_a_code_is_in_no_push(office: Office, push_service: Receiver) -> None:
    keys = await subscribed(office, push_service)
    order_id = await office.order()
    await office.move(order_id, "assigned", "to_sender", "at_sender")
    await office.settle()
    said = json.dumps([keys.read(one) for one in push_service.received])
    assert "CM1:" not in said
    assert "Hold your code" in said


@pytest.mark.parametrize("status", [404, 410])
async def test_a_device_that_has_unsubscribed_is_forgotten(office: Office, push_service: Receiver, status: int) -> None:
    push_service.answers = [status]
    await subscribed(office, push_service)
    await office.order()
    await office.settle()
    await office.order()
    await office.settle()
    assert len(push_service.received) == 1
    given_up = await office.sending("push")
    assert given_up.gave_up_at and given_up.problem == "the device has ended its subscription"
    assert all(sending.sent_at for sending in await office.sendings("mail"))


async def test_a_busy_push_service_says_when_to_come_back_and_gets_the_same_push_again(
    office: Office, push_service: Receiver, clock: SteppedClock
) -> None:
    push_service.answers, push_service.headers = [429, 503], {"Retry-After": "60"}
    keys = await subscribed(office, push_service)
    await office.order()
    await office.settle()
    clock.advance(pause_s(1))
    await office.settle()
    assert len(push_service.received) == 1, "not before it said"
    push_service.headers = {}
    for _ in range(2):
        clock.advance(60)
        await office.settle()
    assert len(push_service.received) == 3
    assert (await office.sending("push")).sent_at
    assert len({one.headers["topic"] for one in push_service.received}) == 1
    assert len({keys.read(one)["tag"] for one in push_service.received}) == 1


async def test_a_push_that_is_refused_is_given_up(office: Office, push_service: Receiver) -> None:
    push_service.answers = [403]
    await subscribed(office, push_service)
    await office.order()
    await office.settle()
    assert (await office.sending("push")).problem == "the push service answered 403"
    assert (await office.sending("push")).gave_up_at


async def test_a_device_behind_the_walls_is_never_reached(
    settings: Settings, clock: SteppedClock, push_service: Receiver
) -> None:
    async with running(settings, clock) as guarded:
        await subscribed(guarded, push_service)
        await guarded.order()
        await guarded.settle()
        assert not push_service.received
        assert not (await guarded.sending("push")).sent_at
        assert "https" in ((await guarded.sending("push")).problem or "")


def test_the_key_is_made_once_and_is_readable_by_its_owner_alone(settings: Settings) -> None:
    path = settings.push_key_path
    first = open_push_key(path)
    assert path.stat().st_mode & 0o777 == 0o600
    assert open_push_key(path).public == first.public
    assert len(base64.urlsafe_b64decode(first.public + "=")) == 65
    path.chmod(0o644)
    with pytest.raises(StartError, match="0600"):
        open_push_key(path)
    path.chmod(0o600)
    path.write_text("damaged")
    with pytest.raises(StartError, match="push key"):
        open_push_key(path)
    assert path.read_text() == "damaged", "never replaced: every browser would have to subscribe anew"


def test_a_waiting_robot_is_worth_a_devices_battery() -> None:
    urgent = {kind for kind in NotificationKind if urgency_of(kind) == "high"}
    assert urgent == {NotificationKind.ROBOT_HERE, NotificationKind.ROBOT_HERE_FOR_YOU, NotificationKind.AT_RETURN}
