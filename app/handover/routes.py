"""Handing over: codes, taps, digits, delegates."""

from typing import Annotated, Final

from fastapi import APIRouter, Path, Response

from app.accounts.current_user import CurrentUser, Dispatcher
from app.accounts.errors import AddressNotAllowed, RoleNeeded
from app.accounts.rate_limits import Door, per_host, per_person
from app.core.database.database import DatabaseDep, ReadingDep, SessionDep
from app.core.errors import ServiceError, problems
from app.core.paging import PAGED, PageDep
from app.core.parts import part
from app.handover import errors
from app.handover.delegates import Delegating
from app.handover.my_delegations import named_by
from app.handover.schemas import (
    CodeView,
    Delegates,
    DelegateView,
    HandoverAsked,
    HandoverRequest,
    MyDelegates,
    MyDelegateView,
    NewDelegate,
)
from app.handover.service import HandOvers
from app.orders.custody.codes import HandoverCode, code_svg
from app.orders.errors import NoCodeForYou, UnknownOrder
from app.orders.routes.orders import PICTURE, OrderId, OrdersDep
from app.orders.views.schemas import OrderView

router = APIRouter(tags=["orders"])
dispatch_router = APIRouter(tags=["dispatch"])

DelegateId = Annotated[str, Path(pattern=r"^[A-Za-z0-9][A-Za-z0-9_-]*$", max_length=64)]
NOT_KEPT: Final = {"Cache-Control": "no-store"}
ASKED = problems(
    UnknownOrder,
    errors.NotYourTurn,
    errors.RobotNotThere,
    errors.RobotOffline,
    errors.RobotTakesNoTaps,
    errors.DigitsLocked,
    errors.CodesExpired,
    errors.WrongDigits,
    429,
)
NAMED = problems(
    UnknownOrder,
    errors.NotYoursToDelegate,
    errors.TooLateToDelegate,
    errors.TooManyDelegates,
    AddressNotAllowed,
    429,
)


HandOversDep = Annotated[HandOvers, part(HandOvers)]
DelegatingDep = Annotated[Delegating, part(Delegating)]


@router.get("/orders/{order_id}/code", responses=problems(UnknownOrder, NoCodeForYou))
async def my_code(
    order_id: OrderId, user: CurrentUser, hand_overs: HandOversDep, session: ReadingDep, response: Response
) -> CodeView:
    """The hand-over code of the person whose turn it is, as a QR text and six digits."""
    code = await hand_overs.my_code(session, user, order_id)
    response.headers.update(NOT_KEPT)
    svg_url = f"/api/v1/orders/{order_id}/code.svg"
    return CodeView.of(code, hand_overs.key, svg_url, await hand_overs.is_locked(session, order_id))


@router.get(
    "/orders/{order_id}/code.svg",
    response_class=Response,
    responses={**PICTURE, **problems(UnknownOrder, NoCodeForYou)},
)
async def my_code_picture(
    order_id: OrderId, user: CurrentUser, hand_overs: HandOversDep, session: ReadingDep
) -> Response:
    """The same code as a picture."""
    return _picture(await hand_overs.my_code(session, user, order_id), hand_overs)


@router.post("/orders/{order_id}/handover", status_code=202, dependencies=[per_host(Door.DIGITS)], responses=ASKED)
async def hand_over(
    order_id: OrderId, request: HandoverRequest, user: CurrentUser, hand_overs: HandOversDep, database: DatabaseDep
) -> HandoverAsked:
    """Ask the robot that waits to hand over: by a tap of the person whose turn it is, or by the digits of a code.

    202: the robot is asked. Mail has changed hands when its receipt has come; the order moves then, and its
    `handover_requested` is null again.
    """
    async with database.transaction() as session:
        if request.digits:
            done = await hand_overs.type_digits(session, user, order_id, request.digits)
        else:
            done = await hand_overs.tap(session, user, order_id)
    if isinstance(done, ServiceError):
        raise done
    return done


