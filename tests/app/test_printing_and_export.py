"""Exports for the mailroom: a table of orders for a spreadsheet, marker sheets for the printer."""

import csv
import io
from datetime import timedelta

import pytest
from fastapi import FastAPI

from app.accounts.sign_in.service import find_person, set_roles
from app.core.database.database import Database
from app.core.settings import Settings
from app.models import Role
from app.retention.order_export import LONG_AGO, pieces
from protocol.clock import SteppedClock
from tests.app.conftest import RECIPIENT, SENDER, Browser, Mailroom, SignedIn

HEAD = (
    "\ufeffid,state,priority,created_at,updated_at,sender,recipient,placed_by,from_post,to_post,description,robot,"
    "window_from,window_to,loaded_at,ended_at\r\n"
)


@pytest.fixture
def settings(settings: Settings) -> Settings:
    """With a map that has bays on the floor: they have sheets, too."""
    return settings.model_copy(update={"map": "test_track"})


@pytest.fixture
def dispatcher(app: FastAPI, signed_in: SignedIn, mailroom: Mailroom) -> Browser:
    browser = signed_in("dispatcher@campus.example")

    async def promote() -> None:
        async with app.state.parts.database.transaction() as session:
            person = await find_person(session, "dispatcher@campus.example")
            assert person
            set_roles(person, {Role.DISPATCHER}, set())

    mailroom.call(promote)
    return browser


def table_of(text: str) -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO(text.removeprefix("\ufeff"), newline="")))


def test_a_time_of_orders_becomes_a_table_that_runs_nothing(
    sender: Browser, dispatcher: Browser, mailroom: Mailroom, clock: SteppedClock
) -> None:
    early = sender.order(description="Before").json()["id"]
    clock.advance(3600)
    begin = clock.utc()
    evil = ["=1+1", "+1", "-1", "@SUM(A1)", "\t=1", " =1", 'two; "three", lines, é']
    ids = []
    for text in evil:
        ids.append(sender.order(description=text).json()["id"])
        clock.advance(1)
    loaded = clock.utc()
    mailroom.move(ids[0], "assigned", "to_sender", "at_sender", "carrying", "at_recipient", "delivered")
    clock.advance(60)
    end = clock.utc()
    late = sender.order(description="After").json()["id"]

    answer = dispatcher.get("/api/v1/orders.csv", params={"from": begin.isoformat(), "to": end.isoformat()})
    assert answer.headers["content-type"] == "text/csv; charset=utf-8"
    assert answer.headers["content-disposition"].startswith('attachment; filename="orders-2')
    assert answer.headers["cache-control"] == "no-store"
    text = answer.content.decode("utf-8")
    assert text.startswith(HEAD)
    rows = table_of(text)
    assert [row["id"] for row in rows] == ids, "those of that time, the oldest first"
    assert [row["description"] for row in rows] == ["'=1+1", "'+1", "'-1", "'@SUM(A1)", "'=1", "'=1", evil[-1]]
    assert (rows[0]["sender"], rows[0]["recipient"], rows[0]["state"]) == (SENDER, RECIPIENT, "delivered")
    assert rows[0]["loaded_at"] == rows[0]["ended_at"] == loaded.isoformat().replace("+00:00", "Z")
    assert (rows[1]["loaded_at"], rows[1]["ended_at"]) == ("", "")
    clock.advance(60)
    everything = [row["id"] for row in table_of(dispatcher.get("/api/v1/orders.csv").text)]
    assert everything == [early, *ids, late]

    backwards = {"from": end.isoformat(), "to": (end - timedelta(days=1)).isoformat()}
    refused = dispatcher.get("/api/v1/orders.csv", params=backwards)
    assert (refused.status_code, refused.json()["code"]) == (400, "bad_range")
    assert sender.get("/api/v1/orders.csv").json()["code"] == "role_needed"


def test_a_long_table_comes_in_pieces_and_holds_no_connection_while_its_reader_waits(
    app: FastAPI, sender: Browser, mailroom: Mailroom, clock: SteppedClock
) -> None:
    ids = []
    for _ in range(5):
        clock.advance(1)
        ids.append(sender.order().json()["id"])

    async def read_slowly() -> tuple[list[str], list[int]]:
        # One of its own: the service's other parts use their connections meanwhile.
        database, texts, in_use = Database(app.state.parts.settings.url_of_database), [], []
        async for piece in pieces(database, LONG_AGO, clock.utc() + timedelta(seconds=1), at_once=2):
            texts.append(piece)
            in_use.append(database.engine.pool.checkedout())
        await database.close()
        return texts, in_use

    texts, in_use = mailroom.call(read_slowly)
    assert len(texts) == 4, "the head, then two, two and one"
    assert [row["id"] for row in table_of("".join(texts))] == ids
    assert max(in_use) == 0


def test_a_marker_sheet_is_the_one_of_the_command_in_its_true_size(dispatcher: Browser, sender: Browser) -> None:
    answer = dispatcher.get("/api/v1/map/posts/post1/marker.svg")
    assert answer.headers["content-type"] == "image/svg+xml"
    assert 'width="148mm" height="210mm" viewBox="0 0 148 210"' in answer.text
    assert "post1" in answer.text
    counts = {post["name"]: post["markers"] for post in dispatcher.get("/api/v1/map").json()["posts"]}
    assert f"{counts['post1']} of these at this post" in answer.text
    unknown = dispatcher.get("/api/v1/map/posts/pots1/marker.svg")
    assert (unknown.status_code, unknown.json()["code"]) == (404, "no_such_post")
    assert "post1" in unknown.json()["detail"]
    assert sender.get("/api/v1/map/posts/post1/marker.svg").json()["code"] == "role_needed"
