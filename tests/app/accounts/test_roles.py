"""Roles, given and taken by maintainers; the first maintainer comes from the command line."""

from typing import Any

import pytest
from fastapi import FastAPI

from app.accounts.sign_in.service import find_person, set_roles
from app.models import Role
from tests.app.conftest import RECIPIENT, SENDER, Browser, Mailroom, SignedIn

PEOPLE = "/api/v1/people"


@pytest.fixture
def maintainer(app: FastAPI, signed_in: SignedIn, mailroom: Mailroom) -> Browser:
    browser = signed_in("maintainer@campus.example")
    mailroom.call(_make_maintainer, app)
    return browser


async def _make_maintainer(app: FastAPI) -> None:
    async with app.state.parts.database.transaction() as session:
        person = await find_person(session, "maintainer@campus.example")
        assert person
        set_roles(person, {Role.MAINTAINER}, set())


def id_of(browser: Browser) -> str:
    found: str = browser.get("/api/v1/me").json()["id"]
    return found


def test_a_maintainer_gives_and_takes_roles(maintainer: Browser, sender: Browser) -> None:
    role = f"{PEOPLE}/{id_of(sender)}/roles/dispatcher"
    assert sender.get(PEOPLE).json()["code"] == "role_needed"
    assert maintainer.put(role).json()["roles"] == ["dispatcher", "member"]
    assert maintainer.put(role).json()["roles"] == ["dispatcher", "member"], "once more changes nothing"
    assert sender.get(PEOPLE).status_code == 200, "from the very next request on"
    assert maintainer.delete(role).json()["roles"] == ["member"]
    assert sender.get(PEOPLE).status_code == 403
    assert maintainer.put(f"{PEOPLE}/nobody/roles/dispatcher").json()["code"] == "unknown_person"
    assert maintainer.put(f"{PEOPLE}/{id_of(sender)}/roles/boss").status_code == 422


def test_the_last_maintainer_stays_one(maintainer: Browser, sender: Browser) -> None:
    mine, theirs = (f"{PEOPLE}/{id_of(one)}/roles/maintainer" for one in (maintainer, sender))
    refused = maintainer.delete(mine)
    assert (refused.status_code, refused.json()["code"]) == (409, "last_maintainer")
    assert maintainer.put(theirs).status_code == 200
    assert sender.delete(mine).status_code == 200
    assert sender.delete(theirs).status_code == 409


def test_people_are_found_page_by_page(maintainer: Browser, sender: Browser, recipient: Browser) -> None:
    def asked(**question: Any) -> Any:
        return maintainer.get(PEOPLE, params=question).json()

    everybody = ["maintainer@campus.example", RECIPIENT, SENDER]
    assert [one["email"] for one in asked()["items"]] == everybody
    first = asked(limit=2)
    assert [one["email"] for one in first["items"]] == everybody[:2]
    rest = asked(limit=2, cursor=first["next"])
    assert ([one["email"] for one in rest["items"]], rest["next"]) == (everybody[2:], None)
    assert [one["email"] for one in asked(search="RECIP")["items"]] == [RECIPIENT]
    assert asked(search="%")["items"] == [], "a sign of the database's is a sign like any"
