"""The byte machine: the manual's examples, the modes and what they refuse, streams, text, sleep."""

import pytest

from robot.simulated.base.actuators import ACTUATORS
from robot.simulated.base.commands import COMMANDS, SF
from robot.simulated.base.open_interface import HANDLERS
from robot.simulated.base.packets import GROUPS, PACKETS, Layout, Readings, stream_frame

OFF, PASSIVE, SAFE, FULL = range(4)
SIZES = {0: 26, 1: 10, 2: 6, 3: 10, 4: 14, 5: 12, 6: 52, 100: 80, 101: 28, 106: 12, 107: 9}


# The manual's own examples ---------------------------------------------------------------------------------------


def test_the_manuals_drive_example_backs_in_an_arc(awake):
    """137 255 56 1 244: −200 mm/s, radius 500 mm."""
    awake.send(137, 255, 56, 1, 244)
    assert (awake.ask(39), awake.ask(40)) == (-200, 500)
    assert (awake.ask(42), awake.ask(41)) == (-153, -247)


def test_the_manuals_query_example_answers_without_a_frame(awake):
    """149 2 7 13: bumps, then virtual wall."""
    awake.send(149, 2, 7, 13)
    assert awake.heard() == b"\x00\x00"


def test_the_manuals_stream_example_comes_out_byte_by_byte():
    """148 2 29 13 with 549 and 0: 19 5 29 2 37 13 0 and a checksum that makes the sum 0."""
    told = Readings(cliff_front_left_signal=549, virtual_wall=0)
    assert stream_frame(Layout((29, 13), tagged=True).encode(told)) == bytes((19, 5, 29, 2, 37, 13, 0, 151))
    told.cliff_front_left_signal = 2 * 256 + 25
    assert stream_frame(Layout((29, 13), tagged=True).encode(told)) == bytes((19, 5, 29, 2, 25, 13, 0, 163))


def test_the_manuals_led_example_lights_dock_only_in_safe_or_full(make):
    bench = make()
    bench.send(128, 139, 4, 0, 128)
    assert bench.robot.body.interface.actuators.leds == (0, 0, 0)
    bench.send(131, 139, 4, 0, 128)
    assert bench.robot.body.interface.actuators.leds == (4, 0, 128)


def test_the_manuals_schedule_example_is_eaten_whole(awake):
    awake.send(167, 40, 0, 0, 0, 0, 0, 0, 15, 0, 0, 0, 10, 36, 0, 0)
    assert awake.ask(35) == SAFE


# The table of commands -------------------------------------------------------------------------------------------


def test_every_command_of_the_table_has_a_handler_and_no_other():
    assert set(HANDLERS) | set(ACTUATORS) == set(COMMANDS)
    assert not set(HANDLERS) & set(ACTUATORS)


@pytest.mark.parametrize("opcode", sorted(COMMANDS))
def test_every_command_eats_exactly_its_data(make, opcode):
    """After the data the next command is understood, whatever the mode allows."""
    bench = make()
    bench.send(128)
    command = COMMANDS[opcode]
    counted = command.each if command.counted_in is not None else 0
    # A count of 1 where the command counts; else bytes that are no dangerous speed.
    bench.send(opcode, *([1] * command.size), *([0] * counted))
    bench.run(5.0)
    if bench.robot.body.interface.asleep:
        bench.robot.brc.low(True)
        bench.run(0.1)
        bench.robot.brc.low(False)
    bench.port.baudrate = bench.robot.body.interface.baud
    bench.send(128)
    assert bench.robot.body.interface.mode == PASSIVE


@pytest.mark.parametrize("opcode", [147, *range(151, 159), 0, 6, 8, 127, 174, 255])
def test_an_unknown_opcode_is_one_lost_byte(awake, opcode):
    awake.send(opcode)
    assert awake.ask(35) == SAFE


@pytest.mark.parametrize("opcode", sorted(opcode for opcode, command in COMMANDS.items() if command.modes == SF))
def test_an_actuator_command_in_passive_is_taken_and_does_nothing(make, opcode):
    bench = make()
    bench.send(128, opcode, *([100] * COMMANDS[opcode].size))
    bench.run(1.0)
    interface = bench.robot.body.interface
    done = interface.actuators
    assert interface.ignored_commands == 1
    assert (done.left_mm_s, done.brushes, done.leds) == (0, (0, 0, 0), (0, 0, 0))
    assert bench.robot.driven_mm == 0
    assert bench.ask(35) == PASSIVE


def test_a_half_command_waits_for_ever_and_eats_the_next_one(awake):
    awake.send(145, 0, 100)
    awake.run(60)
    awake.send(131, 131)
    assert (awake.ask(41), awake.ask(42)) == (100, -500)  # 0x8383 is far beyond the range and is cut to it


def test_off_hears_only_start_and_reset(make):
    bench = make()
    bench.send(131, 132, 142, 35, 145, 0, 100, 0, 100)
    assert bench.heard() == b""
    assert bench.robot.body.interface.mode == OFF
    bench.send(128)
    assert bench.ask(35) == PASSIVE


def test_stop_ends_the_stream_and_the_interface(awake):
    awake.send(148, 1, 35)
    awake.send(173)
    awake.heard()
    awake.run(1.0)
    assert awake.heard() == b""
    awake.send(142, 35)
    assert awake.heard() == b""


def test_full_stays_full_until_told_otherwise(awake):
    awake.send(132)
    assert awake.ask(35) == FULL
    awake.send(131)
    assert awake.ask(35) == SAFE
    awake.send(128)
    assert awake.ask(35) == PASSIVE


# Driving ---------------------------------------------------------------------------------------------------------


