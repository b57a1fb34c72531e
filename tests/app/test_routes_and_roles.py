"""Every route there is, asked by everybody there is. A route that is added without a line here fails the first test.

A line: what a stranger is answered, a member who has nothing to do with the order, its recipient, its sender, a
dispatcher, a maintainer; then the scopes of which any one opens the route to a script. A robot's token opens nothing
but the link; its line is the stranger's.
"""

from collections.abc import Iterator
from string import Formatter
from typing import Any, Final, NamedTuple

import httpx
import pytest
from fastapi import FastAPI
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

from app.accounts.scopes import Scope
from app.accounts.sessions.same_origin import SAFE_METHODS
from app.core.errors import PROBLEM_JSON
from app.http.api_document import operations
from app.robots.conversation.conversation import TOKEN_REFUSED
from tests.app.conftest import RECIPIENT, Mailroom, Served
from tests.app.everybody import PEOPLE, Everybody, routes_of


class Line(NamedTuple):
    """Status codes, and scopes: "" if the route needs no sign-in, "none" if no token opens it."""

    stranger: int
    member: int
    recipient: int
    sender: int
    dispatcher: int
    maintainer: int
    scopes: str


ASKED: Final = ("stranger", *PEOPLE)
OPEN: Final = Line(200, 200, 200, 200, 200, 200, "")
NOT_SET_UP: Final = Line(404, 404, 404, 404, 404, 404, "")
SCRIPTS: Final = tuple(str(scope) for scope in Scope)
REFUSALS: Final = frozenset({"scope_needed", "not_for_scripts"})
"""Answers to scripts whose person would be let in."""


def members(scopes: str, status: int = 200) -> Line:
    """Everybody who is signed in."""
    return Line(401, status, status, status, status, status, scopes)


def dispatchers(scopes: str, status: int = 200) -> Line:
    return Line(401, 403, 403, 403, status, 403, scopes)


def maintainers(scopes: str, status: int = 200) -> Line:
    return Line(401, 403, 403, 403, 403, status, scopes)


