"""Interventions of a dispatcher: an order is stuck, or shall go another way than the rules would have it."""

from dataclasses import dataclass
from typing import Final, Literal

from sqlmodel.ext.asyncio.session import AsyncSession

from app.models import Handover, Order, OrderState, Person, Priority, RobotRow
from app.orders import errors, stops
from app.orders.changes.returning import Returning
from app.orders.custody.by_hand import taken_out_by_hand
from app.orders.custody.codes import Holder
from app.orders.custody.unproven import (
    claim_of_handing_out,
    robot_with_mail,
    settle_as_aboard,
    settle_as_never_aboard,
    settle_as_true,
)
from app.orders.ledger import Actor, Ledger
from app.orders.transitions import ENDED, MAIL_ABOARD, ROBOT_COMING, By
from app.orders.views.schemas import OrderView
from protocol.parts import Purpose, StopAction

WayOut = Literal["resume", "returning", "held", "queued", "cancelled", "handed_over"]
PRIORITY_CHANGED: Final = "priority_changed"
REASSIGNED: Final = "reassigned"
TAKEN_OUT: Final = "taken_out"
"""By hand, of mail whose order had ended already: the order stays as it ended."""
DESTINATION: Final = {
    OrderState.CARRYING: StopAction.RECEIVE,
    OrderState.AT_RECIPIENT: StopAction.RECEIVE,
    OrderState.RETURNING: StopAction.RETURN,
    OrderState.AT_RETURN: StopAction.RETURN,
}


