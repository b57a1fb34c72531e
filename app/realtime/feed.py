"""The feed: features publish to it after the commit; every open page hears what concerns it.

One process with everything in memory (thin: a broker behind the same `Feed` when there are several processes).
"""

import asyncio
import json
import secrets
import time
from collections import deque
from collections.abc import Callable, Container, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final, Protocol

import structlog
from fastapi.sse import format_sse_event
from pydantic import BaseModel

from app.models import Person, Role

log = structlog.get_logger(__name__)

REPLAYED: Final = 1000
QUEUED: Final = 200
WHISPERED: Final = 20
"""So much may wait for a listener before what is only of the moment is left out for them."""
COMES_BACK_S: Final = 60.0
"""Real seconds for which a listener who has left may come back and be given what was missed."""


@dataclass(frozen=True)
class FeedEvent:
    """One event of the stream: its name, what becomes its JSON (or what makes that, if anybody listens), and for whom.

    `person_id` is the one person it is for; `role` all who have that role, but not those in `except_for` (who are told
    in another way); with neither it is for everybody signed in.
    """

    event: str
    data: Mapping[str, Any] | BaseModel | Callable[[], BaseModel]
    person_id: str | None = None
    role: Role | None = None
    except_for: frozenset[str] = frozenset()

    def is_for(self, person: Person) -> bool:
        if self.person_id is not None:
            return self.person_id == person.id
        if person.id in self.except_for:
            return False
        return self.role is None or person.has_role(self.role)


@dataclass(frozen=True)
class Numbered:
    """A happening and its place in the stream (`id` of the event); None: it has none, and is not given again."""

    id: str | None
    happening: FeedEvent

    @cached_property
    def wire(self) -> bytes:
        """As it goes out: written once, however many listen, and never if none does.

        That late it may be beyond words: a row whose change was undone cannot be read any more once its session is
        closed. Then everybody fetches anew; a stream that broke there would break there again when it is resumed.
        """
        try:
            event, text = self.happening.event, self._text()
        except Exception:
            log.exception("what happened has no words", event_name=self.happening.event, id=self.id)
            event, text = "resync", "{}"
        return format_sse_event(data_str=text, event=event, id=self.id)

    def _text(self) -> str:
        data = self.happening.data
        data = data() if callable(data) else data
        return data.model_dump_json() if isinstance(data, BaseModel) else json.dumps(data)


class Feed(Protocol):
    """The feed, as features see it."""

    @property
    def is_heard(self) -> bool:
        """Tell if there is a listener, or was just now: if not, nothing need be put together to be published."""
        ...

    def pass_over(self) -> None:
        """Instead of `publish`, for what was not put together since there was no listener."""
        ...

    def publish(self, happening: FeedEvent) -> None:
        """Tell the listeners; never waits. Call it after the commit (`app.core.database.database.after_commit`)."""
        ...

    def whisper(self, happening: FeedEvent, to: Container[str]) -> None:
        """Tell those of these people (ids) who listen now. It is not kept, and the first thing to be left out."""
        ...


class LocalFeed:
    """The feed of one process. Not for other threads."""

    def __init__(self) -> None:
        # Numbers begin anew with every start of the service; an id of an earlier run is recognised by this.
        self._run = secrets.token_hex(4)
        self._count = 0
        self._recent: deque[Numbered] = deque(maxlen=REPLAYED)
        self._listeners: dict[asyncio.Queue[Numbered | None], Person] = {}
        self._left_at_s = -COMES_BACK_S
        self._closed = False

    @property
    def is_heard(self) -> bool:
        return bool(self._listeners) or time.monotonic() < self._left_at_s + COMES_BACK_S

    def expect_listener(self) -> None:
        """Keep what is published from now on: a page that is being opened listens in a moment."""
        self._left_at_s = time.monotonic()

    def pass_over(self) -> None:
        """It cannot be given to a later listener, and one that has begun to listen meanwhile has to fetch anew."""
        self._recent.clear()
        self._count += 1
        if self._listeners:
            self.publish(FeedEvent("resync", {}))

    def publish(self, happening: FeedEvent) -> None:
        self._count += 1
        numbered = Numbered(f"{self._run}-{self._count}", happening)
        self._recent.append(numbered)
        for queue, person in list(self._listeners.items()):
            if happening.is_for(person):
                self._offer(queue, numbered)

    def whisper(self, happening: FeedEvent, to: Container[str]) -> None:
        of_the_moment = Numbered(None, happening)
        for queue, person in self._listeners.items():
            if person.id in to and happening.is_for(person) and queue.qsize() < WHISPERED:
                queue.put_nowait(of_the_moment)

    def _offer(self, queue: asyncio.Queue[Numbered | None], numbered: Numbered) -> None:
        if queue.qsize() < QUEUED:
            queue.put_nowait(numbered)
        else:  # Too slow: the stream ends, the browser comes back with Last-Event-ID and is given what it missed.
            del self._listeners[queue]
            queue.put_nowait(None)

    @property
    def last_id(self) -> str:
        return f"{self._run}-{self._count}"

    def missed(self, person: Person, last_id: str) -> list[Numbered] | None:
        """Return what `person` has not had since `last_id`; None if that cannot be told any more."""
        run, _, number = last_id.partition("-")
        if run != self._run or not number.isdecimal() or int(number) > self._count:
            return None
        gap = self._count - int(number)
        if gap > len(self._recent):
            return None
        return [one for one in list(self._recent)[len(self._recent) - gap :] if one.happening.is_for(person)]

    @contextmanager
    def listening(self, person: Person) -> Iterator[asyncio.Queue[Numbered | None]]:
        """Everything for `person` from now on; None says that the feed is closed or the listener too slow."""
        queue: asyncio.Queue[Numbered | None] = asyncio.Queue()
        if self._closed:
            queue.put_nowait(None)
        self._listeners[queue] = person
        try:
            yield queue
        finally:
            self._listeners.pop(queue, None)
            self._left_at_s = time.monotonic()

    def close(self) -> None:
        """End every stream: an open one would otherwise hold up the service's end."""
        self._closed = True
        for queue in list(self._listeners):
            queue.put_nowait(None)
