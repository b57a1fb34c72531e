"""The session's cookie: out of reach of scripts, of other sites, of other hosts and of the open network."""

from http.cookies import Morsel, SimpleCookie

import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient

from app.core.settings import Settings
from tests.app.conftest import HERE, SENDER, Mails

SECURE = "https://mail.campus.example"


@pytest.fixture
def settings(settings: Settings) -> Settings:
    return settings.model_copy(update={"oidc_issuer": "http://127.0.0.1:9", "oidc_client_id": "campus-mail"})


def browser_at(base_url: str, app: FastAPI, anonymous: TestClient) -> TestClient:
    browser = TestClient(app, base_url=base_url, headers={"Sec-Fetch-Site": "same-origin"})
    browser.portal = anonymous.portal
    return browser


def cookie_of_sign_in(browser: TestClient, mails: Mails) -> Morsel[str]:
    browser.post("/api/v1/sign-in/codes", json={"email": SENDER})
    answer = browser.post("/api/v1/sign-in", json={"email": SENDER, "code": mails.newest_code(SENDER)})
    (cookie, known) = (
        one for set_one in answer.headers.get_list("Set-Cookie") for one in SimpleCookie(set_one).values()
    )
    assert known.key == cookie.key.replace("session", "browser")
    return cookie


@pytest.mark.parametrize(("base_url", "name", "secure"), [(SECURE, "__Host-session", True), (HERE, "session", "")])
def test_the_cookie_is_as_strict_as_it_can_be(
    app: FastAPI, anonymous: TestClient, mails: Mails, base_url: str, name: str, secure: bool | str
) -> None:
    cookie = cookie_of_sign_in(browser_at(base_url, app, anonymous), mails)
    assert cookie.key == name
    assert cookie["httponly"] is True
    assert cookie["samesite"] == "lax"
    assert cookie["secure"] == secure
    assert (cookie["path"], cookie["domain"]) == ("/", ""), "this host alone"
    assert cookie["max-age"] == str(30 * 86400)
    assert len(cookie.value) >= 43, "256 bits"


@pytest.mark.parametrize(("base_url", "name", "secure"), [(SECURE, "__Host-browser", True), (HERE, "browser", "")])
def test_the_cookie_of_the_browser_that_asks_for_a_code_is_as_strict_and_is_not_of_its_choice(
    app: FastAPI, anonymous: TestClient, base_url: str, name: str, secure: bool | str
) -> None:
    browser = browser_at(base_url, app, anonymous)
    chosen = browser.post("/api/v1/sign-in/codes", json={"email": SENDER}, headers={"Cookie": f"{name}=chosen"})
    (cookie,) = SimpleCookie(chosen.headers["Set-Cookie"]).values()
    assert (cookie.key, len(cookie.value), cookie["max-age"]) == (name, 43, str(180 * 86400))
    assert (cookie["httponly"], cookie["samesite"], cookie["secure"]) == (True, "lax", secure)
    assert (cookie["path"], cookie["domain"]) == ("/", "")
    again = browser.post("/api/v1/sign-in/codes", json={"email": "other@campus.example"})
    assert SimpleCookie(again.headers["Set-Cookie"])[name].value == cookie.value


def test_over_https_a_cookie_without_the_prefix_signs_no_person_in(
    app: FastAPI, anonymous: TestClient, mails: Mails
) -> None:
    """Another host of the campus can set `session` for the whole domain, but never `__Host-session`."""
    cookie = cookie_of_sign_in(browser_at(SECURE, app, anonymous), mails)
    fooled = browser_at(SECURE, app, anonymous)
    assert fooled.get("/api/v1/me", headers={"Cookie": f"session={cookie.value}"}).status_code == 401
    assert fooled.get("/api/v1/me", headers={"Cookie": f"__Host-session={cookie.value}"}).status_code == 200


def test_each_sign_in_has_a_cookie_of_its_own_whatever_was_brought(
    app: FastAPI, anonymous: TestClient, mails: Mails
) -> None:
    browser = browser_at(HERE, app, anonymous)
    browser.cookies.set("session", "chosen-by-a-stranger")
    first = cookie_of_sign_in(browser, mails).value
    again = cookie_of_sign_in(browser, mails).value
    assert len({"chosen-by-a-stranger", first, again}) == 3


def test_signing_out_takes_the_cookie_away_and_its_value_is_worthless(
    app: FastAPI, anonymous: TestClient, mails: Mails
) -> None:
    browser = browser_at(SECURE, app, anonymous)
    value = cookie_of_sign_in(browser, mails).value
    (gone,) = SimpleCookie(browser.delete("/api/v1/session").headers["Set-Cookie"]).values()
    assert (gone.key, gone.value, gone["max-age"], gone["secure"]) == ("__Host-session", "", "0", True)
    assert browser.get("/api/v1/me", headers={"Cookie": f"__Host-session={value}"}).status_code == 401
