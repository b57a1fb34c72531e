"""Errors of requests to the simulated world.

SimulatedWorldError
├── UnknownSwitch   no fault or door command has this name
├── WrongValue      the name is right, the value is not
├── UnknownStart    the robot cannot begin there
├── WorldFileUnusable   several robots cannot share a world in this file
├── BodyTaken       another process moves this robot there
└── WorldStopped    it lives no longer: a step has failed
"""

from collections.abc import Iterable
from pathlib import Path


class SimulatedWorldError(Exception):
    """Something was asked of the simulated world that it does not have."""


class UnknownSwitch(SimulatedWorldError):
    """The sentence lists the names there are."""

    def __init__(self, kind: str, name: object, known: Iterable[str]) -> None:
        super().__init__(f"There is no {kind} {name!r}. There are: {', '.join(sorted(known))}.")


class WrongValue(SimulatedWorldError):
    """The sentence says which value was expected."""

    def __init__(self, name: str, value: object, expected: str) -> None:
        super().__init__(f"{name}: {value!r} does not fit; expected {expected}.")


class UnknownStart(SimulatedWorldError):
    """The map has no such post, dock or corridor to start at."""

    def __init__(self, start: str, why: str) -> None:
        super().__init__(f"A robot cannot start at {start!r}: {why.rstrip('.')}. Say 'dock', a post, or POST:TOWARDS.")


class WorldFileUnusable(SimulatedWorldError):
    """The file cannot be made or read, or is full."""

    def __init__(self, path: Path, problem: str) -> None:
        super().__init__(f"{path}: robots cannot share a world there: {problem}. Name another file with --world.")


class BodyTaken(SimulatedWorldError):
    """A robot has one body, and one process that moves it."""

    def __init__(self, name: str, path: Path) -> None:
        super().__init__(
            f"{name} is in the world {path} already, and its process runs. Stop that one, or give another --name."
        )


class WorldStopped(SimulatedWorldError):
    """A step of the world has failed, and no other followed: time stands still for every client."""

    def __init__(self, failure: Exception) -> None:
        super().__init__(f"The simulated world has stopped: {failure} ({type(failure).__name__}). Start it again.")
