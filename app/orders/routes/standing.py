"""Orders that come again: made, listed, paused, ended."""

from typing import Annotated, Final

from fastapi import APIRouter, Path, Response
from sqlmodel import col

from app.accounts.current_user import CurrentUser
from app.accounts.rate_limits import Door, per_person
from app.core.database.database import ReadingDep, SessionDep
from app.core.errors import answering, problems
from app.core.paging import PAGED, PageDep, Sorting
from app.core.parts import part
from app.models import StandingOrder
from app.orders import errors
from app.orders.routes.orders import REFUSED
from app.orders.standing.standing import StandingOrders
from app.orders.views.schemas import NewStandingOrder, StandingOrderPage, StandingOrderView

router = APIRouter(tags=["standing orders"])

StandingOrderId = Annotated[str, Path(pattern=r"^[A-Za-z0-9][A-Za-z0-9_-]*$", max_length=64)]
NEWEST_FIRST: Final = Sorting("standing orders", col(StandingOrder.created_at), col(StandingOrder.id), descending=True)
CHANGED: Final = problems(errors.UnknownStandingOrder, errors.StandingOrderEnded)


StandingOrdersDep = Annotated[StandingOrders, part(StandingOrders)]


@router.post(
    "/standing-orders",
    status_code=201,
    dependencies=[per_person(Door.ORDERS)],
    responses={**answering(201, "Location"), **problems(*REFUSED)},
)
async def place_standing_order(
    request: NewStandingOrder, user: CurrentUser, standing: StandingOrdersDep, session: SessionDep, response: Response
) -> StandingOrderView:
    """Order something again and again. Each occurrence becomes an order of its own when its time comes."""
    view = await standing.create(session, user, request)
    response.headers["Location"] = f"/api/v1/standing-orders/{view.id}"
    return view


@router.get("/standing-orders", responses=PAGED)
async def list_standing_orders(
    user: CurrentUser, standing: StandingOrdersDep, session: ReadingDep, page: PageDep
) -> StandingOrderPage:
    """This person's standing orders, newest first; a dispatcher sees everybody's."""
    rows, following = await page.of(session, standing.visible_to(user), NEWEST_FIRST)
    return StandingOrderPage(items=await standing.views(session, rows), next=following)


@router.get("/standing-orders/{standing_order_id}", responses=problems(errors.UnknownStandingOrder))
async def one_standing_order(
    standing_order_id: StandingOrderId, user: CurrentUser, standing: StandingOrdersDep, session: ReadingDep
) -> StandingOrderView:
    """One standing order."""
    return await standing.view(session, user, standing_order_id)


@router.post("/standing-orders/{standing_order_id}/pause", responses=CHANGED)
async def pause_standing_order(
    standing_order_id: StandingOrderId, user: CurrentUser, standing: StandingOrdersDep, session: SessionDep
) -> StandingOrderView:
    """Make no orders of it until it is resumed."""
    return await standing.pause(session, user, standing_order_id)


@router.post("/standing-orders/{standing_order_id}/resume", responses=CHANGED)
async def resume_standing_order(
    standing_order_id: StandingOrderId, user: CurrentUser, standing: StandingOrdersDep, session: SessionDep
) -> StandingOrderView:
    """Make orders of it again from now on. What would have come round meanwhile is not made up for."""
    return await standing.resume(session, user, standing_order_id)


@router.post("/standing-orders/{standing_order_id}/end", responses=problems(errors.UnknownStandingOrder))
async def end_standing_order(
    standing_order_id: StandingOrderId, user: CurrentUser, standing: StandingOrdersDep, session: SessionDep
) -> StandingOrderView:
    """End it for good. The orders that it has made stay as they are."""
    return await standing.end(session, user, standing_order_id)
