"""Robots over HTTP, for dispatchers and maintainers: one robot, its commands, its alarms."""

from collections.abc import Callable
from typing import Annotated

from fastapi import APIRouter, Path, Query
from sqlmodel import col, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.accounts.current_user import Dispatcher, DispatcherOrMaintainer
from app.accounts.errors import RoleNeeded
from app.core.database.database import ReadingDep, SessionDep
from app.core.errors import problems
from app.core.paging import PAGED, PageDep, PageOf, Sorting
from app.core.settings import ClockDep
from app.models import Alarm, Person, RobotCommand
from app.robots.commands import Command, ask, new_command_id
from app.robots.errors import UnknownAlarm, UnknownRobot
from app.robots.routes.robots import FleetDep, RobotName
from app.robots.schemas import AlarmView, CommandReason, CommandView, RobotDetails
from app.robots.service import Fleet, known_robot
from protocol.one_line import ONE_LINE
from protocol.to_robot import EmergencyStop, Pause, Recall, Resume

router = APIRouter(tags=["dispatch"])

NEWEST_ALARM = Sorting("alarms", col(Alarm.at), col(Alarm.id), descending=True)
NEWEST_COMMAND = Sorting("robot_commands", col(RobotCommand.asked_at), col(RobotCommand.command_id), descending=True)
TOLD = problems(UnknownRobot, RoleNeeded)
AlarmId = Annotated[int, Path(ge=1, le=2**31 - 1)]


class AlarmPage(PageOf[AlarmView]):
    """Some alarms, newest first."""


class CommandPage(PageOf[CommandView]):
    """Some commands of one robot, newest first."""


@router.get("/robots/{name}", responses=problems(UnknownRobot, RoleNeeded))
async def one_robot(
    name: RobotName, user: DispatcherOrMaintainer, session: ReadingDep, fleet: FleetDep
) -> RobotDetails:
    """One robot: where it is, battery, faults, software, when it was last heard, how far its clock is off."""
    row = await known_robot(session, name)
    open_ones = select(Alarm).where(Alarm.robot == name, col(Alarm.cleared_at).is_(None)).order_by(col(Alarm.id).desc())
    alarms = (await session.exec(open_ones.limit(100))).all()
    return RobotDetails.of(row, fleet.view_of(row), list(alarms))


@router.get("/robots/{name}/commands", responses={**PAGED, **problems(UnknownRobot, RoleNeeded)})
async def list_robot_commands(
    name: RobotName, user: DispatcherOrMaintainer, session: ReadingDep, page: PageDep
) -> CommandPage:
    """List what a robot was told to do, and what it answered, newest first."""
    robot = await known_robot(session, name)
    rows, following = await page.of(session, select(RobotCommand).where(RobotCommand.robot == name), NEWEST_COMMAND)
    return CommandPage(items=[CommandView.of(row, robot.online) for row in rows], next=following)


@router.post("/robots/{name}/pause", status_code=202, responses=TOLD)
async def pause_robot(
    name: RobotName, why: CommandReason, dispatcher: Dispatcher, session: SessionDep, fleet: FleetDep
) -> CommandView:
    """Let a robot wait at the next post until it is told to resume."""
    return await _tell(session, fleet, name, dispatcher, "pause", lambda id_: Pause(command_id=id_, reason=why.reason))


@router.post("/robots/{name}/resume", status_code=202, responses=TOLD)
async def resume_robot(name: RobotName, dispatcher: Dispatcher, session: SessionDep, fleet: FleetDep) -> CommandView:
    """Let a robot go on after a pause or an emergency stop: the dispatcher who says so has looked."""
    return await _tell(session, fleet, name, dispatcher, "resume", lambda id_: Resume(command_id=id_))


@router.post("/robots/{name}/recall", status_code=202, responses=TOLD)
async def recall_robot(
    name: RobotName, why: CommandReason, dispatcher: Dispatcher, session: SessionDep, fleet: FleetDep
) -> CommandView:
    """Let a robot bring back what is aboard and go home."""
    return await _tell(
        session, fleet, name, dispatcher, "recall", lambda id_: Recall(command_id=id_, reason=why.reason)
    )


@router.post("/robots/{name}/emergency-stop", status_code=202, responses=TOLD)
async def stop_robot(
    name: RobotName, why: CommandReason, dispatcher: Dispatcher, session: SessionDep, fleet: FleetDep
) -> CommandView:
    """Let a robot stand still at once, until it is told to resume. A best effort: without network it has not heard."""
    return await _tell(
        session, fleet, name, dispatcher, "stop", lambda id_: EmergencyStop(command_id=id_, reason=why.reason)
    )


async def _tell(
    session: AsyncSession, fleet: Fleet, name: str, dispatcher: Person, word: str, command: Callable[[str], Command]
) -> CommandView:
    robot = await known_robot(session, name, to_change=True)
    row = await ask(session, fleet, robot, command(new_command_id(word)), dispatcher.id)
    return CommandView.of(row, robot.online)


@router.get("/alarms", responses={**PAGED, **problems(RoleNeeded)})
async def list_alarms(
    user: DispatcherOrMaintainer,
    session: ReadingDep,
    page: PageDep,
    only_open: Annotated[bool, Query(description="Only those that are not over.")] = False,
    robot: Annotated[
        str | None, Query(max_length=64, pattern=ONE_LINE, description="Only those of this robot.")
    ] = None,
) -> AlarmPage:
    """List what people should look at, newest first."""
    wanted = select(Alarm).where(col(Alarm.cleared_at).is_(None)) if only_open else select(Alarm)
    wanted = wanted if robot is None else wanted.where(Alarm.robot == robot)
    rows, following = await page.of(session, wanted, NEWEST_ALARM)
    return AlarmPage(items=[AlarmView.of(row) for row in rows], next=following)


@router.post("/alarms/{alarm_id}/acknowledge", responses=problems(UnknownAlarm, RoleNeeded))
async def acknowledge_alarm(
    alarm_id: AlarmId, user: DispatcherOrMaintainer, session: SessionDep, clock: ClockDep
) -> AlarmView:
    """Acknowledge an alarm: a person sees to it. It stays open until it is over by itself."""
    alarm = await session.get(Alarm, alarm_id, with_for_update=True)
    if alarm is None:
        raise UnknownAlarm(f"There is no alarm {alarm_id}.")
    if alarm.acknowledged_at is None:
        alarm.acknowledged_at, alarm.acknowledged_by_id = clock.utc(), user.id
    return AlarmView.of(alarm)
