"""Dispatchers see what has not gone out, help it on, and read no code on the way."""

import re

import pytest
from fastapi import FastAPI

from app.accounts.sign_in.service import find_person, set_roles
from app.models import Role
from protocol.clock import SteppedClock
from tests.app.conftest import SENDER, Browser, Mailroom, SignedIn

pytestmark = pytest.mark.mailed_codes


@pytest.fixture
def dispatcher(app: FastAPI, signed_in: SignedIn, mailroom: Mailroom) -> Browser:
    browser = signed_in("dispatcher@campus.example")

    async def promote() -> None:
        async with app.state.parts.database.transaction() as session:
            person = await find_person(session, "dispatcher@campus.example")
            assert person
            set_roles(person, {Role.DISPATCHER}, set())

    mailroom.call(promote)
    return browser


def test_what_does_not_go_out_is_seen_and_sent_again_by_hand(
    app: FastAPI, sender: Browser, dispatcher: Browser, mailroom: Mailroom, clock: SteppedClock
) -> None:
    folder = app.state.parts.settings.spool_folder
    folder.rename(folder.with_name("aside"))
    folder.write_text("a file where the folder should be")
    order_id = sender.order().json()["id"]
    mailroom.send_mails()
    (waiting,) = dispatcher.get("/api/v1/outbox").json()["items"]
    assert (waiting["email"], waiting["kind"], waiting["order_id"]) == (SENDER, "accepted", order_id)
    assert waiting["tries"] == 1 and waiting["gave_up_at"] is None and waiting["problem"]
    clock.advance(2 * 86_400)
    mailroom.send_mails()
    (given_up,) = dispatcher.get("/api/v1/outbox", params={"given_up": True}).json()["items"]
    assert given_up["id"] == waiting["id"] and given_up["gave_up_at"]
    folder.unlink()
    folder.with_name("aside").rename(folder)
    assert dispatcher.post(f"/api/v1/outbox/{waiting['id']}/retry").status_code == 202
    mailroom.send_mails()
    assert waiting["id"] not in [one["id"] for one in dispatcher.get("/api/v1/outbox").json()["items"]]
    again = dispatcher.post(f"/api/v1/outbox/{waiting['id']}/retry")
    assert (again.status_code, again.json()["code"]) == (409, "sent_already")
    assert dispatcher.post("/api/v1/outbox/999999/retry").json()["code"] == "unknown_sending"


def test_the_spool_shows_who_was_written_to_and_no_code(
    app: FastAPI, sender: Browser, dispatcher: Browser, mailroom: Mailroom
) -> None:
    order_id = sender.order().json()["id"]
    mailroom.move(order_id, "assigned", "to_sender", "at_sender")
    mailroom.send_mails()
    mails = dispatcher.get("/api/v1/spool").json()["items"]
    assert {mail["to"] for mail in mails} == {SENDER, "dispatcher@campus.example"}
    for mail in mails:
        shown = dispatcher.get(f"/api/v1/spool/{mail['name']}").json()
        written = (app.state.parts.settings.spool_folder / mail["name"]).read_text()
        if mail["name"].startswith("sign-in"):
            before, after = shown["text"].split("[redacted]")
            assert re.search(rf"{re.escape(before)}\d{{8}}{re.escape(after)}", written)
        if ".robot_here." in mail["name"]:
            assert shown["attachments"] == ["load-code.png"]
    for hidden in ("none.eml", "..%2Fserver.key.eml", "%2e%2e%2fcampus-mail.sqlite.eml"):
        assert dispatcher.get(f"/api/v1/spool/{hidden}").status_code in (404, 422)
    longest = dispatcher.get(f"/api/v1/spool/{'0' * 251}.eml")
    assert (longest.status_code, longest.json()["code"]) == (404, "not_in_spool")
    assert dispatcher.get(f"/api/v1/spool/{'0' * 252}.eml").status_code == 422, "no file can have such a name"
    # As one is that retention takes away between the list of names and the look at it.
    (app.state.parts.settings.spool_folder / "gone.eml").symlink_to("nowhere")
    assert dispatcher.get("/api/v1/spool").json()["items"] == mails
