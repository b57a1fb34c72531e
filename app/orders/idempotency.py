"""A request sent twice is done once: the answer is kept with the order itself, for 24 hours, per person.

Thin: "still running" is known to this process alone; another process waits for the first one's commit instead.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from datetime import datetime, timedelta
from hashlib import sha256

from sqlmodel.ext.asyncio.session import AsyncSession

from app.orders.errors import KeyReused, StillRunning
from app.orders.schemas import NewOrder
from app.tables import IdempotencyKey

KEPT = timedelta(hours=24)


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
            raise StillRunning("The first request with this Idempotency-Key is still running. Ask again in a moment.")
        self._keys.add(running)
        try:
            yield
        finally:
            self._keys.discard(running)


async def earlier_answer(
    session: AsyncSession, person_id: str, key: str, hash_of_body: str, now: datetime
) -> IdempotencyKey | None:
    """What was answered before, if anything. Raises KeyReused for another body."""
    row = await session.get(IdempotencyKey, (person_id, key))
    if row is not None and row.created_at < now - KEPT:
        # Whoever keeps house deletes the others, which stand in nobody's way.
        await session.delete(row)
        await session.flush()
        return None
    if row is not None and row.body_hash != hash_of_body:
        raise KeyReused("This Idempotency-Key belongs to another order. Take a new key for a new order.")
    return row