THEIR_CODE: Final = Line(401, 404, 404, 200, 200, 404, "orders:read")
LINES: Final[dict[tuple[str, str], Line]] = {
    # The order is assigned: it is the sender's turn to show a code, and who may cancel asks the robot to let go.
    ("GET", "/healthz"): OPEN,
    ("GET", "/readyz"): OPEN,
    ("GET", "/version"): OPEN,
    ("GET", "/metrics"): OPEN,  # to this machine, where all these ask from; to others see test_metrics
    ("GET", "/.well-known/assetlinks.json"): NOT_SET_UP,
    ("GET", "/src/offline/page_files.js"): OPEN,
    # Open as well; but this service's folder of pages has nothing that they are made of.
    ("GET", "/service_worker.js"): NOT_SET_UP,
    ("GET", "/src/styles/everywhere.css"): NOT_SET_UP,
    ("GET", "/src/texts/en.everyday.json"): NOT_SET_UP,
    ("GET", "/src/texts/fr.everyday.json"): NOT_SET_UP,
    ("GET", "/src/texts/en.mailroom.json"): NOT_SET_UP,
    ("GET", "/src/texts/fr.mailroom.json"): NOT_SET_UP,
    ("GET", "/api/v1/openapi.json"): OPEN,
    ("GET", "/api/v1/about"): OPEN,
    ("GET", "/api/v1/map"): OPEN,
    ("POST", "/api/v1/sign-in/codes"): Line(202, 202, 202, 202, 202, 202, ""),
    ("POST", "/api/v1/sign-in"): Line(401, 401, 401, 401, 401, 401, ""),
    ("GET", "/api/v1/sign-in/oidc"): NOT_SET_UP,
    ("GET", "/api/v1/sign-in/oidc/callback"): NOT_SET_UP,
    ("DELETE", "/api/v1/session"): members("none", 204),
    ("GET", "/api/v1/me"): members(" ".join(SCRIPTS)),
    ("PATCH", "/api/v1/me"): members("none"),
    ("GET", "/api/v1/me/contacts"): members("contacts:read"),
    ("PUT", "/api/v1/me/contacts/{email}"): members("none"),
    ("DELETE", "/api/v1/me/contacts/{email}"): members("none", 204),  # saved the line before
    ("GET", "/api/v1/me/delegates"): members("orders:read"),
    # A session and a token of the sender's.
    ("GET", "/api/v1/sessions"): members("none"),
    ("DELETE", "/api/v1/sessions"): members("none", 204),
    ("DELETE", "/api/v1/sessions/{session_id}"): Line(401, 404, 404, 204, 404, 404, "none"),
    ("GET", "/api/v1/tokens"): members("none"),
    ("POST", "/api/v1/tokens"): members("none", 201),
    ("DELETE", "/api/v1/tokens/{prefix}"): Line(401, 404, 404, 204, 404, 404, "none"),
    ("GET", "/api/v1/people"): Line(401, 403, 403, 403, 200, 200, "contacts:read"),
    ("PUT", "/api/v1/people/{person_id}/roles/{role}"): maintainers("none"),
    ("DELETE", "/api/v1/people/{person_id}/roles/{role}"): maintainers("none"),
    # By the link that the order's recipient was mailed, whatever client brings it.
    ("POST", "/api/v1/link/order"): OPEN,
    ("POST", "/api/v1/link/code"): Line(404, 404, 404, 404, 404, 404, ""),  # not their turn yet
    ("POST", "/api/v1/link/handover"): Line(409, 409, 409, 409, 409, 409, ""),
    ("POST", "/api/v1/link/not-now"): Line(409, 409, 409, 409, 409, 409, ""),
    ("POST", "/api/v1/link/delegate"): Line(201, 201, 201, 201, 201, 201, ""),
    ("GET", "/api/v1/estimate"): members("orders:read"),
    ("GET", "/api/v1/estimates"): Line(401, 403, 403, 403, 200, 200, "dispatch"),
    ("POST", "/api/v1/orders"): members("orders:write", 201),
    ("GET", "/api/v1/orders"): members("orders:read"),
    ("GET", "/api/v1/orders/{order_id}"): Line(401, 404, 200, 200, 200, 404, "orders:read"),
    ("GET", "/api/v1/orders/{order_id}/code"): Line(401, 404, 404, 200, 404, 404, "orders:read"),
    ("GET", "/api/v1/orders/{order_id}/page.svg"): Line(401, 404, 200, 200, 200, 404, "orders:read"),
    ("GET", "/api/v1/orders/{order_id}/code.svg"): Line(401, 404, 404, 200, 404, 404, "orders:read"),
    ("POST", "/api/v1/orders/{order_id}/handover"): Line(401, 404, 409, 409, 409, 404, "orders:write"),
    ("POST", "/api/v1/orders/{order_id}/digits/release"): dispatchers("dispatch"),
    # Named by the sender, to load: nothing of the recipient's.
    ("GET", "/api/v1/orders/{order_id}/delegates"): Line(401, 404, 200, 200, 200, 404, "orders:read"),
    ("POST", "/api/v1/orders/{order_id}/delegates"): Line(401, 404, 201, 201, 201, 404, "orders:write"),
    ("DELETE", "/api/v1/orders/{order_id}/delegates/{delegate_id}"): Line(401, 404, 404, 204, 204, 404, "orders:write"),
    ("GET", "/api/v1/orders/{order_id}/delegates/{delegate_id}/code"): THEIR_CODE,
    ("GET", "/api/v1/orders/{order_id}/delegates/{delegate_id}/code.svg"): THEIR_CODE,
    ("POST", "/api/v1/orders/{order_id}/cancel"): Line(401, 404, 409, 200, 200, 404, "orders:write"),
    # No mail is aboard, no robot waits, nothing needs attention.
    ("POST", "/api/v1/orders/{order_id}/recall"): Line(401, 404, 409, 409, 409, 404, "orders:write"),
    ("POST", "/api/v1/orders/{order_id}/not-now"): Line(401, 404, 409, 409, 409, 404, "orders:write"),
    ("POST", "/api/v1/orders/{order_id}/wait"): Line(401, 404, 409, 409, 409, 404, "orders:write"),
    ("POST", "/api/v1/orders/{order_id}/attention"): dispatchers("dispatch"),
    ("POST", "/api/v1/orders/{order_id}/resolve"): dispatchers("dispatch", 409),
    ("POST", "/api/v1/orders/{order_id}/hold"): dispatchers("dispatch", 409),
    ("POST", "/api/v1/orders/{order_id}/pass-on"): dispatchers("dispatch", 409),
    ("POST", "/api/v1/orders/{order_id}/reassign"): dispatchers("dispatch"),
    ("PUT", "/api/v1/orders/{order_id}/priority"): dispatchers("dispatch"),
    ("GET", "/api/v1/orders.csv"): dispatchers("dispatch"),
    ("GET", "/api/v1/map/posts/{post}/marker.svg"): Line(401, 403, 403, 403, 200, 200, "dispatch"),
    # The sender's.
    ("POST", "/api/v1/standing-orders"): members("orders:write", 201),
    ("GET", "/api/v1/standing-orders"): members("orders:read"),
    ("GET", "/api/v1/standing-orders/{standing_order_id}"): Line(401, 404, 404, 200, 200, 404, "orders:read"),
    ("POST", "/api/v1/standing-orders/{standing_order_id}/pause"): Line(401, 404, 404, 200, 200, 404, "orders:write"),
    ("POST", "/api/v1/standing-orders/{standing_order_id}/resume"): Line(401, 404, 404, 200, 200, 404, "orders:write"),
    ("POST", "/api/v1/standing-orders/{standing_order_id}/end"): Line(401, 404, 404, 200, 200, 404, "orders:write"),
    ("GET", "/api/v1/notices"): members("notices:read"),
    ("POST", "/api/v1/notices/read"): members("notices:write", 204),
    ("GET", "/api/v1/me/notices"): members("notices:read"),
    ("PUT", "/api/v1/me/notices"): members("notices:write"),
    ("POST", "/api/v1/me/devices"): members("none", 422),  # this page's keys are no browser's
    ("DELETE", "/api/v1/me/devices/{device_id}"): Line(401, 404, 404, 204, 404, 404, "none"),
    ("PUT", "/api/v1/me/webhook"): members("none", 422),  # to a machine behind the walls
    ("POST", "/api/v1/me/webhook/trial"): Line(401, 404, 404, 200, 404, 404, "none"),
    ("DELETE", "/api/v1/me/webhook"): Line(401, 404, 404, 204, 404, 404, "none"),
    ("GET", "/api/v1/outbox"): dispatchers("none"),
    ("POST", "/api/v1/outbox/{sending_id}/retry"): dispatchers("none", 202),
    ("GET", "/api/v1/spool"): dispatchers("none"),
    ("GET", "/api/v1/spool/{file}"): dispatchers("none", 404),
    ("GET", "/api/v1/live"): members("live:read"),
    ("GET", "/api/v1/robots"): members("robots:read"),
    ("GET", "/api/v1/map/traffic"): members("robots:read"),
    ("GET", "/api/v1/robots/{name}"): Line(401, 403, 403, 403, 200, 200, "dispatch"),
    ("GET", "/api/v1/robots/{name}/commands"): Line(401, 403, 403, 403, 200, 200, "dispatch"),
    ("GET", "/api/v1/robots/{name}/battery"): Line(401, 403, 403, 403, 200, 200, "dispatch"),
    ("POST", "/api/v1/robots/{name}/watch"): maintainers("maintain"),
    ("POST", "/api/v1/robots/{name}/pause"): dispatchers("dispatch", 202),
    ("POST", "/api/v1/robots/{name}/resume"): dispatchers("dispatch", 202),
    ("POST", "/api/v1/robots/{name}/recall"): dispatchers("dispatch", 202),
    ("POST", "/api/v1/robots/{name}/emergency-stop"): dispatchers("dispatch", 202),
    ("POST", "/api/v1/robots/{name}/take-out"): dispatchers("dispatch", 202),
    # It is not connected.
    ("POST", "/api/v1/robots/{name}/open-way"): dispatchers("dispatch", 409),
    ("GET", "/api/v1/corridors/closed"): members("robots:read"),
    ("POST", "/api/v1/corridors/{corridor}/close"): dispatchers("dispatch"),
    ("POST", "/api/v1/corridors/{corridor}/open"): dispatchers("dispatch"),
    ("GET", "/api/v1/alarms"): Line(401, 403, 403, 403, 200, 200, "dispatch"),
    ("POST", "/api/v1/alarms/{alarm_id}/acknowledge"): Line(401, 403, 403, 403, 200, 200, "dispatch"),
    # No caller has a code; the token is one of the robot's.
    ("POST", "/api/v1/robots/enrol"): Line(401, 401, 401, 401, 401, 401, ""),
    ("POST", "/api/v1/robots/{name}/enrolment-codes"): maintainers("maintain", 201),
    ("GET", "/api/v1/robots/{name}/tokens"): maintainers("maintain"),
    ("DELETE", "/api/v1/robots/{name}/tokens/{token_prefix}"): maintainers("maintain", 204),
    ("POST", "/api/v1/demo/camera"): members("none", 404),  # this is no demonstration
}
SOCKETS: Final = ("/api/v1/robots/link",)

