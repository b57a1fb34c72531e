"""What a campus's monitoring is told."""

import shutil

import pytest
from fastapi.testclient import TestClient

from app.core.settings import Settings
from protocol.clock import SteppedClock
from tests.app.conftest import Browser, Mailroom

pytestmark = pytest.mark.mailed_codes


def test_it_is_not_ready_while_a_channel_has_owed_a_notice_for_ten_minutes(
    settings: Settings, clock: SteppedClock, anonymous: TestClient, sender: Browser, mailroom: Mailroom
) -> None:
    shutil.rmtree(settings.spool_folder)
    settings.spool_folder.write_text("Here no mail can be written.")
    assert sender.order().status_code == 201
    mailroom.send_mails()
    clock.advance(590)
    mailroom.send_mails()
    assert anonymous.get("/readyz").json() == {"status": "ready"}
    clock.advance(20)
    mailroom.send_mails()
    answer = anonymous.get("/readyz")
    assert (answer.status_code, answer.json()["code"]) == (503, "not_ready")
    assert "a channel still owes is 610 s old" in answer.json()["detail"]
    settings.spool_folder.unlink()
    clock.advance(3600)
    mailroom.send_mails()
    assert anonymous.get("/readyz").json() == {"status": "ready"}
