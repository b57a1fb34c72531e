"""Signing in at the campus itself, with a real provider in a process of its own (oidc-provider-mock)."""

from collections.abc import Iterator
from typing import Any
from urllib.parse import parse_qs, parse_qsl, urlencode, urlsplit, urlunsplit

import httpx
import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient
from pydantic import SecretStr

from app.cli.serving import listen
from app.core.settings import Settings
from protocol.clock import SteppedClock
from tests.app.accounts.campus_provider import campus_provider, tell_of
from tests.app.conftest import HERE, SignedIn

START = "/api/v1/sign-in/oidc"
ADA = {"email": "Ada.King@campus.example", "email_verified": True, "name": "Ada Lovelace"}


@pytest.fixture(scope="module")
def issuer() -> Iterator[str]:
    with campus_provider() as issuer:
        yield issuer


@pytest.fixture
def settings(settings: Settings, issuer: str) -> Settings:
    client = {"oidc_client_id": "campus-mail", "oidc_client_secret": SecretStr("between the two of us")}
    return settings.model_copy(update={"public_url": HERE, "oidc_issuer": issuer, **client})


class Campus:
    """The provider, as a person's browser and its administrator see it."""

    def __init__(self, issuer: str) -> None:
        self.issuer = issuer

    def knows(self, subject: str, **claims: Any) -> None:
        tell_of(self.issuer, subject, **claims)

    def sign_in(self, address: str, subject: str) -> str:
        """Where the provider sends the browser back to."""
        assert address.startswith(self.issuer)
        answer = httpx.post(address, data={"sub": subject})
        assert answer.status_code == 302, answer.text
        return answer.headers["Location"]


@pytest.fixture
def campus(issuer: str) -> Campus:
    campus = Campus(issuer)
    campus.knows("ada", **ADA)
    return campus


def start(browser: TestClient) -> str:
    answer = browser.get(START, follow_redirects=False)
    assert answer.status_code == 303
    return str(answer.headers["Location"])


def come_back(browser: TestClient, address: str) -> str:
    """Where the browser is sent in the end."""
    answer = browser.get(address, follow_redirects=False)
    assert answer.status_code == 303
    return str(answer.headers["Location"])


def problem(code: str) -> str:
    return f"/?sign_in_problem={code}"


def changed(address: str, **changes: str) -> str:
    parts = urlsplit(address)
    return urlunsplit(parts._replace(query=urlencode({**dict(parse_qsl(parts.query)), **changes})))


def test_a_person_signs_in_at_the_campus_and_is_known_again(anonymous: TestClient, campus: Campus) -> None:
    address = start(anonymous)
    asked = parse_qs(urlsplit(address).query)
    assert asked["code_challenge_method"] == ["S256"]
    assert len(asked["code_challenge"][0]) == 43
    assert come_back(anonymous, campus.sign_in(address, "ada")) == "/"
    me = anonymous.get("/api/v1/me").json()
    assert (me["email"], me["name"], me["roles"]) == ("ada.king@campus.example", "Ada Lovelace", ["member"])
    campus.knows("ada", **{**ADA, "email": "ada.lovelace@campus.example"})
    assert come_back(anonymous, campus.sign_in(start(anonymous), "ada")) == "/"
    assert anonymous.get("/api/v1/me").json()["id"] == me["id"], (
        "by issuer and subject, whatever becomes of the address"
    )


def test_a_person_who_signed_in_by_mail_before_is_the_same_person(
    app: FastAPI, anonymous: TestClient, signed_in: SignedIn, campus: Campus
) -> None:
    by_mail = signed_in("ada.king@campus.example").get("/api/v1/me").json()
    come_back(anonymous, campus.sign_in(start(anonymous), "ada"))
    assert anonymous.get("/api/v1/me").json() == {**by_mail, "name": "Ada Lovelace"}, "a better name than our guess"


def test_a_name_from_the_campus_is_one_printable_line(anonymous: TestClient, campus: Campus) -> None:
    paragraph = "Eve\r\n\r\nYour account ends today.\u2028\u202e" + "https://evil.example/ " * 10
    campus.knows("eve", **{**ADA, "email": "eve@campus.example", "name": paragraph})
    assert come_back(anonymous, campus.sign_in(start(anonymous), "eve")) == "/"
    name = anonymous.get("/api/v1/me").json()["name"]
    assert name == "Eve Your account ends today. https://evil.example/ https://evil.example/ https:/"
    assert (len(name), name.isprintable()) == (80, True)


