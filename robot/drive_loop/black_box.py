"""The last minute of a robot, to find out afterwards why it stood: what the base said and was told, and what was
decided, perceived and done.

    black_box.note("percepts", now, ("+fault(bump)",))         any thread, no disk, no lock
    black_box.write_at(now + 1.0, "bump")                      the drive loop: written by a thread of its own
    black_box.write("on_demand")                               -> the file

Memory: a ring of at most KEPT_ROWS rows. A row is a tuple of its own with a short text or the bytes of one read, about
250 bytes; so the ring stays under 4 MB however long the robot runs.
"""

import gzip
import json
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from queue import SimpleQueue
from typing import Any

import structlog

from robot.core.errors import BlackBoxUnreadable

log = structlog.get_logger("robot.drive_loop.black_box")

KEPT_S = 60.0
KEPT_ROWS = 12_288
"""A frame every 15 ms, a command every 20 ms, and as much again for all else: 60 s of that are fewer."""
KEPT_FILES = 20
AGAIN_AFTER_S = 60.0
"""The same fault within the time that a file covers is in that file."""
ROWS_AT_ONCE = 500
BREATH_S = 0.002
"""Between so many rows the writer lets the other threads have the interpreter."""
CLOSE_WITHIN_S = 3.0

Noted = tuple[str, float, object]


@dataclass(frozen=True, slots=True)
class Row:
    """One line of a file. `kind`: heard and sent (bytes), faults, job, late, percepts, action …"""

    at_s: float
    kind: str
    data: Any


def _utc() -> datetime:
    return datetime.now(UTC)


class BlackBox:
    """Without a folder it remembers and writes nothing: for tests and for a loop that runs alone."""

    def __init__(self, folder: Path | None = None, utc: Callable[[], datetime] = _utc) -> None:
        self._folder, self._utc = folder, utc
        self._ring: deque[Noted] = deque(maxlen=KEPT_ROWS)
        self._due: list[tuple[float, str]] = []
        self._written_s: dict[str, float] = {}
        self._waiting: SimpleQueue[str | None] = SimpleQueue()
        self._writing = threading.Lock()
        self._thread: threading.Thread | None = None

    def note(self, kind: str, at_s: float, data: object) -> None:
        """From any thread. `data`: bytes, text, number, or a tuple of these; the caller must not change it
        afterwards."""
        self._ring.append((kind, at_s, data))

    def heard(self, data: bytes, now: float) -> None:
        """Bytes as they came from the base."""
        self._ring.append(("heard", now, data))

    def sent(self, data: bytes, now: float) -> None:
        """Bytes as they went to the base."""
        self._ring.append(("sent", now, data))

    def write_at(self, at_s: float, name: str) -> None:
        """For the drive loop: a file named after this fault, a moment after it, so that it holds how it ended."""
        if self._folder and at_s - self._written_s.get(name, -AGAIN_AFTER_S) >= AGAIN_AFTER_S:
            self._written_s[name] = at_s
            self._due.append((at_s, name))

    def write_what_is_due(self, now: float) -> None:
        """For the drive loop, once a tick: the disk is met by another thread."""
        while self._due and now >= self._due[0][0]:
            self._hand_over(self._due.pop(0)[1])

    def _hand_over(self, name: str | None) -> None:
        self._waiting.put(name)
        if self._thread is None:
            self._thread = threading.Thread(target=self._write_all, name="black box", daemon=True)
            self._thread.start()

    def _write_all(self) -> None:
        while (name := self._waiting.get()) is not None:
            try:
                log.warning("black_box_written", file=str(self.write(name)))
            except Exception as error:
                # Neither a full disk nor a row that cannot be written may end this thread: the next fault has a file.
                log.error("black_box_not_written", fault=name, error=repr(error))

    def write(self, name: str) -> Path | None:
        """Write the last minute now, in the caller's thread; None without a folder. Raises OSError."""
        if self._folder is None:
            return None
        with self._writing:
            self._folder.mkdir(parents=True, exist_ok=True)
            moment = self._utc()
            self._forget_old_files(self._folder)
            file = self._folder / f"{moment:%Y%m%dT%H%M%S.%f}Z-{name}.jsonl.gz"
            part = file.with_suffix(".part")
            try:
                self._write_rows(part, {"at_utc": moment.isoformat(), "fault": name})
                part.replace(file)
            finally:
                part.unlink(missing_ok=True)
            return file

    def _write_rows(self, part: Path, header: dict[str, str]) -> None:
        rows = list(self._ring)
        until_s = max((at_s for _, at_s, _ in rows), default=0.0)
        with gzip.open(part, "wt", encoding="utf-8", compresslevel=6) as file:
            file.write(json.dumps({"kind": "black_box", "at_s": until_s, "data": header}) + "\n")
            for number, (kind, at_s, data) in enumerate(rows):
                if at_s >= until_s - KEPT_S:
                    file.write(_line(kind, at_s, data))
                if number % ROWS_AT_ONCE == 0:
                    time.sleep(BREATH_S)

    def _forget_old_files(self, folder: Path) -> None:
        """Delete all but the newest files, with room for one more; and what a power cut left half written."""
        for old in [*sorted(folder.glob("*.jsonl.gz"))[: 1 - KEPT_FILES], *folder.glob("*.part")]:
            with suppress(OSError):
                old.unlink()

    def close(self) -> None:
        """Write what is still due."""
        while self._due:
            self._hand_over(self._due.pop(0)[1])
        if self._thread:
            self._hand_over(None)
            self._thread.join(CLOSE_WITHIN_S)


def _line(kind: str, at_s: float, data: object) -> str:
    if isinstance(data, bytes):
        return f'{{"kind": "{kind}", "at_s": {at_s:.4f}, "hex": "{data.hex()}"}}\n'
    return json.dumps({"kind": kind, "at_s": round(at_s, 4), "data": data}, default=str) + "\n"


def rows(file: Path) -> Iterator[Row]:
    """A written black box, line by line; the first is its header. Raises BlackBoxUnreadable."""
    number = 0
    try:
        with gzip.open(file, "rt", encoding="utf-8") as lines:
            for line in lines:
                number += 1
                yield _row(json.loads(line))
        if not number:
            raise ValueError("it is empty")
    except (OSError, EOFError, ValueError, KeyError, TypeError) as error:
        raise BlackBoxUnreadable(file, number, getattr(error, "strerror", None) or error) from None


def _row(raw: dict[str, Any]) -> Row:
    data = bytes.fromhex(raw["hex"]) if "hex" in raw else raw["data"]
    return Row(float(raw["at_s"]), str(raw["kind"]), data)
