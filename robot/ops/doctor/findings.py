"""The input and the result of a check."""

from collections.abc import Callable
from dataclasses import dataclass, field
from enum import StrEnum
from pathlib import Path
from typing import Any

from robot.core.config import Settings
from robot.ops.equipment import Equipment


class Grade(StrEnum):
    """The result of a check. Only FAIL keeps a robot from driving."""

    OK = "ok"
    WARN = "warn"
    FAIL = "FAIL"
    SKIP = "skip"


@dataclass(frozen=True)
class Finding:
    """In words, with the way out where something is wrong."""

    grade: Grade
    said: str
    way_out: str = ""


def ok(said: str) -> Finding:
    return Finding(Grade.OK, said)


def warn(said: str, way_out: str) -> Finding:
    return Finding(Grade.WARN, said, way_out)


def fail(said: str, way_out: str) -> Finding:
    return Finding(Grade.FAIL, said, way_out)


def skip(said: str) -> Finding:
    return Finding(Grade.SKIP, said)


@dataclass(frozen=True)
class Subjects:
    """The subjects of the checks."""

    settings: Settings
    source: Path | None
    """The settings file; None: defaults."""
    equipment: Equipment
    root: Path = Path("/")
    """Where /proc, /sys, /boot and /etc are: a test gives a tree of its own."""
    daemon: dict[str, Any] | None = None
    """What a running daemon says of itself; then port, pins and camera are its."""
    push_s: float = 0.0
    """So long the technician pushes the robot over the tape."""
    patience: float = 1.0
    """Share of the usual time that a device is listened to."""
    tell: Callable[[str], None] = field(default=lambda _: None)
    """What a person has to do now."""

    def text(self, *names: str) -> str | None:
        """The first of these files of the system that can be read, without its end; None if none can."""
        for name in names:
            try:
                return (self.root / name).read_text("utf-8", "replace").strip()
            except OSError:
                continue
        return None


Look = Callable[[Subjects], Finding]