@dispatch_router.post("/orders/{order_id}/digits/release", responses=problems(UnknownOrder, RoleNeeded))
async def release_digits(
    order_id: OrderId, dispatcher: Dispatcher, hand_overs: HandOversDep, orders: OrdersDep, session: SessionDep
) -> OrderView:
    """Let the digits of an order be typed again after five wrong ones."""
    await hand_overs.release_digits(session, dispatcher, order_id)
    return await orders.view(session, dispatcher, order_id)


@router.get("/orders/{order_id}/delegates", responses={**PAGED, **problems(UnknownOrder)})
async def list_delegates(
    order_id: OrderId, user: CurrentUser, delegating: DelegatingDep, page: PageDep, session: ReadingDep
) -> Delegates:
    """List who may hand over for the caller, those whose code was taken back too, oldest first."""
    rows, following = await delegating.page_of(session, user, order_id, page)
    return Delegates(items=[DelegateView.of(one) for one in rows], next=following)


@router.get("/me/delegates", responses=PAGED)
async def my_delegates(user: CurrentUser, page: PageDep, session: ReadingDep) -> MyDelegates:
    """List whom the caller has named to hand over, for all orders that go on; each is taken back at its order."""
    named, following = await named_by(session, user, page)
    return MyDelegates(items=[MyDelegateView.of(one) for one in named], next=following)


@router.post("/orders/{order_id}/delegates", status_code=201, dependencies=[per_person(Door.CHANGES)], responses=NAMED)
async def name_delegate(
    *,
    order_id: OrderId,
    request: NewDelegate,
    user: CurrentUser,
    delegating: DelegatingDep,
    session: SessionDep,
    response: Response,
) -> DelegateView:
    """Name a delegate who hands over instead, with a code of their own."""
    row = await delegating.name(session, user, order_id, request)
    response.headers["Location"] = f"/api/v1/orders/{order_id}/delegates/{row.id}/code"
    return DelegateView.of(row)


@router.delete(
    "/orders/{order_id}/delegates/{delegate_id}",
    status_code=204,
    responses=problems(UnknownOrder, errors.UnknownDelegate),
)
async def revoke_delegate(
    order_id: OrderId, delegate_id: DelegateId, user: CurrentUser, delegating: DelegatingDep, session: SessionDep
) -> None:
    """Take a delegate's code back. A robot without network hears of it when it is back."""
    await delegating.revoke(session, user, order_id, delegate_id)


@router.get("/orders/{order_id}/delegates/{delegate_id}/code", responses=problems(UnknownOrder, errors.UnknownDelegate))
async def delegate_code(
    *,
    order_id: OrderId,
    delegate_id: DelegateId,
    user: CurrentUser,
    delegating: DelegatingDep,
    hand_overs: HandOversDep,
    session: ReadingDep,
    response: Response,
) -> CodeView:
    """A delegate's code, to be passed on to them."""
    code = await delegating.code(session, user, order_id, delegate_id)
    response.headers.update(NOT_KEPT)
    svg_url = f"/api/v1/orders/{order_id}/delegates/{delegate_id}/code.svg"
    return CodeView.of(code, hand_overs.key, svg_url, await hand_overs.is_locked(session, order_id))


@router.get(
    "/orders/{order_id}/delegates/{delegate_id}/code.svg",
    response_class=Response,
    responses={**PICTURE, **problems(UnknownOrder, errors.UnknownDelegate)},
)
async def delegate_code_picture(
    *,
    order_id: OrderId,
    delegate_id: DelegateId,
    user: CurrentUser,
    delegating: DelegatingDep,
    hand_overs: HandOversDep,
    session: ReadingDep,
) -> Response:
    """The same code as a picture."""
    return _picture(await delegating.code(session, user, order_id, delegate_id), hand_overs)


def _picture(code: HandoverCode, hand_overs: HandOvers) -> Response:
    return Response(code_svg(code.text(hand_overs.key)), media_type="image/svg+xml", headers=NOT_KEPT)