ORDER: Final = {"from_post": "post1", "to_post": "post4", "recipient": RECIPIENT}
WISHES: Final[dict[tuple[str, str], dict[str, Any]]] = {
    # the body of a request; `{order_id}` and the like are filled in as in paths
    ("POST", "/api/v1/orders"): ORDER,
    ("POST", "/api/v1/orders/{order_id}/wait"): {},
    ("POST", "/api/v1/orders/{order_id}/attention"): {"reason": "It does not move."},
    ("POST", "/api/v1/orders/{order_id}/resolve"): {"to": "queued"},
    ("POST", "/api/v1/orders/{order_id}/hold"): {},
    ("POST", "/api/v1/orders/{order_id}/pass-on"): {},
    ("POST", "/api/v1/orders/{order_id}/reassign"): {},
    ("PUT", "/api/v1/orders/{order_id}/priority"): {"priority": "high"},
    ("POST", "/api/v1/standing-orders"): {**ORDER, "weekdays": [0], "at": "09:30", "zone": "America/Toronto"},
    ("POST", "/api/v1/sign-in/codes"): {"email": "new@campus.example"},
    ("POST", "/api/v1/sign-in"): {"email": "new@campus.example", "code": "00000000"},
    ("POST", "/api/v1/link/order"): {"token": "{link}"},
    ("POST", "/api/v1/link/code"): {"token": "{link}"},
    ("POST", "/api/v1/link/handover"): {"token": "{link}"},
    ("POST", "/api/v1/link/not-now"): {"token": "{link}"},
    ("POST", "/api/v1/link/delegate"): {"token": "{link}", "name": "Porter"},
    ("PATCH", "/api/v1/me"): {"language": "en"},
    ("PUT", "/api/v1/me/contacts/{email}"): {"label": "Aunt"},
    ("POST", "/api/v1/tokens"): {"name": "script", "scopes": ["orders:read"]},
    ("POST", "/api/v1/notices/read"): {"ids": [1]},
    ("POST", "/api/v1/orders/{order_id}/handover"): {},
    ("POST", "/api/v1/orders/{order_id}/delegates"): {"name": "The porter"},
    ("POST", "/api/v1/robots/{name}/pause"): {"reason": "A parade."},
    ("POST", "/api/v1/robots/{name}/recall"): {"reason": "A parade."},
    ("POST", "/api/v1/robots/{name}/emergency-stop"): {"reason": "A child."},
    ("POST", "/api/v1/robots/{name}/take-out"): {"reason": "Carried into the workshop."},
    ("POST", "/api/v1/robots/{name}/open-way"): {"corridor": "post2-post3"},
    ("POST", "/api/v1/corridors/{corridor}/close"): {"reason": "The floor is wet."},
    ("POST", "/api/v1/robots/enrol"): {"name": "r1", "code": "AAAA-AAAA", "public_key": 43 * "A" + "="},
    ("PUT", "/api/v1/me/notices"): {"muted": {}},
    ("POST", "/api/v1/me/devices"): {"endpoint": "https://push.example/1", "keys": {"p256dh": "AA", "auth": "AA"}},
    ("PUT", "/api/v1/me/webhook"): {"url": "https://127.0.0.1/"},
    ("POST", "/api/v1/demo/camera"): {"order_id": "{order_id}"},
}
QUESTIONS: Final = {"/api/v1/estimate": ORDER}