def test_a_drive_command_latches_for_ever(awake):
    awake.drive(100, 100)
    awake.run(10)
    assert awake.robot.driven_mm == pytest.approx(1000, abs=10)


def test_leaving_safe_stops_the_wheels(awake):
    awake.drive(100, 100)
    awake.send(128)
    awake.run(1)
    before = awake.robot.driven_mm
    awake.run(5)
    assert awake.robot.driven_mm == before


@pytest.mark.parametrize(
    ("radius", "left", "right"),
    [(0x8000, 200, 200), (0x7FFF, 200, 200), (1, -200, 200), (0xFFFF, 200, -200), (1000, 176, 224), (0xFC18, 224, 176)],
)
def test_the_radius_says_which_wheel_is_faster(awake, radius, left, right):
    """0xFC18 is −1000: a turn to the right."""
    awake.send(137, 0, 200, *radius.to_bytes(2, "big"))
    assert awake.ask(42) == pytest.approx(left, abs=1)
    assert awake.ask(41) == pytest.approx(right, abs=1)


def test_speeds_beyond_500_are_cut(awake):
    awake.drive(2000, -2000)
    assert (awake.ask(42), awake.ask(41)) == (500, -500)


def test_drive_pwm_is_a_share_of_the_top_speed(awake):
    awake.send(146, 0, 255, 0, 51)
    assert (awake.ask(41), awake.ask(42)) == (500, 100)


# What the firmware does by itself --------------------------------------------------------------------------------


@pytest.mark.parametrize("mode", [131, 132])
def test_a_wheel_drop_ends_safe_but_not_full(make, mode):
    bench = make()
    bench.send(128, mode)
    bench.drive(100, 100)
    bench.robot.lift(True)
    bench.run(0.1)
    expected = (PASSIVE, 0) if mode == 131 else (FULL, 100)
    assert (bench.ask(35), bench.ask(41)) == expected
    assert bench.ask(7) == 0b1100


def test_a_cliff_stops_a_robot_that_drives_forward_in_safe(awake):
    awake.drive(100, 100)
    awake.robot.cliff(True)
    awake.run(0.1)
    assert (awake.ask(35), awake.ask(10), awake.ask(11), awake.ask(9)) == (PASSIVE, 1, 1, 0)


def test_a_cliff_lets_a_robot_back_off_straight(awake):
    awake.robot.cliff(True)
    awake.send(131)
    awake.drive(-100, -100)
    awake.run(1)
    assert awake.ask(35) == SAFE
    assert awake.robot.driven_mm > 80


def test_a_cliff_stops_a_tight_turn_backward(awake):
    awake.robot.cliff(True)
    awake.drive(-100, 0)
    awake.run(0.1)
    assert awake.ask(35) == PASSIVE


def test_a_bump_is_no_reason_for_the_firmware_to_stop(awake):
    awake.drive(100, 100)
    awake.robot.bump("both", 1.0)
    awake.run(0.5)
    assert (awake.ask(35), awake.ask(7), awake.ask(41)) == (SAFE, 0b11, 100)


@pytest.mark.parametrize(("side", "bits"), [("left", 0b10), ("right", 0b01), ("both", 0b11)])
def test_a_bump_has_a_side_and_an_end(awake, side, bits):
    awake.robot.bump(side)
    awake.run(0.1)
    assert awake.ask(7) == bits
    awake.run(0.6)
    assert awake.ask(7) == 0


# Streams ---------------------------------------------------------------------------------------------------------


def test_the_sizes_of_all_groups_are_the_manuals():
    assert {group: Layout((group,), tagged=False).size for group in GROUPS} == SIZES


def test_a_stream_sends_a_sound_frame_every_15_ms(awake):
    awake.send(148, 3, 7, 43, 100)
    awake.heard()
    awake.run(0.6)
    data = awake.heard()
    size = 2 + 1 + 1 + 1 + 2 + 1 + 80 + 1
    assert len(data) == 40 * size
    for frame in (data[i : i + size] for i in range(0, len(data), size)):
        assert (frame[0], frame[1], frame[2], frame[4], frame[7]) == (19, size - 3, 7, 43, 100)
        assert sum(frame) % 256 == 0


def test_a_stream_pauses_and_goes_on_with_its_last_list(awake):
    awake.send(148, 1, 35, 150, 0)
    awake.heard()
    awake.run(1)
    assert awake.heard() == b""
    awake.send(150, 1)
    assert awake.heard().startswith(bytes((19, 2, 35, SAFE)))


def test_a_stream_longer_than_its_slot_gives_only_broken_frames(awake):
    awake.send(148, 3, 100, 100, 100)
    awake.heard()
    awake.run(0.15)
    data = awake.heard()
    assert len(data) == 172 * 10


def test_packet_38_counts_the_streamed_packets(awake):
    awake.send(148, 3, 7, 8, 9, 150, 0)
    assert awake.ask(38) == 3


def test_reading_distance_and_angle_clears_them(awake):
    awake.drive(100, 100)
    awake.run(2)
    awake.drive(0, 0)
    awake.run(1)
    assert awake.ask(19) == pytest.approx(200, abs=4)
    assert awake.ask(19) == 0
    awake.drive(-50, 50)
    awake.run(2)
    awake.drive(0, 0)
    awake.run(1)
    assert awake.ask(20) == pytest.approx(49, abs=2)
    assert awake.ask(20) == 0


def test_an_unknown_packet_is_no_answer(awake):
    awake.send(142, 59)
    assert awake.heard() == b""
    awake.send(149, 3, 59, 35, 200)
    assert awake.heard() == bytes((SAFE,))


def test_every_packet_has_a_place_in_the_big_group():
    assert list(PACKETS) == list(GROUPS[100])
