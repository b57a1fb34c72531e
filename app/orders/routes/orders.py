"""Ordering, following, cancelling."""

from typing import Annotated, Any, Final

from fastapi import APIRouter, Header, Path, Query, Request, Response
from sqlmodel import col

from app.accounts.current_user import CurrentUser
from app.accounts.rate_limits import Door, per_person
from app.accounts.search import SearchText
from app.core.database.database import ReadingDep, SessionDep
from app.core.errors import TooManyRequests, answering, problems
from app.core.paging import PAGED, PageDep, Sorting
from app.core.parts import part
from app.core.settings import CampusDep, SettingsDep
from app.core.texts.reasons import words_of
from app.models import Order, Person
from app.orders import errors
from app.orders.batcher import OrderBatcher
from app.orders.custody.codes import code_svg
from app.orders.service import Orders
from app.orders.views.schemas import Estimate, NewOrder, OrderPage, OrderView, PostName, WindowView, etag_of
from app.orders.views.search import OrderFilter, RoleInList, StateInList
from app.orders.views.views import load_facts, view_for
from maps import shortest_route

router = APIRouter(tags=["orders"])

PICTURE: Final[dict[int | str, dict[str, Any]]] = {200: {"content": {"image/svg+xml": {"schema": {"type": "string"}}}}}
OrderId = Annotated[str, Path(pattern=r"^[A-Za-z0-9][A-Za-z0-9_-]*$", max_length=64)]
NEWEST_FIRST = Sorting("orders", col(Order.created_at), col(Order.id), descending=True)
SEARCHED = "Part of the description, of the other side's name or mail address, or of a post's name or title."
STATES = "`open`: what goes on; `attention`: what of that waits for a dispatcher; `ended`: what goes on no more."
REPLAYED = "Idempotency-Replayed"
REFUSED: Final = (
    errors.UnknownPost,
    errors.SamePost,
    errors.NoWay,
    errors.UnknownRecipient,
    errors.UnknownSender,
    errors.ForDispatchers,
    TooManyRequests,
)
PLACED = {
    **answering(201, "Location", "ETag", REPLAYED),
    **problems(*REFUSED, errors.KeyReused, errors.StillRunning),
}
CHANGED = {**answering(200, "ETag"), **problems(errors.UnknownOrder, errors.NotCancellable, errors.OrderChanged)}


OrdersDep = Annotated[Orders, part(Orders)]
OrderBatcherDep = Annotated[OrderBatcher, part(OrderBatcher)]


@router.get("/estimate", responses=problems(errors.UnknownPost, errors.SamePost, errors.NoWay))
async def estimate(
    user: CurrentUser, orders: OrdersDep, campus: CampusDep, from_post: PostName, to_post: PostName
) -> Estimate:
    """When mail would arrive if it were ordered now."""
    window = orders.placing.window(from_post, to_post)
    length_m = shortest_route(campus, from_post, to_post).length_m
    reason = orders.ledger.estimates.ahead.reason
    return Estimate(
        window=WindowView.of(window),
        length_m=round(length_m, 2),
        assumed=window.assumed,
        reason=reason,
        reason_words=words_of(reason) if reason else None,
    )


@router.post("/orders", status_code=201, responses=PLACED)
async def place_order(
    *,
    request: NewOrder,
    idempotency_key: Annotated[str, Header(pattern=r"^[!-~]+$", max_length=255)],
    user: Annotated[Person, per_person(Door.ORDERS)],
    batcher: OrderBatcherDep,
    response: Response,
) -> OrderView:
    """Place an order. The same key and body again give the first answer again, with `Idempotency-Replayed: true`."""
    placed = await batcher.place(user, idempotency_key, request)
    response.headers.update({**placed.headers, REPLAYED: "true"} if placed.again else placed.headers)
    return placed.view


@router.get("/orders", responses=PAGED)
async def list_orders(
    *,
    user: CurrentUser,
    orders: OrdersDep,
    session: ReadingDep,
    page: PageDep,
    role: RoleInList = "all",
    state: Annotated[StateInList, Query(description=STATES)] = "all",
    search: Annotated[SearchText, Query(description=SEARCHED)] = "",
) -> OrderPage:
    """This person's orders, newest first; a dispatcher's `all` is everybody's. `state` and `search` narrow it down."""
    walks = OrderFilter(role, state, search.strip()).walks(user, orders.ledger.campus)
    rows, following = await page.of_any(session, walks, NEWEST_FIRST)
    facts, ledger = await load_facts(session, rows), orders.ledger
    views = [view_for(user, one, ledger.campus, ledger.settings, ledger.clock.utc()) for one in facts]
    return OrderPage(items=[view for view in views if view], next=following)


@router.get("/orders/{order_id}", responses=problems(errors.UnknownOrder))
async def one_order(
    order_id: OrderId, user: CurrentUser, orders: OrdersDep, session: ReadingDep, response: Response
) -> OrderView:
    """One order with its timeline."""
    view = await orders.view(session, user, order_id)
    response.headers["ETag"] = etag_of(view)
    return view


@router.get(
    "/orders/{order_id}/page.svg", response_class=Response, responses={**PICTURE, **problems(errors.UnknownOrder)}
)
async def order_page_picture(
    order_id: OrderId,
    user: CurrentUser,
    orders: OrdersDep,
    session: ReadingDep,
    settings: SettingsDep,
    request: Request,
) -> Response:
    """The address of the order's page as a QR code: from paper or from another screen to a phone."""
    await orders.view(session, user, order_id)
    home = (settings.public_url or str(request.base_url)).rstrip("/")
    return Response(code_svg(f"{home}/follow.html?order={order_id}"), media_type="image/svg+xml")


@router.post("/orders/{order_id}/cancel", responses=CHANGED)
async def cancel_order(
    *,
    order_id: OrderId,
    user: CurrentUser,
    orders: OrdersDep,
    session: SessionDep,
    response: Response,
    if_match: Annotated[str, Header(max_length=200)] = "",
) -> OrderView:
    """Cancel, at once or (with a robot on its way) as soon as the robot answers."""
    view = await orders.cancelling.cancel(session, user, order_id, if_match)
    response.headers["ETag"] = etag_of(view)
    return view
