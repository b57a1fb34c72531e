"""Signing in by a mailed code, staying signed in, signing out."""

import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient

from app.accounts.sign_in.service import find_person
from app.core.settings import Settings
from app.models import Person
from protocol.clock import SteppedClock
from tests.app.conftest import HERE, SENDER, Browser, Mailroom, Mails, SignedIn, sqlite_alone

CODES, SIGN_IN = "/api/v1/sign-in/codes", "/api/v1/sign-in"

pytestmark = pytest.mark.mailed_codes


def code_of(answer: object) -> str:
    return answer.json()["code"]  # type: ignore[attr-defined]


def test_a_person_signs_in_with_the_code_from_their_mail(anonymous: TestClient, mails: Mails) -> None:
    assert anonymous.post(CODES, json={"email": "Ada.King@Campus.Example"}).status_code == 202
    code = mails.newest_code("ada.king@campus.example")
    person = anonymous.post(SIGN_IN, json={"email": "ada.king@campus.example", "code": code})
    assert person.status_code == 200
    assert person.json()["name"] == "Ada King"
    assert person.json()["roles"] == ["member"]
    cookie = person.headers["set-cookie"]
    assert cookie.startswith("session=")
    assert "HttpOnly" in cookie
    assert "SameSite=lax" in cookie
    assert anonymous.get("/api/v1/me").json() == person.json() | {"unread_notices": 0}


def test_on_https_the_cookie_belongs_to_this_host_alone(app: FastAPI, anonymous: TestClient, mails: Mails) -> None:
    secure = TestClient(app, base_url="https://mail.campus.example")
    secure.portal = anonymous.portal
    secure.post(CODES, json={"email": SENDER})
    answer = secure.post(SIGN_IN, json={"email": SENDER, "code": mails.newest_code(SENDER)})
    assert answer.headers["set-cookie"].startswith("__Host-session=")
    assert "Secure" in answer.headers["set-cookie"]
    assert secure.get("/api/v1/me").status_code == 200


def test_plain_http_from_another_machine_is_refused(app: FastAPI, anonymous: TestClient) -> None:
    remote = TestClient(app, base_url="http://mail.campus.example")
    remote.portal = anonymous.portal
    answer = remote.post(CODES, json={"email": SENDER})
    assert (answer.status_code, code_of(answer)) == (403, "https_required")


def test_a_person_who_was_sent_something_first_is_spoken_to_as_their_browser_does_from_then_on(
    anonymous: TestClient, sender: Browser, mails: Mails
) -> None:
    sender.order(recipient="bob@campus.example")
    languages = []
    for wanted in ("fr-CA,fr;q=0.9", "en"):
        anonymous.post(CODES, json={"email": "bob@campus.example"})
        wish = {"email": "bob@campus.example", "code": mails.newest_code("bob@campus.example")}
        languages.append(anonymous.post(SIGN_IN, json=wish, headers={"Accept-Language": wanted}).json()["language"])
    assert languages == ["fr", "fr"], "the first sign-in settles it, not whichever machine comes later"


def test_an_address_of_another_domain_gets_no_code(anonymous: TestClient, mails: Mails) -> None:
    answer = anonymous.post(CODES, json={"email": "eve@elsewhere.example"})
    assert (answer.status_code, code_of(answer)) == (422, "address_not_allowed")
    assert mails.to("eve@elsewhere.example") == []


def test_a_wrong_code_is_refused_and_five_of_them_use_the_code_up(anonymous: TestClient, mails: Mails) -> None:
    anonymous.post(CODES, json={"email": SENDER})
    right = mails.newest_code(SENDER)
    wrong = f"{(int(right) + 1) % 10**8:08d}"
    refusals = [code_of(anonymous.post(SIGN_IN, json={"email": SENDER, "code": wrong})) for _ in range(6)]
    assert refusals == ["wrong_code"] * 5 + ["code_expired"]
    assert code_of(anonymous.post(SIGN_IN, json={"email": SENDER, "code": right})) == "code_expired"


def test_a_code_is_good_once(anonymous: TestClient, mails: Mails) -> None:
    anonymous.post(CODES, json={"email": SENDER})
    wish = {"email": SENDER, "code": mails.newest_code(SENDER)}
    assert anonymous.post(SIGN_IN, json=wish).status_code == 200
    assert code_of(anonymous.post(SIGN_IN, json=wish)) == "code_expired"


def test_a_code_is_good_for_ten_minutes(anonymous: TestClient, mails: Mails, clock: SteppedClock) -> None:
    anonymous.post(CODES, json={"email": SENDER})
    clock.advance(600)
    answer = anonymous.post(SIGN_IN, json={"email": SENDER, "code": mails.newest_code(SENDER)})
    assert (answer.status_code, code_of(answer)) == (401, "code_expired")


