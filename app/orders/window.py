"""When an order should arrive: an interval, learned where there is enough to learn from, else by lengths on the map."""

from dataclasses import dataclass
from datetime import datetime, timedelta

from app.models import Order
from fleet.eta.arrivals import Estimates, Promise


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


def promise(order: Order, window: Window | None, now: datetime) -> None:
    """Tell its people this window from now on, or that no time is known."""
    times = (None, None) if window is None else (window.begins_at, window.ends_at)
    order.window_from, order.window_to = order.expected_from, order.expected_to = times
    order.window_assumed, order.estimated_at = window is None or window.assumed, now


def arrival_window(estimates: Estimates, from_post: str, to_post: str, since: datetime) -> Window:
    """When mail should be at `to_post` that may be fetched from `since` on. Raises the map's errors."""
    promise = estimates.promise(from_post, to_post, since)
    earliest, latest = (since + timedelta(seconds=seconds) for seconds in (promise.told.p10_s, promise.told.p90_s))
    return Window(earliest, latest, since, promise)
