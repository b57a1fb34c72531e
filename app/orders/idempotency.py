"""A request sent twice is done once: the answer is kept with the order itself, for 24 hours, per person.

Thin: "still running" is known to this process alone; another process waits for the first one's commit instead.
"""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import datetime, timedelta
from hashlib import sha256
from typing import Any, Final

from sqlalchemy import bindparam, delete, select
from sqlmodel import col
from sqlmodel.ext.asyncio.session import AsyncSession

from app.core.database.database import connection_of
from app.models import IdempotencyKey
from app.orders.errors import KeyReused, StillRunning
from app.orders.views.schemas import NewOrder

Key = tuple[str, str]
"""Of a person (by id), and what they have called their request."""

KEPT = timedelta(hours=24)
TWICE: Final = "The first request with this Idempotency-Key is still running. Ask again in a moment."


def body_hash(request: NewOrder) -> str:
    """Return the same hash for the same request, however its JSON is spaced or ordered."""
    return sha256(request.model_dump_json().encode()).hexdigest()


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
    """The first answer."""

    headers: Mapping[str, str]
    body: Mapping[str, Any]


@dataclass(frozen=True)
class Earlier:
    """A request that was answered before."""

    hash_of_body: str
    answer: Answer

    def answer_to(self, request: NewOrder) -> Answer:
        """Return the earlier answer. Raises KeyReused for another request."""
        if self.hash_of_body != body_hash(request):
            raise KeyReused("This Idempotency-Key belongs to another order. Take a new key for a new order.")
        return self.answer


async def earlier_answers(session: AsyncSession, keys: Sequence[Key], now: datetime) -> dict[Key, Earlier]:
    """Return the earlier answers to these requests."""
    connection = await connection_of(session)
    people, names = {person for person, _ in keys}, {name for _, name in keys}
    rows = await connection.execute(_KEPT, {"people": list(people), "names": list(names)})
    earlier = {}
    for row in rows.all():
        if (row.person_id, row.key) not in keys:
            continue  # of another who calls theirs the same
        if row.created_at < now - KEPT:
            # The retention job deletes the others.
            await connection.execute(_FORGOTTEN, {"person": row.person_id, "name": row.key})
        else:
            earlier[row.person_id, row.key] = Earlier(row.body_hash, Answer(row.headers, row.answer))
    return earlier


def key_row(person_id: str, key: str, request: NewOrder, answer: Answer, now: datetime) -> dict[str, Any]:
    """Return the row to write with the order itself."""
    return {
        "person_id": person_id,
        "key": key,
        "body_hash": body_hash(request),
        "status": 201,
        "headers": answer.headers,
        "answer": answer.body,
        "created_at": now,
    }


# Put together once: that takes longer than asking. Not by pairs, for which SQLite reads the whole table.
_KEPT: Final = select(
    col(IdempotencyKey.person_id),
    col(IdempotencyKey.key),
    col(IdempotencyKey.created_at),
    col(IdempotencyKey.body_hash),
    col(IdempotencyKey.headers),
    col(IdempotencyKey.answer),
).where(
    col(IdempotencyKey.person_id).in_(bindparam("people", expanding=True)),
    col(IdempotencyKey.key).in_(bindparam("names", expanding=True)),
)
_FORGOTTEN: Final = delete(IdempotencyKey).where(
    col(IdempotencyKey.person_id) == bindparam("person"), col(IdempotencyKey.key) == bindparam("name")
)
