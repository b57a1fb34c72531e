"""Names of new things: orders, missions, stops, commands, journals. Random, unless the caller gives a source that
repeats itself. Secrets are not made here: what opens something comes from `secrets` alone.
"""

import secrets
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from uuid import UUID

RandomBytes = Callable[[int], bytes]
"""So many of them."""

_source: ContextVar[RandomBytes] = ContextVar("source of ids", default=secrets.token_bytes)


def new_id() -> str:
    """64 random bits: enough to be unique, short enough to read out."""
    return _source.get()(8).hex()


def new_uuid() -> str:
    """The longer form, for what two sides must never name alike."""
    return str(UUID(bytes=_source.get()(16), version=4))


@contextmanager
def ids_from(source: RandomBytes) -> Iterator[None]:
    """Draw all ids that are made meanwhile, here and in tasks that are begun here, from this source: a life that was
    lived once can be lived again."""
    token = _source.set(source)
    try:
        yield
    finally:
        _source.reset(token)
