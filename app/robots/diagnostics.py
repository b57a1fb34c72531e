"""Live diagnostics: who watches which robot, and what they are shown. In memory alone: nothing of it is kept.

A robot tells what it senses and thinks only while it is watched, and a page says every few seconds that it still
does. So a forgotten page costs nothing, nor does one that was closed.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from datetime import datetime
from typing import Final, Protocol

from pydantic import BaseModel, Field

from app.models import Role
from app.realtime.feed import Feed, FeedEvent
from protocol.diagnostics import Diagnostics
from protocol.to_robot import Watch

HOLDS_S: Final = 30.0
"""Real seconds for which a page's word counts that it is watched."""


class Watched(BaseModel):
    """One event `insight` of the stream: what a robot senses and thinks."""

    robot: str
    at: datetime = Field(description="When the service was told, by its own clock.")
    insight: Diagnostics


class Seats(Protocol):
    """The robots' connections, as far as they are watched."""

    def watch(self, robot: str, watch: Watch) -> bool: ...


@dataclass
class LiveDiagnostics:
    """The watchers until when (real seconds), by robot and person."""

    seats: Seats
    feed: Feed
    stopwatch: Callable[[], float]
    _watchers: dict[str, dict[str, float]] = field(default_factory=dict)

    def watch(self, robot: str, person_id: str, anew: bool = False) -> bool:
        """A technician looks, or still does, perhaps on another page (`anew`); False if this robot is not there, or
        knows nothing of being watched."""
        now_s = self.stopwatch()
        watchers = self._at(robot, now_s)
        is_new = anew or person_id not in watchers
        self._watchers[robot] = {**watchers, person_id: now_s + HOLDS_S}
        return self.seats.watch(robot, Watch(for_s=HOLDS_S, whole=is_new))

    def wanted_of(self, robot: str) -> Watch | None:
        """Return what a robot is to be told that has just come: its watchers have not given up when it was away."""
        now_s = self.stopwatch()
        watchers = self._at(robot, now_s)
        return Watch(for_s=max(watchers.values()) - now_s, whole=True) if watchers else None

    def show(self, robot: str, insight: Diagnostics, at: datetime) -> None:
        """To those who watch this robot and have the role."""
        if watchers := self._at(robot, self.stopwatch()):
            happening = FeedEvent("insight", Watched(robot=robot, at=at, insight=insight), role=Role.MAINTAINER)
            self.feed.whisper(happening, watchers.keys())

    def _at(self, robot: str, now_s: float) -> dict[str, float]:
        held = self._watchers.get(robot, {})
        watchers = {person_id: until_s for person_id, until_s in held.items() if until_s > now_s}
        if held and not watchers:
            del self._watchers[robot]
        return watchers
