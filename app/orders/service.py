"""The orders of one campus, composed: the ledger, and one part for each kind of change."""

from dataclasses import dataclass

from sqlmodel.ext.asyncio.session import AsyncSession

from app.accounts.sign_in.service import SignInService
from app.core.server_key import ServerKey
from app.models import Order, Person
from app.orders.changes.cancelling import Cancelling
from app.orders.changes.intervening import Intervening
from app.orders.changes.passing_on import PassingOn
from app.orders.changes.placing import Placing
from app.orders.changes.returning import Returning
from app.orders.changes.waiting import Waiting
from app.orders.custody.codes import verifiers
from app.orders.ledger import Actor, Ledger
from app.orders.views.schemas import OrderView
from protocol.to_robot import Verifier

__all__ = ["Actor", "Orders"]


@dataclass(frozen=True)
class Orders:
    """The orders of one campus. `key` derives their hand-over codes."""

    ledger: Ledger
    key: ServerKey
    placing: Placing
    waiting: Waiting
    returning: Returning
    cancelling: Cancelling
    intervening: Intervening
    passing_on: PassingOn

    @classmethod
    def of(cls, ledger: Ledger, key: ServerKey, sign_in: SignInService) -> "Orders":
        """Compose the parts on one ledger."""
        returning = Returning(ledger)
        return cls(
            ledger,
            key,
            placing=Placing(ledger, sign_in),
            waiting=Waiting(ledger),
            returning=returning,
            cancelling=Cancelling(ledger, returning),
            intervening=Intervening(ledger, returning),
            passing_on=PassingOn(ledger),
        )

    async def view(self, session: AsyncSession, person: Person, order_id: str) -> OrderView:
        """Return one order as this person sees it. Raises UnknownOrder, also for an order of others."""
        order, role = await self.ledger.visible_order(session, person, order_id)
        return await self.ledger.view(session, order, role, person)

    async def verifiers(self, session: AsyncSession, *orders: Order) -> tuple[Verifier, ...]:
        """Return what a robot needs to check the codes of these orders, delegates' too, with no network."""
        return await verifiers(session, self.key, orders)
