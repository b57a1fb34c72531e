"""One order for a visitor by the link in their mail: no account, no cookie, everything by POST.

The link opens this one order, as its recipient sees it (or a delegate: where it is, and their code), and nothing else.
"""

from datetime import datetime
from typing import Annotated

from fastapi import APIRouter, Depends, Request, Response
from pydantic import BaseModel, ConfigDict, Field, StringConstraints
from sqlmodel.ext.asyncio.session import AsyncSession

from app.accounts.errors import LinkRefused
from app.accounts.links import Links
from app.accounts.rate_limits import Door, per_host
from app.accounts.sessions.same_origin import refuse_other_sites, require_https_or_loopback
from app.core.database.database import DatabaseDep, ReadingDep, SessionDep
from app.core.errors import problems
from app.core.parts import part
from app.handover.routes import ASKED, NAMED, NOT_KEPT, DelegatingDep, HandOversDep, hand_over
from app.handover.schemas import CodeView, DelegateView, HandoverAsked, HandoverRequest, NewDelegate, PurposeName
from app.handover.service import HandOvers
from app.orders.custody.codes import HandoverCode, code_svg
from app.orders.errors import NoCodeForYou, NotRecallable, UnknownOrder
from app.orders.routes.orders import OrdersDep
from app.orders.views.schemas import OrderView

Token = Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9_-]{43}$")]


class Link(BaseModel):
    """The part of the link behind its #."""

    model_config = ConfigDict(extra="forbid")

    token: Token


class LinkedHandOver(HandoverRequest):
    """Hand over now: a tap, or the digits of a code that is good now."""

    token: Token


class LinkedDelegate(NewDelegate):
    """The person who takes the mail instead."""

    token: Token


class LinkedCode(BaseModel):
    """A hand-over code, with its picture: there is no cookie by which it could be fetched."""

    purpose: PurposeName
    text: str
    digits: str
    digits_locked: bool
    expires_at: datetime
    svg: str = Field(description="The QR code as an SVG picture.")


class LinkedDelegateView(BaseModel):
    """The new delegate, and the code to be passed on to them."""

    delegate: DelegateView
    code: LinkedCode


async def _door(request: Request) -> None:
    require_https_or_loopback(request)
    refuse_other_sites(request)


LinksDep = Annotated[Links, part(Links)]

router = APIRouter(
    prefix="/link",
    tags=["one order"],
    dependencies=[Depends(_door), per_host(Door.LINKS)],
    responses=problems(LinkRefused, 429),
)


@router.post("/order")
async def linked_order(
    link: Link, links: LinksDep, orders: OrdersDep, delegating: DelegatingDep, session: ReadingDep
) -> OrderView:
    """The order that this link was mailed for."""
    guest = await links.open(session, link.token)
    if guest.is_delegate:
        return await delegating.view(session, guest.person, guest.order_id)
    return await orders.view(session, guest.person, guest.order_id)


@router.post("/code", responses=problems(NoCodeForYou))
async def linked_code(
    link: Link, links: LinksDep, hand_overs: HandOversDep, session: ReadingDep, response: Response
) -> LinkedCode:
    """The code of the recipient or the delegate, while it is their turn."""
    guest = await links.open(session, link.token)
    code = await hand_overs.my_code(session, guest.person, guest.order_id)
    response.headers.update(NOT_KEPT)
    return await _shown(session, hand_overs, code)


@router.post("/handover", status_code=202, dependencies=[per_host(Door.DIGITS)], responses=ASKED)
async def linked_hand_over(
    request: LinkedHandOver, links: LinksDep, hand_overs: HandOversDep, database: DatabaseDep
) -> HandoverAsked:
    """Ask the robot that waits to hand over; 202: it is asked, and its receipt tells whether it has."""
    async with database.reading() as session:
        guest = await links.open(session, request.token)
    return await hand_over(guest.order_id, request, guest.person, hand_overs, database)


@router.post("/not-now", responses=problems(NotRecallable, UnknownOrder))
async def linked_not_now(link: Link, links: LinksDep, orders: OrdersDep, session: SessionDep) -> OrderView:
    """Decline the mail for now: the robot brings it back."""
    guest = await links.open(session, link.token)
    return await orders.returning.not_now(session, guest.person, guest.order_id)


@router.post("/delegate", status_code=201, responses=NAMED)
async def linked_delegate(
    *,
    request: LinkedDelegate,
    links: LinksDep,
    delegating: DelegatingDep,
    hand_overs: HandOversDep,
    session: SessionDep,
    response: Response,
) -> LinkedDelegateView:
    """Name a delegate who takes the mail instead, with a code of their own, which is shown here once."""
    guest = await links.open(session, request.token)
    named = NewDelegate(name=request.name, email=request.email, purpose=request.purpose)
    row = await delegating.name(session, guest.person, guest.order_id, named)
    code = await delegating.code(session, guest.person, guest.order_id, row.id)
    response.headers.update(NOT_KEPT)
    return LinkedDelegateView(delegate=DelegateView.of(row), code=await _shown(session, hand_overs, code))


async def _shown(session: AsyncSession, hand_overs: HandOvers, code: HandoverCode) -> LinkedCode:
    is_locked = await hand_overs.is_locked(session, code.order_id)
    view = CodeView.of(code, hand_overs.key, "", is_locked).model_dump(exclude={"svg_url"})
    return LinkedCode(**view, svg=code_svg(code.text(hand_overs.key)).decode())
