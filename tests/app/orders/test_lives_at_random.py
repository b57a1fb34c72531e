"""Whole lives of orders at random: people, dispatchers, time, robots and the network do what they like, in any order,
late and more than once; and whatever happens, these things hold."""

import asyncio
import os
import tempfile
from collections import Counter
from itertools import pairwise
from pathlib import Path
from typing import Any

from hypothesis import HealthCheck, Phase, note, settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, precondition, rule

from app.administration import migrate
from app.errors import ServiceError
from app.orders.custody import custody_of
from app.orders.telling import ONCE, TOLD
from app.orders.transitions import ENDED, MAIL_ABOARD, ROBOT_COMING, By, is_allowed
from app.settings import Settings
from app.tables import Handover, MissionRow, Notice, Order, OrderEvent, Person, Priority, StopRow
from app.tables import OrderState as S
from tests.app.orders.lives import World

POSTS = ("post1", "post2", "post3", "post4", "post5")
ROBOTS = st.sampled_from(("r1", "r2"))
LUCK = st.sampled_from(("sets out", "arrives", "no way", "nobody comes", "sender", "sender", "recipient", "mailroom"))
PEOPLE = st.sampled_from(("sender", "recipient", "dispatcher"))
ORDER = st.integers(0, 2)
TELLS = {one.kind: {state for state, told in TOLD.items() if one in told} for told in TOLD.values() for one in told}
ROUNDS_TO_THE_END = 25
folder = tempfile.TemporaryDirectory(prefix="lives-")


def template() -> Path:
    """An empty database, made once."""
    data = Path(folder.name) / "template"
    if not data.exists():
        asyncio.run(migrate(Settings(data=data)))
    return data / "campus-mail.sqlite"


