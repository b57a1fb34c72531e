"""The two processes of a demonstration: started, watched, and ended by their ids."""

import asyncio
import signal
from asyncio.subprocess import Process
from collections.abc import AsyncIterator, Mapping, Sequence
from contextlib import asynccontextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

from app.demo.settings import DemoFailed

STOP_WITHIN_S = 2.3
LAST_LINES = 15


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


@asynccontextmanager
async def running(
    name: str, command: Sequence[str], log: Path, environment: Mapping[str, str] | None = None
) -> AsyncIterator[Child]:
    """A child that is stopped at the end: asked first, then made to."""
    with log.open("ab") as output:
        # A session of its own: Ctrl-C at the terminal reaches us alone, and we stop the children in order.
        process = await asyncio.create_subprocess_exec(
            *command,
            stdin=asyncio.subprocess.DEVNULL,
            stdout=output,
            stderr=output,
            env=environment,
            start_new_session=True,
        )
    try:
        yield Child(name, process, log)
    finally:
        await _stop(process)


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
