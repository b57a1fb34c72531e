"""What can be done with an order. Every change is one transaction: row, event, notices; told aloud after the commit."""

from collections.abc import Callable
from dataclasses import dataclass, field
from datetime import datetime, timedelta
from functools import partial

from sqlmodel import col, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.database import after_commit
from app.live.feed import Feed, Happening
from app.orders import errors
from app.orders.codes import code_text, turn_of, verifiers
from app.orders.schemas import NewOrder, OrderView
from app.orders.telling import facts_of, tell_about
from app.orders.transitions import ENDED, By, is_allowed
from app.orders.views import OrderFacts, is_cancel_under_way, is_cancellable, load_facts, order_view, role_in, view_for
from app.orders.window import Window, arrival_window
from app.people.service import SignInDesk, find_person, new_id
from app.people.service import is_allowed as is_allowed_address
from app.server_key import ServerKey
from app.settings import Settings
from app.tables import Order, OrderEvent, OrderState, Person, Role
from maps import CampusMap, NoRoute, UnknownPost
from protocol.clock import Clock
from protocol.parts import Purpose
from protocol.to_robot import Verifier


@dataclass(frozen=True)
class Word:
    """On whose word an order moves, and what is known of it: `robot_at` is the robot's own time of it."""

    by: By
    person_id: str | None = None
    robot: str | None = None
    robot_at: datetime | None = None
    post: str | None = None
    reason: str | None = None


