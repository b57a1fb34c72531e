"""Unchanged data is not sent again, and a client that changes an order can say which version it means."""

from typing import Any

import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient

from app.models import RobotRow
from tests.app.conftest import RECIPIENT, Browser, Mailroom, SignedIn


def asked_again(browser: TestClient, path: str, tag: str) -> Any:
    return browser.get(path, headers={"If-None-Match": tag})


@pytest.mark.parametrize("path", ["/api/v1/map", "/api/v1/orders", "/api/v1/robots", "/api/v1/notices"])
def test_what_one_has_already_is_not_sent_again(sender: Browser, path: str) -> None:
    first = sender.get(path)
    again = asked_again(sender, path, f'"other", W/{first.headers["ETag"]}')
    assert (again.status_code, again.content, again.headers["ETag"]) == (304, b"", first.headers["ETag"])
    assert "content-length" not in again.headers
    assert asked_again(sender, path, '"other"').content == first.content


def test_a_new_order_changes_the_tag_of_the_list(sender: Browser) -> None:
    tag = sender.get("/api/v1/orders").headers["ETag"]
    sender.order()
    assert asked_again(sender, "/api/v1/orders", tag).status_code == 200


def test_each_person_has_tags_of_their_own(sender: Browser, signed_in: SignedIn) -> None:
    path = sender.order().headers["Location"]
    tag = sender.get(path).headers["ETag"]
    assert asked_again(signed_in(RECIPIENT), path, tag).status_code == 200


def test_an_order_whose_robot_has_moved_is_sent_again_and_can_still_be_changed(
    app: FastAPI, sender: Browser, mailroom: Mailroom
) -> None:
    async def robot_says_why() -> None:
        async with app.state.parts.database.transaction() as session:
            robot = await session.get_one(RobotRow, "r1")
            robot.why = "I am on my way."

    path = sender.order().headers["Location"]
    mailroom.move(path.rpartition("/")[2], "assigned")
    tag = sender.get(path).headers["ETag"]
    assert asked_again(sender, path, tag).status_code == 304
    mailroom.call(robot_says_why)
    assert asked_again(sender, path, tag).status_code == 200
    assert sender.post(f"{path}/cancel", headers={"If-Match": tag}).status_code == 200


def test_an_order_that_has_changed_since_is_not_changed_by_mistake(sender: Browser, mailroom: Mailroom) -> None:
    path = sender.order().headers["Location"]
    tag = sender.get(path).headers["ETag"]
    mailroom.move(path.rpartition("/")[2], "assigned")
    answer = sender.post(f"{path}/cancel", headers={"If-Match": tag})
    assert (answer.status_code, answer.json()["code"]) == (412, "order_changed")


def test_a_code_is_kept_by_no_cache(sender: Browser, mailroom: Mailroom) -> None:
    path = sender.order().headers["Location"]
    mailroom.move(path.rpartition("/")[2], "assigned")
    answer = sender.get(f"{path}/code")
    assert (answer.status_code, answer.headers["Cache-Control"]) == (200, "no-store")
    assert "ETag" not in answer.headers
