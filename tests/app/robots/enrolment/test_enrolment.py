"""A robot enrols itself by a code that is good once, for minutes, for a few tries; tokens are listed and revoked."""

import base64
import json
import re
from pathlib import Path
from typing import Any

import httpx2
import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient
from sqlmodel import select
from typer.testing import CliRunner, Result

from app.__main__ import app as commands
from app.accounts.sign_in.service import find_person, set_roles
from app.core.settings import Settings
from app.models import EnrolmentCode, RobotRow, Role
from app.robots.enrolment.service import CODE_LIFETIME_S
from app.robots.link.tokens import token_of
from protocol.clock import SteppedClock
from tests.app.conftest import Browser, Mailroom, SignedIn

KEY = base64.b64encode(bytes(range(32))).decode()
MAINTAINER = "maintainer@campus.example"


@pytest.fixture
def maintainer(app: FastAPI, signed_in: SignedIn, mailroom: Mailroom) -> Browser:
    async def make() -> None:
        async with app.state.parts.database.transaction() as session:
            person = await find_person(session, MAINTAINER)
            assert person
            set_roles(person, {Role.MAINTAINER}, set())

    browser = signed_in(MAINTAINER)
    mailroom.call(make)
    return browser


def new_code(maintainer: Browser, name: str = "r7") -> str:
    answer = maintainer.post(f"/api/v1/robots/{name}/enrolment-codes")
    assert answer.status_code == 201, answer.text
    return str(answer.json()["code"])


def enrol(anonymous: TestClient, code: str, name: str = "r7", key: str = KEY) -> httpx2.Response:
    return anonymous.post("/api/v1/robots/enrol", json={"name": name, "code": code, "public_key": key})


def whose(app: FastAPI, mailroom: Mailroom, token: str) -> str | None:
    async def look() -> str | None:
        async with app.state.parts.database.transaction() as session:
            row = await token_of(session, f"Bearer {token}")
            return row.robot if row else None

    robot: str | None = mailroom.call(look)
    return robot


def problem(answer: httpx2.Response) -> tuple[int, str]:
    return answer.status_code, str(answer.json()["code"])


def test_a_code_brings_a_token_once_and_the_robots_key_is_known(
    app: FastAPI, maintainer: Browser, anonymous: TestClient, mailroom: Mailroom
) -> None:
    code = new_code(maintainer)
    answer = enrol(anonymous, code.lower().replace("-", " "))
    assert (answer.status_code, answer.json()["name"]) == (201, "r7")
    assert whose(app, mailroom, answer.json()["token"]) == "r7"
    assert problem(enrol(anonymous, code)) == (401, "no_enrolment_code"), "it is used"

    async def look() -> tuple[Any, Any]:
        async with app.state.parts.database.reading() as session:
            return await session.get(RobotRow, "r7"), (await session.exec(select(EnrolmentCode))).one()

    robot, row = mailroom.call(look)
    assert robot.public_key == KEY
    assert code.replace("-", "") not in row.model_dump_json()


def test_a_wrong_code_takes_a_try_and_after_five_the_right_one_is_worthless(
    maintainer: Browser, anonymous: TestClient
) -> None:
    code = new_code(maintainer)
    for _ in range(5):
        assert problem(enrol(anonymous, "AAAA-AAAA")) == (401, "wrong_enrolment_code")
    assert problem(enrol(anonymous, code)) == (401, "no_enrolment_code")


def test_a_code_is_good_for_its_own_robot_for_a_while_and_until_the_next_is_made(
    maintainer: Browser, anonymous: TestClient, clock: SteppedClock, settings: Settings
) -> None:
    code = new_code(maintainer)
    assert problem(enrol(anonymous, code, name="r8")) == (401, "no_enrolment_code")
    newer = new_code(maintainer)
    assert problem(enrol(anonymous, code)) == (401, "wrong_enrolment_code")
    clock.advance(CODE_LIFETIME_S)
    assert problem(enrol(anonymous, newer)) == (401, "no_enrolment_code")


