"""Errors of requests to the simulated world.

SimulatedWorldError
├── UnknownSwitch   no fault or door command has this name
├── WrongValue      the name is right, the value is not
├── UnknownStart    the robot cannot begin there
└── WorldStopped    it lives no longer: a step has failed
"""

from collections.abc import Iterable


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


class WorldStopped(SimulatedWorldError):
    """A step of the world has failed, and no other followed: time stands still for every client."""

    def __init__(self, failure: Exception) -> None:
        super().__init__(f"The simulated world has stopped: {failure} ({type(failure).__name__}). Start it again.")
