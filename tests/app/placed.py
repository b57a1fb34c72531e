"""An order in the middle of a test's own transaction; people's own go over the desk (`app.orders.batcher`)."""

from sqlmodel.ext.asyncio.session import AsyncSession

from app.accounts.sign_in.service import look_up_people
from app.models import Person
from app.orders.service import Orders
from app.orders.views.schemas import NewOrder


async def placed(orders: Orders, session: AsyncSession, person: Person, wish: NewOrder) -> str:
    """Its id."""
    draft = await orders.placing.draft(session, person, wish, await look_up_people(session, wish.addresses))
    await orders.placing.write(session, [draft])
    return draft.facts.order.id
