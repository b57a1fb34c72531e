"""A daemon in a process of its own that is killed and started again, and a look at what it left on the disk."""

import asyncio
import json
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from benchmarks.mind.engines import CHECKOUT
from protocol.clock import SharedClock
from protocol.parts import Leg, MissionHeld, Part, Position, Received
from robot.mission.memory import Memory
from robot.mission.outbox import Outbox
from robot.mission.store import Store

SETTINGS = """
[battery]
simulated_charger_ma = 60000  # a charge takes minutes and not an hour
"""


@dataclass(frozen=True)
class Remembered:
    """The disk of a robot that does not run."""

    mission: MissionHeld | None
    cargo: tuple[str, ...]
    grants: tuple[Leg, ...]
    position: Position
    received: Received
    pending: dict[int, Part]
    last_seq: int
    resume_from: int


def remembered(data: Path) -> Remembered:
    with Store(data / "robot.db") as store:
        memory, outbox = Memory(store), Outbox(store)
        return Remembered(
            mission=memory.mission_held(),
            cargo=memory.cargo(),
            grants=memory.grants(),
            position=memory.position(),
            received=memory.received(),
            pending={kept.seq: kept.message for kept in outbox.pending(limit=10_000)},
            last_seq=outbox.last_seq(),
            resume_from=outbox.resume_from(),
        )


class Robot:
    """`python -m robot --simulated` in `folder`, on a clock that goes on while it is dead."""

    def __init__(self, folder: Path, url: str, seed: int, speed: float) -> None:
        self.data, self._door, self._log = folder / "data", folder / "door", folder / "log.txt"
        self.clock = SharedClock.create(folder / "clock", speed)
        (folder / "robot.toml").write_text(SETTINGS)
        token = folder / "token"
        token.touch(0o600)
        token.write_text("cmr_a_b")
        run = [sys.executable, "-m", "robot", "--simulated", "--name", "r1", "--config", str(folder / "robot.toml")]
        run += ["--server", url, "--token-file", str(token), "--data", str(self.data), "--door", str(self._door)]
        self._command = [*run, "--clock", str(folder / "clock"), "--speed", f"{speed:g}", "--seed", str(seed)]
        self._process: asyncio.subprocess.Process | None = None

    async def start(self) -> None:
        with self._log.open("ab") as log:
            self._process = await asyncio.create_subprocess_exec(
                *self._command, cwd=CHECKOUT, stdout=log, stderr=log, stdin=asyncio.subprocess.DEVNULL
            )

    @property
    def ended(self) -> int | None:
        """The exit status of a daemon that ended by itself."""
        return self._process.returncode if self._process else None

    async def kill(self) -> None:
        """SIGKILL: nothing is tidied up."""
        if self._process and self._process.returncode is None:
            self._process.kill()
            await self._process.wait()

    def log(self, lines: int = 15) -> str:
        """The end of what the daemon said."""
        return "\n".join(self._log.read_text(errors="replace").splitlines()[-lines:])

    def written(self) -> tuple[int, int]:
        """Changes when the daemon's memory is written to."""
        try:
            wal = (self.data / "robot.db-wal").stat()
        except OSError:
            return 0, 0
        return wal.st_size, wal.st_mtime_ns

    async def world(self, **request: Any) -> dict[str, Any] | None:
        """One command to the simulated world; None if it does not listen."""
        try:
            reader, writer = await asyncio.open_unix_connection(self._door)
            writer.write(json.dumps(request).encode() + b"\n")
            answer = await reader.readline()
            writer.close()
        except OSError:
            return None
        return dict(json.loads(answer)) if answer else None