def another_browser(app: FastAPI, anonymous: TestClient) -> TestClient:
    browser = TestClient(app, base_url=HERE)
    browser.portal = anonymous.portal
    return browser


def asked(browser: TestClient, mails: Mails) -> dict[str, str]:
    """Return the e-mail address and code that sign the sender in, as far as this browser may."""
    assert browser.post(CODES, json={"email": SENDER}).status_code == 202
    return {"email": SENDER, "code": mails.newest_code(SENDER)}


def test_the_last_three_codes_count_until_one_is_used(anonymous: TestClient, mails: Mails) -> None:
    wishes = [asked(anonymous, mails) for _ in range(4)]
    assert code_of(anonymous.post(SIGN_IN, json=wishes[0])) == "wrong_code"
    assert anonymous.post(SIGN_IN, json=wishes[1]).status_code == 200
    assert [code_of(anonymous.post(SIGN_IN, json=wish)) for wish in wishes] == ["code_expired"] * 4
    assert anonymous.post(SIGN_IN, json=asked(anonymous, mails)).status_code == 200


def test_wrong_tries_use_up_all_codes_of_a_browser(anonymous: TestClient, mails: Mails) -> None:
    wishes = [asked(anonymous, mails) for _ in range(2)]
    wrong = {"email": SENDER, "code": f"{(int(wishes[0]['code']) + int(wishes[1]['code']) + 1) % 10**8:08d}"}
    assert wrong["code"] not in {wish["code"] for wish in wishes}
    assert [code_of(anonymous.post(SIGN_IN, json=wrong)) for _ in range(6)] == ["wrong_code"] * 5 + ["code_expired"]
    assert [code_of(anonymous.post(SIGN_IN, json=wish)) for wish in wishes] == ["code_expired"] * 2


def test_a_code_is_good_in_the_browser_that_asked_for_it_and_no_other_one_uses_it_up(
    app: FastAPI, anonymous: TestClient, mails: Mails
) -> None:
    wish = asked(anonymous, mails)
    stranger = another_browser(app, anonymous)
    assert [code_of(stranger.post(SIGN_IN, json=wish)) for _ in range(6)] == ["code_expired"] * 6
    theirs = asked(stranger, mails)
    wrong = {"email": SENDER, "code": f"{(int(theirs['code']) + 1) % 10**8:08d}"}
    assert [code_of(stranger.post(SIGN_IN, json=wrong)) for _ in range(6)][-1] == "code_expired"
    assert [stranger.post(CODES, json={"email": SENDER}).status_code for _ in range(10)] == [202] * 9 + [429]
    assert anonymous.post(SIGN_IN, json=wish).status_code == 200, "asked before all that"
    late = another_browser(app, anonymous)
    assert late.post(SIGN_IN, json=asked(late, mails)).status_code == 200, "and after it"


class TestManyNewBrowsers:
    @pytest.fixture
    def settings(self, settings: Settings, request: pytest.FixtureRequest) -> Settings:
        return settings.model_copy(update={"rate_limits": settings.rate_limits | {request.param: "3 per 15 minutes"}})

    @pytest.mark.parametrize("settings", ["sign_in_codes_per_host", "new_browser_codes_per_address"], indirect=True)
    def test_are_slowed_down_together_but_not_who_has_signed_in_before(
        self, app: FastAPI, anonymous: TestClient, mails: Mails
    ) -> None:
        assert anonymous.post(SIGN_IN, json=asked(anonymous, mails)).status_code == 200
        assert anonymous.delete("/api/v1/session", headers={"Sec-Fetch-Site": "same-origin"}).status_code == 204
        strangers = [another_browser(app, anonymous).post(CODES, json={"email": SENDER}) for _ in range(3)]
        assert [answer.status_code for answer in strangers] == [202, 202, 429]
        assert anonymous.post(SIGN_IN, json=asked(anonymous, mails)).status_code == 200
        assert anonymous.post(CODES, json={"email": "other@campus.example"}).status_code == 202, "another address"


