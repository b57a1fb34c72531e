"""People choose what they are told and where; what they must not miss reaches them all the same."""

import base64
import os
from typing import Any

import pytest
from cryptography.hazmat.primitives import serialization
from cryptography.hazmat.primitives.asymmetric import ec
from fastapi import FastAPI
from hypothesis import given
from hypothesis import strategies as st

from app.composition import create_app
from app.core.http_client import HttpClient
from app.core.settings import Settings
from app.models import NotificationKind, NotificationPreferences
from app.notifications.preferences import CHANNELS, MUST_REACH, channels_for
from protocol.clock import SteppedClock
from tests.app.conftest import SENDER, Browser, Mailroom, Mails
from tests.app.notifications.office import running
from tests.app.notifications.receivers import receiving


def subjects(mails: Mails) -> list[str]:
    return [mail["Subject"] for mail in mails.to(SENDER) if mail["Message-ID"].startswith("<mail.")]


def test_a_muted_kind_is_in_the_inbox_and_in_no_mail(sender: Browser, mailroom: Mailroom, mails: Mails) -> None:
    answer = sender.put("/api/v1/me/notices", json={"muted": {"mail": ["accepted"]}})
    assert answer.json()["muted"]["mail"] == ["accepted"]
    order_id = sender.order().json()["id"]
    mailroom.move(order_id, "assigned", "to_sender")
    mailroom.send_mails()
    assert [one["kind"] for one in sender.get("/api/v1/notices").json()["items"]] == ["robot_near", "accepted"]
    assert len(subjects(mails)) == 1
    sender.put("/api/v1/me/notices", json={"muted": {"mail": []}})
    sender.order()
    mailroom.send_mails()
    assert len(subjects(mails)) == 2


def test_no_person_mutes_a_robot_that_waits_with_their_mail_everywhere(sender: Browser) -> None:
    everywhere = {channel: ["robot_here_for_you"] for channel in CHANNELS}
    refused = sender.put("/api/v1/me/notices", json={"muted": everywhere})
    assert (refused.status_code, refused.json()["code"]) == (422, "muted_everywhere")
    assert sender.put("/api/v1/me/notices", json={"muted": {"mail": ["robot_here_for_you"]}}).status_code == 200
    assert sender.put("/api/v1/me/notices", json={"muted": {"push": ["robot_here_for_you"]}}).status_code == 200
    last = sender.put("/api/v1/me/notices", json={"muted": {"webhook": ["robot_here_for_you"]}})
    assert last.status_code == 422, "in small steps neither"
    assert sender.get("/api/v1/me/notices").json()["muted"]["webhook"] == []


@given(
    kind=st.sampled_from(list(NotificationKind)),
    wishes=st.dictionaries(st.sampled_from(CHANNELS), st.lists(st.sampled_from([str(k) for k in NotificationKind]))),
    reachable=st.sets(st.sampled_from(CHANNELS)).map(lambda some: some | {"mail"}),
)
def test_what_must_reach_a_person_takes_some_channel_and_nothing_takes_one_it_is_muted_on(
    kind: NotificationKind, wishes: dict[str, list[str]], reachable: set[str]
) -> None:
    taken = channels_for(kind, wishes, reachable)
    assert set(taken) <= reachable
    if kind in MUST_REACH:
        assert taken
    else:
        assert not any(kind in wishes.get(channel, []) for channel in taken)


def browser_keys() -> dict[str, str]:
    point = ec.generate_private_key(ec.SECP256R1()).public_key()
    raw = point.public_bytes(serialization.Encoding.X962, serialization.PublicFormat.UncompressedPoint)
    return {name: base64.urlsafe_b64encode(one).decode() for name, one in (("p256dh", raw), ("auth", os.urandom(16)))}


