"""The cable: real pyserial on a pseudo-terminal, a foreign client, unplugging, and the port for stepped time."""

import errno
import os
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from random import Random
from struct import unpack

import pytest
import serial

from robot.simulated import SimulatedRobot, WrongValue
from robot.simulated.base.serial_line import PtyLine
from tests.plain_maps import plain_map

SAFE = 2


@pytest.fixture
def robot():
    made = SimulatedRobot(plain_map("test_track"), 0.0, "post1:post2")
    yield made
    made.close()


def heard(port, size):
    """The kernel hands bytes over a moment after they were written."""
    port.timeout = 1.0
    return port.read(size)


def test_pyserial_opens_the_port_for_itself_and_gets_answers(robot):
    with serial.Serial(robot.port_path, 115200, timeout=1, write_timeout=1, exclusive=True) as port:
        port.write(bytes((128, 131, 142, 35)))
        robot.step_until(0.1)
        assert heard(port, 1) == bytes((SAFE,))


def test_a_stable_name_leads_to_the_port(tmp_path):
    link = tmp_path / "create2"
    robot = SimulatedRobot(plain_map("test_track"), 0.0, "post1:post2", link=link)
    assert os.path.realpath(link) == robot.port_path
    robot.close()
    assert not link.is_symlink()


def test_bytes_pass_unchanged_whatever_they_mean_to_a_terminal(robot):
    with serial.Serial(robot.port_path, 115200) as port:
        port.write(bytes((128, 140, 0, 16, *range(3, 35), 148, 1, 100)))
        robot.step_until(0.020)
        assert heard(port, 84)[:3] == bytes((19, 81, 100))
        assert robot.body.interface.actuators.songs.songs[0][:2] == ((3, 4), (5, 6))


def test_a_client_at_another_speed_hears_garbage(robot):
    with serial.Serial(robot.port_path, 19200) as port:
        port.write(bytes((128, 131)))
        robot.step_until(0.1)
        assert robot.body.interface.mode != SAFE


def test_a_client_that_never_reads_does_not_hold_up_the_world(robot):
    with serial.Serial(robot.port_path, 115200) as port:
        port.write(bytes((128, 131, 148, 1, 100)))
        robot.step_until(60.0)
        assert robot.now == pytest.approx(60.0)
        assert port.in_waiting < 100_000


def test_pulling_the_cable_is_seen_by_pyserial(robot):
    with serial.Serial(robot.port_path, 115200, timeout=0.2) as port:
        robot.unplug()
        with pytest.raises(serial.SerialException):
            port.read(1)
        with pytest.raises(OSError, match="Input/output error"):
            _ = port.in_waiting
    robot.step_until(1.0)


def test_rts_does_not_exist_on_a_pseudo_terminal_nor_on_the_memory_port(make):
    with pytest.raises(OSError) as refused:
        make().port.rts = True
    assert refused.value.errno == errno.ENOTTY


def test_the_memory_port_never_waits_and_fails_as_a_real_one_when_unplugged(make):
    port = make().port
    assert (port.in_waiting, port.read(10)) == (0, b"")
    make_unplugged = make()
    port = make_unplugged.port
    make_unplugged.robot.unplug()
    with pytest.raises(serial.SerialException):
        port.read(1)
    with pytest.raises(serial.SerialException):
        port.write(b"\x80")
    with pytest.raises(OSError, match="Input/output error"):
        _ = port.in_waiting
    port.close()
    with pytest.raises(serial.PortNotOpenError):
        port.read(1)


def test_each_kind_of_robot_has_its_own_port_and_says_so(make, robot):
    with pytest.raises(WrongValue, match="memory_port"):
        _ = make().robot.port_path
    with pytest.raises(WrongValue, match="port_path"):
        robot.memory_port()


@pytest.mark.alone
def test_a_second_of_the_world_costs_less_than_25_ms(make):
    """With the recommended stream of 25 packets on. Measured: 2 to 3 ms of processor time."""
    ids = (7, 9, 10, 11, 12, 14, 17, 18, 21, 22, 23, 24, 25, 26, 34, 35, 37, 43, 44, 45, 52, 53, 54, 55, 58)
    bench = make("post1:post2")
    bench.send(128, 131, 148, len(ids), *ids)
    bench.drive(150, 140)
    start = time.process_time()
    for _ in range(500):
        bench.run(0.02)
        bench.heard()
    assert (time.process_time() - start) / 10 < 0.025


def test_the_streamed_numbers_are_big_endian(make):
    bench = make("dock", battery_ratio=0.5)
    bench.send(128, 148, 1, 26)
    bench.run(0.03)
    frame = bench.heard()[-6:]
    assert unpack(">BBBHB", frame)[3] == 2696


def test_a_cable_can_be_pulled_while_the_world_goes_on():
    """The world runs on a thread of its own: its bytes go down no cable that is closed by then."""
    line, is_over = PtyLine(Random(0)), threading.Event()

    def talk() -> None:
        while not is_over.is_set():
            line.send(b"x", 115200)
            line.receive(115200)

    with ThreadPoolExecutor() as world:
        talking = world.submit(talk)
        for _ in range(300):
            line.close()
            line.plug_in()
        is_over.set()
        talking.result()
    line.close()
