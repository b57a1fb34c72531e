"""An order in the middle of a test's own transaction; people's own go over the desk (`app.orders.desk`)."""

from sqlmodel.ext.asyncio.session import AsyncSession

from app.orders.schemas import NewOrder
from app.orders.service import Orders
from app.people.service import look_up_people
from app.tables import Person


async def placed(orders: Orders, session: AsyncSession, person: Person, wish: NewOrder) -> str:
    """Its id."""
    draft = await orders.draft(session, person, wish, await look_up_people(session, wish.addresses))
    await orders.write(session, [draft])
    return draft.facts.order.id
