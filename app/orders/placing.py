"""Placing an order: what is checked, and what it begins with."""

from datetime import timedelta

from sqlmodel.ext.asyncio.session import AsyncSession

from app.orders import errors
from app.orders.ledger import Ledger, Word, event_of
from app.orders.schemas import NewOrder, OrderView
from app.orders.transitions import By
from app.orders.views import OrderFacts, order_view
from app.orders.window import Window, arrival_window
from app.people.service import find_person, may_be_sent_mail, new_id
from app.tables import Order, Person
from app.tables.order_events import MOVED
from maps import NoRoute, UnknownPost


class Placing(Ledger):
    """What begins an order's life."""

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
        event = event_of(order, MOVED, Word(By.SENDER, person_id=sender.id, post=wish.from_post))
        session.add(event)
        await session.flush()
        # Everything that there is to know of it is at hand: nothing is read again.
        facts = OrderFacts(order, [event], {sender.id: sender, recipient.id: recipient}, None)
        await self.begin(session, facts)
        return order_view(facts, "sender", sender.id, self.campus, self.settings)

    async def _recipient(self, session: AsyncSession, email: str) -> Person:
        known = await find_person(session, email)
        if known is None and not may_be_sent_mail(email, self.settings):
            domains = ", ".join(self.settings.allowed_domains)
            raise errors.UnknownRecipient(f"Nobody here has the address {email}. New addresses are those of {domains}.")
        return known or await self.desk.person(session, email, self.clock.utc())
