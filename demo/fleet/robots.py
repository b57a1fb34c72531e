"""The robots' processes in a demonstration of the fleet. One that dies is told of, and started again after a while."""

import asyncio
from collections import Counter
from collections.abc import Callable
from contextlib import suppress

from demo.children import Child, Children
from demo.fleet.settings import FleetDemo
from protocol.clock import Clock, sleep


class RobotProcesses:
    """`say` is told in a line when one ends or begins anew; `down` are those that do not run now."""

    def __init__(self, demo: FleetDemo, clock: Clock, children: Children, say: Callable[[str], None]) -> None:
        self._demo, self._clock, self._start_child, self._say = demo, clock, children.start, say
        self._running: dict[str, Child] = {}
        self._wanted = {robot: asyncio.Event() for robot in demo.homes}
        """Set when a person wants it back sooner."""
        self.died: Counter[str] = Counter()
        self.down: set[str] = set()

    async def start(self) -> None:
        for robot in self._demo.homes:
            self._running[robot] = await self._start(robot)

    async def _start(self, robot: str) -> Child:
        command, log = self._demo.robot_command(robot), self._demo.folder / f"{robot}.log"
        return await self._start_child(f"robot {robot}", command, log)

    @property
    def ids(self) -> dict[str, int]:
        return {robot: child.process.pid for robot, child in self._running.items()}

    def kill(self, robot: str) -> None:
        """End its process as a crash would; nothing if it does not run."""
        with suppress(ProcessLookupError):
            self._running[robot].process.kill()

    def start_again(self, robot: str) -> None:
        """Do not wait any longer; nothing if it runs."""
        if robot in self.down:
            self._wanted[robot].set()

    async def must_live(self) -> None:
        """Until one ends, which none may before there is something to see. Raises DemoFailed."""
        await asyncio.gather(*(child.watch() for child in self._running.values()))

    async def look_after(self) -> None:
        """Whichever dies."""
        await asyncio.gather(*(self._look_after(robot) for robot in self._running))

    async def _look_after(self, robot: str) -> None:
        while True:
            child = self._running[robot]
            how = _how_it_ended(await child.process.wait(), child)
            self.died[robot] += 1
            self.down.add(robot)
            again_s = self._demo.restart_after_s
            self._say(f"{robot}: its process {how}; it is started again in {again_s / 60:g} min, where it stands")
            await self._rest(robot, again_s)
            self._running[robot] = await self._start(robot)
            self.down.remove(robot)
            self._say(f"{robot}: started again, process {self._running[robot].process.pid}")

    async def _rest(self, robot: str, again_s: float) -> None:
        waits = [asyncio.ensure_future(one) for one in (sleep(self._clock, again_s), self._wanted[robot].wait())]
        try:
            await asyncio.wait(waits, return_when=asyncio.FIRST_COMPLETED)
        finally:
            for wait in waits:
                wait.cancel()
        self._wanted[robot].clear()


def _how_it_ended(code: int, child: Child) -> str:
    """Say how a process ended: one that was killed has written no reason."""
    if code < 0:
        return f"was killed by signal {-code}"
    return f"ended with exit code {code}: {child.last_words().splitlines()[-1].strip()}"