@pytest.fixture
def everybody(app: FastAPI, mailroom: Mailroom) -> Everybody:
    return Everybody(app, mailroom)


@pytest.fixture
def browser(served: Served) -> Iterator[httpx.Client]:
    with httpx.Client(base_url=served.url, timeout=20) as client:
        yield client


def test_every_route_has_its_line(app: FastAPI) -> None:
    known = set(LINES) | {("SOCKET", path) for path in SOCKETS}
    assert set(routes_of(app)) == known
    documented = {(m.upper(), path) for path, methods in app.openapi()["paths"].items() for m in methods}
    assert documented <= known


def knock(client: httpx.Client, everybody: Everybody, who: str, route: tuple[str, str]) -> tuple[int, str]:
    """Status, and the code of the problem if it is one."""
    method, path = route
    texts = [path, *(value for _, value in wish(route) if isinstance(value, str))]
    gaps = [gap for text in texts for _, gap, _, _ in Formatter().parse(text) if gap]
    scene = everybody.scene(who, gaps, anew=who in PEOPLE and method not in SAFE_METHODS)
    filled = {key: value.format_map(scene.places) if isinstance(value, str) else value for key, value in wish(route)}
    with client.stream(
        method,
        path.format_map(scene.places),
        params=QUESTIONS.get(path),
        json=filled if route in WISHES else None,
        headers={**scene.headers, "Idempotency-Key": "k"},
    ) as answer:  # not read to its end: an event stream has none
        if answer.status_code < 400:
            return answer.status_code, ""
        assert answer.headers["content-type"] == "application/problem+json", (who, route)
        answer.read()
        return answer.status_code, answer.json()["code"]


