"""A robot that drives in the simulated world over the real driver, until something happens to it."""

import math
from dataclasses import dataclass, field
from typing import ClassVar

import pytest

from protocol.clock import SteppedClock
from robot.drivers.interfaces import WheelSpeeds
from robot.ops.host import HostWatch
from robot.simulated import Person, SimulatedHost
from robot.skills.interfaces import Running, Step, View
from tests.robot.skills.track import TICK_S, Drive

HOST_EVERY = 25
CRUISE = WheelSpeeds(150, 150)
STANDS_MM_S = 1.0


@dataclass
class Rolls:
    """Straight on, for ever, whatever it sees: what the reflexes do is not the skill's doing."""

    wheels: WheelSpeeds = CRUISE
    name: ClassVar[str] = "rolls"
    moves: ClassVar[bool] = True
    limit_s: float = 3600.0
    on_timeout: ClassVar[str] = "timeout"

    def start(self, view: View, now: float) -> None: ...

    def step(self, view: View, now: float) -> Step:
        return Running(self.wheels)


@dataclass
class Moving(Drive):
    """Also looks after the computer and samples the diodes four times a tick, as the daemon does."""

    online: bool = True
    clock: SteppedClock = field(default_factory=SteppedClock)

    def __post_init__(self) -> None:
        self.host: HostWatch | None = None
        super().__post_init__()
        self.host = HostWatch(SimulatedHost(self.robot.faults, self.clock))

    def tick(self) -> None:
        for share in (0.25, 0.5, 0.75):
            self.robot.step_until(self.now + share * TICK_S)
            self.loop.sample_line()
        self.clock.now_s = self.now
        if self.host and self._ticks % HOST_EVERY == 0:
            self.loop.report_host(self.host.tick(self.now))
        if self.mind_lives:
            self.loop.link(self.online)
        super().tick()

    @property
    def wheels_stand(self) -> bool:
        return max(map(abs, self.robot.state()["wheels_mm_s"])) < STANDS_MM_S

    @property
    def faults(self) -> frozenset[str]:
        return self.loop.view.faults

    def distance_m(self, person: Person) -> float:
        return math.hypot(person.x_m - self.robot.pose.x_m, person.y_m - self.robot.pose.y_m)

    def sets_off(self, wheels: WheelSpeeds = CRUISE) -> int:
        """Rolls, and is on its way; the job's number."""
        job = self.loop.start(Rolls(wheels), self.now)
        self.steps(1.0)
        # The driver goes round a few numbers whose bytes could be taken for something else.
        assert self.loop.view.sent == pytest.approx(wheels, abs=3)
        assert not self.wheels_stand
        return job
