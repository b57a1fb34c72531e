"""The real driver against the byte machine in memory, in stepped time: what each fault does to it."""

from collections.abc import Callable

from robot.drivers.create2.create2 import Create2
from robot.drivers.create2.wake_up import NoWakeUpLine, WakeUpLine
from robot.drivers.interfaces import BaseState, Mode, WheelSpeeds
from robot.simulated import SimulatedRobot
from tests.plain_maps import plain_map

TICK_S = 0.02
AHEAD = WheelSpeeds(100, 100)


class Together:
    """`run` lets time pass for both; the test that gives speeds plays the drive loop's part."""

    def __init__(self, start: str = "post1:post2", brc: bool = True, **more: float) -> None:
        self.robot = SimulatedRobot(plain_map("test_track"), 100.0, start, in_memory=True, **more)  # type: ignore[arg-type]
        self.now = 100.0
        line: WakeUpLine = self.robot.brc if brc else NoWakeUpLine()
        self.base = Create2(self.robot.memory_port, line)
        self.states: list[BaseState] = []
        self.sent = bytearray()
        self.base.listen_in(lambda *_: None, lambda data, _: self.sent.extend(data))

    def run(self, for_s: float, wanted: WheelSpeeds | None = None, tick_s: float = TICK_S) -> None:
        for _ in range(round(for_s / tick_s)):
            self.now += tick_s
            self.robot.step_until(self.now)
            state = self.base.poll(self.now)
            if state is not None:
                self.states.append(state)
            if wanted is not None:
                self.base.drive(wanted, self.now)

    def started(self) -> "Together":
        self.run(0.4)
        self.base.set_mode(Mode.SAFE, self.now)
        self.run(0.2)
        return self

    def after_s(self, limit_s: float) -> float:
        """Seconds until the base speaks again."""
        frames, began_s = self.base.health.frames, self.now
        while self.base.health.frames == frames:
            assert self.now - began_s < limit_s, f"silent for {limit_s} s: {self.base.health}"
            self.run(TICK_S)
        return self.now - began_s

    @property
    def wheels_mm_s(self) -> list[float]:
        wheels: list[float] = self.robot.state()["wheels_mm_s"]
        return wheels

    def take_sent(self) -> bytes:
        data = bytes(self.sent)
        self.sent.clear()
        return data

    def close(self) -> None:
        self.base.close()
        self.robot.close()


Join = Callable[..., Together]
"""What the fixture `join` gives: made with the arguments of `Together`, closed when the test is over."""
