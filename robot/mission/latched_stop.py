"""The latched stops that hold, in a file of its own: a robot that was stopped stays so, even if its mind was dead by
then and a restart was the first thing tried.

The mind's memory keeps faults, too, together with what was told about them; this is what the body remembers alone.
"""

import json
import os
from collections.abc import Set
from pathlib import Path

import structlog

from robot.core.durable_file import replace
from robot.reflexes import LATCHED

FILE_NAME = "stops.json"
"""In the robot's data folder."""

log = structlog.get_logger("robot.drive")


class LatchedStop:
    """`keep` is called often and writes on a change only; not by the drive loop, since it waits for the disk."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._kept = self.read()

    def read(self) -> frozenset[str]:
        """A file that cannot be understood counts as a stop: a technician has to look anyway."""
        try:
            names = json.loads(self._path.read_text("utf-8"))
            if not isinstance(names, list):
                raise ValueError("it is no list of names")
            return frozenset(name for name in names if name in LATCHED)
        except FileNotFoundError:
            return frozenset()
        except (OSError, ValueError, TypeError) as error:
            log.error("stop_memory_unreadable", file=str(self._path), error=str(error))
            return frozenset({"emergency_stop"})

    def keep(self, faults: Set[str]) -> None:
        """The latched ones among these hold now. A disk that fails ends nothing: the wheels stand already."""
        latched = frozenset(faults & LATCHED)
        if latched == self._kept:
            return
        try:
            self._write(json.dumps(sorted(latched)))
            self._kept = latched
        except OSError as error:
            log.error("stop_memory_not_written", file=str(self._path), error=str(error))

    def _write(self, text: str) -> None:
        part = self._path.with_suffix(".part")
        with part.open("w", encoding="utf-8") as file:
            file.write(text)
            file.flush()
            os.fsync(file.fileno())
        replace(part, self._path)
