"""Which file an address leads to: pages are looked for before the routes of the API, and must hide none of these."""

from pathlib import Path

import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient

from app.core.errors import add_error_answers
from app.http.pages import add_pages

WEB = Path(__file__).parents[2] / "web"


@pytest.fixture(scope="module")
def client() -> TestClient:
    app = FastAPI()
    add_error_answers(app)
    add_pages(app, WEB)
    app.get("/api/v1/about")(lambda: {"answered_by": "the API"})
    app.get("/healthz")(lambda: {"answered_by": "the API"})
    return TestClient(app, raise_server_exceptions=False)


@pytest.mark.parametrize(
    ("method", "path", "status"),
    [
        ("GET", "/", 200),
        ("HEAD", "/follow.html", 200),
        ("GET", "/src/elements/icon.js", 200),
        ("POST", "/", 405),
        ("GET", "/src/elements", 404),
        ("GET", "/src/%2e%2e/package.json", 404),
        ("GET", "/no-such-page", 404),
        ("POST", "/no-such-page", 404),
        ("GET", "/src/elements/a%00b.js", 404),
        ("GET", "/a%00b", 404),
        ("GET", "/" + "x" * 300, 404),
        ("GET", "/src/elements/" + "x" * 300, 404),
        ("GET", "/..%2fapp/main.py", 404),
        ("GET", "/%2e%2e/app/main.py", 404),
        ("GET", "/src/elements/%2e%2e/%2e%2e/app/main.py", 404),
    ],
)
def test_an_address_leads_to_a_file_of_the_pages_or_to_a_refusal(
    client: TestClient, method: str, path: str, status: int
) -> None:
    answer = client.request(method, path)
    assert answer.status_code == status
    if status != 200:
        assert answer.headers["content-type"] == "application/problem+json"


@pytest.mark.parametrize("path", ["/api/v1/about", "/healthz"])
def test_what_is_no_file_is_answered_by_the_routes_that_come_after(client: TestClient, path: str) -> None:
    assert client.get(path).json() == {"answered_by": "the API"}
