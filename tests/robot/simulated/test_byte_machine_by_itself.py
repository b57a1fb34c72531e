"""Text on the line, reset, sleep, songs and buttons: what the base does by itself."""

import re

import pytest

OFF, PASSIVE, SAFE, FULL = range(4)


def test_reset_prints_the_boot_text_and_hears_nothing_meanwhile(awake):
    awake.send(7)
    awake.run(2)
    assert awake.heard() == b"Soft reset!\n\xfe"
    awake.send(128)
    awake.run(2.5)
    text = awake.heard().decode("ascii")
    assert text.startswith("Roomba by iRobot!\r\n")
    assert re.search(r"release-(?:stm32-)?(\d+)\.(\d+)\.(\d+)", text)
    assert awake.robot.body.interface.mode == OFF
    awake.send(128)
    assert awake.ask(35) == PASSIVE


def test_a_charging_robot_prints_a_battery_line_a_second_until_it_is_started(make):
    bench = make("dock", battery_ratio=0.5)
    bench.run(10)
    begins, check, *lines = bench.heard().decode("ascii").splitlines()
    assert (begins, check) == ("Performing charger self-test", "do-charging-full @ min 0")
    assert len(lines) == 10
    assert re.fullmatch(r"bat:   min 0  sec 8  mV \d+  mA 1250  tenths-deg-C \d+  mAH \d+  state 8  mode 7", lines[-1])
    bench.send(128)
    bench.heard()
    bench.run(5)
    assert bench.heard() == b""


@pytest.mark.slow
def test_five_idle_minutes_in_passive_send_the_robot_to_sleep_even_while_it_is_polled(make):
    bench = make()
    bench.send(128)
    for _ in range(299):
        bench.run(0.98)
        bench.send(142, 35)
    assert len(bench.heard()) == 299
    bench.run(10)
    assert bench.heard() == b"processor-sleep\r\n"
    bench.send(128, 142, 35)
    assert bench.heard() == b""


def test_a_low_pulse_on_brc_wakes_the_robot_into_off(make):
    bench = make()
    bench.send(128)
    bench.run(301)
    bench.heard()
    bench.robot.brc.low(True)
    bench.run(0.03)
    bench.robot.brc.low(False)
    assert bench.robot.body.interface.asleep, "30 ms are too short"
    bench.robot.brc.low(True)
    bench.run(0.5)
    bench.robot.brc.low(False)
    bench.run(0.02)
    assert bench.heard().startswith(b"key-wakeup\r\nslept for 0 minutes 1")
    bench.send(128)
    assert bench.ask(35) == PASSIVE


@pytest.mark.slow
def test_pulses_on_brc_keep_a_passive_robot_awake(make):
    bench = make()
    bench.send(128)
    for _ in range(8):
        bench.run(60)
        bench.robot.brc.low(True)
        bench.run(1)
        bench.robot.brc.low(False)
    assert bench.ask(35) == PASSIVE


@pytest.mark.slow
def test_a_dead_brc_wakes_nobody(make):
    bench = make()
    bench.robot.set_fault("brc_dead", True)
    bench.send(128)
    bench.run(301)
    bench.robot.brc.low(True)
    bench.run(1)
    bench.robot.brc.low(False)
    assert bench.robot.body.interface.asleep


@pytest.mark.parametrize("mode", [131, 132])
@pytest.mark.nightly
def test_safe_and_full_never_sleep(make, mode):
    bench = make()
    bench.send(128, mode)
    bench.run(400)
    assert bench.ask(35) == mode - 129


def test_power_sleeps_at_once(awake):
    awake.send(133)
    assert awake.robot.body.interface.asleep


# Songs and buttons -----------------------------------------------------------------------------------------------


def test_a_song_plays_for_its_length_and_is_not_interrupted(awake):
    awake.send(140, 3, 2, 60, 32, 64, 32, 140, 1, 1, 70, 16)
    awake.send(141, 3)
    awake.run(0.5)
    awake.send(141, 1)
    assert (awake.ask(36), awake.ask(37)) == (3, 1)
    awake.run(0.6)
    assert awake.ask(37) == 0
    assert awake.robot.body.interface.actuators.songs.played == [3]


def test_a_song_is_written_in_passive_but_plays_only_in_safe(make):
    bench = make()
    bench.send(128, 140, 0, 1, 60, 64, 141, 0)
    assert bench.ask(37) == 0
    bench.send(131, 141, 0)
    assert bench.ask(37) == 1


def test_the_dock_button_starts_the_search_in_passive_and_is_only_reported_in_safe(make):
    bench = make()
    bench.send(128, 131, 165, 4)
    assert (bench.ask(18), bench.ask(35)) == (4, SAFE)
    bench.run(0.2)
    assert bench.ask(18) == 0
    bench.send(128, 165, 4)
    bench.run(1)
    assert bench.robot.driven_mm > 50


def test_a_cleaning_cycle_drives_and_a_second_press_pauses_it(make):
    bench = make()
    bench.send(128, 135)
    bench.run(2)
    driven = bench.robot.driven_mm
    assert driven > 200
    bench.send(143)
    bench.run(1)
    driven = bench.robot.driven_mm
    bench.run(2)
    assert bench.robot.driven_mm == driven


def test_the_wrong_baud_gives_garbage_both_ways(awake):
    awake.send(129, 7)
    awake.run(0.1)
    awake.send(142, 35)
    assert awake.heard() != bytes((SAFE,))
    awake.port.baudrate = 19200
    awake.port.reset_input_buffer()
    awake.send(142, 35)
    assert awake.heard() == bytes((SAFE,))
