"""Switched off for long with corridors granted: a person may have given them to others meanwhile."""

from dataclasses import dataclass
from datetime import datetime
from typing import Final

from robot.mission.state import Held

LONG_S: Final = 900.0
"""So long after it was last seen at a post. The service rings an alarm for a robot that is silent for as long."""
HEARS_S: Final = 5.0
"""So long it takes at most, once the service is there, to hear that what was granted is void."""


@dataclass
class OfflineTimeout:
    """From the start of the daemon until the service has had time to say so. Where it was not long, it is none."""

    lasts: bool | None = None
    """None: not checked yet."""
    _online_since_s: float | None = None

    def look(self, held: Held, utc: datetime, online: bool, now: float) -> bool:
        """Return whether it lasts; asked at every tick."""
        if self.lasts is None:
            seen_at = held.position.seen_at
            self.lasts = bool(held.grants) and seen_at is not None and (utc - seen_at).total_seconds() > LONG_S
        if not online:
            self._online_since_s = None
        elif self._online_since_s is None:
            self._online_since_s = now
        elif now - self._online_since_s >= HEARS_S:
            self.lasts = False
        return self.lasts
