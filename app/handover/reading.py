"""Orders read without a lock, for requests that change nothing."""

from sqlmodel.ext.asyncio.session import AsyncSession

from app.models import Order, Person
from app.orders.ledger import unknown
from app.orders.views.views import MyRole, role_in


async def find_order(session: AsyncSession, order_id: str) -> Order:
    """Raises UnknownOrder."""
    order = await session.get(Order, order_id)
    if order is None:
        raise unknown(order_id)
    return order


async def visible_order(session: AsyncSession, person: Person, order_id: str) -> tuple[Order, MyRole]:
    """Return an order that this person may see, and their role in it. Raises UnknownOrder."""
    order = await find_order(session, order_id)
    role = role_in(order, person)
    if role is None:
        raise unknown(order_id)
    return order, role
