"""On threads, real time and a real pseudo-terminal, as on hardware: whatever fails above, the wheels stop."""

import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from protocol.clock import RealClock
from robot.agent.mind import messages_from_person
from robot.core.config import load_settings
from robot.mission.store import StorageFull
from robot.ops.assembly import Simulation, assemble
from robot.ops.runners import Loop, ThreadedRunner
from robot.simulated.live import Live

pytestmark = pytest.mark.alone

WITHIN_S = 2.5
"""A second of silence, a fifth for the wheels to stand, and a machine that does other things, too."""


class Hardware:
    """A robot on threads that drives from post3 towards post2; its world lives on whatever the daemon does."""

    def __init__(self, data: Path) -> None:
        self.clock = RealClock()
        self.parts = assemble(load_settings(None, {"data": data}), self.clock, Simulation("post3:post2"))
        assert self.parts.robot is not None
        self.robot = self.parts.robot
        self.daemon, self.drive = self.parts.daemon, self.parts.daemon.drive
        self.parts.mind.inbox.extend(messages_from_person([], ["visit(post1)"]))
        self.raised: list[BaseException] = []
        # The world is no loop of a real daemon: it goes on by itself.
        loops = [loop for loop in self.daemon.loops() if loop.name != "world"]
        self.runner = ThreadedRunner([self._spoilt(loop) for loop in loops], self.clock)
        self.spoil: dict[str, Callable[[], object]] = {}
        self.thread = threading.Thread(target=self._run)

    def _spoilt(self, loop: Loop) -> Loop:
        """The same loop, with something that happens before its next tick once a test says so."""

        def tick(now: float) -> None:
            if loop.name in self.spoil:
                self.spoil[loop.name]()
            loop.tick(now)

        return Loop(loop.name, loop.rate_hz, loop.feeds, tick, loop.at_end)

    def _run(self) -> None:
        try:
            self.runner.run()
        except BaseException as error:
            self.raised.append(error)

    @property
    def wheels_stand(self) -> bool:
        return max(map(abs, self.robot.state()["wheels_mm_s"])) < 1.0

    def until(self, wanted: Callable[[], object], limit_s: float) -> None:
        until_s = time.monotonic() + limit_s
        while not wanted():
            assert time.monotonic() < until_s, f"not within {limit_s} s: {self.robot.state()}, {self.drive.view.faults}"
            time.sleep(0.02)


@pytest.fixture
def hardware(tmp_path: Path) -> Iterator[Hardware]:
    hardware = Hardware(tmp_path)
    with Live(hardware.robot, hardware.clock):
        hardware.thread.start()
        hardware.until(lambda: hardware.robot.driven_mm > 60, 20)
        yield hardware
        hardware.runner.stop()
        hardware.thread.join()
    hardware.daemon.close(hardware.clock.now())


@pytest.fixture
def gate() -> Iterator[threading.Event]:
    """Shut until the test is over: for what hangs."""
    gate = threading.Event()
    yield gate
    gate.set()


def test_a_mind_that_hangs_stops_the_wheels_and_leaves_the_drive_loop_alive(
    gate: threading.Event, hardware: Hardware
) -> None:
    hardware.spoil["mind"] = gate.wait
    hardware.until(lambda: hardware.wheels_stand, WITHIN_S)
    assert hardware.drive.view.faults == {"agent_silent"}
    at_s = hardware.drive.view.at_s
    hardware.until(lambda: hardware.drive.view.at_s > at_s, 1)
    del hardware.spoil["mind"]
    gate.set()
    hardware.until(lambda: not hardware.wheels_stand, 5)


@pytest.mark.parametrize("name", ["mind", "camera", "tell", "line and drive"])
def test_a_loop_that_breaks_stops_the_wheels_at_once_and_leaves_the_base_in_passive(
    hardware: Hardware, name: str
) -> None:
    def breaks() -> None:
        raise StorageFull("no room left for robot.db")

    hardware.spoil[name] = breaks
    hardware.until(lambda: hardware.wheels_stand, WITHIN_S)
    assert hardware.robot.state()["mode"] == "passive"
    hardware.thread.join(5)
    assert [str(error) for error in hardware.raised] == ["no room left for robot.db"]


def test_a_stop_does_not_wait_for_a_thread_that_hangs(gate: threading.Event, hardware: Hardware) -> None:
    hardware.spoil["camera"] = gate.wait
    time.sleep(0.3)
    asked_s = time.monotonic()
    hardware.runner.stop()
    hardware.until(lambda: hardware.wheels_stand, 0.8)
    hardware.thread.join(5)
    assert time.monotonic() - asked_s < 2.0


def test_a_camera_that_hangs_stops_the_wheels_until_it_gives_pictures_again(
    gate: threading.Event, hardware: Hardware
) -> None:
    hardware.spoil["camera"] = gate.wait
    hardware.until(lambda: hardware.wheels_stand, WITHIN_S)
    assert hardware.drive.view.faults == {"camera_stale"}
    del hardware.spoil["camera"]
    gate.set()
    hardware.until(lambda: not hardware.wheels_stand, 5)


def test_an_unplugged_base_is_a_fault_and_no_end(hardware: Hardware) -> None:
    hardware.robot.unplug()
    hardware.until(lambda: "base_silent" in hardware.drive.view.faults, WITHIN_S)
    assert hardware.drive.view.sent.still
    assert hardware.thread.is_alive()
    assert hardware.raised == []