@dataclass(frozen=True)
class Intervening:
    """Change an order on a dispatcher's request. The routes check the role."""

    ledger: Ledger
    returning: Returning

    async def stop_for_attention(
        self, session: AsyncSession, person: Person, order_id: str, reason: str, if_match: str = ""
    ) -> OrderView:
        """Stop an order until a dispatcher resolves it: its robot no longer reports."""
        order, _ = await self.ledger.visible_order(session, person, order_id, if_match)
        await self.ledger.move(session, order.id, OrderState.ATTENTION, _actor(person, reason))
        return await self.ledger.view(session, order, "dispatcher", person)

    async def resolve(
        self, session: AsyncSession, person: Person, order_id: str, to: WayOut, reason: str | None, if_match: str = ""
    ) -> OrderView:
        """Out of attention: on as before, back, into the mailroom's hands, into the queue again, or not at all; or its
        mail is out as its robot says.

        Raises UnknownOrder, OrderChanged, TransitionRefused, NothingToResume, NothingClaimed.
        """
        order, _ = await self.ledger.visible_order(session, person, order_id, if_match)
        before = order.state_before_attention
        if before is None:
            raise errors.TransitionRefused(f"Order {order.id} is {order.state}: it needs no attention.")
        actor = _actor(person, reason)
        await _WAYS_OUT[to](self, session, order, before, actor)
        return await self.ledger.view(session, order, "dispatcher", person)

    async def _resume(self, session: AsyncSession, order: Order, before: OrderState, actor: Actor) -> None:
        left = await stops.stops_of_order(session, order.id, order.robot or "")
        if not left and before in ROBOT_COMING:
            raise errors.NothingToResume("Its robot does not come for it any more. Queue the order again.")
        if not left:  # the robot has given up; with the mail aboard it can be sent once more
            action = DESTINATION[before]
            post = order.to_post if action is StopAction.RECEIVE else self.returning.return_post(order)
            await self.returning.send(session, order, action, post)
        await self._settle_aboard(session, order, before)
        await self.ledger.move(session, order.id, before, actor)

    async def _settle_aboard(self, session: AsyncSession, order: Order, before: OrderState) -> None:
        """Settle that the mail was in the robot, on the dispatcher's decision."""
        if before in MAIL_ABOARD:
            await settle_as_aboard(session, order.id, self.ledger.clock.utc())

    async def _handed_over(self, session: AsyncSession, order: Order, before: OrderState, actor: Actor) -> None:
        """End an order whose mail a person has, as the dispatcher found by asking."""
        claim = await claim_of_handing_out(session, order.id)
        if claim is None:
            raise errors.NothingClaimed("Its robot does not say that the mail is out.")
        await settle_as_true(session, claim, self.ledger.clock.utc())
        await self.ledger.move(session, order.id, _where_it_went(order, claim), actor)

    async def _return(self, session: AsyncSession, order: Order, before: OrderState, actor: Actor) -> None:
        await self._settle_aboard(session, order, before)
        await self.returning.bring_back(session, order)
        await self.ledger.move(session, order.id, OrderState.RETURNING, actor)

    async def _hold(self, session: AsyncSession, order: Order, before: OrderState, actor: Actor) -> None:
        if before in MAIL_ABOARD:
            await self.take_into_hands(session, order, actor)
        else:  # of what was passed on: the mailroom has it already
            order.let_go_by = order.robot
            await self.ledger.move(session, order.id, OrderState.HELD, actor)

    async def _queue(self, session: AsyncSession, order: Order, before: OrderState, actor: Actor) -> None:
        was_a_claim = await settle_as_never_aboard(session, order.id, self.ledger.clock.utc())
        if before in MAIL_ABOARD and not was_a_claim:
            raise errors.TransitionRefused(f"Robot {order.robot} has the mail of order {order.id}: pass it on.")
        order.let_go_by, order.avoided_robot = order.robot, order.robot
        await self.ledger.move(session, order.id, OrderState.QUEUED, actor)

    async def _cancel_by_hand(self, session: AsyncSession, order: Order, before: OrderState, actor: Actor) -> None:
        order.let_go_by = order.robot
        await self.ledger.move(session, order.id, OrderState.CANCELLED, actor)

    async def hold(
        self, session: AsyncSession, person: Person, order_id: str, reason: str | None, if_match: str = ""
    ) -> OrderView:
        """Record that the mailroom took the mail out of the robot by hand. Raises TransitionRefused."""
        order, _ = await self.ledger.visible_order(session, person, order_id, if_match)
        await self.take_into_hands(session, order, _actor(person, reason))
        return await self.ledger.view(session, order, "dispatcher", person)

    async def take_into_hands(self, session: AsyncSession, order: Order, actor: Actor) -> None:
        """Record custody as the dispatcher reports it, without a receipt; the robot is told to forget the order."""
        if order.state is OrderState.HELD:
            return  # the mailroom has it already
        if order.state in ENDED and await robot_with_mail(session, order) is None:
            raise errors.TransitionRefused(f"Order {order.id} is {order.state}, and no robot has its mail.")
        await settle_as_aboard(session, order.id, self.ledger.clock.utc())
        if order.robot is not None:
            order.let_go_by = order.robot
            post, now = self.returning.return_post(order), self.ledger.clock.utc()
            session.add(taken_out_by_hand(order, f"held-{order.id}", post, actor.person_id, now))
        if order.state in ENDED:
            await self.ledger.note(session, order.id, TAKEN_OUT, actor)
        else:
            await self.ledger.move(session, order.id, OrderState.HELD, actor)

    async def reassign(
        self, session: AsyncSession, person: Person, order_id: str, robot: str | None, if_match: str = ""
    ) -> OrderView:
        """Another robot fetches it: this one if named, else any other. Raises NotReassignable, UnknownRobotWanted."""
        order, _ = await self.ledger.visible_order(session, person, order_id, if_match)
        if order.state is not OrderState.QUEUED and order.state not in ROBOT_COMING:
            raise errors.NotReassignable(f"The order is {order.state}: only mail that is not aboard can change robots.")
        if robot is not None and await session.get(RobotRow, robot) is None:
            raise errors.UnknownRobotWanted(f"No robot named {robot!r} is enrolled.")
        order.wanted_robot = robot
        order.avoided_robot = order.robot if robot is None else None
        if order.state in ROBOT_COMING and order.robot != robot:
            order.reassign_requested_at, order.let_go_by = self.ledger.clock.utc(), order.robot
        await self.ledger.note(session, order.id, REASSIGNED, _actor(person, f"to {robot}" if robot else None))
        return await self.ledger.view(session, order, "dispatcher", person)

    async def prioritise(
        self, session: AsyncSession, person: Person, order_id: str, priority: Priority, if_match: str = ""
    ) -> OrderView:
        """Fetch it sooner, or later, than others. Raises TransitionRefused for an order that has ended."""
        order, _ = await self.ledger.visible_order(session, person, order_id, if_match)
        if order.state in ENDED:
            raise errors.TransitionRefused(f"Order {order.id} is {order.state}: its priority means nothing any more.")
        if order.priority is not priority:
            order.priority = priority
            await self.ledger.note(session, order.id, PRIORITY_CHANGED, _actor(person, priority))
        return await self.ledger.view(session, order, "dispatcher", person)


_WAYS_OUT: Final = {
    "resume": Intervening._resume,
    "returning": Intervening._return,
    "held": Intervening._hold,
    "queued": Intervening._queue,
    "cancelled": Intervening._cancel_by_hand,
    "handed_over": Intervening._handed_over,
}


def _where_it_went(order: Order, claim: Handover) -> OrderState:
    """As who took it says, and for want of that the place."""
    if claim.purpose == Purpose.RECEIVE or claim.holder == Holder.RECIPIENT:
        return OrderState.DELIVERED
    is_senders = claim.holder == Holder.SENDER or (claim.holder != Holder.MAILROOM and claim.post == order.from_post)
    return OrderState.RETURNED if is_senders else OrderState.HELD


def _actor(person: Person, reason: str | None) -> Actor:
    return Actor(By.DISPATCHER, person_id=person.id, reason=reason)
