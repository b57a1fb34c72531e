"""Every error is a problem document with a stable code, and no answer gives away what it should not."""

import sqlite3

import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient

from app.core.errors import PROBLEM_JSON
from app.core.settings import Settings
from app.http.api_document import operations
from tests.app.conftest import Browser, sqlite_alone


@pytest.mark.parametrize(
    ("method", "path", "status", "code"),
    [
        ("GET", "/nowhere", 404, "not_found"),
        ("GET", "/api/v1/nowhere", 404, "not_found"),
        ("GET", "/package.json", 404, "not_found"),
        ("GET", "/node_modules/lit/package.json", 404, "not_found"),
        ("DELETE", "/api/v1/me", 405, "method_not_allowed"),
        ("GET", "/api/v1/me", 401, "not_signed_in"),
    ],
)
def test_what_is_not_there_is_a_problem_too(
    anonymous: TestClient, method: str, path: str, status: int, code: str
) -> None:
    answer = anonymous.request(method, path)
    assert answer.headers["content-type"] == PROBLEM_JSON
    problem = answer.json()
    assert (answer.status_code, problem["status"], problem["code"]) == (status, status, code)
    assert problem["type"] == f"urn:campus-mail:problem:{code}"


@pytest.mark.parametrize(
    ("path", "allowed"),
    [
        ("/api/v1/robots/enrol", "POST"),  # not what GET /robots/{name} would make of it
        ("/api/v1/robots/r1", "GET"),
        ("/api/v1/me", "GET, PATCH"),
    ],
)
@pytest.mark.slow
def test_allow_says_what_the_document_says(anonymous: TestClient, path: str, allowed: str) -> None:
    answer = anonymous.options(path)
    assert (answer.status_code, set(answer.headers["Allow"].split(", "))) == (405, set(allowed.split(", ")))


def test_what_does_not_fit_is_named_by_its_field_and_not_repeated(anonymous: TestClient) -> None:
    answer = anonymous.post("/api/v1/sign-in", json={"email": "ann@campus.example", "code": "sesame-1234"})
    problem = answer.json()
    assert (answer.status_code, problem["code"]) == (422, "invalid_request")
    assert [error["field"] for error in problem["errors"]] == ["code"]
    assert "sesame" not in answer.text


def test_a_body_that_is_no_json_is_a_problem(anonymous: TestClient) -> None:
    answer = anonymous.post("/api/v1/sign-in", content="{", headers={"Content-Type": "application/json"})
    assert (answer.status_code, answer.json()["code"]) == (400, "malformed_body")


def test_an_unforeseen_error_is_a_problem_without_its_inside(app: FastAPI, anonymous: TestClient) -> None:
    async def broken() -> None:
        raise RuntimeError("the inside")

    app.add_api_route("/broken", broken)
    answer = anonymous.get("/broken")
    assert (answer.status_code, answer.json()["code"]) == (500, "unforeseen")
    assert "inside" not in answer.text


@sqlite_alone
def test_while_the_database_cannot_be_written_people_are_asked_to_try_again(
    settings: Settings, sender: Browser
) -> None:
    """As on a full disk: the same order, tried again with its key once there is room, is placed once."""
    file = settings.data / "campus-mail.sqlite"
    with sqlite3.connect(file) as plain:
        plain.execute("create trigger full before insert on orders begin select nobody_knows_this(); end")
    plain.close()
    refused = sender.order("once")
    assert (refused.status_code, refused.json()["code"]) == (503, "database_away")
    assert refused.headers["Retry-After"] == "5"
    assert "nobody_knows" not in refused.text
    with sqlite3.connect(file) as plain:
        plain.execute("drop trigger full")
    plain.close()
    assert sender.order("once").status_code == 201
    assert len(sender.get("/api/v1/orders").json()["items"]) == 1


def test_a_client_that_is_not_signed_in_is_told_how_to_say_who_they_are(anonymous: TestClient) -> None:
    assert anonymous.get("/api/v1/orders").headers["WWW-Authenticate"] == "Bearer"
    wrong = anonymous.get("/api/v1/orders", headers={"Authorization": "Bearer cmp_00000000_wrong"})
    assert wrong.headers["WWW-Authenticate"] == 'Bearer error="invalid_token"'


def closed_routes(app: FastAPI) -> list[tuple[str, str]]:
    """Return the routes that need a signed-in person, as the document says."""
    return [(method.upper(), path) for method, path, operation in operations(app.openapi()) if "security" in operation]


def test_every_route_that_is_not_open_wants_a_signed_in_person(app: FastAPI, anonymous: TestClient) -> None:
    closed = closed_routes(app)
    assert len(closed) > 30
    for method, path in closed:
        answer = anonymous.request(method, path.replace("{order_id}", "o1"), headers={"Idempotency-Key": "k"})
        assert (answer.status_code, answer.json()["code"]) == (401, "not_signed_in"), (method, path)


def test_every_route_that_changes_something_wants_our_own_page(app: FastAPI, sender: Browser) -> None:
    for method, path in closed_routes(app):
        if method == "GET":
            continue
        headers = {"Idempotency-Key": "k", "Sec-Fetch-Site": "cross-site"}
        answer = sender.request(method, path.replace("{order_id}", "o1"), headers=headers)
        assert (answer.status_code, answer.json()["code"]) == (403, "cross_site"), (method, path)


def test_pages_run_no_script_but_their_own(anonymous: TestClient) -> None:
    answer = anonymous.get("/")
    policy = answer.headers["content-security-policy"]
    assert "script-src 'self' 'sha256-" in policy
    assert "unsafe-inline" not in policy
    assert answer.headers["cache-control"] == "no-cache"
    assert answer.headers["x-content-type-options"] == "nosniff"


def test_the_service_says_how_it_is(anonymous: TestClient) -> None:
    assert anonymous.get("/healthz").json() == {"status": "ok"}
    assert anonymous.get("/readyz").json() == {"status": "ready"}
    assert anonymous.get("/version").json()["version"] == anonymous.get("/api/v1/about").json()["version"]


def test_a_page_learns_what_the_map_is(anonymous: TestClient) -> None:
    campus = anonymous.get("/api/v1/map").json()
    assert {"post1", "post4"} <= {post["name"] for post in campus["posts"]}
    assert all(len(corridor["tape"]) >= 2 for corridor in campus["corridors"])
    assert anonymous.get("/api/v1/about").json()["demo"] is False


def test_without_a_demonstration_there_is_no_camera(sender: Browser) -> None:
    answer = sender.post("/api/v1/demo/camera", json={"order_id": "o1"})
    assert (answer.status_code, answer.json()["code"]) == (404, "not_a_demonstration")
