"""Orders that come at the same time are placed together, and each is refused alone."""

import asyncio
from typing import Any

import pytest
from fastapi import FastAPI
from sqlalchemy import event
from sqlmodel import select

from app.accounts.sign_in.service import set_roles
from app.core.errors import ServiceError
from app.models import Person, Role
from app.orders.batcher import AT_ONCE, OrderBatcher, Placed
from app.orders.errors import KeyReused, StillRunning, UnknownPost, UnknownRecipient, UnknownSender
from app.orders.views.schemas import NewOrder
from tests.app.conftest import RECIPIENT, SENDER, Browser, Mailroom, sqlite_alone

NEWCOMER = "new.comer@campus.example"


class Crowd:
    """Requests of one person that come in before the first of them has been answered."""

    def __init__(self, app: FastAPI, mailroom: Mailroom) -> None:
        self._app, self._mailroom = app, mailroom
        self.desk: OrderBatcher = app.state.parts.order_batcher
        self.begun = 0

    def people(self) -> dict[str, Person]:
        return {one.email: one for one in self._mailroom.call(self._people)}

    async def _people(self) -> list[Person]:
        async with self._app.state.parts.database.reading() as session:
            return list((await session.exec(select(Person))).all())

    def dispatches(self, email: str) -> None:
        async def promote() -> None:
            async with self._app.state.parts.database.transaction() as session:
                person = (await session.exec(select(Person).where(Person.email == email))).one()
                set_roles(person, {Role.DISPATCHER}, set())

        self._mailroom.call(promote)

    def ask(self, *wishes: dict[str, Any], key: str = "k") -> list[Placed | BaseException]:
        made = [NewOrder.model_validate({"from_post": "post1", "to_post": "post4", **wish}) for wish in wishes]
        answers: list[Placed | BaseException] = self._mailroom.call(self._ask, made, key)
        return answers

    async def _ask(self, wishes: list[NewOrder], key: str) -> list[Placed | BaseException]:
        person = next(one for one in await self._people() if one.email == SENDER)
        engine = self._app.state.parts.database.writing.sync_engine
        event.listen(engine, "begin", self._count)
        try:
            places = [self.desk.place(person, f"{key}{number}", wish) for number, wish in enumerate(wishes)]
            return await asyncio.gather(*places, return_exceptions=True)
        finally:
            event.remove(engine, "begin", self._count)

    def _count(self, connection: Any) -> None:
        self.begun += "IMMEDIATE" in str(connection.get_execution_options().get("begin", "")) or (
            "advisory" in str(connection.get_execution_options().get("begin", ""))
        )


@pytest.fixture
def crowd(app: FastAPI, mailroom: Mailroom, sender: Browser, recipient: Browser) -> Crowd:
    return Crowd(app, mailroom)


def test_what_cannot_be_delivered_keeps_no_other_sender_from_ordering(crowd: Crowd, sender: Browser) -> None:
    answers = crowd.ask({"recipient": RECIPIENT}, {"recipient": RECIPIENT, "to_post": "post9"}, {"recipient": NEWCOMER})
    assert isinstance(answers[1], UnknownPost)
    placed = [one.view for one in answers if isinstance(one, Placed)]
    assert [one.recipient.email for one in placed] == [RECIPIENT, NEWCOMER]
    assert {one["id"] for one in sender.get("/api/v1/orders").json()["items"]} == {one.id for one in placed}


def test_of_an_order_that_is_refused_nothing_is_kept_nor_its_recipient(crowd: Crowd, sender: Browser) -> None:
    refused = crowd.ask({"recipient": NEWCOMER, "to_post": "post9"}, {"recipient": "eve@elsewhere.example"})
    assert [type(one) for one in refused] == [UnknownPost, UnknownRecipient]
    assert NEWCOMER not in crowd.people()
    (placed,) = crowd.ask({"recipient": NEWCOMER})  # under the same key, which was not used up
    assert isinstance(placed, Placed) and not placed.again
    assert [one["kind"] for one in sender.get("/api/v1/notices").json()["items"]] == ["accepted"]


def test_of_an_order_for_a_recipient_who_is_not_of_here_its_new_recipient_is_not_kept(crowd: Crowd) -> None:
    crowd.dispatches(SENDER)
    refused, placed = crowd.ask(
        {"recipient": NEWCOMER, "on_behalf_of": "eve@elsewhere.example"},
        {"recipient": RECIPIENT, "on_behalf_of": "walk.up@campus.example"},
    )
    assert isinstance(refused, UnknownSender) and isinstance(placed, Placed)
    assert placed.view.my_role == "dispatcher"
    assert {NEWCOMER, "walk.up@campus.example"} & crowd.people().keys() == {"walk.up@campus.example"}


def test_two_orders_to_the_same_newcomer_make_one_person(crowd: Crowd) -> None:
    first, second = crowd.ask({"recipient": NEWCOMER}, {"recipient": NEWCOMER})
    assert isinstance(first, Placed) and isinstance(second, Placed)
    assert first.view.id != second.view.id
    assert NEWCOMER in crowd.people()


def test_a_crowd_takes_few_transactions(crowd: Crowd) -> None:
    answers = crowd.ask(*({"recipient": RECIPIENT} for _ in range(2 * AT_ONCE)))
    assert len({one.view.id for one in answers if isinstance(one, Placed)}) == 2 * AT_ONCE
    assert crowd.begun <= 6  # two rounds; the outbox and dispatch have some of their own


