"""When a daemon is killed: what has to have happened since its start, and how long afterwards at most."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from protocol.parts import Purpose


class Scene(Protocol):
    """A mission under way, as far as a moment asks."""

    @property
    def has_mail(self) -> bool: ...

    @property
    def charges(self) -> bool: ...

    @property
    def has_claimed(self) -> bool:
        """Since the last start."""
        ...

    def is_shown(self, purpose: Purpose) -> bool:
        """Return whether a person has held up this code since the last start."""
        ...

    def has_written(self) -> bool:
        """Return whether the daemon's memory was written to since the last time this was asked."""
        ...


@dataclass(frozen=True)
class Moment:
    """`phase` orders moments within a mission; None: at any time. `within_s` is of the simulated clock."""

    name: str
    begins: Callable[[Scene], bool]
    within_s: float
    phase: int | None = None


MOMENTS = (
    Moment("at any time", lambda _: True, 60.0),
    Moment("at a transaction", lambda scene: scene.has_written(), 0.0),
    Moment("claiming", lambda scene: scene.has_claimed, 0.5, 1),
    Moment("loading", lambda scene: scene.is_shown(Purpose.LOAD), 1.5, 2),
    Moment("driving with mail", lambda scene: scene.has_mail, 25.0, 3),
    Moment("charging", lambda scene: scene.charges, 40.0, 4),
    Moment("handing over", lambda scene: scene.is_shown(Purpose.RECEIVE), 1.5, 5),
)
