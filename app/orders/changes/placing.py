"""Placing an order: what is checked, and what it begins with."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Any

from sqlmodel.ext.asyncio.session import AsyncSession

from app.accounts.sign_in.service import SignInService, look_up_people, may_be_sent_mail
from app.core.database.database import new_row, row_of, write_all
from app.core.errors import Unprocessable
from app.eta.records import promise_row
from app.models import ForecastRow, Order, OrderEvent, OrderState, Person, Priority, Role, StandingOrder
from app.models.orders.order_events import MOVED
from app.notifications.service import tell_all
from app.orders import errors
from app.orders.ledger import Actor, Ledger, event_row
from app.orders.transitions import By
from app.orders.views.schemas import NewOrder, OrderRequest, OrderView
from app.orders.views.views import MyRole, OrderFacts
from app.orders.window import Window, arrival_window
from maps import NoRoute, UnknownPost
from protocol.ids import new_id


@dataclass(frozen=True)
class Parties:
    """Sender and recipient, and the dispatcher who ordered it, if one did."""

    sender: Person
    recipient: Person
    placed_by: Person | None = None


@dataclass(frozen=True)
class Draft:
    """A new order before it is written down: what is known of it, and its rows."""

    facts: OrderFacts
    order: Mapping[str, Any]
    event: Mapping[str, Any]
    notices: Sequence[Mapping[str, Any]]
    forecast: Mapping[str, Any] | None


@dataclass(frozen=True)
class Placing:
    """Begin an order's life."""

    ledger: Ledger
    sign_in: SignInService

    def window(self, from_post: str, to_post: str, not_before: datetime | None = None) -> Window:
        """When mail should arrive that is fetched from now, or later. Raises UnknownPost, SamePost, NoWay."""
        begins_at = max(self.ledger.clock.utc(), not_before or self.ledger.clock.utc())
        try:
            window = arrival_window(self.ledger.estimates, from_post, to_post, begins_at)
        except UnknownPost as error:
            raise errors.UnknownPost(str(error)) from None
        except NoRoute as error:
            raise errors.NoWay(str(error)) from None
        if from_post == to_post:
            raise errors.SamePost("From and to are the same post: there is nothing to carry.")
        return window

    async def draft(self, session: AsyncSession, person: Person, request: NewOrder, known: dict[str, Person]) -> Draft:
        """Return the order that `person` requests; `known` are people by their addresses, and grow with it.

        Raises UnknownPost, SamePost, NoWay, UnknownRecipient, UnknownSender, ForDispatchers.
        """
        window = self.window(request.from_post, request.to_post, request.not_before)
        parties = await self._parties(session, person, request, known)
        return self._draft(parties, request, window, request.not_before)

    def first_view(self, draft: Draft, person: Person) -> OrderView:
        """Return a new order as its creator sees it."""
        role: MyRole = "sender" if draft.facts.order.placed_by_id is None else "dispatcher"
        return self.ledger.view_of(draft.facts, role, person.id)

    async def parties(self, session: AsyncSession, person: Person, request: OrderRequest) -> Parties:
        """Return the parties of a request by `person`. Raises UnknownRecipient, UnknownSender, ForDispatchers."""
        return await self._parties(session, person, request, await look_up_people(session, request.addresses))

    async def _parties(
        self, session: AsyncSession, person: Person, request: OrderRequest, known: dict[str, Person]
    ) -> Parties:
        if (request.on_behalf_of or request.priority is Priority.HIGH) and not person.has_role(Role.DISPATCHER):
            raise errors.ForDispatchers("Only a dispatcher orders for another person, or with high priority.")
        self._check_known(request.recipient, known, errors.UnknownRecipient)
        if not request.on_behalf_of or request.on_behalf_of == person.email:
            return Parties(person, await self._person(session, request.recipient, known))
        self._check_known(request.on_behalf_of, known, errors.UnknownSender)
        # Both are checked before either is created: a refused order leaves no new person behind.
        recipient = await self._person(session, request.recipient, known)
        return Parties(await self._person(session, request.on_behalf_of, known), recipient, person)

    async def place(
        self, session: AsyncSession, parties: Parties, request: OrderRequest, standing: StandingOrder, occurs_on: str
    ) -> OrderFacts:
        """Write down the order of a standing order and tell its people. Raises UnknownPost, SamePost, NoWay."""
        window = self.window(request.from_post, request.to_post)
        draft = self._draft(parties, request, window, standing_order_id=standing.id, occurs_on=occurs_on)
        await self.write(session, [draft])
        return draft.facts

    def _draft(
        self,
        parties: Parties,
        request: OrderRequest,
        window: Window,
        not_before: datetime | None = None,
        standing_order_id: str | None = None,
        occurs_on: str | None = None,
    ) -> Draft:
        now = self.ledger.clock.utc()
        lifetime = timedelta(seconds=self.ledger.settings.handover_code_lifetime_s)
        order_id = new_id()
        row = {
            "id": order_id,
            "state": OrderState.QUEUED,
            "version": 1,
            "sender_id": parties.sender.id,
            "recipient_id": parties.recipient.id,
            "placed_by_id": parties.placed_by.id if parties.placed_by else None,
            "from_post": request.from_post,
            "to_post": request.to_post,
            "description": request.description or None,
            "priority": request.priority,
            "not_before": not_before,
            "standing_order_id": standing_order_id,
            "occurs_on": occurs_on,
            "created_at": now,
            "updated_at": now,
            "codes_expire_at": max(now, not_before or now) + lifetime,
            **self._expectation(window, now),
        }
        is_promised = row["window_to"] is not None
        forecast = promise_row(order_id, window.since, window.promise) if is_promised else None
        return self._with_event_and_notices(row, parties, forecast)

    def _expectation(self, window: Window, now: datetime) -> dict[str, Any]:
        """The window, promised and expected; while no robot can come nothing is promised, and the reason is said."""
        reason = self.ledger.estimates.ahead.reason if window.since <= now else None
        times = (None, None) if reason else (window.begins_at, window.ends_at)
        return {
            **dict(zip(("window_from", "window_to"), times, strict=True)),
            **dict(zip(("expected_from", "expected_to"), times, strict=True)),
            "window_assumed": window.assumed,
            "estimated_at": now,
            "why": reason,
        }

    def _with_event_and_notices(
        self, row: Mapping[str, Any], parties: Parties, forecast: Mapping[str, Any] | None
    ) -> Draft:
        order, (by, person) = new_row(Order, row), _placing_actor(row, parties)
        event = event_row(order, MOVED, Actor(by, person_id=person.id, post=order.from_post))
        # Everything that there is to know of it is at hand: nothing is read again.
        people = {one.id: one for one in (parties.sender, parties.recipient, person)}
        facts = OrderFacts(order, [row_of(OrderEvent, event)], people, None)
        return Draft(facts, row, event, self.ledger.notices(facts), forecast)

    async def write(self, session: AsyncSession, drafts: Sequence[Draft]) -> None:
        """Write new orders down, tell their people, and publish them after the commit."""
        await write_all(session, Order, [one.order for one in drafts])
        await write_all(session, OrderEvent, [one.event for one in drafts])
        await write_all(session, ForecastRow, [one.forecast for one in drafts if one.forecast is not None])
        await tell_all(session, [notice for one in drafts for notice in one.notices])
        for one in drafts:
            self.ledger.publish(session, one.facts)

    def _check_known(self, email: str, known: Mapping[str, Person], unknown: type[Unprocessable]) -> None:
        if email not in known and not may_be_sent_mail(email, self.ledger.settings):
            domains = ", ".join(self.ledger.settings.allowed_domains)
            raise unknown(f"No account here has the address {email}. New addresses are those of {domains}.")

    async def _person(self, session: AsyncSession, email: str, known: dict[str, Person]) -> Person:
        if email not in known:
            known[email] = await self.sign_in.person(session, email, self.ledger.clock.utc())
        return known[email]


def _placing_actor(row: Mapping[str, Any], parties: Parties) -> tuple[By, Person]:
    if row["standing_order_id"] is not None:
        return By.TIMER, parties.placed_by or parties.sender
    return (By.SENDER, parties.sender) if parties.placed_by is None else (By.DISPATCHER, parties.placed_by)
