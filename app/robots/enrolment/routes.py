"""Enrolling robots, and looking after their tokens."""

from typing import Annotated

from fastapi import APIRouter, Depends, Path, Request
from sqlmodel import col, select

from app.accounts.current_user import Maintainer
from app.accounts.errors import CrossSite, HttpsRequired, RoleNeeded
from app.accounts.rate_limits import Door, per_host
from app.accounts.sessions.same_origin import refuse_other_sites, require_https_or_loopback
from app.core.database.database import DatabaseDep, ReadingDep, SessionDep, after_commit
from app.core.errors import problems
from app.core.paging import PAGED, PageDep, PageOf, Sorting
from app.core.parts import part
from app.core.settings import ClockDep
from app.models import RobotToken
from app.robots.enrolment.errors import NoEnrolmentCode, NoHomeForRobot, UnknownRobotToken, WrongEnrolmentCode
from app.robots.enrolment.schemas import Enrolled, Enrolment, EnrolmentCodeView, RobotTokenView
from app.robots.enrolment.service import EnrolmentService
from app.robots.errors import RobotNameInvalid, UnknownRobot
from app.robots.routes.robots import FleetDep, RobotName
from app.robots.service import known_robot

router = APIRouter(tags=["enrolment"])

NEWEST_FIRST = Sorting("robot_tokens", col(RobotToken.created_at), col(RobotToken.prefix), descending=True)
Prefix = Annotated[str, Path(pattern=r"^[0-9a-f]{8}$")]


async def _door(request: Request) -> None:
    require_https_or_loopback(request)
    refuse_other_sites(request)


DeskDep = Annotated[EnrolmentService, part(EnrolmentService)]


class RobotTokenPage(PageOf[RobotTokenView]):
    """Some tokens of a robot, newest first."""


@router.post(
    "/robots/{name}/enrolment-codes", status_code=201, responses=problems(RobotNameInvalid, NoHomeForRobot, RoleNeeded)
)
async def make_enrolment_code(
    name: RobotName, maintainer: Maintainer, desk: DeskDep, session: SessionDep
) -> EnrolmentCodeView:
    """Make a one-time code by which a robot of this name enrols itself, for the first time or again."""
    row, code = await desk.make_code(session, name, maintainer.id)
    return EnrolmentCodeView(robot=name, code=code, expires_at=row.expires_at)


@router.post(
    "/robots/enrol",
    status_code=201,
    dependencies=[Depends(_door), per_host(Door.ENROLMENT)],
    responses=problems(WrongEnrolmentCode, NoEnrolmentCode, NoHomeForRobot, HttpsRequired, CrossSite, 429),
)
async def enrol_robot(wish: Enrolment, desk: DeskDep, database: DatabaseDep) -> Enrolled:
    """Exchange a one-time code for a robot's token; its receipts are checked by the key that it brings."""
    async with database.transaction() as session:
        refusal = await desk.use_code(session, wish.name, wish.code)
        token = "" if refusal else await desk.admit(session, wish.name, wish.public_key)
    if refusal:
        raise refusal
    return Enrolled(name=wish.name, token=token)


@router.get("/robots/{name}/tokens", responses={**PAGED, **problems(UnknownRobot, RoleNeeded)})
async def list_robot_tokens(
    name: RobotName, maintainer: Maintainer, session: ReadingDep, page: PageDep
) -> RobotTokenPage:
    """List the tokens that a robot has had, newest first: prefix, when made, used and taken back."""
    await known_robot(session, name)
    rows, following = await page.of(session, select(RobotToken).where(RobotToken.robot == name), NEWEST_FIRST)
    return RobotTokenPage(items=[RobotTokenView.of(row) for row in rows], next=following)


@router.delete(
    "/robots/{name}/tokens/{token_prefix}", status_code=204, responses=problems(UnknownRobotToken, RoleNeeded)
)
async def revoke_robot_token(
    name: RobotName, token_prefix: Prefix, maintainer: Maintainer, session: SessionDep, fleet: FleetDep, clock: ClockDep
) -> None:
    """Take a robot's token back: its connection is cut off, and no robot signs in by it again."""
    row = await session.get(RobotToken, token_prefix)
    if row is None or row.robot != name:
        raise UnknownRobotToken(f"Robot {name} has no token {token_prefix}.")
    row.revoked_at = row.revoked_at or clock.utc()
    after_commit(session, lambda: fleet.connections.wake(name))
