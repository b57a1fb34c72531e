"""Hand-over codes: who is shown which, when, and what a robot needs to check them."""

from hashlib import sha256

import cv2
import numpy as np
import pytest
import zxingcpp
from fastapi import FastAPI

from app.core.server_key import ServerKey, open_server_key
from app.models import Order
from app.orders.custody.codes import code_png, code_text
from protocol.parts import Purpose
from tests.app.conftest import SENDER, Browser, Mailroom, Mails


@pytest.fixture
def order_id(sender: Browser) -> str:
    return str(sender.order().json()["id"])


def code(browser: Browser, order_id: str) -> str | None:
    answer = browser.get(f"/api/v1/orders/{order_id}/code")
    return str(answer.json()["purpose"]) if answer.status_code == 200 else None


def test_each_person_is_shown_their_code_in_their_turn(
    sender: Browser, recipient: Browser, mailroom: Mailroom, order_id: str
) -> None:
    turns = {}
    for state in ("queued", "assigned", "to_sender", "at_sender", "carrying", "at_recipient", "delivered"):
        if state != "queued":
            mailroom.move(order_id, state)
        turns[state] = (code(sender, order_id), code(recipient, order_id))
    assert turns == {
        "queued": (None, None),
        "assigned": ("load", None),
        "to_sender": ("load", None),
        "at_sender": ("load", None),
        "carrying": (None, "receive"),
        "at_recipient": (None, "receive"),
        "delivered": (None, None),
    }


def test_the_robot_can_check_a_code_by_its_hash_alone(
    app: FastAPI, sender: Browser, mailroom: Mailroom, order_id: str
) -> None:
    mailroom.move(order_id, "assigned")
    text = sender.get(f"/api/v1/orders/{order_id}/code").json()["text"]
    assert text.startswith("CM1:")
    assert len(bytes.fromhex(text[4:])) == 16

    async def verifiers() -> dict[str, str]:
        async with app.state.parts.database.reading() as session:
            order = await session.get_one(Order, order_id)
            return {one.purpose: one.sha256 for one in await app.state.parts.orders.verifiers(session, order)}

    known = mailroom.call(verifiers)
    assert known["load"] == sha256(text.encode()).hexdigest()
    assert known["receive"] != known["load"]


def test_the_picture_says_the_same_as_the_code(sender: Browser, mailroom: Mailroom, order_id: str) -> None:
    mailroom.move(order_id, "assigned")
    answer = sender.get(f"/api/v1/orders/{order_id}/code").json()
    svg = sender.get(answer["svg_url"])
    assert svg.headers["content-type"] == "image/svg+xml"
    assert svg.headers["cache-control"] == "no-store"
    assert b"<svg" in svg.content
    picture = cv2.imdecode(np.frombuffer(code_png(answer["text"]), np.uint8), cv2.IMREAD_GRAYSCALE)
    assert [found.text for found in zxingcpp.read_barcodes(picture)] == [answer["text"]]


def test_the_mail_that_the_robot_is_here_brings_the_code_as_a_picture_and_never_in_its_title(
    sender: Browser, mailroom: Mailroom, mails: Mails, order_id: str
) -> None:
    mailroom.move(order_id, "assigned", "to_sender", "at_sender")
    text = sender.get(f"/api/v1/orders/{order_id}/code").json()["text"]
    mailroom.send_mails()
    (here,) = [mail for mail in mails.to(SENDER) if mail["Subject"].startswith("The robot is waiting")]
    (attachment,) = here.iter_attachments()
    picture = cv2.imdecode(np.frombuffer(attachment.get_content(), np.uint8), cv2.IMREAD_GRAYSCALE)
    assert zxingcpp.read_barcodes(picture)[0].text == text
    assert all("CM1:" not in mail["Subject"] for mail in mails.to(SENDER))
    notices = sender.get("/api/v1/notices").text
    assert "CM1:" not in notices


def test_codes_derive_from_the_key_file_and_survive_a_restart(tmp_path: object, settings: object) -> None:
    path = settings.data / "server.key"  # type: ignore[attr-defined]
    first = code_text(open_server_key(path), "o1", Purpose.LOAD)
    assert path.stat().st_mode & 0o777 == 0o600
    assert code_text(open_server_key(path), "o1", Purpose.LOAD) == first
    assert code_text(open_server_key(path), "o2", Purpose.LOAD) != first
    assert code_text(ServerKey(b"another"), "o1", Purpose.LOAD) != first
