"""A mail goes to the address that was typed, and to no other: not by what is hidden in the address either."""

from datetime import UTC, datetime
from email import message_from_bytes, policy
from urllib.parse import quote

import pytest
from aiosmtplib.email import extract_recipients
from fastapi.testclient import TestClient
from hypothesis import given
from hypothesis import settings as hypothesis_settings
from hypothesis.strategies import from_regex

from app.accounts.schemas import EMAIL, MAX_EMAIL
from app.core.mail.message import Mail, message_of
from tests.app.conftest import Browser, Mails

HIDDEN = [
    "=?utf-8?q?eve=40evil.example=2C?=@campus.example",
    "=?utf-8?q?eve=40evil.example=3E?=@campus.example",
    "=?utf-8?b?ZXZlQGV2aWwuZXhhbXBsZQ==?=@campus.example",
    "=?utf-8?q?a=0d=0aBcc=3aeve=40evil.example?=@campus.example",
    "eve%evil.example@campus.example",
    "evil.example!eve@campus.example",
    "eve@evil.example,ada@campus.example",
    "eve@evil.example>@campus.example",
    '"eve@evil.example "@campus.example',
    "ada@campus.example\r\nBcc: eve@evil.example",
    "ada@campus.example\n",
]

pytestmark = pytest.mark.mailed_codes


@pytest.mark.parametrize("address", HIDDEN)
@pytest.mark.slow
def test_an_address_that_hides_another_is_refused_wherever_one_is_typed(
    anonymous: TestClient, sender: Browser, mails: Mails, address: str
) -> None:
    mailed = len(list(mails.folder.iterdir()))
    order_id = sender.order().json()["id"]
    answers = [
        anonymous.post("/api/v1/sign-in/codes", json={"email": address}),
        sender.order(recipient=address),
        sender.post(f"/api/v1/orders/{order_id}/delegates", json={"name": "Dee", "email": address}),
        sender.request("PUT", f"/api/v1/me/contacts/{quote(address, safe='')}", json={"label": "Ada"}),
    ]
    assert [(answer.status_code, answer.json()["code"]) for answer in answers] == [(422, "invalid_request")] * 4
    assert len([mail for mail in mails.folder.iterdir() if mail.name.startswith("sign-in")]) == mailed


@hypothesis_settings(max_examples=300, deadline=None, derandomize=True)
@given(address=from_regex(EMAIL, fullmatch=True).filter(lambda text: len(text) <= MAX_EMAIL))
@pytest.mark.slow
def test_on_the_wire_and_in_the_envelope_stands_what_was_typed(address: str) -> None:
    message = message_of(
        Mail("key", address, "Subject", "Body", datetime(2026, 1, 5, tzinfo=UTC)), "mail@campus.example"
    )
    read = message_from_bytes(message.as_bytes(), policy=policy.SMTP)
    assert extract_recipients(message) == extract_recipients(read) == [address]
    assert [one.addr_spec for one in read["To"].addresses] == [address]