def wish(route: tuple[str, str]) -> Any:
    return WISHES.get(route, {}).items()


@pytest.mark.slow
def test_everybody_may_do_what_is_theirs_and_nothing_else(browser: httpx.Client, everybody: Everybody) -> None:
    holes = {}
    for route, line in LINES.items():
        answered = {who: knock(browser, everybody, who, route) for who in ASKED}
        expected = dict(zip(ASKED, line, strict=False))
        if {who: status for who, (status, _) in answered.items()} != expected:
            holes[route] = {"answered": answered, "expected": expected}
    assert holes == {}


@pytest.mark.slow
def test_a_script_may_do_what_its_scopes_say_and_nothing_else(browser: httpx.Client, everybody: Everybody) -> None:
    """Each scope that opens a route does so alone; all the others together do not."""
    holes = {}
    for route, line in LINES.items():
        if line.scopes:
            opening = set(line.scopes.split()) - {"none"}
            others = " ".join(scope for scope in SCRIPTS if scope not in opening)
            answered = {who: knock(browser, everybody, who, route)[1] for who in {*opening, others} - {""}}
            refused = {who: code for who, code in answered.items() if code in REFUSALS}
            if refused != ({others: "scope_needed" if opening else "not_for_scripts"} if others else {}):
                holes[route] = answered
    assert holes == {}


def test_the_document_offers_scripts_what_the_service_opens_to_them(app: FastAPI) -> None:
    """The lines here are what the service was seen to answer; who is told otherwise builds on sand."""
    opened = {(method.upper(), path): (offered(one), refusals(one)) for method, path, one in operations(app.openapi())}
    assert opened == {
        (method, path): (
            set(line.scopes.split()) - {"none"},
            {"": set(), "none": {"not_for_scripts"}}.get(line.scopes, {"scope_needed"}),
        )
        for (method, path), line in LINES.items()
        if (method, path) in opened
    }


