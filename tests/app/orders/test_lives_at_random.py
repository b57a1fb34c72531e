"""Whole lives of orders at random: people, dispatchers, time, robots and the network do what they like, in any order,
late and more than once; and whatever happens, these things hold."""

import asyncio
import os
import tempfile
from contextlib import ExitStack
from datetime import timedelta
from pathlib import Path
from random import Random
from typing import Any

import pytest
from hypothesis import HealthCheck, Phase, settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, precondition, rule

from app.cli.administration import migrate
from app.core.errors import ServiceError
from app.core.settings import Settings
from app.models import Alarm, Handover, MissionRow, Notification, Order, OrderEvent, Person, Priority, StopRow
from app.models import OrderState as S
from app.orders.transitions import MAIL_ABOARD
from protocol.ids import ids_from
from tests.app.orders.lives import World
from tests.app.orders.what_holds import ENDED, Record, how_it_ended

POSTS = ("post1", "post2", "post3", "post4", "post5")
ROBOTS = st.sampled_from(("r1", "r2"))
TURNS = ("sets out", "arrives", "no way", "no person comes", "sender", "sender", "recipient", "mailroom")
LUCK = st.sampled_from(TURNS)
WAY = {
    "a robot is told": (),
    "it sets out": ("sets out",),
    "it waits for the sender": ("arrives",),
    "the sender does not come": ("no person comes",),
    "the mail is loaded": ("sender",),
    "it sets out with it": ("sender", "sets out"),
    "it waits for the recipient": ("sender", "arrives"),
    "the recipient does not come": ("sender", "no person comes"),
    "and it goes back": ("sender", "no person comes", "sets out", "arrives"),
}
SO_FAR = st.sampled_from((None, *WAY))
"""Most of what can go wrong begins in the middle of a life."""
WISHES: tuple[tuple[str, str], ...] = (
    *(("sender", what) for what in ("cancel", "recall", "extend_wait")),
    *(("recipient", what) for what in ("not_now", "extend_wait", "cancel")),
    *(("dispatcher", what) for what in ("cancel", "recall", "extend_wait")),
)
WISH = st.sampled_from(WISHES)
ORDERS = 5
ORDER = st.integers(0, ORDERS - 1)
ROUNDS_TO_THE_END = 25

folder = tempfile.TemporaryDirectory(prefix="lives-")


def template() -> Path:
    """An empty database, made once."""
    data = Path(folder.name) / "template"
    if not data.exists():
        asyncio.run(migrate(Settings(data=data)))
    return data / "campus-mail.sqlite"


