"""A request sent twice is done once: the answer is kept with the order itself, for 24 hours, per person.

Thin: "still running" is known to this process alone; another process waits for the first one's commit instead.
"""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import datetime, timedelta
from hashlib import sha256
from typing import Any, Final

from sqlalchemy import bindparam, delete
from sqlmodel import col, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.database import connection_of, write_once
from app.orders.errors import KeyReused, StillRunning
from app.orders.schemas import NewOrder
from app.tables import IdempotencyKey

KEPT = timedelta(hours=24)
TWICE: Final = "The first request with this Idempotency-Key is still running. Ask again in a moment."


def body_hash(wish: NewOrder) -> str:
    """The same for the same wish, however its JSON is spaced or ordered."""
    return sha256(wish.model_dump_json().encode()).hexdigest()


class Running:
    """The keys whose first request has not ended."""

    def __init__(self) -> None:
        self._keys: set[tuple[str, str]] = set()

    @contextmanager
    def only_once(self, person_id: str, key: str) -> Iterator[None]:
        """Raises StillRunning while another request with this key is under way."""
        running = (person_id, key)
        if running in self._keys:
            raise StillRunning(TWICE)
        self._keys.add(running)
        try:
            yield
        finally:
            self._keys.discard(running)


@dataclass(frozen=True)
class Answer:
    """What was answered the first time."""

    headers: Mapping[str, str]
    answer: Mapping[str, Any]


async def earlier_answer(
    session: AsyncSession, person_id: str, key: str, hash_of_body: str, now: datetime
) -> Answer | None:
    """What was answered before, if anything. Raises KeyReused for another body."""
    connection = await connection_of(session)
    row = (await connection.execute(_KEPT, {"person": person_id, "name": key})).first()
    if row is None:
        return None
    if row.created_at < now - KEPT:
        # Whoever keeps house deletes the others, which stand in nobody's way.
        await connection.execute(_FORGOTTEN, {"person": person_id, "name": key})
        return None
    if row.body_hash != hash_of_body:
        raise KeyReused("This Idempotency-Key belongs to another order. Take a new key for a new order.")
    return Answer(row.headers, row.answer)


async def keep_answer(
    session: AsyncSession, person_id: str, key: str, hash_of_body: str, answer: Answer, now: datetime
) -> None:
    """Raises StillRunning if another process has answered meanwhile: what was done here is undone."""
    values = {"person_id": person_id, "key": key, "body_hash": hash_of_body, "status": 201, "created_at": now}
    if not await write_once(session, IdempotencyKey, {**values, "headers": answer.headers, "answer": answer.answer}):
        raise StillRunning(TWICE)


# Put together once: that takes longer than asking.
_OF_THIS_KEY: Final = (
    col(IdempotencyKey.person_id) == bindparam("person"),
    col(IdempotencyKey.key) == bindparam("name"),
)
_KEPT: Final = select(
    col(IdempotencyKey.created_at),
    col(IdempotencyKey.body_hash),
    col(IdempotencyKey.headers),
    col(IdempotencyKey.answer),
).where(*_OF_THIS_KEY)
_FORGOTTEN: Final = delete(IdempotencyKey).where(*_OF_THIS_KEY)
