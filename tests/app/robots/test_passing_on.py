"""Mail that changes robots half way: one order, two legs, and the mailroom's hands between them."""

from collections.abc import Iterator
from operator import attrgetter

import pytest

from app.accounts.sign_in.service import set_roles
from app.core.errors import ServiceError
from app.models import Notification, Order, OrderState, Person, Role
from app.orders.custody.codes import Holder, codes_of
from app.orders.service import Actor
from app.orders.transitions import By
from app.orders.views.views import load_facts, view_for
from protocol.clock import SteppedClock
from protocol.parts import Purpose
from protocol.to_robot import Cancel
from protocol.to_server import Step
from tests.app.robots.playing import PlayedRobot, Service

POST = "post3"


@pytest.fixture
def second(clock: SteppedClock) -> PlayedRobot:
    return PlayedRobot(clock, "r2", "journal-2")


class Mailroom:
    """A dispatcher of the service."""

    def __init__(self, service: Service) -> None:
        self.service = service

    async def does(self, what: str, order_id: str, *words: object) -> str:
        """The order's state then, or the code of the refusal."""
        state = self.service.app.state.parts
        try:
            async with state.database.transaction() as session:
                change = attrgetter(what)(state.orders)
                return str((await change(session, await self.person(session), order_id, *words)).state)
        except ServiceError as refused:
            return refused.code

    async def person(self, session: object) -> Person:
        state = self.service.app.state.parts
        person: Person = await state.sign_in_service.person(session, "mailroom@campus.example", state.clock.utc())
        set_roles(person, {Role.DISPATCHER}, set())
        return person

    async def links(self, order_id: str) -> list[tuple[str, str | None]]:
        """Return the holders of the mail, in turn."""
        state = self.service.app.state.parts
        async with state.database.transaction() as session:
            (facts,) = await load_facts(session, [await session.get_one(Order, order_id)])
            view = view_for(await self.person(session), facts, state.campus, state.settings, state.clock.utc())
            return [(one.holder, one.name) for one in view.custody]

    async def code(self, order_id: str) -> str:
        """As a dispatcher may show it, to load."""
        state = self.service.app.state.parts
        order = await self.service.row(Order, id=order_id)
        async with state.database.transaction() as session:
            shown = await state.hand_overs.my_code(session, await self.person(session), order_id)
        assert (shown.purpose, shown.holder) == (Purpose.LOAD, Holder.MAILROOM)
        assert shown.text(state.orders.key) not in [one.text(state.orders.key) for one in codes_of(order)[:4]], (
            "its own"
        )
        sha256: str = shown.sha256(state.orders.key)
        return sha256


@pytest.fixture
def mailroom(service: Service) -> Iterator[Mailroom]:
    yield Mailroom(service)


async def loads(robot: PlayedRobot, code: str | None = None) -> None:
    mission = await robot.mission()
    stop = mission.stops[0]
    await robot.report(mission, Step.ACCEPTED)
    await robot.ends(await robot.report(mission, Step.ARRIVED, stop, post=stop.post))
    facts = {"code_sha256": code} if code else {}
    await robot.ends(await robot.say(robot.receipt(stop, **facts)))


async def test_what_one_robot_cannot_carry_on_another_does_and_the_chain_has_no_gap(
    service: Service, mailroom: Mailroom, robot: PlayedRobot, second: PlayedRobot
) -> None:
    tokens = {name: await service.enrol(name) for name in ("r1", "r2")}
    order_id = await service.order()
    async with robot.connected(service.url, tokens["r1"]):
        await robot.greet("post1")
        assert await mailroom.does("passing_on.pass_on", order_id, POST, None) == "nothing_to_pass_on", (
            "it is with its sender"
        )
        await loads(robot)
        await service.reaches(order_id, "carrying")
        assert await mailroom.does("passing_on.pass_on", order_id, "attic", None) == "unknown_post"
        assert await mailroom.does("passing_on.pass_on", order_id, "post4", None) == "same_post"
        assert await mailroom.does("passing_on.pass_on", order_id, POST, "Its battery is flat.") == "queued"
        dropped = (await robot.hear("cancel")).body
        assert isinstance(dropped, Cancel)
        assert (dropped.order_id, dropped.by_hand) == (order_id, True), "it is to forget what it has not"
        async with second.connected(service.url, tokens["r2"]):
            await second.greet("post5")
            mission = await second.mission()
            assert [(stop.action, stop.post) for stop in mission.stops] == [("load", POST), ("receive", "post4")]
            load, give = mission.stops
            await second.report(mission, Step.ACCEPTED)
            await second.ends(await second.report(mission, Step.ARRIVED, load, post=POST))
            await second.ends(await second.say(second.receipt(load, code_sha256=await mailroom.code(order_id))))
            await service.reaches(order_id, "carrying")
            await second.ends(await second.report(mission, Step.ARRIVED, give, post=give.post))
            await second.ends(await second.say(second.receipt(give)))
        await service.reaches(order_id, "delivered")
    links = [("sender", None), ("robot", "r1"), ("mailroom", None), ("robot", "r2"), ("recipient", None)]
    assert await mailroom.links(order_id) == links
    sender = (await service.row(Order, id=order_id)).sender_id
    told = [one.kind for one in await service.rows(Notification, order_id=order_id, person_id=sender)]
    assert told.count("robot_here") == 1, "the second robot does not come to the sender"


@pytest.mark.parametrize("ends", ["its sender cancels", "no robot fetches it", "the robot on its way lets go"])
@pytest.mark.slow
async def test_mail_that_waits_for_its_second_leg_ends_in_the_mailrooms_hands(
    service: Service, mailroom: Mailroom, robot: PlayedRobot, ends: str
) -> None:
    order_id = await service.order()
    await service.enrol("r2")
    async with robot.connected(service.url, await service.enrol("r1")):
        await robot.greet("post1")
        await loads(robot)
        assert await mailroom.does("intervening.stop_for_attention", order_id, "It does not move.") == "attention"
        assert await mailroom.does("intervening.resolve", order_id, "queued", None) == "transition_refused", (
            "its mail is aboard"
        )
        assert await mailroom.does("passing_on.pass_on", order_id, POST, None) == "queued"
        assert await mailroom.does("passing_on.pass_on", order_id, POST, None) == "nothing_to_pass_on"
    state = service.app.state.parts
    if ends == "its sender cancels":
        await service.cancel(order_id)
    async with state.database.transaction() as session:
        if ends == "no robot fetches it":
            actor = Actor(By.TIMER, reason="Nobody came.")
            await state.orders.ledger.move(session, order_id, OrderState.EXPIRED, actor)
        elif ends == "the robot on its way lets go":
            for to, by in ((OrderState.ASSIGNED, By.DISPATCHER), (OrderState.CANCELLED, By.ROBOT)):
                await state.orders.ledger.move(session, order_id, to, Actor(by, robot="r2"))
    assert str((await service.row(Order, id=order_id)).state) == "held"
    assert (await mailroom.links(order_id))[-1] == ("mailroom", None)