class TestWithAPushServiceOnThisMachine:
    """Where the guard is open, as in no service that was not made so in its code."""

    @pytest.fixture
    def app(self, settings: Settings, clock: SteppedClock) -> FastAPI:

        return create_app(settings, clock, HttpClient(allow_private=True))

    def test_a_browser_subscribes_is_told_and_ends_it(self, sender: Browser, mailroom: Mailroom) -> None:
        with receiving() as push_service:
            wish = {"endpoint": f"{push_service.url}/me", "keys": browser_keys(), "expirationTime": None}
            device = sender.post("/api/v1/me/devices", json=wish)
            assert device.status_code == 201, device.text
            mine = sender.get("/api/v1/me/notices").json()
            assert [one["id"] for one in mine["devices"]] == [device.json()["id"]]
            assert len(base64.urlsafe_b64decode(mine["push_key"] + "=")) == 65
            sender.order()
            mailroom.send_mails()
            assert len(push_service.received) == 1
            assert sender.delete(f"/api/v1/me/devices/{device.json()['id']}").status_code == 204
            sender.order()
            mailroom.send_mails()
            assert len(push_service.received) == 1

    def test_a_browser_belongs_to_the_person_who_signed_in_there_last(
        self, sender: Browser, recipient: Browser
    ) -> None:
        wish = {"endpoint": "http://127.0.0.1:9/shared", "keys": browser_keys()}
        assert sender.post("/api/v1/me/devices", json=wish).status_code == 201
        assert recipient.post("/api/v1/me/devices", json=wish).status_code == 201
        assert sender.get("/api/v1/me/notices").json()["devices"] == []
        assert len(recipient.get("/api/v1/me/notices").json()["devices"]) == 1

    def test_a_webhook_keeps_its_secret_until_its_address_changes(self, sender: Browser) -> None:
        def put(path: str) -> Any:
            return sender.put("/api/v1/me/webhook", json={"url": f"http://127.0.0.1:9/{path}"}).json()["secret"]

        first = put("a")
        assert first.startswith("whsec_")
        assert put("a") == first
        assert put("b") != first
        assert "secret" not in sender.get("/api/v1/me/notices").json()["webhook"]
        assert sender.delete("/api/v1/me/webhook").status_code == 204
        assert sender.delete("/api/v1/me/webhook").json()["code"] == "no_webhook"


@pytest.mark.parametrize(
    "url", ["https://127.0.0.1/", "https://[::1]/", "http://1.1.1.1/", "https://10.1.2.3/x", "nonsense"]
)
def test_addresses_behind_the_walls_are_refused_at_once(sender: Browser, url: str) -> None:
    hook = sender.put("/api/v1/me/webhook", json={"url": url})
    device = sender.post("/api/v1/me/devices", json={"endpoint": url, "keys": browser_keys()})
    assert [(one.status_code, one.json()["code"]) for one in (hook, device)] == [(422, "target_refused")] * 2


def test_keys_that_no_browser_makes_are_refused(sender: Browser) -> None:
    compressed = base64.urlsafe_b64encode(
        bytes.fromhex("03" + "6b17d1f2e12c4247f8bce6e563a440f277037d812deb33a0f4a13945d898c296")
    )
    for changed in ({"p256dh": "AAAA"}, {"auth": "AAAA"}, {"p256dh": "A"}, {"p256dh": compressed.decode()}):
        keys = {**browser_keys(), **changed}
        refused = sender.post("/api/v1/me/devices", json={"endpoint": "https://push.example/", "keys": keys})
        assert (refused.status_code, refused.json()["code"]) == (422, "bad_subscription")


async def test_a_person_without_any_other_channel_left_is_mailed_what_must_reach_them(
    settings: Settings, clock: SteppedClock
) -> None:
    """They muted it in mails because their phone had it; then the phone was lost."""

    async with running(settings, clock) as office:
        order_id = await office.order()
        recipient = await office.person("recipient@campus.example")
        await office.add(
            NotificationPreferences(person_id=recipient.id, muted={"mail": ["robot_here_for_you", "on_its_way"]})
        )
        await office.move(order_id, "assigned", "to_sender", "at_sender", "carrying", "at_recipient")
        await office.settle()
        kinds = {sending.key.split(".")[2] for sending in await office.sendings("mail") if recipient.id in sending.key}
    assert kinds == {"robot_here_for_you"}
