"""Robots over HTTP, and the robots' own way in."""

from typing import Annotated

from fastapi import APIRouter, Path, WebSocket
from sqlmodel import col, select

from app.accounts.current_user import CurrentUser
from app.accounts.sessions.same_origin import travels_safely
from app.core.database.database import ReadingDep
from app.core.paging import PAGED, PageDep, PageOf, Sorting
from app.core.parts import part
from app.models import RobotRow
from app.orders.views.robot_view import RobotView
from app.robots.conversation.conversation import TOKEN_REFUSED, Conversation
from app.robots.conversation.intake import Intake
from app.robots.corridors.occupied import Traffic, traffic_for
from app.robots.link.tokens import token_of
from app.robots.service import Fleet

router = APIRouter(tags=["robots"])

BY_NAME = Sorting("robots", col(RobotRow.name))


FleetDep = Annotated[Fleet, part(Fleet)]
IntakeDep = Annotated[Intake, part(Intake)]
RobotName = Annotated[str, Path(pattern=r"^[A-Za-z0-9][A-Za-z0-9_-]*$", max_length=64)]


class RobotPage(PageOf[RobotView]):
    """Some robots, by name; `next` is the cursor of the following page, null on the last."""


@router.get("/robots", responses=PAGED)
async def all_robots(user: CurrentUser, session: ReadingDep, fleet: FleetDep, page: PageDep) -> RobotPage:
    """Where the robots were last seen and what they are doing."""
    robots, following = await page.of(session, select(RobotRow), BY_NAME)
    return RobotPage(items=[fleet.view_of(robot) for robot in robots], next=following)


@router.get("/map/traffic")
async def traffic(user: CurrentUser, session: ReadingDep) -> Traffic:
    """Which robot holds which corridor: all of them, or those with an order of one's own for members."""
    return await traffic_for(session, user)


@router.websocket("/robots/link")
async def robot_link(socket: WebSocket, fleet: FleetDep, intake: IntakeDep) -> None:
    """The link of one robot (docs/reference/protocol.md), signed in by its token."""
    async with fleet.database.reading() as session:
        token = await token_of(session, socket.headers.get("Authorization"))
    await socket.accept()
    if token is None or not travels_safely(socket):
        reason = "token refused" if token is None else "a token is taken over wss alone"
        await socket.close(TOKEN_REFUSED, reason)
        return
    await Conversation(intake, token, socket).run()
