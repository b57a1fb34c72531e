"""Delegates, who hand over for another person: named, listed, revoked; the robot is notified each time."""

from dataclasses import dataclass
from typing import Final

from sqlmodel import col, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.accounts.sign_in.service import SignInService
from app.core.paging import Paging, Sorting
from app.handover import errors
from app.handover.notifications import notify_delegate, notify_revoked
from app.handover.people import code_for, may_see, purpose_to_delegate
from app.handover.schemas import NewDelegate
from app.models import Delegate, Order, OrderState, Person, RobotRow
from app.models.orders.order_events import DELEGATE_NAMED, DELEGATE_REVOKED
from app.orders.custody.codes import HandoverCode, Holder, delegates_of
from app.orders.service import Actor
from app.orders.transitions import ENDED, By
from app.orders.views.schemas import OrderView
from app.orders.views.views import HANDOVER_PURPOSES, MyRole, delegates_view, load_facts
from app.robots.service import Fleet
from protocol.ids import new_id
from protocol.parts import Purpose
from protocol.to_robot import Verifiers

MOST: Final = 10
OLDEST_FIRST: Final = Sorting("delegates", col(Delegate.named_at), col(Delegate.id))


@dataclass(frozen=True)
class Delegating:
    """The delegates of the orders of one campus."""

    fleet: Fleet
    sign_in: SignInService

    async def page_of(
        self, session: AsyncSession, person: Person, order_id: str, page: Paging
    ) -> tuple[list[Delegate], str | None]:
        """Those that this person may see, revoked ones too, and the cursor of the next. Raises UnknownOrder."""
        order, role = await self.fleet.orders.ledger.visible_order(session, person, order_id)
        seen = col(Delegate.purpose).in_(HANDOVER_PURPOSES[role])
        return await page.of(session, select(Delegate).where(Delegate.order_id == order.id, seen), OLDEST_FIRST)

    async def name(self, session: AsyncSession, person: Person, order_id: str, request: NewDelegate) -> Delegate:
        """Name a delegate with a code of their own, by mail if there is an address.

        Raises UnknownOrder, NotYoursToDelegate, TooLateToDelegate, TooManyDelegates, AddressNotAllowed.
        """
        order, role = await self.fleet.orders.ledger.visible_order(session, person, order_id)
        purpose = purpose_to_delegate(order, role, Purpose(request.purpose) if request.purpose else None)
        if len([one for one in await delegates_of(session, [order]) if one.revoked_at is None]) >= MOST:
            raise errors.TooManyDelegates(f"There are {MOST} delegates already. Revoke one first.")
        row = Delegate(
            id=new_id(),
            order_id=order.id,
            purpose=purpose,
            name=request.name,
            email=request.email,
            named_by_id=person.id,
            named_at=self.fleet.clock.utc(),
        )
        session.add(row)
        await session.flush()
        if request.email is not None:
            await notify_delegate(session, self.fleet.orders.ledger, self.sign_in, order, row, person)
        await self._tell(session, order, DELEGATE_NAMED, _actor(role, person, request.name))
        return row

    async def revoke(self, session: AsyncSession, person: Person, order_id: str, delegate_id: str) -> None:
        """Take a code back: at once if the robot can be reached, else when it is back. Raises UnknownOrder,
        UnknownDelegate."""
        order, role = await self.fleet.orders.ledger.visible_order(session, person, order_id)
        row = await self._delegate(session, order, role, delegate_id)
        if row.revoked_at is None:
            row.revoked_at = self.fleet.clock.utc()
            await notify_revoked(session, self.fleet.orders.ledger, order, row)
            await self._tell(session, order, DELEGATE_REVOKED, _actor(role, person, row.name))

    async def code(self, session: AsyncSession, person: Person, order_id: str, delegate_id: str) -> HandoverCode:
        """Return a delegate's code, for the person who passes it on to them. Raises UnknownOrder, UnknownDelegate."""
        order, role = await self.fleet.orders.ledger.visible_order(session, person, order_id)
        row = await self._delegate(session, order, role, delegate_id)
        if row.revoked_at is not None or order.state in ENDED:
            raise errors.UnknownDelegate("This code opens nothing any more.")
        return HandoverCode(order.id, Purpose(row.purpose), Holder.DELEGATE, order.codes_expire_at, row)

    async def view(self, session: AsyncSession, delegate: Person, order_id: str) -> OrderView:
        """The order as a delegate of it may see it. Raises UnknownOrder."""
        ledger = self.fleet.orders.ledger
        order = await ledger.order(session, order_id)
        code = code_for(order, delegate, await delegates_of(session, [order]))
        facts = (await load_facts(session, [order]))[0]
        return delegates_view(facts, code.purpose if code else None, ledger.campus, ledger.settings, ledger.clock.utc())

    async def _delegate(self, session: AsyncSession, order: Order, role: MyRole, delegate_id: str) -> Delegate:
        row = await session.get(Delegate, delegate_id)
        if row is None or row.order_id != order.id or not may_see(row, role):
            raise errors.UnknownDelegate(f"This order has no delegate {delegate_id} of yours.")
        return row

    async def _tell(self, session: AsyncSession, order: Order, kind: str, actor: Actor) -> None:
        await session.flush()
        await self.fleet.orders.ledger.note(session, order.id, kind, actor)
        if order.robot is not None and order.state is not OrderState.QUEUED and order.state not in ENDED:
            robot = await session.get_one(RobotRow, order.robot, with_for_update=True)
            codes = await self.fleet.orders.verifiers(session, order)
            await self.fleet.tell(session, robot, Verifiers(verifiers=codes))


def _actor(role: MyRole, person: Person, name: str) -> Actor:
    return Actor(By(role), person_id=person.id, reason=name)
