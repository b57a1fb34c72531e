"""When an order should arrive: an interval, learned where there is enough to learn from, else by lengths on the map."""

from dataclasses import dataclass
from datetime import datetime, timedelta

from app.estimates.arrivals import Estimates, Promise


@dataclass(frozen=True)
class Window:
    """From the earliest to the latest arrival that is expected; both UTC. `promise`: what it was made from."""

    begins_at: datetime
    ends_at: datetime
    since: datetime
    promise: Promise

    @property
    def assumed(self) -> bool:
        """By the map alone: nothing was measured yet."""
        return self.promise.assumed


def arrival_window(estimates: Estimates, from_post: str, to_post: str, since: datetime) -> Window:
    """When mail should be at `to_post` that may be fetched from `since` on. Raises the map's errors."""
    promise = estimates.promise(from_post, to_post, since)
    earliest, latest = (since + timedelta(seconds=seconds) for seconds in (promise.told.p10_s, promise.told.p90_s))
    return Window(earliest, latest, since, promise)
