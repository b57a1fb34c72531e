"""Every fault is a switch, and the door to the world answers every command, wrong ones by name."""

import json
import math
import socket
import stat
import threading

import pytest

from protocol.clock import RealClock
from robot.simulated import SWITCHES, Door, Faults, SimulatedRobot, UnknownSwitch, WrongValue
from robot.simulated.door import COMMANDS, obey
from robot.simulated.live import Live
from tests.plain_maps import plain_map

PASSIVE, SAFE = 1, 2
CODE = "CM1:" + "0123456789abcdef" * 2


# Switches --------------------------------------------------------------------------------------------------------


def test_every_switch_is_described_and_rests_in_off():
    faults = Faults()
    assert set(SWITCHES) == set(vars(faults))
    assert not any(vars(faults).values())
    assert faults.on() == {}


@pytest.mark.parametrize(
    ("name", "value"),
    [("frozen", 1), ("frozen", "yes"), ("drop_byte", 1.5), ("drop_byte", True), ("mode_offset", 0.5), ("darkness", -1)],
)
def test_a_value_that_a_switch_cannot_mean_is_refused(name, value):
    with pytest.raises(WrongValue, match=name):
        Faults().set(name, value)


def test_an_unknown_switch_is_refused_with_the_list_of_those_there_are():
    with pytest.raises(UnknownSwitch, match="mode_offset"):
        Faults().set("gravity", True)


def test_lost_bytes_are_about_as_many_as_asked(awake):
    awake.robot.set_fault("drop_byte", 0.1)
    awake.send(148, 1, 100)
    heard = b""
    for _ in range(100):
        awake.run(0.15)
        heard += awake.heard()
    assert len(heard) == pytest.approx(0.9 * 1000 * 84, rel=0.02)


def test_flipped_bits_break_checksums(awake):
    awake.robot.set_fault("flip_byte", 0.01)
    awake.send(148, 1, 100)
    awake.heard()
    sound = 0
    for _ in range(200):
        awake.run(0.015)
        sound += sum(awake.heard()) % 256 == 0
    assert 40 < sound < 180


def test_a_frozen_robot_neither_hears_nor_speaks_but_rolls_on(awake):
    awake.send(148, 1, 35)
    awake.drive(100, 100)
    awake.heard()
    awake.robot.set_fault("frozen", True)
    before = awake.robot.driven_mm
    awake.drive(0, 0)
    awake.run(2)
    assert awake.heard() == b""
    assert awake.robot.driven_mm > before + 190
    awake.robot.set_fault("frozen", False)
    awake.run(0.1)
    assert len(awake.heard()) >= 5 * 5


def test_the_mode_can_be_told_wrong_or_not_at_all(awake):
    awake.robot.set_fault("mode_offset", 1)
    assert awake.ask(35) == 3
    awake.robot.set_fault("mode_offset", 30)
    assert awake.ask(35) == 32
    awake.robot.set_fault("mode_silent", True)
    awake.send(142, 35, 142, 7)
    assert awake.heard() == b"\x00", "only packet 7 is answered"


def test_firmware_text_comes_between_two_frames(awake):
    awake.send(148, 1, 35)
    awake.heard()
    awake.robot.print_text()
    awake.run(0.03)
    assert awake.heard().startswith(b"ERROR: language set error type 2\r\n")


def test_a_stuck_robot_turns_its_wheels_without_moving(awake):
    awake.robot.set_fault("stuck", True)
    awake.drive(100, 100)
    awake.run(1.5)
    assert awake.robot.driven_mm == 0
    assert awake.ask(43) > 200
    assert (awake.ask(58), awake.ask(14)) == (0, 0b11000)


def test_old_firmware_tells_a_third_of_the_angle(awake):
    awake.robot.set_fault("angle_bug", True)
    awake.drive(-50, 50)
    awake.run(2)
    assert awake.ask(20) == pytest.approx(49 * 0.324, abs=1.5)


def test_an_unpowered_dock_does_not_charge(make):
    bench = make("dock", battery_ratio=0.5)
    bench.robot.set_fault("dock_unpowered", True)
    bench.send(128, 131)
    bench.run(5)
    assert (bench.ask(34), bench.ask(21), bench.ask(35)) == (0, 0, SAFE)


