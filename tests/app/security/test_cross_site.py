"""No page of another site acts with a person's cookie: every route that changes something, found by itself."""

from collections import defaultdict
from typing import Final

import httpx
import pytest
from fastapi import FastAPI

from app.accounts.sessions.same_origin import SAFE_METHODS
from tests.app.conftest import Mailroom, Served
from tests.app.everybody import Everybody, routes_of

ELSEWHERE: Final = (
    {"Sec-Fetch-Site": "cross-site"},
    {"Sec-Fetch-Site": "same-site"},  # another host of the campus
    {"Sec-Fetch-Site": "none"},  # typed into the address bar: no person posts that way
    {"Origin": "https://evil.example"},
    {"Origin": "null"},
)


@pytest.fixture
def everybody(app: FastAPI, mailroom: Mailroom) -> Everybody:
    return Everybody(app, mailroom)


@pytest.mark.slow
def test_no_route_that_changes_something_takes_a_request_from_elsewhere(
    app: FastAPI, served: Served, everybody: Everybody
) -> None:
    scene = everybody.scene("dispatcher")
    cookie = {"Cookie": scene.headers["Cookie"], "Idempotency-Key": "k"}
    unsafe = [(method, path) for method, path in routes_of(app) if method not in {*SAFE_METHODS, "SOCKET"}]
    assert len(unsafe) > 20
    taken = []
    with httpx.Client(base_url=served.url) as browser:
        for method, path in unsafe:
            for origin in ELSEWHERE:
                address = path.format_map(defaultdict(lambda: "1", scene.places))
                answer = browser.request(method, address, headers={**cookie, **origin}, json={})
                if (answer.status_code, answer.json()["code"]) != (403, "cross_site"):
                    taken.append((method, path, origin, answer.status_code))
    assert taken == []


def test_a_cookie_alone_without_a_word_of_where_it_comes_from_changes_nothing(
    served: Served, everybody: Everybody
) -> None:
    scene = everybody.scene("sender")
    cookie = {"Cookie": scene.headers["Cookie"]}
    order = f"{served.url}/api/v1/orders/{scene.places['order_id']}"
    refused = httpx.post(f"{order}/cancel", headers=cookie)
    assert (refused.status_code, refused.json()["code"]) == (403, "cross_site")
    assert httpx.get(order, headers=cookie).json()["state"] == "assigned"


def test_a_page_elsewhere_may_not_read_anything_either(served: Served, everybody: Everybody) -> None:
    """There is no permission to share with any origin, not even to ask for one."""
    elsewhere = {"Cookie": everybody.scene("sender").headers["Cookie"], "Origin": "https://evil.example"}
    read = httpx.get(f"{served.url}/api/v1/orders", headers=elsewhere)
    assert "access-control-allow-origin" not in read.headers
    asked = httpx.options(f"{served.url}/api/v1/orders", headers={**elsewhere, "Access-Control-Request-Method": "POST"})
    assert asked.status_code == 405
    assert "access-control-allow-origin" not in asked.headers