class TestAHostThatIsFlooded:
    @pytest.fixture
    def settings(self, settings: Settings) -> Settings:
        return settings.model_copy(
            update={"rate_limits": settings.rate_limits | {"sign_in_tries_per_host": "4 per 15 minutes"}}
        )

    def test_keeps_no_person_out_of_a_browser_where_they_have_signed_in(
        self, app: FastAPI, anonymous: TestClient, campus: Campus
    ) -> None:
        come_back(anonymous, campus.sign_in(start(anonymous), "ada"))
        other = TestClient(app, base_url=HERE)
        other.portal = anonymous.portal
        assert [other.get(START, follow_redirects=False).status_code for _ in range(3)] == [303, 303, 429]
        assert come_back(anonymous, campus.sign_in(start(anonymous), "ada")) == "/"


def test_a_wrong_state_is_refused(app: FastAPI, anonymous: TestClient, campus: Campus) -> None:
    back = campus.sign_in(start(anonymous), "ada")
    other = TestClient(app, base_url=HERE)
    other.portal = anonymous.portal
    assert come_back(other, back) == problem("wrong_state"), "a browser that was not sent there"
    assert come_back(anonymous, changed(back, state="x")) == problem("wrong_state")
    assert come_back(anonymous, back) == problem("wrong_state"), "an attempt is one attempt"
    assert anonymous.get("/api/v1/me").status_code == 401


def test_an_attempt_is_good_for_ten_minutes(anonymous: TestClient, campus: Campus, clock: SteppedClock) -> None:
    back = campus.sign_in(start(anonymous), "ada")
    clock.advance(600)
    assert come_back(anonymous, back) == problem("wrong_state")


def test_a_cookie_that_was_made_elsewhere_is_refused(anonymous: TestClient, campus: Campus) -> None:
    back = campus.sign_in(start(anonymous), "ada")
    made_up = anonymous.cookies["oidc"].rsplit(".", 1)[0] + ".AAAA"
    anonymous.cookies.clear()
    anonymous.cookies.set("oidc", made_up)
    assert come_back(anonymous, back) == problem("wrong_state")


def test_a_token_with_another_nonce_is_refused(anonymous: TestClient, campus: Campus) -> None:
    back = campus.sign_in(changed(start(anonymous), nonce="another"), "ada")
    assert come_back(anonymous, back) == problem("oidc_untrusted")


def test_a_code_of_another_client_or_none_at_all_is_refused(anonymous: TestClient, campus: Campus) -> None:
    back = campus.sign_in(changed(start(anonymous), client_id="another-program"), "ada")
    assert come_back(anonymous, back) == problem("oidc_refused")
    back = campus.sign_in(start(anonymous), "ada")
    assert come_back(anonymous, changed(back, code="")) == problem("oidc_refused")


def test_a_code_is_good_once(anonymous: TestClient, campus: Campus) -> None:
    address = start(anonymous)
    cookie = anonymous.cookies["oidc"]
    back = campus.sign_in(address, "ada")
    assert come_back(anonymous, back) == "/"
    anonymous.cookies.clear()
    anonymous.cookies.set("oidc", cookie)
    assert come_back(anonymous, back) == problem("oidc_refused")


@pytest.mark.parametrize(
    ("claims", "code"),
    [
        ({"email": "ada@campus.example", "email_verified": False}, "email_not_verified"),
        ({"email": "ada@campus.example"}, "email_not_verified"),
        ({"email": "ada@campus.example", "email_verified": "yes"}, "email_not_verified"),
        ({"email_verified": True}, "email_not_verified"),
        ({"email": "ada@elsewhere.example", "email_verified": True}, "address_not_allowed"),
    ],
)
@pytest.mark.slow
def test_only_verified_addresses_of_our_domains_get_in(
    anonymous: TestClient, campus: Campus, claims: dict[str, Any], code: str
) -> None:
    campus.knows("doubtful", **claims)
    assert come_back(anonymous, campus.sign_in(start(anonymous), "doubtful")) == problem(code)
    assert anonymous.get("/api/v1/me").status_code == 401


def test_a_provider_that_is_not_there_is_a_problem_and_no_crash(anonymous: TestClient, app: FastAPI) -> None:
    with listen("127.0.0.1", 0) as gone:
        port = gone.getsockname()[1]
    app.state.parts.provider.settings = app.state.parts.settings.model_copy(
        update={"oidc_issuer": f"http://127.0.0.1:{port}"}
    )
    assert start(anonymous) == problem("provider_failed")


@pytest.mark.slow
def test_where_none_is_set_up_there_is_no_campus_sign_in(anonymous: TestClient, app: FastAPI) -> None:
    app.state.parts.provider.settings = app.state.parts.settings.model_copy(update={"oidc_issuer": ""})
    refused = anonymous.get(START)
    assert (refused.status_code, refused.json()["code"]) == (404, "no_campus_sign_in")