def test_a_retry_among_new_orders_is_given_its_first_answer(crowd: Crowd) -> None:
    (first,) = crowd.ask({"recipient": RECIPIENT})
    again, other = crowd.ask({"recipient": RECIPIENT}, {"recipient": RECIPIENT})
    assert isinstance(first, Placed) and isinstance(again, Placed) and isinstance(other, Placed)
    assert (again.again, again.view, again.headers) == (True, first.view, first.headers)
    assert not other.again


def test_where_a_round_fails_each_of_its_orders_is_tried_by_itself(crowd: Crowd, sender: Browser) -> None:
    """A person who was erased just now cannot order any more; another who orders at the same moment can."""
    people = crowd.people()
    erased = people[SENDER].model_copy(update={"id": "nobody"})
    wish = NewOrder(from_post="post1", to_post="post4", recipient=RECIPIENT)

    async def both() -> list[Placed | BaseException]:
        desk = crowd.desk
        places = [desk.place(erased, "k", wish), desk.place(people[SENDER], "k", wish)]
        return await asyncio.gather(*places, return_exceptions=True)

    failed, placed = crowd._mailroom.call(both)
    assert isinstance(failed, Exception) and not isinstance(failed, ServiceError)
    assert isinstance(placed, Placed)
    assert [one["id"] for one in sender.get("/api/v1/orders").json()["items"]] == [placed.view.id]


def wish(**changes: Any) -> NewOrder:
    return NewOrder.model_validate({"from_post": "post1", "to_post": "post4", "recipient": RECIPIENT, **changes})


def test_a_key_is_one_persons_and_one_request_at_a_time(crowd: Crowd) -> None:
    people = crowd.people()
    me, other = people[SENDER], people[RECIPIENT]

    async def at_once() -> list[Placed | BaseException]:
        theirs = crowd.desk.place(other, "k", wish(recipient=SENDER))
        mine = [crowd.desk.place(me, "k", wish()), crowd.desk.place(me, "k", wish())]
        return await asyncio.gather(theirs, *mine, return_exceptions=True)

    theirs, first, second = crowd._mailroom.call(at_once)
    assert isinstance(theirs, Placed) and isinstance(first, Placed) and isinstance(second, StillRunning)
    again, new = crowd._mailroom.call(both, crowd.desk, (me, "k", wish()), (other, "l", wish()))
    assert (again.again, again.view.id, new.again) == (True, first.view.id, False)


@pytest.mark.parametrize(("changes", "expected"), [({}, Placed), ({"description": "Other keys."}, KeyReused)])
def test_a_sender_who_hangs_up_while_they_wait_has_ordered_once_whatever_they_ask_next(
    crowd: Crowd, sender: Browser, changes: dict[str, Any], expected: type
) -> None:
    person = crowd.people()[SENDER]

    async def twice() -> list[Placed | BaseException]:
        first = asyncio.create_task(crowd.desk.place(person, "k", wish()))
        await asyncio.sleep(0)  # it waits by now
        first.cancel()
        await asyncio.wait([first])
        return await asyncio.gather(crowd.desk.place(person, "k", wish(**changes)), return_exceptions=True)

    (second,) = crowd._mailroom.call(twice)
    assert isinstance(second, expected)
    assert len(sender.get("/api/v1/orders").json()["items"]) == 1


async def both(desk: OrderBatcher, *asked: tuple[Person, str, NewOrder]) -> list[Placed]:
    return list(await asyncio.gather(*(desk.place(*one) for one in asked)))


class Disk:
    """It is full when the database has grown to so many pages."""

    def __init__(self, app: FastAPI) -> None:
        self._engine = app.state.parts.database.engine
        self.pages = 1_000_000
        event.listen(self._engine.sync_engine, "begin", self._limit)

    def _limit(self, connection: Any) -> None:
        connection.connection.driver_connection.defer(f"PRAGMA max_page_count={self.pages}")

    async def has_room_for(self, pages: int) -> None:
        async with self._engine.connect() as connection:
            self.pages = (await connection.exec_driver_sql("PRAGMA page_count")).scalar_one() + pages


@sqlite_alone
def test_on_a_full_disk_some_orders_find_room_and_the_others_are_placed_by_their_keys_once_there_is_more(
    app: FastAPI, crowd: Crowd, sender: Browser
) -> None:
    wishes = [{"recipient": RECIPIENT, "description": "x" * 500} for _ in range(AT_ONCE)]
    disk = Disk(app)
    crowd._mailroom.call(disk.has_room_for, 1)
    before = crowd.ask(*wishes)
    placed = [one.view.id for one in before if isinstance(one, Placed)]
    assert len(placed) < AT_ONCE
    assert {one["id"] for one in sender.get("/api/v1/orders?limit=100").json()["items"]} == set(placed)
    crowd._mailroom.call(disk.has_room_for, 10_000)
    after = [one for one in crowd.ask(*wishes) if isinstance(one, Placed)]
    assert len(after) == AT_ONCE
    assert {one.view.id for one in after if one.again} == set(placed)
    assert len(sender.get("/api/v1/orders?limit=100").json()["items"]) == AT_ONCE
