"""Errors of the body, each by its name; a message says what, where and the way out.

RobotError
├── PortAbsent       no such serial port, or no permission to open it
├── PortBusy         another program holds the port
├── CameraAbsent     no such video device
├── BlackBoxUnreadable  a file of the black box is torn or something else
└── UnknownSkill     a caller asked for a long action that the body does not have
"""

from pathlib import Path


class RobotError(Exception):
    """Everything the body raises on purpose."""


class PortAbsent(RobotError):
    """The drive base cannot be reached at all: no such port, or no permission to open it."""

    def __init__(self, port: str, reason: str) -> None:
        self.port = port
        super().__init__(
            f"The drive base does not answer at {port}: {reason}. "
            "Plug in its USB cable, name another serial_port, or join the group dialout; "
            "to try without a robot: --simulated."
        )


class PortBusy(RobotError):
    """Another program holds the port; two masters on one robot would be dangerous."""

    def __init__(self, port: str) -> None:
        self.port = port
        super().__init__(f"Another program holds {port}. Stop it first: only one may drive the base.")


class CameraAbsent(RobotError):
    """The video device cannot be opened."""

    def __init__(self, device: int | str) -> None:
        self.device = device
        super().__init__(f"No camera opens as video device {device}. Check its cable, or set camera.device.")


class UnknownSkill(RobotError):
    """An action names a way of doing it that the body does not have."""

    def __init__(self, name: str, known: tuple[str, ...]) -> None:
        self.name = name
        super().__init__(f"There is no {name!r}. There are: {', '.join(known)}.")


class BlackBoxUnreadable(RobotError):
    """A file is no black box, or was torn when it was copied."""

    def __init__(self, file: Path, line: int, reason: object) -> None:
        super().__init__(
            f"{file}, after line {line}: no black box can be read there: {reason}. Check the path, or copy it again."
        )
