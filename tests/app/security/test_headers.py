"""Security headers of every answer: pages, the API, problems, and paths that do not exist."""

import re
from pathlib import Path

import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient
from httpx import Headers

from app.core.settings import ROOT
from app.http.pages import content_security_policy
from tests.app.conftest import Browser

ANSWERS = {
    # path: status
    "/": 200,
    "/index.html": 200,
    "/service_worker.js": 404,
    "/nothing-here": 404,
    "/package.json": 404,
    "/healthz": 200,
    "/api/v1/about": 200,
    "/api/v1/me": 401,
    "/api/v1/people": 401,
    "/api/v1/nothing-here": 404,
    "/api/v1/link/order": 405,
    "/api/v1/sign-in/oidc": 404,
}
DOCUMENTS = {"/", "/index.html"}


def policy_of(headers: Headers) -> dict[str, str]:
    return dict(part.strip().partition(" ")[::2] for part in headers["Content-Security-Policy"].split(";"))


@pytest.fixture
def secure(app: FastAPI, anonymous: TestClient) -> TestClient:
    """A browser that came over https."""
    browser = TestClient(app, base_url="https://mail.campus.example")
    browser.portal = anonymous.portal
    return browser


@pytest.mark.parametrize("path", ANSWERS)
@pytest.mark.slow
def test_every_answer_says_what_browsers_must_not_do(secure: TestClient, path: str) -> None:
    answer = secure.get(path)
    assert answer.status_code == ANSWERS[path]
    headers = answer.headers
    policy = policy_of(headers)
    assert policy["frame-ancestors"] == "'none'", "no page of another site shows ours inside it"
    if path in DOCUMENTS:
        assert policy["default-src"] == "'self'"
        assert policy["object-src"] == policy["base-uri"] == "'none'"
        assert headers["Referrer-Policy"] == "same-origin"
        assert headers["Cross-Origin-Opener-Policy"] == "same-origin"
        assert "camera=()" in headers["Permissions-Policy"]
    else:
        assert policy["default-src"] == "'none'", "data is shown by pages; by itself it does nothing"
        assert "json" in headers["Content-Type"]
    assert headers["X-Content-Type-Options"] == "nosniff"
    assert headers["Cache-Control"] in {"no-cache", "no-store"}
    assert int(re.fullmatch(r"max-age=(\d+).*", headers["Strict-Transport-Security"])[1]) >= 15_768_000  # type: ignore[index]
    assert "server" not in headers, "which version of what runs here is not for clients to know"


@pytest.mark.parametrize("name", ["a_module.js", "some_style.css"])
def test_a_part_of_a_page_is_short_of_words_but_never_taken_for_something_else(
    app: FastAPI, secure: TestClient, name: str
) -> None:
    (app.state.parts.settings.pages / "src" / name).write_text("", encoding="utf-8")
    answer = secure.get(f"/src/{name}")
    assert answer.status_code == 200
    headers = answer.headers
    assert headers["X-Content-Type-Options"] == "nosniff"
    assert headers["Cache-Control"] == "no-cache"
    assert {"Content-Security-Policy", "Permissions-Policy"}.isdisjoint(headers)


def test_without_https_no_client_is_told_to_insist_on_it(anonymous: TestClient) -> None:
    """It would lock a developer out of their own localhost."""
    assert "Strict-Transport-Security" not in anonymous.get("/healthz").headers


def test_no_script_of_a_page_stands_in_it_but_the_import_maps_that_the_policy_names() -> None:
    policy = content_security_policy(ROOT / "web")
    assert "unsafe" not in policy
    assert policy.count("'sha256-") >= 1
    inline = re.compile(r"<script(?![^>]*\bsrc=)(?![^>]*importmap)|\son[a-z]+\s*=|javascript:", re.IGNORECASE)
    pages = list(Path(ROOT / "web/public").glob("*.html"))
    assert pages
    assert {page.name: found for page in pages if (found := inline.findall(page.read_text()))} == {}


def test_what_is_shown_once_is_kept_by_no_cache(sender: Browser) -> None:
    made = sender.post("/api/v1/tokens", json={"name": "x", "scopes": ["orders:read"]})
    assert made.headers["Cache-Control"] == "no-store"
