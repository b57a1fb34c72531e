"""Robots over HTTP, and the robots' own way in."""

from typing import Annotated

from fastapi import APIRouter, Depends, WebSocket
from starlette.requests import HTTPConnection

from app.database import ReadingDep
from app.errors import problems
from app.fleet.conversation import TOKEN_REFUSED, Conversation
from app.fleet.service import Fleet
from app.fleet.tokens import token_of
from app.orders.robot_view import RobotView
from app.people.current_user import CurrentUser
from app.people.same_origin import travels_safely

router = APIRouter(tags=["robots"])


def _fleet_of(connection: HTTPConnection) -> Fleet:
    fleet: Fleet = connection.app.state.fleet
    return fleet


FleetDep = Annotated[Fleet, Depends(_fleet_of)]


@router.get("/robots", responses=problems(401, 403))
async def all_robots(user: CurrentUser, session: ReadingDep, fleet: FleetDep) -> list[RobotView]:
    """Where the robots were last seen and what they are doing."""
    return list(await fleet.views(session))


@router.websocket("/robots/link")
async def robot_link(socket: WebSocket, fleet: FleetDep) -> None:
    """The link of one robot (docs/protocol.md), signed in by its token."""
    async with fleet.database.transaction() as session:
        token = await token_of(session, socket.headers.get("Authorization"), fleet.clock.utc())
    await socket.accept()
    if token is None or not travels_safely(socket):
        reason = "token refused" if token is None else "a token is taken over wss alone"
        await socket.close(TOKEN_REFUSED, reason)
        return
    await Conversation(fleet, token, socket).run()