def offered(operation: dict[str, Any]) -> set[str]:
    return {scope for way in operation.get("security", ()) for scope in way.get("token", ())}


def refusals(operation: dict[str, Any]) -> set[str]:
    """By which codes of these the operation may refuse a script, as the document has it."""
    forbidden = operation["responses"].get("403", {}).get("content", {}).get(PROBLEM_JSON, {})
    return REFUSALS & set(forbidden["schema"]["allOf"][1]["properties"]["code"]["enum"] if forbidden else ())


@pytest.mark.slow
def test_a_script_with_every_scope_may_do_what_its_person_may(browser: httpx.Client, everybody: Everybody) -> None:
    opened = [route for route, line in LINES.items() if line.scopes not in {"", "none"}]
    answered = {route: knock(browser, everybody, " ".join(SCRIPTS), route)[0] for route in opened}
    assert {route: status for route, status in answered.items() if status in {401, 403}} == {}


def test_a_delegate_has_their_code_and_is_else_like_anybody(browser: httpx.Client, everybody: Everybody) -> None:
    theirs = {
        ("GET", "/api/v1/orders/{order_id}/code"): 200,
        ("GET", "/api/v1/orders/{order_id}/code.svg"): 200,
        ("POST", "/api/v1/orders/{order_id}/handover"): 409,  # no robot waits yet
    }
    of_orders = {route: line.member for route, line in LINES.items() if "{order_id}" in route[1]}
    answered = {route: knock(browser, everybody, "delegate", route)[0] for route in of_orders}
    assert answered == {**of_orders, **theirs}


@pytest.mark.slow
def test_a_robots_token_opens_no_route(browser: httpx.Client, everybody: Everybody) -> None:
    answered = {route: knock(browser, everybody, "robot", route)[0] for route in LINES}
    assert answered == {route: line.stranger for route, line in LINES.items()}


def test_the_pages_are_for_everybody(browser: httpx.Client, everybody: Everybody) -> None:
    for who in (*ASKED, "robot", "orders:read"):
        assert browser.get("/", headers=everybody.scene(who).headers).status_code == 200


@pytest.mark.parametrize("path", SOCKETS)
def test_the_link_is_for_robots_alone(served: Served, everybody: Everybody, path: str) -> None:
    for who in (*ASKED, " ".join(SCRIPTS)):
        headers = everybody.scene(who).headers
        with connect(served.url.replace("http", "ws") + path, additional_headers=headers, proxy=None) as socket:
            with pytest.raises(ConnectionClosed) as closed:
                socket.recv(timeout=5)
            assert closed.value.rcvd is not None
            assert closed.value.rcvd.code == TOKEN_REFUSED, who


def test_lists_hold_what_is_ones_own_and_a_dispatchers_hold_everything(
    browser: httpx.Client, everybody: Everybody
) -> None:
    order_id = everybody.scene("stranger").places["order_id"]

    def mine(who: str, path: str) -> int:
        items = browser.get(path, headers=everybody.scene(who).headers).json()["items"]
        return [one.get("order_id") or one["id"] for one in items].count(order_id)

    def all_of(path: str) -> dict[str, int]:
        return {who: mine(who, path) for who in PEOPLE}

    nobodys = dict.fromkeys(PEOPLE, 0)
    assert all_of("/api/v1/orders") == {**nobodys, "recipient": 1, "sender": 1, "dispatcher": 1}
    assert all_of("/api/v1/orders?role=sent") == {**nobodys, "sender": 1}
    assert all_of("/api/v1/notices") == {**nobodys, "sender": 1}


def test_a_dispatchers_script_sees_others_orders_only_with_the_scope_dispatch(
    browser: httpx.Client, everybody: Everybody
) -> None:
    route = ("GET", "/api/v1/orders/{order_id}")
    assert knock(browser, everybody, "orders:read", route) == (404, "unknown_order")
    assert knock(browser, everybody, "orders:read dispatch", route) == (200, "")
