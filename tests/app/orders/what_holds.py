"""Invariants of every order's life, checked after each step of the random lives."""

from collections import Counter
from itertools import pairwise
from typing import Any

from app.models import Handover, MissionRow, Notification, Order, OrderEvent, StopRow
from app.models import OrderState as S
from app.orders.custody.custody import custody_of
from app.orders.notifications import NOTIFICATION_RULES, ONCE
from app.orders.transitions import MAIL_ABOARD, NOTHING_ABOARD, ROBOT_COMING, By, is_allowed
from protocol.parts import Purpose
from tests.app.orders.lives import World

ENDED = frozenset({S.DELIVERED, S.RETURNED, S.HELD, S.EXPIRED, S.CANCELLED})
"""Said here once more: a table that lets an order out of its end would call it no end."""
SURELY_TOLD = {
    S.QUEUED: {("sender", "accepted")},
    S.AT_SENDER: {("sender", "robot_here")},
    S.CARRYING: {("recipient", "on_its_way")},
    S.AT_RECIPIENT: {("recipient", "robot_here_for_you")},
    S.DELIVERED: {("sender", "delivered"), ("recipient", "delivered")},
    S.RETURNED: {("sender", "returned"), ("recipient", "returned")},
    S.HELD: {("sender", "held"), ("recipient", "held")},
    S.CANCELLED: {("sender", "cancelled")},
    S.EXPIRED: {("sender", "expired")},
    S.ATTENTION: {("sender", "attention")},
}
SEEN_BY_PEOPLE = ("state", "robot", "priority", "wait_until", "cancel_requested_at", "return_requested_at")
TELLS = {
    one.kind: {state for state, told in NOTIFICATION_RULES.items() if one in told}
    for told in NOTIFICATION_RULES.values()
    for one in told
}


def is_left(stop: StopRow) -> bool:
    return stop.done_at is None and stop.gave_up_at is None and stop.dropped_at is None