def test_a_faulty_charger_says_so_and_gives_nothing(make):
    bench = make("dock", battery_ratio=0.5)
    bench.robot.set_fault("charge_fault", True)
    bench.send(128)
    bench.run(60)
    assert bench.ask(21) == 5
    assert bench.robot.battery.ratio <= 0.5


def test_bouncing_contacts_come_and_go(make):
    bench = make("dock", battery_ratio=0.5)
    bench.send(128)
    bench.robot.set_fault("contact_bounce", True)
    seen = {bench.ask(34) for _ in range(100)}
    assert seen == {0, 2}


def test_a_dock_without_beams_is_not_found(make):
    bench = make("post5")
    bench.robot.set_fault("dock_beams_off", True)
    bench.send(128, 143)
    bench.run(70)
    assert (bench.ask(17), bench.robot.docked) == (0, False)


def test_flipped_diodes_are_about_as_many_as_asked(make):
    bench = make("post1:post2")
    bench.robot.set_fault("floor_flip", 0.05)
    readings = [bench.robot.body.pins.readings(0.0, 3.5, -math.pi / 2) for _ in range(4000)]
    assert sum(reading != [1, 0, 1] for reading in readings) == pytest.approx(4000 * 0.143, rel=0.15)


def test_tape_edges_read_by_chance_only_near_the_edge(make):
    bench = make("post1:post2")
    bench.robot.set_fault("floor_edge_mm", 4.0)
    read = bench.robot.body.pins.readings
    assert {read(0.0115, 3.5, -math.pi / 2)[1] for _ in range(50)} == {0, 1}
    assert {read(0.005, 3.5, -math.pi / 2)[1] for _ in range(50)} == {0}


def test_stuck_pins_keep_what_they_said(make):
    bench = make("post1:post2")
    pin = bench.robot.pin_factory.pin(15)
    before = pin.state
    bench.robot.set_fault("pins_stuck", True)
    bench.robot.push(200)
    bench.run(0.1)
    assert pin.state == before


def test_an_empty_battery_silences_the_robot_until_it_is_on_a_charger(make):
    bench = make("post1:post2", battery_ratio=0.001, capacity_mah=60)
    bench.send(128, 131)
    bench.drive(100, 100)
    bench.run(20)
    bench.heard()
    bench.send(128, 142, 35)
    driven = bench.robot.driven_mm
    bench.run(5)
    assert (bench.heard(), bench.robot.driven_mm) == (b"", driven)


def test_a_robot_pushed_by_hand_counts_up_whichever_way(awake):
    before = awake.ask(43)
    awake.robot.push(100)
    awake.robot.push(-100)
    awake.run(0.03)
    assert awake.ask(43) - before == pytest.approx(200 / 0.44456, abs=2)
    assert awake.robot.pose.y_m == pytest.approx(4.0)


# The door --------------------------------------------------------------------------------------------------------


@pytest.fixture
def home(tmp_path):
    """A living robot in real time, with a door in a folder."""
    clock = RealClock()
    robot = SimulatedRobot(plain_map("test_track"), clock.now(), "post1:post2", in_memory=True)
    door = Door(robot, tmp_path / "door", tell=lambda: {"find_line_episodes": 3})
    with Live(robot, clock):
        yield robot, tmp_path / "door"
    door.close()
    robot.close()


def knock(path, *lines: object):
    """Each line's answer."""
    with socket.socket(socket.AF_UNIX) as visitor:
        visitor.settimeout(10)
        visitor.connect(str(path))
        file = visitor.makefile("rwb")
        answers = []
        for line in lines:
            file.write(line if isinstance(line, bytes) else json.dumps(line).encode() + b"\n")
            file.flush()
            answers.append(json.loads(file.readline()))
        file.close()
    return answers


def test_the_door_is_for_its_owner_only(home):
    assert stat.S_IMODE(home[1].stat().st_mode) == 0o600


def test_a_code_shown_through_the_door_is_seen_by_the_camera(home):
    robot, path = home
    assert knock(path, {"do": "show_code", "text": CODE}) == [{"ok": True}]
    assert robot.camera.shown == CODE
    assert knock(path, {"do": "hide_code"}) == [{"ok": True}]
    assert robot.camera.shown is None


