"""The worker round by round: what is noted down, what is sent again, and what is left alone."""

import asyncio
from collections.abc import AsyncIterator
from dataclasses import dataclass, field
from datetime import datetime, timedelta

import pytest
from sqlmodel import delete

from app.composition import create_app
from app.core.database.schema_version import bring_to_head
from app.core.settings import Settings
from app.models import Notification, OutgoingNotification, Webhook
from app.notifications.channels.interface import Delivery, NotSent
from app.notifications.delivery.worker import GATHER_S, LONGEST_REST_S, OutboxWorker, rest_s
from protocol.clock import SteppedClock
from tests.app.conftest import SENDER
from tests.app.notifications.office import Office


@dataclass
class Channel:
    """One that keeps what it was given, refuses what it is told to, and waits for its gate."""

    name: str = "mail"
    at_once: int = 4
    gives_up_after: timedelta = timedelta(days=1)
    refuses: set[str] = field(default_factory=set)
    given: list[Delivery] = field(default_factory=list)
    gate: asyncio.Event = field(default_factory=asyncio.Event)

    async def send(self, sending: Delivery) -> None:
        self.given.append(sending)
        await self.gate.wait()
        if sending.key in self.refuses:
            raise NotSent("not this one")

    @property
    def keys(self) -> list[str]:
        return [sending.key for sending in self.given]


@pytest.fixture
async def office(settings: Settings, clock: SteppedClock) -> AsyncIterator[Office]:
    """Without anything that runs by itself."""
    app = create_app(settings, clock)
    await bring_to_head(app.state.parts.database)
    yield Office(app, clock)
    for client in (app.state.parts.public_http, app.state.parts.operator_http):
        await client.aclose()
    await app.state.parts.database.close()


def worker_of(office: Office, *channels: Channel) -> OutboxWorker:
    return OutboxWorker(office.state.database, office.state.feed, office.clock, channels)


async def end_of_sending() -> None:
    """Give the tasks under way their turns."""
    for _ in range(5):
        await asyncio.sleep(0)


async def orders(office: Office, count: int) -> list[str]:
    """The keys of the mails that follow."""
    person = await office.person(SENDER)
    return [f"mail.{await office.order()}.accepted.{person.id}" for _ in range(count)]


async def test_in_a_batch_the_one_that_fails_is_tried_again_and_the_others_are_sent(office: Office) -> None:
    keys = await orders(office, 3)
    mail = Channel(refuses={keys[1]})
    mail.gate.set()
    worker = worker_of(office, mail)
    await worker.work_once()
    await end_of_sending()
    await worker.work_once()
    assert mail.keys == keys, "in the order of writing"
    first, failed, last = await office.sendings("mail")
    assert first.sent_at and last.sent_at and not failed.sent_at
    assert [one.tries for one in (first, failed, last)] == [1, 1, 1]
    assert failed.problem == "not this one" and failed.next_try_at and failed.next_try_at > office.clock.utc()
    assert first.next_try_at is last.next_try_at is None
    assert not await worker.has_work()


async def test_what_was_sent_and_not_noted_down_is_sent_again_under_its_key(office: Office) -> None:
    (key,) = await orders(office, 1)
    mail = Channel()
    mail.gate.set()
    await worker_of(office, mail).work_once()
    await end_of_sending()
    await worker_of(office, mail).work_once()  # another process: the first has noted down nothing
    await end_of_sending()
    assert mail.keys == [key, key]


class BadMoment(SteppedClock):
    """A round that asks for the time fails, once."""

    comes = False

    def utc(self) -> datetime:
        if self.comes:
            self.comes = False
            raise RuntimeError("a bad moment")
        return super().utc()


async def test_a_round_that_fails_has_nothing_sent_a_second_time(office: Office) -> None:
    keys, clock = await orders(office, 2), BadMoment()
    mail = Channel()
    worker = OutboxWorker(office.state.database, office.state.feed, clock, [mail])
    await worker.work_once()
    await end_of_sending()
    clock.comes = True
    with pytest.raises(RuntimeError, match="a bad moment"):
        await worker.run()
    mail.gate.set()
    worker.stop()
    await worker.run()
    assert all(one.sent_at for one in await office.sendings("mail"))
    assert mail.keys == keys


async def test_what_is_under_way_is_not_begun_again_and_no_more_than_there_are_places(office: Office) -> None:
    keys = await orders(office, 6)
    mail = Channel()
    worker = worker_of(office, mail)
    for _ in range(3):
        await worker.work_once()
        await end_of_sending()
    assert mail.keys == keys[:4]
    mail.gate.set()
    await end_of_sending()
    await worker.work_once()
    await end_of_sending()
    assert mail.keys == keys


async def test_what_was_erased_while_it_was_under_way_marks_no_other_as_sent(office: Office) -> None:
    await orders(office, 1)
    mail = Channel()
    worker = worker_of(office, mail)
    await worker.work_once()
    await end_of_sending()
    async with office.state.database.transaction() as session:
        await session.exec(delete(OutgoingNotification))
        await session.exec(delete(Notification))
    (other,) = await orders(office, 1)
    await worker.work_once()  # SQLite gives the other's row the number that has become free
    mail.gate.set()
    for _ in range(3):
        await end_of_sending()
        await worker.work_once()
    assert mail.keys[1:] == [other]
    assert (await office.sending("mail")).sent_at


async def test_one_target_is_sent_one_thing_at_a_time_and_holds_up_no_other(office: Office) -> None:
    sender, now = await office.person(SENDER), office.clock.utc()
    other = await office.person("other@campus.example")
    for number, person in enumerate((sender, other)):
        hook = f"https://hooks.example/{number}"
        await office.add(Webhook(id=f"hook{number}", person_id=person.id, url=hook, created_at=now))
    await orders(office, 2)
    about = {"from_post": "a", "to_post": "b", "recipient": "c", "window": "d"}
    await office.add(Notification(key="last", kind="accepted", person_id=other.id, at=now, facts=about))
    hooks = Channel("webhook")
    worker = worker_of(office, hooks)
    await worker.work_once()
    await worker.work_once()
    await end_of_sending()
    assert [one.target for one in hooks.given] == ["hook0", "hook1"]
    hooks.gate.set()
    await end_of_sending()
    await worker.work_once()
    await end_of_sending()
    assert [one.target for one in hooks.given] == ["hook0", "hook1", "hook0"]


def test_the_worker_rests_as_long_as_it_worked_within_bounds() -> None:
    assert [rest_s(took_s) for took_s in (0.001, 0.3, 9.0)] == [GATHER_S, 0.3, LONGEST_REST_S]