class LivesOfOrders(RuleBasedStateMachine):
    """A few orders, two robots, one of each kind of person. What they are called is drawn too: what is found first
    depends on it, and a life that failed must fail again."""

    def __init__(self) -> None:
        super().__init__()
        self.runner, self.lasting = asyncio.Runner(), ExitStack()
        self.world = World(template(), Path(tempfile.mkdtemp(dir=folder.name)) / "data")
        self.ids: list[str] = []
        self.record = Record(self.world)

    def run(self, work: Any) -> Any:
        return self.runner.run(work)

    def order(self, number: int) -> str:
        """The newest first: those before have mostly ended."""
        return self.ids[-1 - number % len(self.ids)]

    @initialize(
        names=st.integers(0, 2**16),
        from_post=st.sampled_from(POSTS),
        step=st.integers(1, 4),
        so_far=SO_FAR,
        alone=st.booleans(),
    )
    def begin(self, names: int, from_post: str, step: int, so_far: str | None, alone: bool) -> None:
        self.lasting.enter_context(ids_from(Random(names).randbytes))
        self.run(self.world.begin())
        self.run(self.world.set_online("r2", not alone))
        self.a_sender_orders(from_post, step, so_far)

    # What people do.

    @precondition(lambda self: len(self.ids) < ORDERS)
    @rule(from_post=st.sampled_from(POSTS), step=st.integers(1, 4), so_far=SO_FAR)
    def a_sender_orders(self, from_post: str, step: int, so_far: str | None) -> None:
        to_post = POSTS[(POSTS.index(from_post) + step) % len(POSTS)]
        self.ids.append(self.run(self.world.place(from_post, to_post)))
        self.an_order_comes(0, so_far)

    @precondition(lambda self: len(self.ids) < ORDERS)
    @rule(number=ORDER)
    def a_sender_orders_the_same_way(self, number: int) -> None:
        """Which goes along with what is on its way already, if no other robot is free."""
        (same,) = self.run(self.world.rows(Order, id=self.order(number)))
        self.ids.append(self.run(self.world.place(same.from_post, same.to_post)))
        self.run(self.world.dispatch())

    @rule(number=ORDER, wish=WISH, so_far=SO_FAR)
    def a_person_asks(self, number: int, wish: tuple[str, str], so_far: str | None) -> None:
        self.an_order_comes(number, so_far)
        self.asks(number, wish)

    @rule(first=ORDER, one=WISH, second=ORDER, other=WISH, so_far=SO_FAR)
    def wishes_cross(
        self, first: int, one: tuple[str, str], second: int, other: tuple[str, str], so_far: str | None
    ) -> None:
        """Robots have heard of the first, and are not heard themselves before they are told of the second."""
        self.an_order_comes(first, so_far)
        for number, wish in ((first, one), (second, other)):
            self.asks(number, wish)
            self.run(self.world.dispatch())
            for name in self.reached():
                self.run(self.world.hear(name))
        for name in self.reached():
            self.run(self.world.speak(name))

    def reached(self) -> list[str]:
        return [name for name, robot in self.world.robots.items() if robot.online]

    def asks(self, number: int, wish: tuple[str, str]) -> None:
        who, what = wish
        orders = self.world.orders
        change, *arguments = {
            "cancel": (orders.cancelling.cancel, ""),
            "recall": (orders.returning.recall,),
            "not_now": (orders.returning.not_now,),
            "extend_wait": (orders.waiting.extend_wait, None),
        }[what]
        self.tries(change, who, self.order(number), *arguments)

    @rule(number=ORDER, to=st.sampled_from(("resume", "returning", "queued", "cancelled")))
    def a_dispatcher_decides(self, number: int, to: str) -> None:
        waiting = [one.id for one in self.run(self.world.rows(Order, state=S.ATTENTION))]
        order_id = sorted(waiting)[number % len(waiting)] if waiting else self.order(number)
        self.tries(self.world.orders.intervening.resolve, "dispatcher", order_id, to, "decided")

    @rule(number=ORDER, so_far=SO_FAR)
    def a_dispatcher_stops_an_order(self, number: int, so_far: str | None) -> None:
        self.an_order_comes(number, so_far)
        self.tries(
            self.world.orders.intervening.stop_for_attention, "dispatcher", self.order(number), "It does not move."
        )

    @rule(number=ORDER, robot=ROBOTS | st.none(), so_far=SO_FAR)
    def a_dispatcher_reassigns(self, number: int, robot: str | None, so_far: str | None) -> None:
        self.an_order_comes(number, so_far)
        self.tries(self.world.orders.intervening.reassign, "dispatcher", self.order(number), robot)

    @rule(number=ORDER, so_far=SO_FAR, luck=st.lists(LUCK, max_size=3), comes_back=st.booleans())
    def a_robot_is_given_up_on_and_goes_on(
        self, number: int, so_far: str | None, luck: list[str], comes_back: bool
    ) -> None:
        """A dispatcher gives its order to another, while it does what it was told."""
        self.an_order_comes(number, so_far)
        (order,) = self.run(self.world.rows(Order, id=self.order(number)))
        if order.robot is None or not self.tries(
            self.world.orders.intervening.stop_for_attention, "dispatcher", order.id, "Lost."
        ):
            return
        self.run(self.world.set_online(order.robot, False))
        self.tries(self.world.orders.intervening.resolve, "dispatcher", order.id, "queued", None)
        self.an_order_comes(number, "it sets out")
        for one in luck:
            self.world.act(order.robot, one)
        if comes_back:
            self.run(self.world.set_online(order.robot, True))
            self.run(self.world.speak(order.robot))

    @rule(number=ORDER, priority=st.sampled_from(Priority))
    def a_dispatcher_prioritises(self, number: int, priority: Priority) -> None:
        self.tries(self.world.orders.intervening.prioritise, "dispatcher", self.order(number), priority)

    @rule(number=ORDER)
    def a_dispatcher_takes_mail_out_by_hand(self, number: int) -> None:
        """Only what is in a robot can be taken out of it."""
        order_id = self.order(number)
        state = self.run(self.world.rows(Order, id=order_id))[0].state
        if self.world.where[order_id] not in self.world.robots or state not in {S.ATTENTION, S.AT_RETURN, *ENDED}:
            return
        if state is not S.ATTENTION:
            done = self.tries(self.world.orders.intervening.hold, "dispatcher", order_id, "fetched")
        else:
            done = self.tries(self.world.orders.intervening.resolve, "dispatcher", order_id, "held", "fetched")
        if done:
            self.world.where[order_id] = "mailroom"

    @rule(number=ORDER, post=st.sampled_from((None, *POSTS)), so_far=SO_FAR)
    def a_dispatcher_passes_mail_on(self, number: int, post: str | None, so_far: str | None) -> None:
        """Taken out of one robot, for another."""
        self.an_order_comes(number, so_far)
        order_id = self.order(number)
        if self.world.where[order_id] not in self.world.robots:
            return
        if self.tries(self.world.orders.passing_on.pass_on, "dispatcher", order_id, post, "its robot is flat"):
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
        return await self.world.everything(
            Order, OrderEvent, Notification, Handover, MissionRow, StopRow, Person, Alarm
        )

    # What time and dispatch do.

    @rule()
    def dispatch_looks(self) -> None:
        self.run(self.world.dispatch())

    @rule(minutes=st.sampled_from((1, 20, 600, 1500)), so_far=SO_FAR)
    def time_passes(self, minutes: int, so_far: str | None) -> None:
        self.an_order_comes(0, so_far)
        self.world.clock.advance(minutes * 60.0)
        self.run(self.world.timer.tick())
        limit = timedelta(seconds=self.world.settings.queue_limit_s)
        waits_since = [order.created_at for order in self.run(self.world.rows(Order, state=S.QUEUED))]
        assert all(self.world.clock.utc() - at <= limit for at in waits_since), "nothing waits for ever"

    @rule()
    def the_service_is_restarted(self) -> None:
        self.run(self.world.restart())

    # What robots do.

    @rule(robot=ROBOTS, luck=LUCK)
    def a_robot_acts(self, robot: str, luck: str) -> None:
        self.world.act(robot, luck)

    @rule(robot=ROBOTS, luck=st.lists(LUCK, min_size=1, max_size=4), hears=st.booleans())
    def a_robot_goes_on(self, robot: str, luck: list[str], hears: bool) -> None:
        """Dispatched to, told (or not so soon), doing and telling, as on a good day."""
        self.run(self.world.dispatch())
        if self.world.robots[robot].online:
            if hears:
                self.run(self.world.hear(robot))
            for one in luck:
                self.world.act(robot, one)
            self.run(self.world.speak(robot))

    @rule(number=ORDER, so_far=SO_FAR)
    def an_order_comes(self, number: int, so_far: str | None) -> None:
        """To this point, if it waits still and there is a network."""
        if so_far is None or self.world.where[self.order(number)] != "sender":
            return
        self.run(self.world.dispatch())
        for name in self.reached():
            self.run(self.world.hear(name))
            for luck in WAY[so_far]:
                self.world.act(name, luck)
            self.run(self.world.speak(name))

    @rule(robot=ROBOTS, count=st.integers(1, 4))
    def a_robot_hears(self, robot: str, count: int) -> None:
        if self.world.robots[robot].online:
            self.run(self.world.hear(robot, count))

    @rule(robot=ROBOTS, count=st.integers(1, 4), is_heard=st.booleans())
    def a_robot_speaks(self, robot: str, count: int, is_heard: bool) -> None:
        if self.world.robots[robot].online:
            self.run(self.world.speak(robot, count, is_heard))

    @rule(robot=ROBOTS, count=st.integers(1, 4))
    def what_was_not_acknowledged_comes_again(self, robot: str, count: int) -> None:
        if not self.world.robots[robot].online:
            return
        self.run(self.world.speak(robot, count, is_heard=False))
        before = self.run(self.everything())
        self.run(self.world.speak(robot, count))
        assert self.run(self.everything()) == before, "a message is taken once"

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
        self.world.robots[robot].missions.report_fault(name, f"It is {name}.", "post3", cleared=is_over)
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
            self.run(self.record.check())

    # And in the end.

    def teardown(self) -> None:
        try:
            if self.ids:
                self.run(self.everybody_does_their_part())
        finally:
            if hasattr(self.world, "database"):
                self.run(self.world.end())
            self.runner.close()
            self.lasting.close()

    async def everybody_does_their_part(self) -> None:
        """Whatever went before: with a network, people who come and a dispatcher who decides, every order ends."""
        for robot in self.world.robots.values():
            await self.world.set_online(robot.name, True)
            for fault in ("wheel_drop", "bump"):
                robot.missions.report_fault(fault, "It is over.", "post3", cleared=True)
        for _ in range(ROUNDS_TO_THE_END):
            await self.one_round()
            if await self.all_is_done():
                break
        assert await self.all_is_done(), "\n".join(
            ["no order and no robot is stuck for ever", *await how_it_ended(self.world)]
        )
        await self.record.check()

    async def one_round(self) -> None:
        await self.world.dispatch()
        for name, robot in self.world.robots.items():
            await self.world.hear(name)
            for _ in range(6):
                self.world.act(name, "sender")
            await self.world.speak(name)
            assert robot.outbox.waiting() == 0
        orders = {order.id: order for order in await self.world.rows(Order)}
        for robot in self.world.robots.values():
            if robot.missions.held.mission is None and any(
                orders[one].state in ENDED for one in robot.missions.held.cargo
            ):
                await self.world.recall(robot.name)  # its alarm says that it has mail aboard
        for order in orders.values():
            if order.state is S.ATTENTION:
                to = "returning" if order.state_before_attention in MAIL_ABOARD else "queued"
                await self.world.change(
                    self.world.orders.intervening.resolve, "dispatcher", order.id, to, "so that it ends"
                )

    async def all_is_done(self) -> bool:
        orders, missions = await self.world.rows(Order), await self.world.rows(MissionRow)
        idle = all(
            robot.missions.held.mission is None and not robot.missions.held.cargo
            for robot in self.world.robots.values()
        )
        return idle and all(one.state in ENDED for one in orders) and not any(one.state == "active" for one in missions)


LIVES = os.environ.get("CAMPUS_MAIL_LIVES", "")
LivesOfOrders.TestCase.settings = settings(
    max_examples=int(LIVES or "8"),
    # A life takes a second, and finding the shortest one that fails takes hundreds: ask for it.
    phases=[phase for phase in Phase if phase is not Phase.shrink or os.environ.get("CAMPUS_MAIL_SHRINK")],
    stateful_step_count=40,
    deadline=None,
    suppress_health_check=list(HealthCheck),
)
# Fifteen seconds of work: on a machine that is busy with other things much longer.
TestLivesOfOrders = pytest.mark.timeout(400)(LivesOfOrders.TestCase)
