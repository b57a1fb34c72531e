"""Rate limits: a client that asks too often is told to wait and for how long; other clients are not slowed down."""

from collections.abc import Iterator

import httpx
import pytest
from fastapi.testclient import TestClient
from starlette.requests import Request

from app.accounts.rate_limits import host_of
from app.core.settings import Settings
from tests.app.conftest import RECIPIENT, Browser, Served

CODES = "/api/v1/sign-in/codes"


@pytest.fixture
def settings(settings: Settings) -> Settings:
    few = {"orders_per_person": "3 per hour", "changes_per_person": "2 per hour"}
    few |= {f"{door}_tries_per_host": "2 per hour" for door in ("digits", "enrolment", "link")}
    few |= {"sign_in_tries_per_host": "8 per hour"}
    return settings.model_copy(update={"rate_limits": settings.rate_limits | few, "streams_per_person": 2})


def assert_slowed(answer: httpx.Response) -> None:
    assert (answer.status_code, answer.json()["code"]) == (429, "too_many_requests")
    assert 0 < int(answer.headers["Retry-After"]) <= 3600


def test_orders_are_counted_per_person(sender: Browser, recipient: Browser) -> None:
    assert [sender.order().status_code for _ in range(3)] == [201] * 3
    assert_slowed(sender.order())
    assert recipient.order(recipient="sender@campus.example").status_code == 201


def test_changes_are_counted_per_person(sender: Browser, recipient: Browser) -> None:
    assert sender.patch("/api/v1/me", json={"language": "fr"}).status_code == 200
    assert sender.post("/api/v1/tokens", json={"name": "x", "scopes": ["orders:read"]}).status_code == 201
    assert_slowed(sender.put(f"/api/v1/me/contacts/{RECIPIENT}", json={}))
    assert recipient.patch("/api/v1/me", json={"language": "fr"}).status_code == 200


def test_knocking_at_the_door_is_counted_per_address_that_it_comes_from(anonymous: TestClient) -> None:
    answers = [anonymous.post(CODES, json={"email": f"p{number}@campus.example"}) for number in range(9)]
    assert [answer.status_code for answer in answers[:8]] == [202] * 8
    assert_slowed(answers[8])


def test_a_client_that_guesses_digits_links_or_enrolment_codes_is_slowed_down(
    sender: Browser, anonymous: TestClient
) -> None:
    digits = f"/api/v1/orders/{sender.order().json()['id']}/handover"
    guess = {"name": "r9", "code": "AAAA-AAAA-AAAA", "public_key": "A" * 43}
    doors = ((sender, digits, {"digits": "000000"}), (anonymous, "/api/v1/link/order", {"token": "A" * 43}))
    for who, path, wish in (*doors, (anonymous, "/api/v1/robots/enrol", guess)):
        first = [who.post(path, json=wish).status_code for _ in range(2)]
        assert 429 not in first, path
        assert_slowed(who.post(path, json=wish))


def test_a_person_has_some_event_streams_open_and_no_more(served: Served, sender: Browser, recipient: Browser) -> None:
    def headers(browser: Browser) -> dict[str, str]:
        return {"Cookie": f"session={browser.cookies['session']}"}

    live = f"{served.url}/api/v1/live"
    with httpx.stream("GET", live, headers=headers(sender)), httpx.stream("GET", live, headers=headers(sender)) as last:
        assert last.status_code == 200
        assert_slowed(httpx.get(live, headers=headers(sender)))
        with httpx.stream("GET", live, headers=headers(recipient)) as other:
            assert other.status_code == 200
    assert any(_opens(live, headers(sender))), "a stream that has ended leaves its place"


def _opens(url: str, headers: dict[str, str]) -> Iterator[bool]:
    for _ in range(50):  # the service hears of a closed connection in its own time
        with httpx.stream("GET", url, headers=headers) as answer:
            yield answer.status_code == 200


@pytest.mark.parametrize(
    ("address", "counted_as"),
    [
        ("192.0.2.7", "192.0.2.7"),
        ("2001:db8:1:2:3:4:5:6", "2001:db8:1:2::/64"),
        ("2001:db8:1:2::9", "2001:db8:1:2::/64"),
        ("testclient", "unknown"),
    ],
)
def test_who_has_a_whole_network_of_addresses_counts_once(address: str, counted_as: str) -> None:
    assert host_of(Request({"type": "http", "client": (address, 1234)})) == counted_as
