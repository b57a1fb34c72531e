"""One order for whoever came by the link in their mail: no account, no cookie, everything by POST.

The link opens this one order, as its recipient sees it, and nothing else.
"""

from typing import Annotated

from fastapi import APIRouter, Depends, Request
from pydantic import BaseModel, ConfigDict, StringConstraints

from app.database import ReadingDep
from app.errors import problems
from app.orders.routes import OrdersDep
from app.orders.schemas import OrderView
from app.people.errors import LinkRefused
from app.people.links import Links
from app.people.rate_limits import Door, per_host
from app.people.same_origin import refuse_other_sites, require_https_or_loopback


class LinkToken(BaseModel):
    """What stands behind the # of the link."""

    model_config = ConfigDict(extra="forbid")

    token: Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9_-]{43}$")]


def _door(request: Request) -> None:
    require_https_or_loopback(request)
    refuse_other_sites(request)


def _links(request: Request) -> Links:
    links: Links = request.app.state.links
    return links


LinksDep = Annotated[Links, Depends(_links)]

router = APIRouter(
    prefix="/link",
    tags=["one order"],
    dependencies=[Depends(_door), per_host(Door.LINKS)],
    responses=problems(LinkRefused, 429),
)


@router.post("/order")
async def linked_order(link: LinkToken, links: LinksDep, orders: OrdersDep, session: ReadingDep) -> OrderView:
    """The order that this link was mailed for."""
    guest = await links.open(session, link.token)
    return await orders.view(session, guest.person, guest.order_id)
