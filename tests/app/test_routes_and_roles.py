"""Every route there is, asked by everybody there is. A route that is added without a line here fails the first test."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Final

import httpx
import pytest
from fastapi import FastAPI
from starlette.routing import BaseRoute, Mount

from app.people.service import find_person, set_roles
from app.tables import Role
from tests.app.conftest import RECIPIENT, SENDER, STRANGER, Browser, Mailroom, Served, SignedIn

DISPATCHER: Final = "dispatcher@campus.example"
WHO: Final = ("nobody", "other member", "recipient", "sender", "dispatcher")
ORDER: Final = {"from_post": "post1", "to_post": "post4", "recipient": RECIPIENT}
WISHES: Final[dict[str, dict[str, Any]]] = {
    "/api/v1/orders": ORDER,
    "/api/v1/sign-in/codes": {"email": "new@campus.example"},
    "/api/v1/sign-in": {"email": "new@campus.example", "code": "00000000"},
    "/api/v1/notices/read": {"ids": [1]},
}

OPEN: Final = (200, 200, 200, 200, 200)
SIGNED_IN: Final = (401, 200, 200, 200, 200)
EXPECTED: Final[dict[tuple[str, str], tuple[int, ...]]] = {
    # The order is assigned: it is the sender's turn to show a code, and who may cancel asks the robot to let go.
    ("GET", "/healthz"): OPEN,
    ("GET", "/readyz"): OPEN,
    ("GET", "/version"): OPEN,
    ("GET", "/api/v1/openapi.json"): OPEN,
    ("GET", "/api/v1/about"): OPEN,
    ("GET", "/api/v1/map"): OPEN,
    ("POST", "/api/v1/sign-in/codes"): (202, 202, 202, 202, 202),
    ("POST", "/api/v1/sign-in"): (401, 401, 401, 401, 401),
    ("DELETE", "/api/v1/session"): (401, 204, 204, 204, 204),
    ("GET", "/api/v1/me"): SIGNED_IN,
    ("GET", "/api/v1/estimate"): SIGNED_IN,
    ("POST", "/api/v1/orders"): (401, 201, 201, 201, 201),
    ("GET", "/api/v1/orders"): SIGNED_IN,
    ("GET", "/api/v1/orders/{order_id}"): (401, 404, 200, 200, 200),
    ("GET", "/api/v1/orders/{order_id}/code"): (401, 404, 404, 200, 404),
    ("GET", "/api/v1/orders/{order_id}/code.svg"): (401, 404, 404, 200, 404),
    ("POST", "/api/v1/orders/{order_id}/cancel"): (401, 404, 409, 200, 200),
    ("GET", "/api/v1/notices"): SIGNED_IN,
    ("POST", "/api/v1/notices/read"): (401, 204, 204, 204, 204),
    ("GET", "/api/v1/live"): SIGNED_IN,
    ("GET", "/api/v1/robots"): SIGNED_IN,
    ("POST", "/api/v1/demo/camera"): (401, 404, 404, 404, 404),  # this is no demonstration
}
ELSEWHERE: Final = {
    "/api/v1/robots/link": "a WebSocket, for robots: tests/app/fleet/test_robot_link.py",
}


def routes_of(app: FastAPI) -> Iterator[tuple[str, str]]:
    """Method and path of every route, those that the API document leaves out too; a socket has no method."""
    for route, prefix in _flat(app.routes):
        path = prefix + getattr(route, "path", "")
        for method in getattr(route, "methods", None) or {"SOCKET"}:
            if method != "HEAD":
                yield method, path


def _flat(routes: list[BaseRoute], prefix: str = "") -> Iterator[tuple[BaseRoute, str]]:
    for route in routes:
        inner = getattr(route, "original_router", None)
        if inner is not None:
            yield from _flat(inner.routes, prefix + route.include_context.prefix)  # type: ignore[attr-defined]
        elif not isinstance(route, Mount):  # files
            yield route, prefix


def test_every_route_has_its_line(app: FastAPI) -> None:
    known = set(EXPECTED) | {("SOCKET", path) for path in ELSEWHERE}
    assert set(routes_of(app)) == known
    documented = {(m.upper(), path) for path, methods in app.openapi()["paths"].items() for m in methods}
    assert documented <= known


@dataclass(frozen=True)
class Everybody:
    """The cookies of whoever asks, and the order that they ask about."""

    cookies: dict[str, str]
    order_id: str


@pytest.fixture
def everybody(app: FastAPI, sender: Browser, recipient: Browser, signed_in: SignedIn, mailroom: Mailroom) -> Everybody:
    people = {"other member": signed_in(STRANGER), "recipient": recipient, "sender": sender}
    people["dispatcher"] = signed_in(DISPATCHER)
    mailroom.call(_make_dispatcher, app)
    order_id = sender.order().json()["id"]
    mailroom.move(order_id, "assigned")
    cookies = {who: f"session={browser.cookies['session']}" for who, browser in people.items()}
    return Everybody({"nobody": "", **cookies}, order_id)


async def _make_dispatcher(app: FastAPI) -> None:
    async with app.state.database.transaction() as session:
        person = await find_person(session, DISPATCHER)
        assert person
        set_roles(person, {Role.DISPATCHER}, set())


@pytest.mark.parametrize(("method", "path"), list(EXPECTED))
def test_everybody_may_do_what_is_theirs_and_nothing_else(
    served: Served, everybody: Everybody, method: str, path: str
) -> None:
    answered = []
    for who in WHO:
        headers = {"Cookie": everybody.cookies[who], "Sec-Fetch-Site": "same-origin", "Idempotency-Key": "k"}
        wish = {"order_id": everybody.order_id} if path.endswith("camera") else WISHES.get(path)
        with httpx.stream(
            method,
            served.url + path.replace("{order_id}", everybody.order_id),
            params={"from_post": "post1", "to_post": "post4"} if path.endswith("estimate") else None,
            json=wish if method == "POST" else None,
            headers=headers,
        ) as answer:  # not read to its end: an event stream has none
            answered.append(answer.status_code)
            if answer.status_code >= 400:
                assert answer.headers["content-type"] == "application/problem+json", (who, path)
    assert dict(zip(WHO, answered, strict=True)) == dict(zip(WHO, EXPECTED[method, path], strict=True))


def test_lists_hold_what_is_ones_own_and_a_dispatchers_hold_everything(
    served: Served, everybody: Everybody, sender: Browser
) -> None:
    def mine(who: str, path: str) -> list[str]:
        page = httpx.get(served.url + path, headers={"Cookie": everybody.cookies[who]}).json()
        return [one.get("order_id") or one["id"] for one in page["items"]]

    one = [everybody.order_id]
    assert [mine(who, "/api/v1/orders") for who in WHO[1:]] == [[], one, one, one]
    assert [mine(who, "/api/v1/orders?role=sent") for who in WHO[1:]] == [[], [], one, []]
    assert [mine(who, "/api/v1/notices") for who in WHO[1:]] == [[], [], one, []]
    assert {SENDER, RECIPIENT} <= {sender.get(f"/api/v1/orders/{one[0]}").json()[who]["email"] for who in WHO[2:4]}
