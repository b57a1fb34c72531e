"""The two processes of a demonstration: started, watched, and ended by their ids."""

import asyncio
import ctypes
import signal
import sys
from asyncio.subprocess import Process
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from demo.settings import DemoFailed

STOP_WITHIN_S = 2.0
LAST_LINES = 15
PR_SET_PDEATHSIG = 1


@dataclass(frozen=True)
class Child:
    """One process and its log."""

    name: str
    process: Process
    log: Path

    def last_words(self) -> str:
        lines = self.log.read_text(errors="replace").splitlines()[-LAST_LINES:]
        return "\n".join(f"    {line}" for line in lines) or "    (it said nothing)"

    async def watch(self) -> None:
        """Until it ends, which it must not. Raises DemoFailed."""
        code = await self.process.wait()
        raise DemoFailed(f"The {self.name} ended with exit code {code}. Its last words:\n{self.last_words()}")


class Children:
    """Starts children, and stops them all at once."""

    def __init__(self) -> None:
        self._started: list[Process] = []

    async def start(
        self, name: str, command: Sequence[str], log: Path, environment: Mapping[str, str] | None = None
    ) -> Child:
        """A new process; what it says goes to `log`."""
        with log.open("ab") as output:
            # A session of its own: Ctrl-C at the terminal reaches us alone, and we stop the children.
            process = await asyncio.create_subprocess_exec(
                *command,
                stdin=asyncio.subprocess.DEVNULL,
                stdout=output,
                stderr=output,
                env=environment,
                start_new_session=True,
                preexec_fn=_end_with_us if sys.platform == "linux" else None,
            )
        self._started.append(process)
        return Child(name, process, log)

    async def stop(self) -> None:
        """Ask first, then make them."""
        await asyncio.gather(*(_stop(process) for process in self._started))


def _end_with_us() -> None:
    """End children with their parent (`prctl`, PR_SET_PDEATHSIG), even if the parent is killed."""
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)


async def _stop(process: Process) -> None:
    with suppress(ProcessLookupError):
        process.send_signal(signal.SIGTERM)
    try:
        async with asyncio.timeout(STOP_WITHIN_S):
            await process.wait()
    except TimeoutError:
        with suppress(ProcessLookupError):
            process.kill()
        await process.wait()
