"""The link, as far as it concerns duties."""

from collections.abc import Sequence
from typing import Protocol

from robot.mission.memory import Incoming


class Server(Protocol):
    """Neither call waits."""

    def incoming(self) -> Sequence[Incoming]: ...

    def wake(self) -> None: ...

    @property
    def online(self) -> bool: ...