class TestOfTheDoor:
    """A client that tries too often has to wait, whatever code it has."""

    @pytest.fixture
    def settings(self, settings: Settings) -> Settings:
        return settings.model_copy(
            update={"rate_limits": settings.rate_limits | {"enrolment_tries_per_host": "3 per 15 minutes"}}
        )

    def test_too_many_tries_from_one_address_are_refused(self, maintainer: Browser, anonymous: TestClient) -> None:
        code = new_code(maintainer)
        for _ in range(3):
            enrol(anonymous, "AAAA-AAAA")
        answer = enrol(anonymous, code)
        assert problem(answer) == (429, "too_many_requests")
        assert int(answer.headers["Retry-After"]) > 0


def test_a_robot_that_enrols_again_has_a_new_key_and_its_old_token_is_worthless(
    app: FastAPI, maintainer: Browser, anonymous: TestClient, mailroom: Mailroom
) -> None:
    old = enrol(anonymous, new_code(maintainer)).json()["token"]
    code = new_code(maintainer)
    assert whose(app, mailroom, old) == "r7", "until a technician comes with the code"
    new = enrol(anonymous, code, key=base64.b64encode(bytes(32)).decode()).json()["token"]
    assert (whose(app, mailroom, old), whose(app, mailroom, new)) == (None, "r7")


def test_tokens_are_listed_by_their_prefix_and_taken_back(
    app: FastAPI, maintainer: Browser, anonymous: TestClient, mailroom: Mailroom
) -> None:
    token = enrol(anonymous, new_code(maintainer)).json()["token"]
    (listed,) = maintainer.get("/api/v1/robots/r7/tokens").json()["items"]
    assert token.split("_")[1] == listed["prefix"]
    assert not listed["used_at"] and not listed["revoked_at"]
    assert token.split("_")[2] not in str(listed)
    assert maintainer.delete(f"/api/v1/robots/r7/tokens/{listed['prefix']}").status_code == 204
    assert whose(app, mailroom, token) is None
    assert maintainer.get("/api/v1/robots/r7/tokens").json()["items"][0]["revoked_at"]
    assert problem(maintainer.delete("/api/v1/robots/r1/tokens/01234567")) == (404, "unknown_robot_token")
    assert problem(maintainer.get("/api/v1/robots/r9/tokens")) == (404, "unknown_robot")


@pytest.mark.parametrize("key", ["", "AAAA", "not base64!"])
def test_a_key_that_is_none_is_refused_before_the_code_is_used(
    maintainer: Browser, anonymous: TestClient, key: str
) -> None:
    code = new_code(maintainer)
    assert problem(enrol(anonymous, code, key=key)) == (422, "invalid_request")
    assert enrol(anonymous, code).status_code == 201


def test_the_commands_print_a_code_list_tokens_by_prefix_and_take_one_back(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("CAMPUS_MAIL_DATA", str(tmp_path / "data"))

    def command(*words: str) -> Result:
        return CliRunner().invoke(commands, ["robots", *words])

    code = command("enrol", "r1")
    assert re.fullmatch(r"[2-9A-Z]{4}-[2-9A-Z]{4}\n", code.stdout), code.stdout
    assert command("tokens", "r1").exit_code == 2, "a code alone makes no robot"
    prefixes = [command("enrol", "r1", "--token", *again).stdout.split("_")[1] for again in ((), ("--again",))]
    listed = json.loads(command("tokens", "r1", "--json").stdout)
    assert [one["prefix"] for one in listed] == prefixes
    assert [one["revoked_at"] is None for one in listed] == [False, True]
    assert "1 tokens revoked" in command("revoke", "r1", "--prefix", prefixes[1]).stdout
    assert "0 tokens revoked" in command("revoke", "r1", "--prefix", prefixes[1]).stdout
