"""However many pages are open, an event is put into words once; and never if no page is there to read it."""

from collections.abc import ItemsView
from datetime import UTC, datetime

import pytest
from fastapi import FastAPI
from sqlalchemy.orm.exc import DetachedInstanceError

from app.accounts.sign_in.service import make_person
from app.core.database.database import savepoint
from app.orders.ledger import Actor
from app.orders.transitions import By
from app.realtime.feed import FeedEvent, LocalFeed
from tests.app.conftest import SENDER, Browser, Mailroom

AT = datetime(2026, 1, 5, 9, 0, tzinfo=UTC)


class Read(dict[str, int]):
    """Facts that know how often they were read."""

    times = 0

    def items(self) -> ItemsView[str, int]:
        self.times += 1
        return super().items()


def test_what_happens_is_encoded_once_for_all_listeners() -> None:
    feed, unheard, heard = LocalFeed(), Read(number=1), Read(number=2)
    feed.publish(FeedEvent("robot", unheard))
    people = [make_person(f"p{number}@campus.example", "en", AT) for number in range(3)]
    with feed.listening(people[0]) as first, feed.listening(people[1]) as second, feed.listening(people[2]) as third:
        feed.publish(FeedEvent("robot", heard))
        pieces = [queue.get_nowait() for queue in (first, second, third)]
    wires = [piece.wire for piece in pieces if piece is not None]
    assert wires == [f'event: robot\ndata: {{"number": 2}}\nid: {feed.last_id}\n\n'.encode()] * 3
    assert (unheard.times, heard.times) == (0, 1)


def test_what_cannot_be_put_into_words_any_more_is_fetched_anew(
    app: FastAPI, sender: Browser, mailroom: Mailroom
) -> None:
    """Something else in the transaction failed and was undone: it took along the row that the page was to be shown."""
    order_id = sender.order().json()["id"]
    wires = mailroom.call(_told_of_a_row_that_was_undone, app, order_id)
    events = [wire.partition(b"\n")[0].decode() for wire in wires]  # dispatch and notices may say something too
    assert events.count("event: resync") == 1
    assert "event: order" in events[events.index("event: resync") :], "the stream goes on"
    assert all(b"\nid: " in wire for wire in wires), "a stream that breaks goes on after it"


async def _told_of_a_row_that_was_undone(app: FastAPI, order_id: str) -> list[bytes]:
    state = app.state.parts
    async with state.database.transaction() as session:
        person = await state.sign_in_service.person(session, SENDER, state.clock.utc())
    with state.feed.listening(person) as queue:
        async with state.database.transaction() as session:
            await state.orders.ledger.note(session, order_id, "wait_extended", Actor(By.SENDER, person_id=person.id))
            order = await state.orders.ledger.order(session, order_id)
            with pytest.raises(ZeroDivisionError):
                async with savepoint(session):
                    order.why = "undone"
                    await session.flush()
                    1 / 0  # noqa: B018
        async with state.database.transaction() as session:
            await state.orders.ledger.note(session, order_id, "wait_extended", Actor(By.SENDER, person_id=person.id))
        with pytest.raises(DetachedInstanceError):
            _ = order.why
        return [queue.get_nowait().wire for _ in range(queue.qsize())]