@dataclass(frozen=True)
class Orders:
    """The orders of one campus. `on_change` is called with an order's id after the commit of each change."""

    campus: CampusMap
    settings: Settings
    clock: Clock
    feed: Feed
    key: ServerKey
    desk: SignInDesk
    on_change: list[Callable[[str], None]] = field(default_factory=list)

    def window(self, from_post: str, to_post: str) -> Window:
        """When mail ordered now should arrive. Raises UnknownPost, SamePost, NoWay."""
        try:
            window = arrival_window(self.campus, from_post, to_post, self.clock.utc(), self.settings)
        except UnknownPost as error:
            raise errors.UnknownPost(str(error)) from None
        except NoRoute as error:
            raise errors.NoWay(str(error)) from None
        if from_post == to_post:
            raise errors.SamePost("From and to are the same post: there is nothing to carry.")
        return window

    async def create(self, session: AsyncSession, sender: Person, wish: NewOrder) -> OrderView:
        """Queue a new order. Raises UnknownPost, SamePost, NoWay, UnknownRecipient."""
        window = self.window(wish.from_post, wish.to_post)
        recipient = await self._recipient(session, wish.recipient)
        now = self.clock.utc()
        order = Order(
            id=new_id(),
            sender_id=sender.id,
            recipient_id=recipient.id,
            from_post=wish.from_post,
            to_post=wish.to_post,
            description=wish.description or None,
            created_at=now,
            updated_at=now,
            codes_expire_at=now + timedelta(seconds=self.settings.handover_code_lifetime_s),
            window_from=window.begins_at,
            window_to=window.ends_at,
        )
        session.add(order)
        await session.flush()
        word = Word(By.SENDER, person_id=sender.id, post=wish.from_post)
        facts = await self._record(session, order, word)
        return order_view(facts, "sender", sender.id, self.campus, self.settings)

    async def _recipient(self, session: AsyncSession, email: str) -> Person:
        known = await find_person(session, email)
        if known is None and not is_allowed_address(email, self.settings):
            domains = ", ".join(self.settings.allowed_domains)
            raise errors.UnknownRecipient(f"Nobody here has the address {email}. New addresses are those of {domains}.")
        return known or await self.desk.person(session, email, self.clock.utc())

    async def move(self, session: AsyncSession, order_id: str, to: OrderState, word: Word) -> bool:
        """Take an order to its next state; False if this has happened before and nothing changes.

        A robot repeats itself after a lost acknowledgement, and may tell late what others told already: whatever the
        order has been through before, on a robot's word, is no news. Raises UnknownOrder, TransitionRefused.
        """
        order = await self._order(session, order_id)
        if order.state is to or await self._is_old_news(session, order, to, word):
            return False
        if not is_allowed(order.state, to, word.by, order.state_before_attention):
            raise errors.TransitionRefused(f"Order {order.id} is {order.state}: {word.by} cannot make it {to}.")
        order.state_before_attention = order.state if to is OrderState.ATTENTION else None
        order.state = to
        order.robot = word.robot or order.robot
        order.why = word.reason if to is OrderState.ATTENTION else None
        await self._change(session, order)
        await self._record(session, order, word)
        return True

    async def _is_old_news(self, session: AsyncSession, order: Order, to: OrderState, word: Word) -> bool:
        if word.by is not By.ROBOT or to is OrderState.ATTENTION:
            return False
        past = select(OrderEvent.seq).where(OrderEvent.order_id == order.id, OrderEvent.state == to)
        return (await session.exec(past)).first() is not None

    async def explain(self, session: AsyncSession, order_id: str, why: str | None) -> None:
        """Say in words why an order waits (or, with None, that it does not). Changes nothing else."""
        order = await self._order(session, order_id)
        if order.why != why:
            order.why = why
            self._publish(session, (await load_facts(session, [order]))[0])

    async def cancel(self, session: AsyncSession, person: Person, order_id: str, if_match: str) -> OrderView:
        """Cancel at once, or ask the robot that is on its way to let go; until it answers the order goes on.

        Raises UnknownOrder, OrderChanged, NotCancellable.
        """
        order = await self._order(session, order_id)
        role = role_in(order, person)
        if role is None:
            raise _unknown(order_id)
        if if_match and not _matches(if_match, order.version):
            raise errors.OrderChanged(f"The order is at version {order.version} now. Read it again first.")
        if not is_cancel_under_way(order):
            if role == "recipient" or not is_cancellable(order):
                raise errors.NotCancellable(_why_not_cancellable(order, role))
            await self._cancel(session, order, Word(By(role), person_id=person.id))
        facts = (await load_facts(session, [order]))[0]
        return order_view(facts, role, person.id, self.campus, self.settings)

    async def _cancel(self, session: AsyncSession, order: Order, word: Word) -> None:
        if order.state is OrderState.QUEUED:
            await self.move(session, order.id, OrderState.CANCELLED, word)
            return
        order.cancel_requested_at = self.clock.utc()
        order.cancel_requested_by = word.by
        await self._change(session, order)
        self._publish(session, (await load_facts(session, [order]))[0])

    async def view(self, session: AsyncSession, person: Person, order_id: str) -> OrderView:
        """One order as this person sees it. Raises UnknownOrder, for what is not theirs too."""
        order = await self._order(session, order_id)
        view = view_for(person, (await load_facts(session, [order]))[0], self.campus, self.settings)
        if view is None:
            raise _unknown(order_id)
        return view

    async def code(self, session: AsyncSession, person: Person, order_id: str) -> tuple[Order, Purpose, str]:
        """The code that it is this person's turn to show. Raises UnknownOrder, NoCodeForYou."""
        order = await self._order(session, order_id)
        if role_in(order, person) is None:
            raise _unknown(order_id)
        purpose = turn_of(order, person.id)
        if purpose is None:
            raise errors.NoCodeForYou("It is not your turn to show a code for this order.")
        return order, purpose, code_text(self.key, order.id, purpose)

    async def verifiers(self, session: AsyncSession, *orders: Order) -> tuple[Verifier, ...]:
        """What a robot needs to check the codes of these orders, delegates' too, with no network."""
        return await verifiers(session, self.key, orders)

    async def _order(self, session: AsyncSession, order_id: str) -> Order:
        order = await session.get(Order, order_id, with_for_update=True)
        if order is None:
            raise _unknown(order_id)
        return order

    async def _change(self, session: AsyncSession, order: Order) -> None:
        order.version += 1
        order.updated_at = self.clock.utc()
        await session.flush()

    async def _record(self, session: AsyncSession, order: Order, word: Word) -> OrderFacts:
        """The event, the notices and what is told aloud after the commit."""
        last = select(OrderEvent.seq).where(OrderEvent.order_id == order.id).order_by(col(OrderEvent.seq).desc())
        event = OrderEvent(
            order_id=order.id,
            seq=((await session.exec(last)).first() or 0) + 1,
            state=order.state,
            at=order.updated_at,
            by=word.by,
            person_id=word.person_id,
            robot=word.robot,
            robot_at=word.robot_at,
            post=word.post,
            reason=word.reason,
        )
        session.add(event)
        await session.flush()
        facts = (await load_facts(session, [order]))[0]
        gaps = facts_of(order, facts.people, self.campus, self.settings)
        await tell_about(session, self.feed, order, facts.people, gaps)
        self._publish(session, facts)
        return facts

    def _publish(self, session: AsyncSession, facts: OrderFacts) -> None:
        """To sender, recipient and dispatchers, each as they may see it, and to whoever waits for changes."""
        mine = {facts.sender.id: facts.sender, facts.recipient.id: facts.recipient}
        for person in mine.values():
            if view := view_for(person, facts, self.campus, self.settings):
                self._publish_view(session, view, person_id=person.id)
        for_all = order_view(facts, "dispatcher", "", self.campus, self.settings)
        self._publish_view(session, for_all, role=Role.DISPATCHER, except_for=frozenset(mine))
        after_commit(session, partial(self._changed, facts.order.id))

    def _changed(self, order_id: str) -> None:
        for call in self.on_change:
            call(order_id)

    def _publish_view(
        self,
        session: AsyncSession,
        view: OrderView,
        person_id: str | None = None,
        role: Role | None = None,
        except_for: frozenset[str] = frozenset(),
    ) -> None:
        happening = Happening("order", view.model_dump(mode="json"), person_id, role, except_for)
        after_commit(session, lambda: self.feed.publish(happening))


def _unknown(order_id: str) -> errors.UnknownOrder:
    return errors.UnknownOrder(f"There is no order {order_id} among yours.")


def _matches(if_match: str, version: int) -> bool:
    return any(tag.strip() in {"*", f'"{version}"'} for tag in if_match.split(","))


def _why_not_cancellable(order: Order, role: str) -> str:
    if role == "recipient":
        return "Only the sender can cancel."
    if order.state in ENDED:
        return f"The order is {order.state} already."
    return f"The order is {order.state}: the mail is aboard and will be delivered."
