"""Errors of a map or of a question asked of it.

CampusMapError
├── MapError         a file that cannot be used
├── UnknownPost      a name that is not on the map
├── UnknownCorridor  two posts, or a name, that no corridor joins
└── NoRoute          two posts that nothing (that may be used) connects
"""

from collections.abc import Iterable
from difflib import get_close_matches


class CampusMapError(Exception):
    """Everything this package raises on purpose."""


class MapError(CampusMapError):
    """A map file that cannot be used: which file, where in it, what is wrong, and what to do about it."""

    def __init__(self, source: str, place: str, message: str, way_out: str) -> None:
        self.source, self.place, self.message, self.way_out = source, place, message, way_out
        super().__init__(f"{source}: {place}: {message}. {way_out}")


class UnknownPost(CampusMapError):
    """The map has no post of this name; `nearest` is the spelling that was probably meant."""

    def __init__(self, name: str, map_name: str, known: Iterable[str]) -> None:
        known = sorted(known)
        self.name = name
        self.nearest = next(iter(get_close_matches(name, known, n=1, cutoff=0.5)), None)
        hint = f"Did you mean {self.nearest!r}?" if self.nearest else f"It has: {', '.join(known)}."
        super().__init__(f"There is no post {name!r} on the map {map_name!r}. {hint}")


class UnknownCorridor(CampusMapError):
    """The map has no corridor of this name."""

    def __init__(self, name: str, map_name: str) -> None:
        self.name = name
        super().__init__(f"There is no corridor {name!r} on the map {map_name!r}")


class NoRoute(CampusMapError):
    """No way from start to goal: either none exists, or every one of them uses a corridor to be avoided."""

    def __init__(self, start: str, goal: str, reason: str) -> None:
        self.start, self.goal, self.reason = start, goal, reason
        super().__init__(f"No route from {start} to {goal}: {reason}")
