"""A bench for the simulated robot: bytes in, time passes, packets out."""

from collections.abc import Callable, Iterator
from struct import unpack
from typing import Any

import pytest

from robot.simulated import Motion, Options, SimulatedRobot
from robot.simulated.base.packets import PACKETS
from robot.simulated.body import Build
from tests.plain_maps import plain_map

EXACT = Options(build=Build(motion=Motion(ripple_mm_s=0.0, wheel_error=0.0)))


class Bench:
    """`send` bytes, `run` for a while, `ask` for a packet's value."""

    def __init__(self, robot: SimulatedRobot) -> None:
        self.robot = robot
        self.port = robot.memory_port()

    def send(self, *data: int) -> None:
        self.port.write(bytes(data))
        self.run(0.020)

    def run(self, duration_s: float) -> None:
        self.robot.step_until(self.robot.now + duration_s)

    def drive(self, left_mm_s: int, right_mm_s: int) -> None:
        self.send(145, *right_mm_s.to_bytes(2, "big", signed=True), *left_mm_s.to_bytes(2, "big", signed=True))

    def ask(self, packet: int) -> int:
        """One packet's value by the Sensors command; everything printed before is dropped."""
        self.port.reset_input_buffer()
        self.send(142, packet)
        return int(unpack(">" + PACKETS[packet][1], self.port.read(99))[0])

    def heard(self) -> bytes:
        return self.port.read(100_000)


Make = Callable[..., Bench]


@pytest.fixture
def make() -> Iterator[Make]:
    """Benches on the test track; wheels without ripple and error unless `options` says otherwise."""
    made: list[SimulatedRobot] = []

    def bench(start: str = "post1:post2", campus: str = "test_track", **more: Any) -> Bench:
        more = {"options": EXACT, **more}
        made.append(SimulatedRobot(plain_map(campus), 0.0, start, in_memory=True, **more))
        return Bench(made[-1])

    yield bench
    for robot in made:
        robot.close()


@pytest.fixture
def awake(make: Make) -> Bench:
    """A robot on the line in Safe mode."""
    bench = make()
    bench.send(128, 131)
    bench.heard()
    return bench
