"""The outbox over HTTP, for dispatchers: what waits or was given up, and the mails in the spool."""

import asyncio
from datetime import datetime
from typing import Annotated

from fastapi import APIRouter, Path, Request
from pydantic import BaseModel
from sqlmodel import col, select

from app.accounts.current_user import Dispatcher
from app.core.database.database import ReadingDep, SessionDep, after_commit
from app.core.errors import problems
from app.core.paging import PAGED, PageDep, PageOf, Sorting
from app.core.parts import find_part
from app.core.settings import ClockDep, SettingsDep
from app.models import Notification, OutgoingNotification, Person
from app.notifications import spooled
from app.notifications.delivery.worker import OutboxWorker
from app.notifications.errors import NotInSpool, SentAlready, UnknownDelivery
from app.notifications.spooled import SpooledMail

router = APIRouter(tags=["outbox"])

NEWEST_FIRST = Sorting("outbox", col(OutgoingNotification.id), descending=True)
SendingId = Annotated[int, Path(ge=1, le=2**31 - 1)]
FileName = Annotated[str, Path(pattern=r"^[A-Za-z0-9_-][A-Za-z0-9._-]*\.eml$", max_length=255)]
"""No file system has longer names."""


class DeliveryView(BaseModel):
    """A notice that a channel has not taken yet. Without its contents: who is told what is enough to help."""

    id: int
    channel: str
    kind: str
    email: str
    order_id: str | None
    created_at: datetime
    tries: int
    next_try_at: datetime | None
    gave_up_at: datetime | None
    problem: str | None

    @classmethod
    def of(cls, row: OutgoingNotification, notice: Notification, person: Person) -> "DeliveryView":
        told = {"kind": str(notice.kind), "email": person.email, "order_id": notice.order_id}
        return cls.model_validate({**row.model_dump(), **told})


class DeliveryPage(PageOf[DeliveryView]):
    """Newest first."""


class SpooledMails(BaseModel):
    """The newest mails in the spool."""

    items: list[SpooledMail]


class SpooledText(SpooledMail):
    """One of them, with whatever opens something taken out."""

    text: str
    attachments: list[str]


@router.get("/outbox", responses={**PAGED, **problems(400, 401, 403)})
async def not_sent(user: Dispatcher, session: ReadingDep, page: PageDep, *, given_up: bool = False) -> DeliveryPage:
    """Notices that have not gone out, or only those that were given up."""
    waiting = select(OutgoingNotification).where(col(OutgoingNotification.sent_at).is_(None))
    if given_up:
        waiting = waiting.where(col(OutgoingNotification.gave_up_at).is_not(None))
    rows, following = await page.of(session, waiting, NEWEST_FIRST)
    notices = select(Notification, Person).join(Person).where(col(Notification.id).in_([row.notice_id for row in rows]))
    told = {notice.id: (notice, person) for notice, person in (await session.exec(notices)).all()}
    return DeliveryPage(items=[DeliveryView.of(row, *told[row.notice_id]) for row in rows], next=following)


@router.post("/outbox/{sending_id}/retry", status_code=202, responses=problems(401, 403, UnknownDelivery, SentAlready))
async def send_again(
    sending_id: SendingId, request: Request, user: Dispatcher, session: SessionDep, clock: ClockDep
) -> DeliveryView:
    """Try once more, now: what was given up, or waits for its next try."""
    row = await session.get(OutgoingNotification, sending_id, with_for_update=True)
    if row is None:
        raise UnknownDelivery(f"There is nothing with the number {sending_id} in the outbox.")
    if row.sent_at is not None:
        raise SentAlready("It has gone out already.")
    row.next_try_at, row.gave_up_at = clock.utc(), None
    after_commit(session, find_part(request, OutboxWorker).wake)
    notice = await session.get_one(Notification, row.notice_id)
    return DeliveryView.of(row, notice, await session.get_one(Person, notice.person_id))


@router.get("/spool", responses=problems(401, 403))
async def spooled_mails(user: Dispatcher, settings: SettingsDep) -> SpooledMails:
    """The newest mails that lie in the spool because no mail server is set."""
    return SpooledMails(items=await asyncio.to_thread(spooled.newest, settings.spool_folder))


@router.get("/spool/{file}", responses=problems(401, 403, NotInSpool))
async def spooled_mail(file: FileName, user: Dispatcher, settings: SettingsDep) -> SpooledText:
    """One mail of the spool. Codes and links that open something are taken out; pictures are named, not shown."""
    mail = await asyncio.to_thread(spooled.read, settings.spool_folder, file)
    if mail is None:
        raise NotInSpool(f"There is no mail {file} in the spool.")
    about, text, attachments = mail
    return SpooledText(**about.model_dump(), text=text, attachments=attachments)
