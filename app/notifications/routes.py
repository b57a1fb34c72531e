"""The inbox."""

from fastapi import APIRouter

from app.accounts.current_user import CurrentUser
from app.core.database.database import ReadingDep, SessionDep
from app.core.errors import problems
from app.core.paging import PAGED, PageDep
from app.core.settings import ClockDep
from app.notifications.schemas import Inbox, NoticesRead
from app.notifications.service import inbox, mark_read

router = APIRouter(tags=["notices"])


@router.get("/notices", responses=PAGED)
async def my_notices(user: CurrentUser, session: ReadingDep, page: PageDep) -> Inbox:
    """List what this person was told, newest first."""
    return await inbox(session, user, page)


@router.post("/notices/read", status_code=204, responses=problems(401, 403, 422))
async def notices_read(read: NoticesRead, user: CurrentUser, session: SessionDep, clock: ClockDep) -> None:
    """Mark notices as read."""
    await mark_read(session, user, read.ids, clock.utc())
