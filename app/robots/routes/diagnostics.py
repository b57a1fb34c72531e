"""Diagnostics over HTTP, for maintainers: a robot's senses and mind now, and its battery over time."""

from datetime import datetime, timedelta
from typing import Annotated, Final

from fastapi import APIRouter, Query
from pydantic import AwareDatetime, BaseModel

from app.accounts.current_user import DispatcherOrMaintainer, Maintainer
from app.accounts.errors import RoleNeeded
from app.core.database.database import ReadingDep
from app.core.errors import problems
from app.core.settings import ClockDep
from app.robots.battery import samples_since
from app.robots.diagnostics import HOLDS_S
from app.robots.errors import UnknownRobot
from app.robots.routes.robots import FleetDep, RobotName
from app.robots.service import known_robot

router = APIRouter(tags=["dispatch"])
upkeep_router = APIRouter(tags=["upkeep"])

USUAL: Final = timedelta(hours=24)


class WatchView(BaseModel):
    """`online` false: it is shown when the robot is back. `tells` false: this robot's software knows nothing of it."""

    robot: str
    online: bool
    tells: bool
    for_s: float


class BatterySampleView(BaseModel):
    """Charge as a ratio of capacity at one moment, and whether the dock was charging."""

    at: datetime
    ratio: float
    charging: bool


class BatteryHistory(BaseModel):
    """The battery of a robot, oldest first: at most about 300 samples, those where charging began or ended
    among them. `low_ratio`: below this a robot goes to charge, unless its own settings say otherwise."""

    robot: str
    since: datetime
    until: datetime
    low_ratio: float
    samples: list[BatterySampleView]


@upkeep_router.post("/robots/{name}/watch", responses=problems(UnknownRobot, RoleNeeded))
async def watch_robot(
    name: RobotName,
    maintainer: Maintainer,
    session: ReadingDep,
    fleet: FleetDep,
    anew: Annotated[bool, Query(description="Begin with all that it believes: for who has seen nothing yet.")] = False,
) -> WatchView:
    """Watch what a robot senses and thinks: events `insight` of the live stream, for half a minute from now.

    Say so again every ten seconds or so. Nothing of it is kept.
    """
    robot = await known_robot(session, name)
    tells = fleet.watching.watch(name, maintainer.id, anew)
    return WatchView(robot=name, online=robot.online, tells=tells, for_s=HOLDS_S)


@router.get("/robots/{name}/battery", responses=problems(UnknownRobot, RoleNeeded))
async def robot_battery(
    name: RobotName,
    user: DispatcherOrMaintainer,
    session: ReadingDep,
    clock: ClockDep,
    since: Annotated[AwareDatetime | None, Query(description="Default: a day ago.")] = None,
) -> BatteryHistory:
    """Show a robot's charge over time, as it told it."""
    await known_robot(session, name)
    now = clock.utc()
    begin = now - USUAL if since is None else since
    samples = await samples_since(session, name, begin)
    shown = [BatterySampleView(at=at, ratio=ratio, charging=charging) for at, ratio, charging in samples]
    return BatteryHistory(robot=name, since=begin, until=now, low_ratio=LOW_RATIO, samples=shown)


LOW_RATIO: Final = 0.25
"""The robots' usual setting `battery.low_ratio` (docs/reference/settings.md)."""
