"""A person's sessions: described in words, ended one by one or all others at once."""

import time

import pytest
from fastapi import FastAPI

from app.accounts.sessions.devices import device_of
from protocol.clock import SteppedClock
from tests.app.conftest import SENDER, Browser, SignedIn

SESSIONS = "/api/v1/sessions"
FIREFOX = "Mozilla/5.0 (Windows NT 10.0; Win64; x64; rv:145.0) Gecko/20100101 Firefox/145.0"
PIXEL = "Mozilla/5.0 (Linux; Android 16) AppleWebKit/537.36 (KHTML, like Gecko) Chrome/142.0.0.0 Mobile Safari/537.36"
IPHONE = "Mozilla/5.0 (iPhone; CPU iPhone OS 18_5 like Mac OS X) AppleWebKit/605.1.15 Version/18.5 Safari/604.1"
EDGE = "Mozilla/5.0 (Windows NT 10.0) AppleWebKit/537.36 (KHTML, like Gecko) Chrome/142.0.0.0 Safari/537.36 Edg/142.0"


@pytest.mark.parametrize(
    ("user_agent", "words"),
    [
        (FIREFOX, "Firefox, Windows"),
        (PIXEL, "Chrome, Android"),
        (IPHONE, "Safari, iPhone"),
        (EDGE, "Edge, Windows"),
        ("curl/8.5 (Linux)", "Linux"),
        ("", ""),
    ],
)
def test_a_device_is_named_in_words(user_agent: str, words: str) -> None:
    assert device_of(user_agent) == words


def sessions_of(browser: Browser) -> list[dict[str, object]]:
    items: list[dict[str, object]] = browser.get(SESSIONS).json()["items"]
    return items


def test_a_person_sees_where_they_are_signed_in_and_ends_what_they_do_not_know(
    signed_in: SignedIn, recipient: Browser, clock: SteppedClock
) -> None:
    desk = signed_in(SENDER)
    clock.advance(60)
    phone = signed_in(SENDER)
    newest, oldest = sessions_of(desk)
    assert (newest["current"], oldest["current"]) == (False, True)
    assert newest["created_at"] > oldest["created_at"]  # type: ignore[operator]
    assert recipient.delete(f"{SESSIONS}/{newest['id']}").status_code == 404, "not theirs"
    assert desk.delete(f"{SESSIONS}/{newest['id']}").status_code == 204
    assert desk.delete(f"{SESSIONS}/{newest['id']}").json()["code"] == "unknown_session"
    assert phone.get("/api/v1/me").status_code == 401
    assert [one["id"] for one in sessions_of(desk)] == [oldest["id"]]


def test_all_other_sessions_end_at_once(signed_in: SignedIn, recipient: Browser) -> None:
    here, there, elsewhere = (signed_in(SENDER) for _ in range(3))
    assert here.delete(SESSIONS).status_code == 204
    assert [one.get("/api/v1/me").status_code for one in (here, there, elsewhere)] == [200, 401, 401]
    assert recipient.get("/api/v1/me").status_code == 200


def test_last_seen_is_some_minutes_behind_and_not_a_write_for_each_request(
    app: FastAPI, sender: Browser, clock: SteppedClock
) -> None:
    opened = sessions_of(sender)[0]["seen_at"]
    clock.advance(599)
    assert sessions_of(sender)[0]["seen_at"] == opened
    clock.advance(1)
    while (seen := sessions_of(sender)[0]["seen_at"]) == opened:  # noted after the answer
        time.sleep(0.01)
    assert seen == clock.utc().isoformat().replace("+00:00", "Z")


def test_a_person_changes_their_name_language_and_usual_post(sender: Browser) -> None:
    changed = sender.patch("/api/v1/me", json={"name": " Ada King ", "language": "fr", "usual_post": "post2"})
    assert changed.status_code == 200
    me = sender.get("/api/v1/me").json()
    assert (me["name"], me["language"], me["usual_post"]) == ("Ada King", "fr", "post2")
    refused = sender.patch("/api/v1/me", json={"usual_post": "post22"})
    assert (refused.status_code, refused.json()["code"]) == (422, "unknown_post")
    assert "post2" in refused.json()["detail"]
    assert sender.patch("/api/v1/me", json={"usual_post": None}).json()["usual_post"] is None
    assert sender.get("/api/v1/me").json()["name"] == "Ada King", "what is absent stays"
    for wrong in ({"name": "  "}, {"language": "de"}, {"roles": ["maintainer"]}, {"email": "x@campus.example"}):
        assert sender.patch("/api/v1/me", json=wrong).status_code == 422, wrong
