"""Following through broken connections: nothing is missed, nothing told twice."""

import asyncio
from collections.abc import AsyncIterator

import pytest

from app.core.settings import Settings
from campus_mail_client import AsyncCampusMail, Change, NoAnswer, Retrying
from campus_mail_client.problems import NotSignedIn
from protocol.clock import SteppedClock
from tests.app.robots.playing import serving
from tests.client.conftest import RECIPIENT, Campus
from tests.client.wire import BreakingWire

LIFE = ("assigned", "to_sender", "at_sender", "carrying", "at_recipient", "delivered")


async def heard(changes: AsyncIterator[Change], into: list[Change]) -> None:
    async for change in changes:
        into.append(change)


async def until(ready: object, limit_s: float = 20) -> None:
    async with asyncio.timeout(limit_s):
        while not ready():  # type: ignore[operator]  # noqa: ASYNC110  # the stream rings no bell of ours
            await asyncio.sleep(0.02)


def orders_in(told: list[Change]) -> list[tuple[str, int]]:
    """Each version of an order, once for each time that the same was told; a new estimate of it is another event."""
    versions: list[tuple[str, int]] = []
    told_before: dict[tuple[str, int], list[object]] = {}
    for one in told:
        if one.event == "order":
            version = one.data["id"], one.data["version"]
            if version not in told_before or one.data in told_before[version]:
                versions.append(version)
            told_before.setdefault(version, []).append(one.data)
    return versions


async def test_a_stream_that_breaks_in_the_middle_of_events_misses_nothing_and_doubles_nothing(campus: Campus) -> None:
    await campus.enrol()
    token = await campus.token()
    told: list[Change] = []
    async with (
        AsyncCampusMail(campus.url, token) as mail,
        BreakingWire(campus.service.port, breaks=[700, 1500, 4000]).laid() as wire,
        AsyncCampusMail(f"http://127.0.0.1:{wire.port}", token) as follower,
    ):
        listening = asyncio.create_task(heard(follower.changes(), told))
        await until(lambda: told)
        orders = []
        for _ in range(4):
            order = await mail.place("post1", "post4", RECIPIENT)
            orders.append(order.id)
            await campus.move(order.id, *LIFE)
            await asyncio.sleep(0.4)
        await until(lambda: {version for _, version in orders_in(told)[-1:]} == {7} and wire.connections == 4)
        await until(lambda: orders_in(told)[-1][0] == orders[-1])
        listening.cancel()
    assert wire.connections == 4, "it broke three times"
    assert [one.event for one in told].count("connected") == 1
    assert "resync" not in {one.event for one in told}
    assert orders_in(told) == [(order_id, version) for order_id in orders for version in range(1, 8)]


async def test_one_order_is_followed_through_a_restart_of_the_service_to_its_end(
    settings: Settings, clock: SteppedClock
) -> None:
    states: list[str] = []

    async def follow(url: str, token: str, order_id: str) -> None:
        async with AsyncCampusMail(url, token) as mail:
            async for order in mail.follow(order_id):
                states.append(order.state)

    async with BreakingWire(0).laid() as wire:
        async with serving(settings, clock) as service:
            campus, wire.target_port = Campus(service), service.port
            await campus.enrol()
            token = await campus.token()
            async with AsyncCampusMail(campus.url, token) as mail:
                order_id = (await mail.place("post1", "post4", RECIPIENT)).id
            following = asyncio.create_task(follow(f"http://127.0.0.1:{wire.port}", token, order_id))
            await until(lambda: states)
            await campus.move(order_id, "assigned", "to_sender")
            await until(lambda: states[-1] == "to_sender")
        async with serving(settings, clock) as service:
            campus, wire.target_port = Campus(service), service.port
            await campus.move(order_id, "at_sender", "carrying")  # while no client listens
            await until(lambda: states[-1] == "carrying")
            await campus.move(order_id, "at_recipient", "delivered")
            await following
    once = list(dict.fromkeys(states))
    assert once[-4:] == ["to_sender", "carrying", "at_recipient", "delivered"]
    assert states.count("delivered") == states.count("at_recipient") == 1


async def test_a_stream_that_never_opens_is_an_error_and_not_silence(campus: Campus) -> None:
    async with AsyncCampusMail("http://127.0.0.1:9", "t", retrying=Retrying(tries=1)) as mail:
        with pytest.raises(NoAnswer):
            await anext(mail.changes())
    async with AsyncCampusMail(campus.url, "cmp_00000000_nothing") as mail:
        with pytest.raises(NotSignedIn):
            await anext(mail.changes())
