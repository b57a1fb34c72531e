"""Notices as mail: the text, the hand-over code as a picture, and where to follow the order."""

import asyncio
from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from datetime import timedelta
from typing import ClassVar, Final

from app.core.mail import Mail, Mailer, NotMailed
from app.core.settings import Settings
from app.core.texts import text
from app.models import Notification, NotificationKind, Person
from app.notifications.channels.interface import Delivery, NotSent

Drawing = Callable[[], tuple[str, bytes]]
CodePicture = Callable[[Notification], Drawing | None]
"""What draws the hand-over code that goes with a notice, as file name and PNG; None if none goes with it."""
LinkFor = Callable[[Person, Notification], Awaitable[str | None]]
"""A link for a person without an account, by which they may follow this one order; None: they sign in."""


LEADS_NOWHERE: Final = frozenset({NotificationKind.DELEGATION_OVER})
"""Told to a person whom the order concerns no more: they could not open it."""


async def no_link(person: Person, notice: Notification) -> str | None:
    """Everybody signs in."""
    return None


@dataclass
class MailChannel:
    """By SMTP or into the spool, as the mailer has it."""

    mailer: Mailer
    settings: Settings
    code_picture: CodePicture
    link_for: LinkFor = no_link
    name: ClassVar[str] = "mail"
    gives_up_after: timedelta = timedelta(days=1)

    @property
    def at_once(self) -> int:
        return self.mailer.at_once

    async def send(self, sending: Delivery) -> None:
        try:
            await self.mailer.send(await self._mail(sending))
        except NotMailed as problem:
            raise NotSent(str(problem), for_good=problem.for_good) from problem

    async def _mail(self, sending: Delivery) -> Mail:
        notice, language = sending.notice, sending.person.language
        drawing = self.code_picture(notice)
        picture = await asyncio.to_thread(drawing) if drawing else None  # it takes its time to draw
        url = await self._url(sending)
        parts = [sending.body]
        parts += [text(language, "email.code")] if picture else []
        parts += [text(language, "email.link", {"url": url})] if url else []
        return Mail(sending.key, sending.person.email, sending.title, "\n\n".join(parts) + "\n", notice.at, picture)

    async def _url(self, sending: Delivery) -> str | None:
        notice = sending.notice
        if not self.settings.public_url or notice.order_id is None or notice.kind in LEADS_NOWHERE:
            return None
        page = f"{self.settings.public_url.rstrip('/')}/follow.html?order={notice.order_id}"
        return await self.link_for(sending.person, notice) or page