def test_the_state_tells_pose_battery_faults_and_what_the_daemon_adds(home):
    _, path = home
    state = knock(
        path, {"do": "fault", "name": "darkness", "value": 0.5}, {"do": "battery", "ratio": 0.2}, {"do": "state"}
    )[2]
    assert state["ok"]
    assert state["pose"] == pytest.approx({"x_m": 0.0, "y_m": 4.0, "heading_rad": -math.pi / 2})
    assert state["battery"]["ratio"] == pytest.approx(0.2, abs=0.001)
    assert state["battery"]["charging"] is False
    assert (state["distance_m"], state["faults"], state["find_line_episodes"]) == (0, {"darkness": 0.5}, 3)


@pytest.mark.parametrize(
    ("request_", "part"),
    [
        (b"not json\n", "not JSON"),
        ([1], "an object"),
        ({}, "no door command None"),
        ({"do": "fly"}, "no door command 'fly'"),
        ({"do": "show_code"}, "text"),
        ({"do": "show_code", "text": 5}, "a text"),
        ({"do": "battery"}, "ratio"),
        ({"do": "battery", "ratio": 2}, "from 0 to 1"),
        ({"do": "battery", "ratio": "half"}, "from 0 to 1"),
        ({"do": "bump", "side": "top"}, "left, right or both"),
        ({"do": "cliff", "on": 1}, "true or false"),
        ({"do": "wheel_drop"}, "true or false"),
        ({"do": "fault", "name": "gravity", "value": True}, "no fault 'gravity'"),
        ({"do": "fault", "name": ["x"], "value": True}, "no fault"),
        ({"do": ["state"]}, "no door command"),
    ],
)
def test_a_wrong_command_gets_a_sentence_and_the_door_stays_open(home, request_, part):
    answer, after = knock(home[1], request_, {"do": "state"})
    assert answer["ok"] is False
    assert part in answer["error"]
    assert after["ok"]


@pytest.mark.parametrize(
    ("request_", "packet", "value"),
    [
        ({"do": "bump", "side": "left"}, 7, 2),
        ({"do": "cliff", "on": True}, 11, 1),
        ({"do": "wheel_drop", "on": True}, 7, 12),
        ({"do": "fault", "name": "virtual_wall", "value": True}, 13, 1),
        ({"do": "person", "x_m": 0.0, "y_m": 3.63}, 7, 3),
    ],
)
def test_what_happens_through_the_door_shows_in_the_packets(awake, request_, packet, value):
    assert obey(awake.robot, request_)["ok"]
    awake.run(0.1)
    assert awake.ask(packet) == value


def test_people_leave_when_told(awake):
    obey(awake.robot, {"do": "person", "x_m": 0.0, "y_m": 3.63})
    assert obey(awake.robot, {"do": "clear_people"}) == {"ok": True}
    awake.run(0.1)
    assert awake.ask(7) == 0


def test_every_door_command_has_an_answer(awake):
    given = {
        "show_code": {"text": "x"},
        "battery": {"ratio": 0.5},
        "bump": {"side": "left"},
        "cliff": {"on": False},
        "wheel_drop": {"on": False},
        "fault": {"name": "dirt", "value": 0.0},
        "person": {"x_m": 9, "y_m": 9},
        "push": {"ahead_mm": 1},
        "place": {"x_m": 1, "y_m": 1, "heading_rad": 0},
        "print_text": {"text": "hello"},
    }
    for name in COMMANDS:
        assert obey(awake.robot, {"do": name, **given.get(name, {})})["ok"], name


def test_a_world_that_stands_still_says_so(tmp_path):
    robot = SimulatedRobot(plain_map("test_track"), 0.0, in_memory=True)
    door = Door(robot, tmp_path / "door", answer_within_s=0.1)
    answer = knock(tmp_path / "door", {"do": "state"})[0]
    assert not answer["ok"]
    assert "has not moved" in answer["error"]
    door.close()
    assert not (tmp_path / "door").exists()


def test_many_visitors_are_served_at_once(home):
    answers = []
    visitors = [threading.Thread(target=lambda: answers.extend(knock(home[1], {"do": "state"}))) for _ in range(8)]
    for visitor in visitors:
        visitor.start()
    for visitor in visitors:
        visitor.join()
    assert [answer["ok"] for answer in answers] == [True] * 8


def test_with_a_share_of_slip_the_wheels_count_more_than_the_robot_moves(make):
    bench = make()
    bench.robot.set_fault("slip", 0.25)
    bench.send(128, 131)
    bench.drive(200, 200)
    bench.run(3.0)
    counted_mm = bench.ask(43) * 0.44456
    assert bench.robot.driven_mm == pytest.approx(0.75 * counted_mm, rel=0.02)
