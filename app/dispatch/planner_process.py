"""Decisions are made beside the event loop, so that neither robots nor people wait for them: the first answer in a
thread, and better ones in a process of their own.

Those are a luxury: a process that has died or answers too late is ended, and the next question starts another one.
"""

import asyncio
import pickle
import random
import signal
import struct
import sys
import time
from asyncio.subprocess import PIPE, Process
from contextlib import suppress
from pathlib import Path
from typing import BinaryIO, Final

import structlog

from fleet.assignment.deciding import Decision, decide
from fleet.assignment.improving import improved, within
from fleet.assignment.problem import AssignmentProblem

GRACE_S: Final = 2.0
"""So much longer than its budget an answer may take."""
STARTS_WITHIN_S: Final = 20.0
_LENGTH: Final = struct.Struct(">I")
ROOT: Final = Path(__file__).parents[2]

log = structlog.get_logger(__name__)


class PlannerProcess:
    """One at a time, started when it is needed first; it ends with the service, or when that is gone."""

    def __init__(self) -> None:
        self._process: Process | None = None
        self._in_turn = asyncio.Lock()

    @property
    def process_id(self) -> int | None:
        """Of the process that was asked last, if there is one."""
        return self._process.pid if self._process is not None else None

    async def decided(self, problem: AssignmentProblem, rng: random.Random) -> Decision | None:
        """The first answer, as `decide` gives it."""
        return await asyncio.to_thread(decide, problem, rng)

    async def improved(self, decision: Decision, budget_s: float) -> Decision | None:
        """The best that was found within the budget; None if the process has failed. Who asks meanwhile waits."""
        async with self._in_turn:
            return await self._improved(decision, budget_s)

    async def _improved(self, decision: Decision, budget_s: float) -> Decision | None:
        is_new = self._process is None or self._process.returncode is not None
        try:
            async with asyncio.timeout(budget_s + (STARTS_WITHIN_S if is_new else GRACE_S)):
                return await self._ask(decision, budget_s)
        except (TimeoutError, OSError, EOFError, pickle.UnpicklingError) as error:
            log.warning("no better plan was looked for", error=repr(error))
            await self.end()
            return None
        except asyncio.CancelledError:
            await self.end()
            raise

    async def _ask(self, decision: Decision, budget_s: float) -> Decision:
        if self._process is None or self._process.returncode is not None:
            self._process = await asyncio.create_subprocess_exec(
                sys.executable, "-m", "app.dispatch.planner_process", cwd=ROOT, stdin=PIPE, stdout=PIPE
            )
        writes, reads = self._process.stdin, self._process.stdout
        assert writes is not None and reads is not None  # noqa: S101  # both were asked for
        question = pickle.dumps((decision, budget_s))
        writes.write(_LENGTH.pack(len(question)) + question)
        await writes.drain()
        (length,) = _LENGTH.unpack(await reads.readexactly(_LENGTH.size))
        answer = pickle.loads(await reads.readexactly(length))  # noqa: S301  # from our own process
        assert isinstance(answer, Decision)  # noqa: S101
        return answer

    def cut_off(self) -> None:
        """End it, whatever it is doing: the caller hears that it has failed."""
        if self._process is not None and self._process.returncode is None:
            with suppress(ProcessLookupError):
                self._process.kill()

    async def end(self) -> None:
        self.cut_off()
        process, self._process = self._process, None
        if process is not None:
            await process.wait()


def answer_all(reads: BinaryIO, writes: BinaryIO) -> None:
    """Answer until there is no caller any more. Asked the same twice it looks elsewhere."""
    rng = random.Random(0)
    while len(head := reads.read(_LENGTH.size)) == _LENGTH.size:
        (length,) = _LENGTH.unpack(head)
        decision, budget_s = pickle.loads(reads.read(length))  # noqa: S301  # from the service that has started this
        go_on = within(budget_s, time.monotonic)
        answer = pickle.dumps(improved(decision, rng, go_on, go_on))
        writes.write(_LENGTH.pack(len(answer)) + answer)
        writes.flush()


if __name__ == "__main__":
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the service, ended at a terminal, ends this with it
    answer_all(sys.stdin.buffer, sys.stdout.buffer)
