"""Deliveries that are due: which channels have anything to do, and which come next on one of them.

The questions are put together once; the worker asks them many times a second.
"""

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any, Final

from sqlalchemy import bindparam, literal, select, union
from sqlmodel import col
from sqlmodel.ext.asyncio.session import AsyncSession

from app.models import Notification, OutgoingNotification, Person
from app.notifications.channels.interface import Delivery

NOT_ROUTED: Final = "not routed"
"""Stands among the channels for notices that none of them has yet."""

_ID: Final = col(OutgoingNotification.id)
_TARGET: Final = col(OutgoingNotification.target)
_IS_DUE: Final = col(OutgoingNotification.next_try_at) <= bindparam("now")
_NEW: Final = select(col(Notification.id)).where(col(Notification.routed_at).is_(None)).exists()

_WAITING: Final[Any] = union(
    select(col(OutgoingNotification.channel)).where(_IS_DUE).distinct(), select(literal(NOT_ROUTED)).where(_NEW)
)
_NEXT: Final[Any] = (
    select(_ID, col(OutgoingNotification.key), _TARGET, Notification, Person)
    .select_from(OutgoingNotification)
    .join(Notification, col(OutgoingNotification.notice_id) == Notification.id)
    .join(Person, col(Notification.person_id) == Person.id)
    .where(col(OutgoingNotification.channel) == bindparam("channel"), _IS_DUE)
    .order_by(_ID)
    .limit(bindparam("places"))
)
_NEXT_BESIDES: Final[Any] = _NEXT.where(
    _ID.not_in(bindparam("ids", expanding=True)),
    _TARGET.is_(None) | _TARGET.not_in(bindparam("targets", expanding=True)),
)


@dataclass(frozen=True)
class Due:
    """One row of the outbox that is to go out, with all that its channel has to know."""

    id: int
    channel: str
    sending: Delivery

    @property
    def target(self) -> str | None:
        return self.sending.target


async def waiting(session: AsyncSession, now: datetime) -> set[str]:
    """The channels that have anything to send, what is under way too, and NOT_ROUTED."""
    return set((await session.exec(_WAITING, params={"now": now})).scalars())


async def next_of(
    session: AsyncSession, channel: str, now: datetime, places: int, busy: Collection[Due]
) -> Sequence[Due]:
    """The oldest that are due, for so many places; of each target the one that waits longest, and none that is busy."""
    known: dict[str, Any] = {"channel": channel, "now": now, "places": places}
    if busy:
        known["ids"] = [one.id for one in busy]
        known["targets"] = [one.target for one in busy if one.target]
    found = await session.exec(_NEXT_BESIDES if busy else _NEXT, params=known)
    return _one_for_each_target([Due(row_id, channel, Delivery(key, *told)) for row_id, key, *told in found])


def _one_for_each_target(found: Sequence[Due]) -> list[Due]:
    targets: set[str] = set()
    first = []
    for one in found:
        if one.target is None or one.target not in targets:
            first.append(one)
            targets |= {one.target} if one.target else set()
    return first
