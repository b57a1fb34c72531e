"""The base for a few seconds without a daemon: what it says, how often, how well."""

import time
from collections.abc import Callable
from dataclasses import dataclass

from robot.drivers.create2.create2 import Create2
from robot.drivers.create2.serial_port import SerialPort
from robot.drivers.create2.wake_up import WakeUpLine
from robot.drivers.interfaces import BaseState

POLL_S = 0.005
STARTING_S = 1.5
"""Until the stream has begun, nothing is counted."""


@dataclass(frozen=True)
class BaseAnswer:
    """The input of the port. No `state`: not one frame."""

    state: BaseState | None
    frames: int
    corrupt: int
    watched_s: float
    firmware: str | None = None

    @property
    def frames_per_s(self) -> float:
        return self.frames / self.watched_s if self.watched_s else 0.0


def watch_base(open_port: Callable[[], SerialPort], line: WakeUpLine, for_s: float) -> BaseAnswer:
    """Listen, and leave it in Passive. Raises PortAbsent, PortBusy."""
    base = Create2(open_port, line)
    try:
        _listen(base, STARTING_S, until_heard=True)
        frames, corrupt = base.health.frames, base.health.corrupt
        _listen(base, for_s)
        health = base.health
        return BaseAnswer(base.state, health.frames - frames, health.corrupt - corrupt, for_s, health.firmware)
    finally:
        base.close()


def _listen(base: Create2, for_s: float, until_heard: bool = False) -> None:
    until_s = time.monotonic() + for_s
    while (now := time.monotonic()) < until_s and not (until_heard and base.health.frames):
        base.poll(now)
        time.sleep(POLL_S)
