"""Placing an order: what is checked, and what it begins with."""

from dataclasses import dataclass
from datetime import datetime, timedelta

from sqlmodel.ext.asyncio.session import AsyncSession

from app.database import write_new
from app.errors import Unprocessable
from app.orders import errors
from app.orders.ledger import Ledger, Word, event_of
from app.orders.schemas import NewOrder, OrderView, Wish
from app.orders.transitions import By
from app.orders.views import MyRole, OrderFacts, order_view
from app.orders.window import Window, arrival_window
from app.people.service import look_up_person, may_be_sent_mail
from app.tables import Order, Person, Priority, Role, StandingOrder
from app.tables.order_events import MOVED
from maps import NoRoute, UnknownPost
from protocol.ids import new_id


@dataclass(frozen=True)
class Parties:
    """Who sends, who receives, and who ordered it if somebody else did."""

    sender: Person
    recipient: Person
    placed_by: Person | None = None


class Placing(Ledger):
    """What begins an order's life."""

    def window(self, from_post: str, to_post: str, not_before: datetime | None = None) -> Window:
        """When mail should arrive that is fetched from now, or later. Raises UnknownPost, SamePost, NoWay."""
        begins_at = max(self.clock.utc(), not_before or self.clock.utc())
        try:
            window = arrival_window(self.ways, from_post, to_post, begins_at, self.settings)
        except UnknownPost as error:
            raise errors.UnknownPost(str(error)) from None
        except NoRoute as error:
            raise errors.NoWay(str(error)) from None
        if from_post == to_post:
            raise errors.SamePost("From and to are the same post: there is nothing to carry.")
        return window

    async def create(self, session: AsyncSession, person: Person, wish: NewOrder) -> OrderView:
        """Queue a new order. Raises UnknownPost, SamePost, NoWay, UnknownRecipient, UnknownSender, ForDispatchers."""
        parties = await self.parties(session, person, wish)
        facts = await self.place(session, parties, wish, not_before=wish.not_before)
        role: MyRole = "sender" if parties.placed_by is None else "dispatcher"
        return order_view(facts, role, person.id, self.campus, self.settings)

    async def parties(self, session: AsyncSession, person: Person, wish: Wish) -> Parties:
        """Who sends what `person` orders. Raises UnknownRecipient, UnknownSender, ForDispatchers."""
        if (wish.on_behalf_of or wish.priority is Priority.HIGH) and not person.has_role(Role.DISPATCHER):
            raise errors.ForDispatchers("Only a dispatcher orders for somebody else, or with high priority.")
        recipient = await self._somebody(session, wish.recipient, errors.UnknownRecipient)
        if not wish.on_behalf_of or wish.on_behalf_of == person.email:
            return Parties(person, recipient)
        return Parties(await self._somebody(session, wish.on_behalf_of, errors.UnknownSender), recipient, person)

    async def place(
        self,
        session: AsyncSession,
        parties: Parties,
        wish: Wish,
        *,
        not_before: datetime | None = None,
        standing: StandingOrder | None = None,
        occurs_on: str | None = None,
    ) -> OrderFacts:
        """Write a new order down and tell its people. Raises UnknownPost, SamePost, NoWay."""
        window = self.window(wish.from_post, wish.to_post, not_before)
        now = self.clock.utc()
        lifetime = timedelta(seconds=self.settings.handover_code_lifetime_s)
        order = Order(
            id=new_id(),
            sender_id=parties.sender.id,
            recipient_id=parties.recipient.id,
            placed_by_id=parties.placed_by.id if parties.placed_by else None,
            from_post=wish.from_post,
            to_post=wish.to_post,
            description=wish.description or None,
            priority=wish.priority,
            not_before=not_before,
            standing_order_id=standing.id if standing else None,
            occurs_on=occurs_on,
            created_at=now,
            updated_at=now,
            codes_expire_at=max(now, not_before or now) + lifetime,
            window_from=window.begins_at,
            window_to=window.ends_at,
        )
        return await self._begin(session, order, parties, standing)

    async def _begin(
        self, session: AsyncSession, order: Order, parties: Parties, standing: StandingOrder | None
    ) -> OrderFacts:
        by, person = By.SENDER, parties.sender
        if parties.placed_by is not None:
            by, person = By.DISPATCHER, parties.placed_by
        if standing is not None:
            by = By.TIMER
        event = event_of(order, MOVED, Word(by, person_id=person.id, post=order.from_post))
        await write_new(session, order, event)
        # Everything that there is to know of it is at hand: nothing is read again.
        people = [parties.sender, parties.recipient, person]
        facts = OrderFacts(order, [event], {one.id: one for one in people}, None)
        await self.begin(session, facts)
        return facts

    async def _somebody(self, session: AsyncSession, email: str, unknown: type[Unprocessable]) -> Person:
        known = await look_up_person(session, email)
        if known is None and not may_be_sent_mail(email, self.settings):
            domains = ", ".join(self.settings.allowed_domains)
            raise unknown(f"Nobody here has the address {email}. New addresses are those of {domains}.")
        return known or await self.desk.person(session, email, self.clock.utc())
