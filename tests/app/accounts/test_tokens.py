"""Scripts sign in with a token for some of what their person may do, for some time."""

import time
from typing import Any

import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient

from protocol.clock import SteppedClock
from tests.app.conftest import HERE, RECIPIENT, Browser

TOKENS = "/api/v1/tokens"
ORDER = {"from_post": "post1", "to_post": "post4", "recipient": RECIPIENT}


class Script(TestClient):
    """A program: no cookie, no Origin, a token."""

    def __init__(self, app: FastAPI, like: Browser, token: str) -> None:
        super().__init__(app, base_url=HERE, headers={"Authorization": f"Bearer {token}"})
        self.portal = like.portal


def issue(browser: Browser, *scopes: str, days: int = 30) -> dict[str, Any]:
    answer = browser.post(TOKENS, json={"name": "lab script", "scopes": list(scopes), "days": days})
    assert answer.status_code == 201, answer.text
    assert answer.headers["Cache-Control"] == "no-store"
    made: dict[str, Any] = answer.json()
    return made


def test_a_script_orders_in_its_persons_name(app: FastAPI, sender: Browser) -> None:
    made = issue(sender, "orders:read", "orders:write")
    assert made["token"].startswith(f"cmp_{made['prefix']}_")
    script = Script(app, sender, made["token"])
    placed = script.post("/api/v1/orders", json=ORDER, headers={"Idempotency-Key": "1"})
    assert placed.status_code == 201
    assert sender.get(f"/api/v1/orders/{placed.json()['id']}").json()["my_role"] == "sender"
    assert script.get("/api/v1/me").json()["email"] == sender.get("/api/v1/me").json()["email"]


def test_a_token_is_listed_without_its_secret_and_revoked(app: FastAPI, sender: Browser, recipient: Browser) -> None:
    made = issue(sender, "orders:read")
    script = Script(app, sender, made["token"])
    assert sender.get(TOKENS).json()["items"][0]["used_at"] is None
    assert script.get("/api/v1/orders").status_code == 200
    while (listed := sender.get(TOKENS).json()["items"][0])["used_at"] is None:  # noted after the answer
        time.sleep(0.01)
    assert (listed["name"], listed["scopes"], "token" in listed) == ("lab script", ["orders:read"], False)
    assert recipient.delete(f"{TOKENS}/{made['prefix']}").status_code == 404, "not theirs"
    assert sender.delete(f"{TOKENS}/{made['prefix']}").status_code == 204
    assert (script.get("/api/v1/orders").status_code, sender.get(TOKENS).json()["items"]) == (401, [])


def test_a_token_is_good_until_its_day(app: FastAPI, sender: Browser, clock: SteppedClock) -> None:
    script = Script(app, sender, issue(sender, "orders:read", days=1)["token"])
    clock.advance(86399)
    assert script.get("/api/v1/orders").status_code == 200
    clock.advance(1)
    refused = script.get("/api/v1/orders")
    assert (refused.status_code, refused.json()["code"]) == (401, "not_signed_in")
    assert refused.headers["WWW-Authenticate"] == 'Bearer error="invalid_token"'


def test_a_token_makes_no_tokens_and_ends_no_sessions(app: FastAPI, sender: Browser) -> None:
    scopes = ["orders:read", "orders:write", "robots:read", "notices:read", "notices:write", "contacts:read"]
    script = Script(app, sender, issue(sender, *scopes, "live:read", "dispatch", "maintain")["token"])
    for method, path in (
        ("POST", TOKENS),
        ("GET", TOKENS),
        ("DELETE", "/api/v1/sessions"),
        ("DELETE", "/api/v1/session"),
    ):
        refused = script.request(method, path, json={"name": "x", "scopes": ["orders:read"]})
        assert (refused.status_code, refused.json()["code"]) == (403, "not_for_scripts"), path


def test_scopes_give_no_person_a_role(app: FastAPI, sender: Browser) -> None:
    script = Script(app, sender, issue(sender, "contacts:read", "dispatch", "maintain")["token"])
    refused = script.get("/api/v1/people")
    assert (refused.status_code, refused.json()["code"]) == (403, "role_needed")
    assert script.get("/api/v1/me").json()["roles"] == ["member"]


@pytest.mark.parametrize(
    "damage", [lambda t: t[:-1] + "~", lambda t: t[:-4] + "AAAA", lambda t: t.replace("cmp_", "cmr_")]
)
def test_a_token_that_is_nearly_right_is_wrong(app: FastAPI, sender: Browser, damage: Any) -> None:
    script = Script(app, sender, damage(issue(sender, "orders:read")["token"]))
    assert script.get("/api/v1/orders").status_code == 401


def test_a_wrong_token_is_refused_beside_a_good_cookie_too(sender: Browser) -> None:
    assert sender.get("/api/v1/me", headers={"Authorization": "Bearer cmp_00000000_x"}).status_code == 401
    assert sender.get("/api/v1/me", headers={"Authorization": "Basic cHJveHk6eA=="}).status_code == 200, "a proxy's"


def test_a_token_travels_over_https_or_within_this_machine(app: FastAPI, sender: Browser) -> None:
    token = issue(sender, "orders:read")["token"]
    remote = TestClient(app, base_url="http://mail.campus.example", headers={"Authorization": f"Bearer {token}"})
    remote.portal = sender.portal
    assert remote.get("/api/v1/orders").json()["code"] == "https_required"
