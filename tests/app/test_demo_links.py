"""The links of a demonstration sign a person in; no other service has such a link, and no other machine may use it."""

from pathlib import Path
from typing import Any

import pytest
from fastapi.testclient import TestClient
from httpx import Response

from app.accounts.demo_links import link_path
from app.composition import create_app
from app.core.server_key import ServerKey, open_server_key
from app.core.settings import Settings
from protocol.clock import SteppedClock
from tests.app.conftest import HERE

MAILROOM = "mailroom@campus.example"


@pytest.fixture
def link(settings: Settings) -> str:
    return link_path(open_server_key(settings.server_key_path), MAILROOM, "mailroom")


def opened(settings: Settings, link: str, host: str = HERE, **client: Any) -> Response:
    """The answer to a browser that follows the link."""
    app = create_app(settings, SteppedClock())
    with TestClient(app, base_url=host, client=client.get("client", ("127.0.0.1", 50000))) as browser:
        return browser.get(link, follow_redirects=False)


@pytest.fixture
def demonstration(settings: Settings, tmp_path: Path) -> Settings:
    return settings.model_copy(update={"demo_door": tmp_path / "door"})


def test_a_link_signs_its_person_in_and_leads_to_the_page(demonstration: Settings, link: str) -> None:
    with TestClient(create_app(demonstration, SteppedClock()), base_url=HERE, client=("127.0.0.1", 1)) as browser:
        answer = browser.get(link, follow_redirects=False)
        assert (answer.status_code, answer.headers["location"]) == (303, "/mailroom.html")
        assert browser.get("/api/v1/me").json()["email"] == MAILROOM


def test_a_service_that_is_no_demonstration_has_no_such_door(settings: Settings, link: str) -> None:
    answer = opened(settings, link)
    assert (answer.status_code, answer.cookies) == (404, {})
    paths = {getattr(route, "path", "") for route in create_app(settings, SteppedClock()).routes}
    assert not any(path.startswith("/demo") for path in paths)


@pytest.mark.parametrize(
    "stranger",
    [
        {"client": ("192.0.2.7", 50000)},
        {"host": "http://mail.campus.example"},
        {"key": ServerKey(b"another demonstration's")},
        {"who": "sender@campus.example"},
    ],
    ids=["from another machine", "by another name", "by another key", "for another person"],
)
def test_no_person_is_signed_in_by_what_is_no_link_of_this_demonstration(
    demonstration: Settings, link: str, stranger: dict[str, Any]
) -> None:
    if key := stranger.pop("key", None):
        link = link_path(key, MAILROOM, "mailroom")
    link = link.replace(MAILROOM, stranger.pop("who", MAILROOM))
    answer = opened(demonstration, link, **stranger)
    assert (answer.status_code, answer.json()["code"], answer.cookies) == (404, "no_such_link", {})


def test_a_demonstration_is_not_served_to_other_machines(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"demo_door is for demonstrations.*host must be 127\.0\.0\.1, not 0\.0\.0\.0"):
        Settings(demo_door=tmp_path / "door", host="0.0.0.0")  # noqa: S104  # what must not be
