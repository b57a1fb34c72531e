"""Traffic over HTTP: close and open corridors, take a robot out of service, tell one that a corridor is free."""

from typing import Annotated

from fastapi import APIRouter, Path

from app.accounts.current_user import CurrentUser, Dispatcher
from app.accounts.errors import RoleNeeded
from app.core.database.database import ReadingDep, SessionDep
from app.core.errors import problems
from app.robots.corridors.closures import ClosedCorridors, all_closed
from app.robots.errors import NoSuchCorridor, RobotAway, RobotGoesOn, RobotTooOld, UnknownRobot
from app.robots.routes.robots import FleetDep, RobotName
from app.robots.schemas import CommandReason, CommandView, WayIsOpen
from app.robots.service import known_robot
from app.traffic.closing import close, open_again
from app.traffic.out_of_service import take_out
from app.traffic.reopening import open_way
from protocol.one_line import ONE_LINE

router = APIRouter(tags=["dispatch"])
reading_router = APIRouter(tags=["robots"])

CorridorName = Annotated[str, Path(min_length=1, max_length=129, pattern=ONE_LINE)]
CHANGED = problems(NoSuchCorridor, RoleNeeded)
TOLD = problems(UnknownRobot, RoleNeeded)


@reading_router.get("/corridors/closed")
async def closed_corridors(user: CurrentUser, session: ReadingDep) -> ClosedCorridors:
    """List the corridors into which no robot is let: people have closed them, or robots turned back there."""
    return await all_closed(session)


@router.post("/corridors/{corridor}/close", responses=CHANGED)
async def close_corridor(
    corridor: CorridorName, why: CommandReason, dispatcher: Dispatcher, session: SessionDep, fleet: FleetDep
) -> ClosedCorridors:
    """Let no robot into a corridor any more, until it is opened again; one that is in there drives on."""
    return await close(session, fleet, corridor, why.reason, dispatcher)


@router.post("/corridors/{corridor}/open", responses=CHANGED)
async def open_corridor(
    corridor: CorridorName, dispatcher: Dispatcher, session: SessionDep, fleet: FleetDep
) -> ClosedCorridors:
    """Let robots into a closed corridor again: the dispatcher who says so has looked. Robots that turned back there
    are told."""
    return await open_again(session, fleet, corridor, dispatcher)


@router.post(
    "/robots/{name}/open-way", status_code=202, responses={**TOLD, **problems(NoSuchCorridor, RobotAway, RobotTooOld)}
)
async def tell_robot_of_open_way(
    name: RobotName, way: WayIsOpen, dispatcher: Dispatcher, session: SessionDep, fleet: FleetDep
) -> CommandView:
    """Tell a robot that a corridor which it took for closed is free again: the dispatcher who says so has looked."""
    robot = await known_robot(session, name, to_change=True)
    return CommandView.of(await open_way(session, fleet, robot, way.corridor, dispatcher), robot.online)


@router.post("/robots/{name}/take-out", status_code=202, responses={**TOLD, **problems(RobotGoesOn, RobotTooOld)})
async def take_robot_out(
    name: RobotName, why: CommandReason, dispatcher: Dispatcher, session: SessionDep, fleet: FleetDep
) -> CommandView:
    """Give the corridors of a robot that is dead to others: the dispatcher who says so has looked, and it blocks no
    robot.

    It stands still when it hears so, until it is put down at a post or in a dock.
    """
    robot = await known_robot(session, name, to_change=True)
    return CommandView.of(await take_out(session, fleet, robot, why.reason, dispatcher), robot.online)
