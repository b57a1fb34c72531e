"""What a robot is told: whether it may go where it asks to go, and what it is to do next."""

from dataclasses import dataclass

from fleet.schedule.network import Lane


@dataclass(frozen=True)
class Granted:
    """The corridor may be entered over the crossing before it, and a place at its end is kept: a bay, or its home."""

    lane: Lane
    at_home: bool = False


@dataclass(frozen=True)
class LetIn:
    """The crossing is its own until it is wholly in its bay at this post, or in its home place."""

    post: int
    at_home: bool


@dataclass(frozen=True)
class Waits:
    """Not yet. `robots` have to go on before. `lane` None: it waits for the crossing alone."""

    lane: Lane | None
    robots: tuple[str, ...]


@dataclass(frozen=True)
class Denied:
    """Not this way: the schedule leads over `instead` (None: nowhere, no way is open)."""

    lane: Lane
    instead: Lane | None


Answer = Granted | Waits | Denied


@dataclass(frozen=True)
class ComeIn:
    """It is to come into its bay or home place at this post. From a corridor that may be where it came from: then it
    turns round. From a bay there: it is to make room and go to its home place."""

    post: int
    at_home: bool


@dataclass(frozen=True)
class GoOn:
    """It is to go into this corridor, without a stop where it comes from another."""

    lane: Lane


Move = ComeIn | GoOn