class LivesOfOrders(RuleBasedStateMachine):
    """Three orders at most, two robots, one of each kind of person."""

    def __init__(self) -> None:
        super().__init__()
        self.runner = asyncio.Runner()
        self.world = World(template(), Path(tempfile.mkdtemp(dir=folder.name)) / "data")
        self.ids: list[str] = []
        self.ended: dict[str, S] = {}

    def run(self, work: Any) -> Any:
        return self.runner.run(work)

    def order(self, number: int) -> str:
        return self.ids[number % len(self.ids)]

    @initialize(from_post=st.sampled_from(POSTS), step=st.integers(1, 4))
    def begin(self, from_post: str, step: int) -> None:
        self.run(self.world.begin())
        self.somebody_orders(from_post, step)

    # What people do.

    @precondition(lambda self: len(self.ids) < 3)
    @rule(from_post=st.sampled_from(POSTS), step=st.integers(1, 4))
    def somebody_orders(self, from_post: str, step: int) -> None:
        to_post = POSTS[(POSTS.index(from_post) + step) % len(POSTS)]
        self.ids.append(self.run(self.world.place(from_post, to_post)))

    @rule(number=ORDER, who=PEOPLE, what=st.sampled_from(("cancel", "recall", "not_now", "extend_wait")))
    def somebody_asks(self, number: int, who: str, what: str) -> None:
        arguments = {"cancel": ("",), "extend_wait": (None,)}.get(what, ())
        self.tries(getattr(self.world.orders, what), who, self.order(number), *arguments)

    @rule(number=ORDER, to=st.sampled_from(("resume", "returning", "queued", "cancelled")))
    def a_dispatcher_decides(self, number: int, to: str) -> None:
        self.tries(self.world.orders.resolve, "dispatcher", self.order(number), to, "decided")

    @rule(number=ORDER)
    def a_dispatcher_stops_an_order(self, number: int) -> None:
        self.tries(self.world.orders.stop_for_attention, "dispatcher", self.order(number), "It does not move.")

    @rule(number=ORDER, robot=ROBOTS | st.none())
    def a_dispatcher_reassigns(self, number: int, robot: str | None) -> None:
        self.tries(self.world.orders.reassign, "dispatcher", self.order(number), robot)

    @rule(number=ORDER, priority=st.sampled_from(Priority))
    def a_dispatcher_prioritises(self, number: int, priority: Priority) -> None:
        self.tries(self.world.orders.prioritise, "dispatcher", self.order(number), priority)

    @rule(number=ORDER)
    def a_dispatcher_takes_mail_out_by_hand(self, number: int) -> None:
        """Only what is in a robot can be taken out of it."""
        order_id = self.order(number)
        if self.world.where[order_id] not in self.world.robots:
            return
        orders, state = self.world.orders, self.run(self.world.rows(Order, id=order_id))[0].state
        if state in MAIL_ABOARD - {S.AT_RETURN}:
            self.tries(orders.stop_for_attention, "dispatcher", order_id, "It stands in the way.")
        if state is S.AT_RETURN:
            done = self.tries(orders.hold, "dispatcher", order_id, "fetched")
        else:
            done = self.tries(orders.resolve, "dispatcher", order_id, "held", "fetched")
        if done:
            self.world.where[order_id] = "mailroom"

    @rule(robot=ROBOTS)
    def a_dispatcher_recalls_a_robot(self, robot: str) -> None:
        self.run(self.world.recall(robot))

    def tries(self, what: Any, who: str, order_id: str, *arguments: Any) -> bool:
        """Granted, or refused by name with nothing changed."""
        before = self.run(self.everything())
        try:
            self.run(self.world.change(what, who, order_id, *arguments))
        except ServiceError as refused:
            assert refused.code != "service_error"
            assert refused.sentence
            assert self.run(self.everything()) == before, "what is refused changes nothing"
            return False
        return True

    async def everything(self) -> dict[str, list[str]]:
        return await self.world.everything(Order, OrderEvent, Notice, Handover, MissionRow, StopRow, Person)

    # What time and dispatch do.

    @rule()
    def dispatch_looks(self) -> None:
        self.run(self.world.dispatch())

    @rule(minutes=st.sampled_from((1, 20, 600)))
    def time_passes(self, minutes: int) -> None:
        self.world.clock.advance(minutes * 60.0)
        self.run(self.world.timer.tick())

    @rule()
    def the_service_is_restarted(self) -> None:
        self.run(self.world.restart())

    # What robots do.

    @rule(robot=ROBOTS, luck=LUCK)
    def a_robot_acts(self, robot: str, luck: str) -> None:
        self.world.act(robot, luck)

    @rule(robot=ROBOTS, luck=st.lists(LUCK, min_size=1, max_size=4))
    def a_robot_goes_on(self, robot: str, luck: list[str]) -> None:
        """Dispatched to, told, doing and telling, as on a good day."""
        self.run(self.world.dispatch())
        if self.world.robots[robot].online:
            self.run(self.world.hear(robot))
            for one in luck:
                self.world.act(robot, one)
            self.run(self.world.speak(robot))

    @rule(number=ORDER, stops_at=st.sampled_from(("sender", "sets out", "arrives", "nobody comes")))
    def mail_is_loaded(self, number: int, stops_at: str) -> None:
        """Most of what can go wrong begins with mail that is aboard."""
        order_id = self.order(number)
        self.run(self.world.dispatch())
        for name, robot in self.world.robots.items():
            if robot.online and self.world.where[order_id] == "sender":
                self.run(self.world.hear(name))
                self.world.act(name, "sender")
                self.world.act(name, stops_at)
                self.run(self.world.speak(name))

    @rule(robot=ROBOTS, count=st.integers(1, 4))
    def a_robot_hears(self, robot: str, count: int) -> None:
        if self.world.robots[robot].online:
            self.run(self.world.hear(robot, count))

    @rule(robot=ROBOTS, count=st.integers(1, 4), is_heard=st.booleans())
    def a_robot_speaks(self, robot: str, count: int, is_heard: bool) -> None:
        if self.world.robots[robot].online:
            self.run(self.world.speak(robot, count, is_heard))

    @rule(robot=ROBOTS, online=st.booleans())
    def the_network_comes_and_goes(self, robot: str, online: bool) -> None:
        self.run(self.world.set_online(robot, online))

    @rule(robot=ROBOTS, number=st.integers(0, 9))
    def a_robot_repeats_itself(self, robot: str, number: int) -> None:
        if not self.world.robots[robot].online:
            return
        self.run(self.world.speak(robot))
        before = self.run(self.everything())
        self.run(self.world.say_again(robot, number))
        assert self.run(self.everything()) == before, "what was said before changes nothing"

    @rule(robot=ROBOTS, name=st.sampled_from(("wheel_drop", "bump")), is_over=st.booleans())
    def a_robot_has_a_fault(self, robot: str, name: str, is_over: bool) -> None:
        self.world.robots[robot].duties.report_fault(name, f"It is {name}.", "post3", cleared=is_over)
        # Faults may come again: they are no part of what is repeated.
        self.run(self.speak_and_forget(robot))

    async def speak_and_forget(self, robot: str) -> None:
        if self.world.robots[robot].online:
            await self.world.speak(robot)
        said = self.world.robots[robot].said
        said[:] = [one for one in said if one.happened.kind != "fault"]

    # What holds.

    @invariant()
    def everything_holds(self) -> None:
        if self.ids:
            self.run(self.check())

    async def check(self) -> None:
        orders = await self.world.rows(Order)
        events = await self.world.rows(OrderEvent)
        handovers = await self.world.rows(Handover)
        notices = await self.world.rows(Notice)
        for order in orders:
            theirs = sorted((one for one in events if one.order_id == order.id), key=lambda one: one.seq)
            passed_on = sorted((one for one in handovers if one.order_id == order.id), key=lambda one: one.id)
            self.every_change_is_explained(order, theirs)
            self.terminal_is_terminal(order, theirs)
            self.exactly_one_holds_the_mail(order, passed_on)
            self.nobody_is_told_twice(theirs, [one for one in notices if one.order_id == order.id])

    def every_change_is_explained(self, order: Order, events: list[OrderEvent]) -> None:
        assert [one.seq for one in events] == list(range(1, order.version + 1)), "one event for each version"
        moves = [one for one in events if one.kind == "moved"]
        assert moves[-1].state is order.state
        assert moves[0].state is S.QUEUED
        before: S | None = None
        for last, one in pairwise(moves):
            assert is_allowed(last.state, one.state, By(one.by), before), (last.state, one.state, one.by)
            before = last.state if one.state is S.ATTENTION else None
        for one in events:
            assert one.robot if one.by == By.ROBOT else one.person_id or one.by == By.TIMER or one.state is S.ASSIGNED
            if one.kind == "moved" and one.state in {S.ATTENTION, S.EXPIRED}:
                assert one.reason

    def terminal_is_terminal(self, order: Order, events: list[OrderEvent]) -> None:
        if order.id in self.ended:
            assert order.state is self.ended[order.id]
        if order.state in ENDED:
            self.ended[order.id] = order.state
        assert not ENDED & {one.state for one in events if one.kind == "moved"} - {order.state}

    def exactly_one_holds_the_mail(self, order: Order, handovers: list[Handover]) -> None:
        chain = custody_of(order, handovers)
        assert [held.until for held in chain[:-1]] == [held.since for held in chain[1:]], "a chain without gaps"
        assert chain[-1].until is None, "and one who holds it now"
        assert all(one.since <= two.since for one, two in pairwise(chain))
        holder = chain[-1].name or chain[-1].holder
        state = order.state_before_attention or order.state
        if state in MAIL_ABOARD:
            assert holder == order.robot
        elif state is S.QUEUED or state in ROBOT_COMING or state is S.RETURNED:
            assert holder == "sender"
        elif state in {S.DELIVERED, S.HELD}:
            assert holder == {S.DELIVERED: "recipient", S.HELD: "mailroom"}[state]
        if all(robot.outbox.waiting() == 0 for robot in self.world.robots.values()):
            assert holder == self.world.where[order.id], "with everything told, the record is the truth"

    def nobody_is_told_twice(self, events: list[OrderEvent], notices: list[Notice]) -> None:
        moves = Counter(one.state for one in events if one.kind == "moved")
        for (kind, _), count in Counter((one.kind, one.person_id) for one in notices).items():
            if kind in TELLS:
                assert count <= (1 if kind in ONCE else sum(moves[state] for state in TELLS[kind])), kind

    # And in the end.

    def teardown(self) -> None:
        try:
            if self.ids:
                self.run(self.everybody_does_their_part())
        finally:
            if hasattr(self.world, "database"):
                self.run(self.world.end())
            self.runner.close()

    async def everybody_does_their_part(self) -> None:
        """Whatever went before: with a network, people who come and a dispatcher who decides, every order ends."""
        for robot in self.world.robots.values():
            await self.world.set_online(robot.name, True)
            for fault in ("wheel_drop", "bump"):
                robot.duties.report_fault(fault, "It is over.", "post3", cleared=True)
        for _ in range(ROUNDS_TO_THE_END):
            await self.one_round()
            if await self.all_is_done():
                break
        orders = await self.world.rows(Order)
        note(
            str(
                [(one.id, one.state, one.state_before_attention, one.robot, self.world.where[one.id]) for one in orders]
            )
        )
        assert await self.all_is_done(), "no order and no robot is stuck for ever"
        await self.check()

    async def one_round(self) -> None:
        await self.world.dispatch()
        for name, robot in self.world.robots.items():
            await self.world.hear(name)
            for _ in range(6):
                self.world.act(name, "sender")
            await self.world.speak(name)
            assert robot.outbox.waiting() == 0
        for order in await self.world.rows(Order):
            if order.state is S.ATTENTION:
                to = "returning" if order.state_before_attention in MAIL_ABOARD else "queued"
                await self.world.change(self.world.orders.resolve, "dispatcher", order.id, to, "so that it ends")

    async def all_is_done(self) -> bool:
        orders, missions = await self.world.rows(Order), await self.world.rows(MissionRow)
        idle = all(
            robot.duties.held.mission is None and not robot.duties.held.cargo for robot in self.world.robots.values()
        )
        return idle and all(one.state in ENDED for one in orders) and not any(one.state == "active" for one in missions)


LIVES = os.environ.get("CAMPUS_MAIL_LIVES", "")
LivesOfOrders.TestCase.settings = settings(
    max_examples=int(LIVES or "12"),
    # A life takes a second, and finding the shortest one that fails takes hundreds: ask for it.
    phases=[phase for phase in Phase if phase is not Phase.shrink or os.environ.get("CAMPUS_MAIL_SHRINK")],
    stateful_step_count=40,
    deadline=None,
    suppress_health_check=list(HealthCheck),
)
TestLivesOfOrders = LivesOfOrders.TestCase
