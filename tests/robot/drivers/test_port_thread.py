"""Real time and a real pseudo-terminal: the port's own thread keeps the deadline, and nothing blocks for long."""

import os
import pty
import threading
import time
import tty
from collections.abc import Callable, Iterator

import pytest

from protocol.clock import RealClock
from robot.drivers.create2.create2 import Create2
from robot.drivers.create2.serial_port import open_serial
from robot.drivers.interfaces import Mode, WheelSpeeds
from robot.drivers.port_thread import PortThread
from robot.simulated import SimulatedRobot
from robot.simulated.live import Live
from tests.plain_maps import plain_map

pytestmark = pytest.mark.alone
AHEAD = WheelSpeeds(100, 100)


class OnThreads:
    """A robot that lives by the clock, and the base as a real robot has it."""

    def __init__(self) -> None:
        self.clock = RealClock()
        self.robot = SimulatedRobot(plain_map("test_track"), self.clock.now(), "post1:post2")
        self.base = PortThread(Create2(lambda: open_serial(self.robot.port_path)), self.clock.now)
        self.before = set(threading.enumerate())

    def drive_for(self, duration_s: float) -> None:
        until_s = self.clock.now() + duration_s
        while self.clock.now() < until_s:
            self.base.poll(self.clock.now())
            self.base.drive(AHEAD, self.clock.now())
            time.sleep(0.02)

    def until(self, wanted: Callable[[], object], limit_s: float) -> float:
        began_s = time.monotonic()
        while not wanted():
            assert time.monotonic() - began_s < limit_s, self.base.health
            time.sleep(0.005)
        return time.monotonic() - began_s

    @property
    def fastest_mm_s(self) -> float:
        return max(abs(speed) for speed in self.robot.state()["wheels_mm_s"])


@pytest.fixture
def driving() -> Iterator[OnThreads]:
    made = OnThreads()
    with Live(made.robot, made.clock):
        made.base.start()
        made.until(lambda: made.base.state is not None, 5)
        made.base.set_mode(Mode.SAFE, made.clock.now())
        made.drive_for(0.6)
        assert made.fastest_mm_s > 50
        yield made
        made.base.close()
    made.robot.close()


def test_wheels_stop_although_nobody_drives_or_polls_any_more(driving: OnThreads) -> None:
    took_s = driving.until(lambda: driving.fastest_mm_s < 1, 3)
    assert 0.35 < took_s < 1.5, "0.4 s of validity, 0.3 s for the wheels to run down"


def test_a_touch_is_urgent_once_and_frames_have_the_time_of_their_arrival(driving: OnThreads) -> None:
    driving.base.urgent.clear()
    driving.robot.bump("left", 0.2)
    assert driving.base.urgent.wait(1.0)
    driving.base.urgent.clear()
    state = driving.base.poll(driving.clock.now())
    assert state is not None and state.bump_left
    assert driving.clock.now() - state.at_s < 0.5
    time.sleep(0.1)
    assert not driving.base.urgent.is_set(), "still pressed is no news"


def test_the_end_leaves_the_base_in_passive_and_no_thread_behind(driving: OnThreads) -> None:
    driving.base.close()
    driving.until(lambda: driving.robot.state()["mode"] == "passive", 1)
    assert "base port" not in {thread.name for thread in set(threading.enumerate()) - driving.before}
    driving.base.poll(driving.clock.now())
    assert driving.base.poll(driving.clock.now()) is None, "no thread listens any more"


def test_an_unplugged_cable_is_known_and_stops_nobody(driving: OnThreads) -> None:
    driving.robot.unplug()
    driving.until(lambda: driving.base.health.problem is not None, 2)
    began_s = time.monotonic()
    driving.drive_for(0.1)
    assert time.monotonic() - began_s < 0.5


def test_a_cable_that_takes_no_bytes_never_blocks_the_drive_loop_for_long() -> None:
    master, slave = pty.openpty()
    tty.setraw(slave)
    base = Create2(lambda: open_serial(os.ttyname(slave)))
    now, worst_s, lost = 100.0, 0.0, False
    base.poll(now)
    base.set_mode(Mode.SAFE, now)
    for number in range(20_000):
        now += 0.02
        began_s = time.monotonic()
        base.drive(WheelSpeeds(100, 100 + number % 2), now)
        worst_s = max(worst_s, time.monotonic() - began_s)
        if base.health.problem is not None:
            lost = True
            break
    assert lost, "what no thread reads fills up"
    assert "timeout" in str(base.health.problem).lower()
    assert worst_s < 0.1
    base.close()
    os.close(master)
    os.close(slave)
