"""The interface of a channel: what it is given, and how it reports a failure."""

from dataclasses import dataclass
from datetime import timedelta
from typing import Protocol

from app.models import Notification, Person
from app.notifications.wording import body_of, title_of


@dataclass(frozen=True)
class Delivery:
    """One notice to one person on one channel. `key` is the same on every try: a receiver that gets it twice can
    tell."""

    key: str
    target: str | None
    notice: Notification
    person: Person

    @property
    def title(self) -> str:
        return title_of(self.notice, self.person.language)

    @property
    def body(self) -> str:
        return body_of(self.notice, self.person.language)


class NotSent(Exception):
    """It did not go out. `for_good`: nor will it next time; `again_after_s`: the other side said when to come back."""

    def __init__(self, problem: str, *, for_good: bool = False, again_after_s: float | None = None) -> None:
        super().__init__(problem)
        self.for_good = for_good
        self.again_after_s = again_after_s


class Channel(Protocol):
    """A way to people. At least once: after a crash a sending comes again with the same key."""

    @property
    def name(self) -> str: ...

    @property
    def at_once(self) -> int:
        """Return how many deliveries may be under way; of those to the same target one at a time."""
        ...

    @property
    def gives_up_after(self) -> timedelta: ...

    async def send(self, sending: Delivery) -> None:
        """Hand it over. Raises NotSent; anything else that is raised is tried again too."""
        ...