class Record:
    """The rows that the service has written of a world, and those of the last check."""

    def __init__(self, world: World) -> None:
        self.world = world
        self.ended: dict[str, S] = {}
        self.seen: dict[str, tuple[int, list[Any]]] = {}

    async def check(self) -> None:
        orders = await self.world.rows(Order)
        events = await self.world.rows(OrderEvent)
        handovers = await self.world.rows(Handover)
        notices = await self.world.rows(Notification)
        for order in orders:
            theirs = sorted((one for one in events if one.order_id == order.id), key=lambda one: one.seq)
            passed_on = sorted((one for one in handovers if one.order_id == order.id), key=lambda one: one.id)
            self.every_change_is_explained(order, theirs)
            self.nothing_changes_in_silence(order)
            self.terminal_is_terminal(order, theirs)
            self.exactly_one_holds_the_mail(order, passed_on, theirs)
            told = [(self.who_is(one.person_id), str(one.kind)) for one in notices if one.order_id == order.id]
            self.everybody_is_told_once(theirs, Counter(told))
        await self.robots_do_what_the_record_says(orders)

    def every_change_is_explained(self, order: Order, events: list[OrderEvent]) -> None:
        assert [one.seq for one in events] == list(range(1, order.version + 1)), "one event for each version"
        moves = [one for one in events if one.kind == "moved"]
        assert moves[-1].state is order.state
        assert moves[0].state is S.QUEUED
        before: S | None = None
        passed_on = False
        for last, one in pairwise(moves):
            allowed = is_allowed(last.state, one.state, By(one.by), before, is_passed_on=passed_on)
            assert allowed, (last.state, one.state, one.by)
            passed_on |= one.state is S.QUEUED and (before or last.state) in MAIL_ABOARD
            if one.state in {S.EXPIRED, S.CANCELLED}:
                assert (before or last.state) not in MAIL_ABOARD, "mail that is aboard has to go somewhere"
            before = last.state if one.state is S.ATTENTION else None
        for one in events:
            assert one.robot if one.by == By.ROBOT else one.person_id or one.by == By.TIMER or one.state is S.ASSIGNED
            if one.kind == "moved" and one.state in {S.ATTENTION, S.EXPIRED}:
                assert one.reason

    def nothing_changes_in_silence(self, order: Order) -> None:
        now = (order.version, [getattr(order, name) for name in SEEN_BY_PEOPLE])
        before = self.seen.get(order.id, now)
        assert now == before or now[0] > before[0], "what people see has changed, and the timeline has not"
        self.seen[order.id] = now

    def terminal_is_terminal(self, order: Order, events: list[OrderEvent]) -> None:
        if order.id in self.ended:
            assert order.state is self.ended[order.id]
        if order.state in ENDED:
            self.ended[order.id] = order.state
        assert not ENDED & {one.state for one in events if one.kind == "moved"} - {order.state}

    def exactly_one_holds_the_mail(self, order: Order, handovers: list[Handover], events: list[OrderEvent]) -> None:
        chain = custody_of(order, handovers)
        assert [held.until for held in chain[:-1]] == [held.since for held in chain[1:]], "a chain without gaps"
        assert chain[-1].until is None, "and one who holds it now"
        assert all(one.since <= two.since for one, two in pairwise(chain))
        holder = chain[-1].name or chain[-1].holder
        state = order.state_before_attention or order.state
        legs = 1 + sum(one.stop_id.startswith("passed-on-") for one in handovers)
        before_the_end = legs - ended_with_nothing_aboard(events)
        is_loaded_again = sum(one.purpose == Purpose.LOAD for one in handovers) > before_the_end
        if state in MAIL_ABOARD:
            assert holder == order.robot
        elif is_loaded_again:
            assert state in ENDED, "only mail of an ended order can be loaded again, by a robot that knew nothing"
        elif state is S.QUEUED or state in ROBOT_COMING or state is S.RETURNED:
            assert holder == ("sender" if legs == 1 or state is S.RETURNED else "mailroom")
        elif state in {S.DELIVERED, S.HELD}:
            assert holder == {S.DELIVERED: "recipient", S.HELD: "mailroom"}[state]
        if all(robot.outbox.waiting() == 0 for robot in self.world.robots.values()):
            assert holder == self.world.where[order.id], "with everything told, the record is the truth"

    def who_is(self, person_id: str) -> str:
        return next(name for name, person in self.world.people.items() if person.id == person_id)

    def everybody_is_told_once(self, events: list[OrderEvent], told: Counter[tuple[str, str]]) -> None:
        """Once for each time that it happens, and after an order was stopped or queued again: once more at most."""
        moves = Counter(one.state for one in events if one.kind == "moved")
        rounds = moves[S.QUEUED] + moves[S.ATTENTION]
        for (who, kind), count in told.items():
            times = 1 if kind in ONCE else min(rounds, sum(moves[state] for state in TELLS.get(kind, moves)))
            assert count <= times, (who, kind)
        surely = {one for state in moves for one in SURELY_TOLD.get(state, ())}
        assert surely <= set(told), surely - set(told)

    async def robots_do_what_the_record_says(self, orders: list[Order]) -> None:
        """Once both have said and heard everything: no robot goes where it is not sent, or is sent and does not go."""
        missions, stops = await self.world.rows(MissionRow, state="active"), await self.world.rows(StopRow)
        for robot in self.world.robots.values():
            theirs = {one.id for one in missions if one.robot == robot.name}
            left = {one.id for one in stops if one.mission_id in theirs and is_left(one)}
            is_untold = any(one.told_update < one.update_number for one in missions if one.id in theirs)
            waits = is_untold or robot.outbox.waiting() or any(one.let_go_by == robot.name for one in orders)
            if not waits and not await self.world.unheard(robot):
                assert robot.still_to_do() == left
                assert set(robot.missions.held.cargo) == self.world.aboard(robot.name)


def ended_with_nothing_aboard(events: list[OrderEvent]) -> bool:
    """Return whether the order ended while no robot had its mail: a load on its last leg came after the end."""
    states = [one.state for one in events if one.kind == "moved"]
    left = next(one for one in reversed(states) if one not in ENDED | {S.ATTENTION})
    return states[-1] in ENDED and left in NOTHING_ABOARD


async def how_it_ended(world: World) -> list[str]:
    """Orders, what robots still have to do, and what they believe, to find out why a check failed."""
    orders = [(o.id, o.state, o.state_before_attention, o.robot) for o in await world.rows(Order)]
    missions = [one for one in await world.rows(MissionRow) if one.state == "active"]
    stops = [one for one in await world.rows(StopRow) if one.mission_id in {mission.id for mission in missions}]
    held = [f"{robot.name}: {robot.missions.held}" for robot in world.robots.values()]
    return [str(orders), *map(repr, missions), *map(repr, stops), *held]
