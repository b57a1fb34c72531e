"""What dispatchers do with corridors: close one for all robots, and open it again."""

from typing import Annotated

from fastapi import APIRouter, Path

from app.database import ReadingDep, SessionDep
from app.errors import problems
from app.fleet.closed import ClosedCorridors, all_closed
from app.fleet.closed_corridors import close, open_again
from app.fleet.errors import NoSuchCorridor
from app.fleet.routes import FleetDep
from app.fleet.schemas import CommandReason
from app.people.current_user import CurrentUser, Dispatcher
from app.people.errors import RoleNeeded
from protocol.one_line import ONE_LINE

router = APIRouter(tags=["dispatch"])
reading_router = APIRouter(tags=["robots"])

CorridorName = Annotated[str, Path(min_length=1, max_length=129, pattern=ONE_LINE)]
CHANGED = problems(NoSuchCorridor, RoleNeeded)


@reading_router.get("/corridors/closed")
async def closed_corridors(user: CurrentUser, session: ReadingDep) -> ClosedCorridors:
    """List the corridors into which no robot is let: people have closed them, or robots turned back there."""
    return await all_closed(session)


@router.post("/corridors/{corridor}/close", responses=CHANGED)
async def close_corridor(
    corridor: CorridorName, why: CommandReason, dispatcher: Dispatcher, session: SessionDep, fleet: FleetDep
) -> ClosedCorridors:
    """Let no robot into a corridor any more, until it is opened again; whoever is in there drives on."""
    return await close(session, fleet, corridor, why.reason, dispatcher)


@router.post("/corridors/{corridor}/open", responses=CHANGED)
async def open_corridor(
    corridor: CorridorName, dispatcher: Dispatcher, session: SessionDep, fleet: FleetDep
) -> ClosedCorridors:
    """Let robots into a closed corridor again: whoever says so has looked. Robots that turned back there are told."""
    return await open_again(session, fleet, corridor, dispatcher)
