"""`pycreate2` from PyPI, which none of us wrote, unmodified, in a process of its own: it drives and reads the truth."""

import json
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import asdict
from math import cos, sin
from typing import Any

import pytest

from protocol.clock import RealClock
from robot.simulated import Person, SimulatedRobot
from robot.simulated.live import Live
from tests.plain_maps import plain_map

SAFE = 2
CLIENT = """
import json, sys, time
from pycreate2 import Create2
client = Create2(sys.argv[1])
client.sleep_timer = 0.05
client.start()
client.safe()

def tell():
    sensors = client.get_sensors()
    print(json.dumps(sensors._asdict()), flush=True)

tell()
client.led(4, 0, 128)
client.digit_led_ascii("mail")
client.createSong(3, [60, 16, 64, 16])
client.playSong(3)
client.drive_direct(200, 100)
time.sleep(1.0)
tell()
client.drive_pwm(-51, 51)
time.sleep(0.5)
client.drive_stop()
time.sleep(0.6)
tell()
sys.stdin.readline()
tell()
sys.stdin.readline()
"""
# pycreate2's name of a sensor → ours. Bits are compared apart; 19 and 20 are cleared by reading.
SAME = {
    "wall": "wall",
    "cliff_left": "cliff_left",
    "cliff_front_left": "cliff_front_left",
    "cliff_front_right": "cliff_front_right",
    "cliff_right": "cliff_right",
    "virtual_wall": "virtual_wall",
    "dirt_detect": "dirt_detect",
    "ir_opcode": "ir_omni",
    "charger_state": "charging_state",
    "voltage": "voltage_mv",
    "current": "current_ma",
    "temperature": "temperature_c",
    "battery_charge": "charge_mah",
    "battery_capacity": "capacity_mah",
    "wall_signal": "wall_signal",
    "cliff_left_signal": "cliff_left_signal",
    "cliff_front_left_signal": "cliff_front_left_signal",
    "cliff_front_right_signal": "cliff_front_right_signal",
    "cliff_right_signal": "cliff_right_signal",
    "open_interface_mode": "oi_mode",
    "song_number": "song_number",
    "song_playing": "song_playing",
    "oi_stream_num_packets": "stream_packets",
    "velocity_left": "left_velocity_mm_s",
    "velocity_right": "right_velocity_mm_s",
    "encoder_counts_left": "left_encoder",
    "encoder_counts_right": "right_encoder",
    "light_bumper_left": "light_left",
    "light_bumper_front_left": "light_front_left",
    "light_bumper_center_left": "light_centre_left",
    "light_bumper_center_right": "light_centre_right",
    "light_bumper_front_right": "light_front_right",
    "light_bumper_right": "light_right",
    "ir_opcode_left": "ir_left",
    "ir_opcode_right": "ir_right",
    "left_motor_current": "left_motor_ma",
    "right_motor_current": "right_motor_ma",
    "main_brush_current": "main_brush_ma",
    "side_brush_current": "side_brush_ma",
}


class Client:
    """A program that prints what it has sensed, and waits at two places."""

    def __init__(self, port: str) -> None:
        command = [sys.executable, "-c", CLIENT, port]
        self._process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )

    def sensed(self) -> dict[str, Any]:
        assert self._process.stdout
        for line in self._process.stdout:
            if line.startswith("{"):
                sensors: dict[str, Any] = json.loads(line)
                return sensors
        raise AssertionError(self._process.communicate()[1])

    def go_on(self) -> None:
        assert self._process.stdin
        self._process.stdin.write("\n")
        self._process.stdin.flush()

    def close(self) -> None:
        """Whatever state the test left it in."""
        self._process.kill()
        self._process.communicate()

    def end(self) -> tuple[int, str]:
        _, errors = self._process.communicate("\n", timeout=20)
        return self._process.returncode, errors


@pytest.fixture
def robot() -> Iterator[SimulatedRobot]:
    clock = RealClock()
    made = SimulatedRobot(plain_map("test_track"), clock.now(), "post1:post2", battery_ratio=0.5)
    with Live(made, clock):
        yield made
    made.close()


@pytest.fixture
def client(robot: SimulatedRobot) -> Iterator[Client]:
    made = Client(robot.port_path)
    yield made
    made.close()


def test_it_drives_lights_sings_and_reads_what_is_true(robot: SimulatedRobot, client: Client) -> None:
    first = client.sensed()
    assert (first["open_interface_mode"], first["encoder_counts_left"], first["battery_capacity"]) == (SAFE, 0, 2696)
    driving = client.sensed()
    assert (driving["velocity_right"], driving["velocity_left"], driving["song_playing"]) == (200, 100, 0)
    assert driving["encoder_counts_right"] * 0.44456 == pytest.approx(190, abs=25)
    assert driving["encoder_counts_left"] * 0.44456 == pytest.approx(95, abs=15)
    assert driving["left_motor_current"] == 300 and driving["statis"] == [True, False]
    assert robot.pose.heading_rad > -1.4, "the right wheel was faster: a turn to the left"
    standing = client.sensed()
    assert standing["encoder_counts_right"] < driving["encoder_counts_right"], "PWM −51 turns backwards"
    done = robot.body.interface.actuators
    assert (done.leds, done.digits) == ((4, 0, 128), b"MAIL")
    assert done.songs.songs[3] == ((60, 16), (64, 16)) and done.songs.played[-1] == 3

    base = robot.body.base
    ahead_m = 0.36  # the bumper touches, the body does not overlap
    x_m, y_m = base.x_m + ahead_m * cos(base.heading_rad), base.y_m + ahead_m * sin(base.heading_rad)
    robot.world.obstacles.append(Person(x_m, y_m, 0.2))
    robot.sag(0.3)
    robot.set_fault("cliff_left", True)
    robot.set_fault("virtual_wall", True)
    robot.place(robot.pose)
    client.go_on()
    told, truth = client.sensed(), asdict(robot.body.readings)
    for theirs, ours in SAME.items():
        assert told[theirs] == pytest.approx(truth[ours], abs=2 if ours.endswith(("_mv", "_ma", "_mah")) else 0), theirs
    assert told["bumps_wheeldrops"] == [True, True, False, False]
    assert told["overcurrents"] == [False] * 4
    assert told["charger_available"] == [False, False]
    assert told["buttons"] == [False] * 8
    assert any(told["light_bumper"]) and told["cliff_left"] is True
    assert client.end() == (0, "")
    assert robot.state()["mode"] == "off", "it ends by switching the interface off"
