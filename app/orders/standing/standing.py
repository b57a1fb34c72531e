"""Standing orders: each occurrence becomes an order of its own, once, whatever stops and starts meanwhile.

An occurrence is known by its standing order and its local day, which the database keeps apart; the order and the next
moment are written in one transaction.
"""

from dataclasses import dataclass
from datetime import UTC, date, datetime, time, timedelta
from typing import Final
from zoneinfo import ZoneInfo

import structlog
from sqlmodel import col, select
from sqlmodel.ext.asyncio.session import AsyncSession
from sqlmodel.sql.expression import SelectOfScalar

from app.core.errors import ServiceError
from app.models import Order, Person, Role, StandingOrder
from app.orders import errors
from app.orders.changes.placing import Parties, Placing
from app.orders.standing.recurrence import Recurrence, day_of, next_after
from app.orders.views.schemas import NewStandingOrder, OrderRequest, PartyView, StandingOrderView
from protocol.clock import Clock
from protocol.ids import new_id

log = structlog.get_logger(__name__)
GRACE: Final = timedelta(hours=6)
"""An order that could not be made in time is still made so much later."""


@dataclass(frozen=True)
class StandingOrders:
    """The standing orders of one campus."""

    placing: Placing
    clock: Clock

    async def create(self, session: AsyncSession, person: Person, request: NewStandingOrder) -> StandingOrderView:
        """Raises UnknownPost, SamePost, NoWay, UnknownRecipient, UnknownSender, ForDispatchers."""
        self.placing.window(request.from_post, request.to_post)
        parties = await self.placing.parties(session, person, request)
        now = self.clock.utc()
        row = StandingOrder(
            id=new_id(),
            sender_id=parties.sender.id,
            recipient_id=parties.recipient.id,
            placed_by_id=parties.placed_by.id if parties.placed_by else None,
            from_post=request.from_post,
            to_post=request.to_post,
            description=request.description or None,
            priority=request.priority,
            weekdays=sorted(set(request.weekdays)),
            at=request.at,
            zone=request.zone,
            until=request.until.isoformat() if request.until else None,
            created_at=now,
        )
        _plan(row, now)
        session.add(row)
        await session.flush()
        return _view(row, parties)

    def visible_to(self, person: Person) -> SelectOfScalar[StandingOrder]:
        """One's own; a dispatcher sees everybody's."""
        if person.has_role(Role.DISPATCHER):
            return select(StandingOrder)
        return select(StandingOrder).where(StandingOrder.sender_id == person.id)

    async def views(self, session: AsyncSession, rows: list[StandingOrder]) -> list[StandingOrderView]:
        return [_view(row, await self._parties(session, row)) for row in rows]

    async def view(self, session: AsyncSession, person: Person, standing_id: str) -> StandingOrderView:
        """Raises UnknownStandingOrder."""
        row = await self._visible_row(session, person, standing_id, to_change=False)
        return (await self.views(session, [row]))[0]

    async def pause(self, session: AsyncSession, person: Person, standing_id: str) -> StandingOrderView:
        """No more orders until it is resumed. Raises UnknownStandingOrder, StandingOrderEnded."""
        row = await self._lasting(session, person, standing_id)
        row.paused_at, row.next_at = row.paused_at or self.clock.utc(), None
        return (await self.views(session, [row]))[0]

    async def resume(self, session: AsyncSession, person: Person, standing_id: str) -> StandingOrderView:
        """From now on again: what would have come round meanwhile is not made up for."""
        row = await self._lasting(session, person, standing_id)
        if row.paused_at is not None:
            row.paused_at = row.why = None
            _plan(row, self.clock.utc())
        return (await self.views(session, [row]))[0]

    async def end(self, session: AsyncSession, person: Person, standing_id: str) -> StandingOrderView:
        """For good; the orders that it has made stay as they are. Raises UnknownStandingOrder."""
        row = await self._visible_row(session, person, standing_id)
        row.ended_at, row.next_at = row.ended_at or self.clock.utc(), None
        return (await self.views(session, [row]))[0]

    async def due(self, session: AsyncSession) -> list[str]:
        """Which have come round."""
        wanted = select(StandingOrder.id).where(col(StandingOrder.next_at) <= self.clock.utc())
        return list((await session.exec(wanted.order_by(col(StandingOrder.next_at), col(StandingOrder.id)))).all())

    async def make_next(self, session: AsyncSession, standing_id: str) -> str | None:
        """The order of this occurrence; None if it is too late for it, or was made before. Then the next is planned."""
        now = self.clock.utc()
        row = await session.get_one(StandingOrder, standing_id, with_for_update=True)
        if row.next_at is None or row.next_at > now:
            return None
        day, moment = day_of(_recurrence(row), row.next_at), row.next_at
        _plan(row, moment)
        if now - moment > GRACE:
            log.warning("standing_order_missed", standing_order=row.id, day=day.isoformat())
            return None
        return await self._make(session, row, day)

    async def _make(self, session: AsyncSession, row: StandingOrder, day: date) -> str | None:
        made = select(Order.id).where(Order.standing_order_id == row.id, Order.occurs_on == day.isoformat())
        if (await session.exec(made)).first() is not None:
            return None
        parties = await self._parties(session, row)
        request = OrderRequest.model_construct(
            from_post=row.from_post,
            to_post=row.to_post,
            recipient=parties.recipient.email,
            description=row.description,
            priority=row.priority,
        )
        try:
            facts = await self.placing.place(session, parties, request, row, day.isoformat())
        except ServiceError as problem:  # the map has changed, say: its owner has to correct it
            row.paused_at, row.next_at, row.why = self.clock.utc(), None, problem.sentence[:500]
            log.warning("standing_order_paused", standing_order=row.id, problem=problem.code)
            return None
        return facts.order.id

    async def _visible_row(
        self, session: AsyncSession, person: Person, standing_id: str, *, to_change: bool = True
    ) -> StandingOrder:
        row = await session.get(StandingOrder, standing_id, with_for_update=to_change or None)
        if row is None or (row.sender_id != person.id and not person.has_role(Role.DISPATCHER)):
            raise errors.UnknownStandingOrder(f"There is no standing order {standing_id} among yours.")
        return row

    async def _lasting(self, session: AsyncSession, person: Person, standing_id: str) -> StandingOrder:
        row = await self._visible_row(session, person, standing_id)
        if row.ended_at is not None:
            raise errors.StandingOrderEnded(f"Standing order {standing_id} has ended. Make a new one.")
        return row

    async def _parties(self, session: AsyncSession, row: StandingOrder) -> Parties:
        sender, recipient = [await session.get_one(Person, one) for one in (row.sender_id, row.recipient_id)]
        placed_by = await session.get_one(Person, row.placed_by_id) if row.placed_by_id else None
        return Parties(sender, recipient, placed_by)


def _recurrence(row: StandingOrder) -> Recurrence:
    until = date.fromisoformat(row.until) if row.until else None
    return Recurrence(frozenset(row.weekdays), time.fromisoformat(row.at), ZoneInfo(row.zone), until)


def _plan(row: StandingOrder, after: datetime) -> None:
    """When it comes round next; with the last day behind it, it has ended."""
    row.next_at = next_after(_recurrence(row), after.astimezone(UTC))
    if row.next_at is None:
        row.ended_at = after


def _view(row: StandingOrder, parties: Parties) -> StandingOrderView:
    sender, recipient = [PartyView(email=one.email, name=one.name) for one in (parties.sender, parties.recipient)]
    return StandingOrderView(
        id=row.id,
        from_post=row.from_post,
        to_post=row.to_post,
        sender=sender,
        recipient=recipient,
        description=row.description,
        priority=row.priority.value,
        weekdays=list(row.weekdays),
        at=row.at,
        zone=row.zone,
        until=date.fromisoformat(row.until) if row.until else None,
        created_at=row.created_at,
        next_at=row.next_at,
        paused=row.paused_at is not None,
        ended=row.ended_at is not None,
        why=row.why,
    )