class TestAHostThatIsFlooded:
    @pytest.fixture
    def settings(self, settings: Settings) -> Settings:
        return settings.model_copy(
            update={"rate_limits": settings.rate_limits | {"sign_in_tries_per_host": "6 per 15 minutes"}}
        )

    def test_keeps_no_person_out_of_a_browser_where_they_have_signed_in(
        self, app: FastAPI, anonymous: TestClient, mails: Mails
    ) -> None:
        assert anonymous.post(SIGN_IN, json=asked(anonymous, mails)).status_code == 200
        assert anonymous.delete("/api/v1/session", headers={"Sec-Fetch-Site": "same-origin"}).status_code == 204
        stranger = another_browser(app, anonymous)
        guess = {"email": "eve@campus.example", "code": "00000000"}
        assert [stranger.post(SIGN_IN, json=guess).status_code for _ in range(5)] == [401] * 4 + [429]
        assert anonymous.post(SIGN_IN, json=asked(anonymous, mails)).status_code == 200
        assert [anonymous.post(SIGN_IN, json=guess).status_code for _ in range(5)] == [401] * 4 + [429], "its own count"

    def test_is_not_passed_by_with_a_cookie_of_ones_own_making(
        self, app: FastAPI, anonymous: TestClient, mails: Mails
    ) -> None:
        assert anonymous.post(SIGN_IN, json=asked(anonymous, mails)).status_code == 200
        secret, _, seal = anonymous.cookies["browser"].partition(".")
        assert seal, "sealed"
        guess = {"email": "eve@campus.example", "code": "00000000"}
        for cookie in (f"{'A' * 43}.{seal}", f"{secret}.{'A' * 43}", f"{secret}.é", secret, "", "."):
            forged = another_browser(app, anonymous)
            forged.post(SIGN_IN, json=guess, headers={"Cookie": f"browser={cookie}".encode()})
        assert another_browser(app, anonymous).post(SIGN_IN, json=guess).status_code == 429


def test_asking_too_often_for_codes_is_slowed_down(anonymous: TestClient) -> None:
    answers = [anonymous.post(CODES, json={"email": SENDER}) for _ in range(11)]
    assert [answer.status_code for answer in answers] == [202] * 10 + [429]
    assert int(answers[-1].headers["Retry-After"]) > 0
    assert anonymous.post(CODES, json={"email": "other@campus.example"}).status_code == 202


def test_a_session_ends_by_signing_out(sender: Browser) -> None:
    cookie = sender.cookies["session"]
    assert sender.delete("/api/v1/session").status_code == 204
    sender.cookies.set("session", cookie)
    assert code_of(sender.get("/api/v1/me")) == "not_signed_in"


def test_a_session_ends_by_itself_after_thirty_days(sender: Browser, clock: SteppedClock) -> None:
    clock.advance(30 * 86400 - 1)
    assert sender.get("/api/v1/me").status_code == 200
    clock.advance(1)
    assert sender.get("/api/v1/me").status_code == 401


@pytest.mark.parametrize(
    "headers",
    [
        {"Sec-Fetch-Site": "cross-site"},
        {"Sec-Fetch-Site": "same-site"},
        {"Sec-Fetch-Site": "", "Origin": "http://evil.example"},
        {"Sec-Fetch-Site": ""},
    ],
)
def test_another_site_cannot_act_with_a_persons_cookie(sender: Browser, headers: dict[str, str]) -> None:
    answer = sender.post("/api/v1/notices/read", json={"ids": []}, headers=headers)
    assert (answer.status_code, code_of(answer)) == (403, "cross_site")


def test_an_old_browser_that_says_only_its_origin_may_act(app: FastAPI, sender: Browser) -> None:
    old = TestClient(app, base_url="http://127.0.0.1", cookies={"session": sender.cookies["session"]})
    old.portal = sender.portal
    answer = old.post("/api/v1/notices/read", json={"ids": []}, headers={"Origin": "http://127.0.0.1"})
    assert answer.status_code == 204


@sqlite_alone
def test_codes_cookies_tokens_and_links_are_not_stored_in_the_clear(
    app: FastAPI, settings: Settings, sender: Browser, mails: Mails, mailroom: Mailroom
) -> None:
    token = sender.post("/api/v1/tokens", json={"name": "script", "scopes": ["orders:read"]}).json()["token"]
    order_id = sender.order(recipient="ann@campus.example").json()["id"]
    ann = mailroom.call(_person, app, "ann@campus.example")
    link = mailroom.call(app.state.parts.links.url_for, ann, order_id).partition("#")[2]
    stored = b"".join(file.read_bytes() for file in settings.data.glob("campus-mail.sqlite*"))
    assert SENDER.encode() in stored
    secrets = (mails.newest_code(SENDER), sender.cookies["session"], token.rpartition("_")[2], link)
    assert [secret for secret in secrets if secret.encode() in stored] == []


async def _person(app: FastAPI, email: str) -> Person | None:
    async with app.state.parts.database.reading() as session:
        return await find_person(session, email)


def test_the_mail_is_written_in_the_browsers_language(signed_in: SignedIn, anonymous: TestClient, mails: Mails) -> None:
    anonymous.post(CODES, json={"email": SENDER}, headers={"Accept-Language": "fr-CA,fr;q=0.9,en;q=0.5"})
    assert mails.to(SENDER)[0]["Subject"] == "Votre code de connexion à Campus Mail"
