"""The file in which several processes share one world: a row of fixed size for each robot's body.

Every process maps the file into its memory, writes the row of its own robot and reads the others'. A row outlives its
process: a robot whose daemon was killed stands where it stood. The lock on a row does not: the next daemon of that
name takes the row over, a second one beside it is refused.
"""

import fcntl
import mmap
import os
import struct
from collections.abc import Iterator
from pathlib import Path

from robot.simulated.errors import BodyTaken, WorldFileUnusable
from robot.simulated.true_poses import TruePose

MAGIC = b"CMWORLD1"
ROWS = 64
NAME_BYTES = 64
_HEADER = struct.Struct("=8sQ")  # magic; 1 if bodies pass through each other
_POSE = struct.Struct("=ddddQ")
_ROW_BYTES = NAME_BYTES + 8 + 2 * _POSE.size  # name, number of the newest pose, the last two poses
_FILE_BYTES = _HEADER.size + ROWS * _ROW_BYTES


class WorldFile:
    """Raises WorldFileUnusable. The file is made if there is none."""

    def __init__(self, path: Path) -> None:
        self._path = path
        try:
            # A process loses all its locks on a file when it closes that file once: it opens it only here.
            self._file = os.open(path, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600)
        except OSError as error:
            raise WorldFileUnusable(path, str(error.strerror)) from None
        try:
            self._lay_out()
        except BaseException:
            os.close(self._file)
            raise
        self._memory = mmap.mmap(self._file, _FILE_BYTES)
        # Whole words are read and written in one go, which `struct` does not promise.
        self._words = memoryview(self._memory).cast("Q")
        self.ghosts = bool(_HEADER.unpack_from(self._memory)[1])
        """Bodies pass through each other and do not see each other; the judge sees all of them."""

    @classmethod
    def create(cls, path: Path, ghosts: bool = False) -> "WorldFile":
        """Make an empty world, whatever was there before."""
        path.unlink(missing_ok=True)  # a process that has the old one mapped keeps it
        path.write_bytes(_empty(ghosts))
        return cls(path)

    def _lay_out(self) -> None:
        fcntl.lockf(self._file, fcntl.LOCK_EX, _HEADER.size)
        try:
            size = os.fstat(self._file).st_size
            if size == 0:
                os.pwrite(self._file, _empty(ghosts=False), 0)
            elif size != _FILE_BYTES or os.pread(self._file, len(MAGIC), 0) != MAGIC:
                raise WorldFileUnusable(self._path, "it holds something else")
        finally:
            fcntl.lockf(self._file, fcntl.LOCK_UN, _HEADER.size)

    def take(self, name: str) -> int:
        """The row of this robot, for this process alone until `close` or its end. Raises BodyTaken too."""
        fcntl.lockf(self._file, fcntl.LOCK_EX, _HEADER.size)  # two newcomers do not take the same free row
        try:
            row = self._find(name)
            try:
                fcntl.lockf(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB, _ROW_BYTES, _at(row))
            except OSError:
                raise BodyTaken(name, self._path) from None
            self._memory[_at(row) : _at(row) + NAME_BYTES] = name.encode().ljust(NAME_BYTES, b"\0")
        finally:
            fcntl.lockf(self._file, fcntl.LOCK_UN, _HEADER.size)
        return row

    def _find(self, name: str) -> int:
        for row in range(ROWS):
            if self.name(row) in {"", name}:
                return row
        raise WorldFileUnusable(self._path, f"there is room for {ROWS} robots only")

    def name(self, row: int) -> str:
        """Return whose row it is; empty for a free one, after which all are free."""
        return bytes(self._memory[_at(row) : _at(row) + NAME_BYTES]).rstrip(b"\0").decode()

    def number(self, row: int) -> int:
        """Return how many poses were written into this row."""
        return self._words[(_at(row) + NAME_BYTES) // 8]

    def write(self, row: int, pose: TruePose) -> None:
        """Over the older of the last two poses. A kill in between leaves the newer one as it was."""
        number = self.number(row) + 1
        fields = (pose.time_s, pose.x_m, pose.y_m, pose.heading_rad, pose.handled)
        _POSE.pack_into(self._memory, _pose_at(row, number), *fields)
        self._words[(_at(row) + NAME_BYTES) // 8] = number

    def read(self, row: int) -> TruePose | None:
        """The newest pose, whole; None before the first. Read again if another was begun meanwhile."""
        while number := self.number(row):
            fields = _POSE.unpack_from(self._memory, _pose_at(row, number))
            if self.number(row) == number:
                return TruePose(*fields)
        return None

    def rows(self) -> Iterator[int]:
        """Rows in use."""
        for row in range(ROWS):
            if not self._memory[_at(row)]:
                return
            yield row

    def poses(self) -> dict[str, TruePose]:
        """Every body in the world."""
        poses = ((self.name(row), self.read(row)) for row in self.rows())
        return {name: pose for name, pose in poses if pose is not None}

    def close(self) -> None:
        self._words.release()
        self._memory.close()
        os.close(self._file)


def _at(row: int) -> int:
    return _HEADER.size + row * _ROW_BYTES


def _pose_at(row: int, number: int) -> int:
    return _at(row) + NAME_BYTES + 8 + number % 2 * _POSE.size


def _empty(ghosts: bool) -> bytes:
    return _HEADER.pack(MAGIC, ghosts).ljust(_FILE_BYTES, b"\0")
