"""Charging that is not what it should be, and docks that do not help."""

import pytest

from robot.drivers.interfaces import ChargingState, Mode
from tests.robot.drivers.against_the_byte_machine import Join

RESET = 7


def test_a_capacity_that_is_not_known_yet_is_no_ratio(join: Join) -> None:
    one = join().started()
    one.robot.set_fault("capacity_unknown", True)
    one.run(0.1)
    assert one.base.state is not None and one.base.state.battery_ratio is None


def test_a_battery_that_sags_is_told_at_once(join: Join) -> None:
    one = join(battery_ratio=0.9).started()
    one.robot.sag(0.08)
    one.run(0.1)
    assert one.base.state is not None and one.base.state.battery_ratio == pytest.approx(0.08, abs=0.01)


def test_a_faulty_charger_is_no_charging(join: Join) -> None:
    one = join("dock", battery_ratio=0.5)
    one.robot.set_fault("charge_fault", True)
    one.run(5.0)
    assert one.base.state is not None
    assert one.base.state.charging_state is ChargingState.FAULT and not one.base.state.charging


def test_a_dock_without_mains_is_no_dock(join: Join) -> None:
    one = join("dock", battery_ratio=0.5)
    one.robot.set_fault("dock_unpowered", True)
    one.run(5.0)
    assert one.base.state is not None and not one.base.state.docked and not one.base.state.charging


def test_bouncing_contacts_show_as_they_are_and_passive_is_kept(join: Join) -> None:
    one = join("dock", battery_ratio=0.5)
    one.run(1.0)
    one.robot.set_fault("contact_bounce", True)
    one.states.clear()
    one.take_sent()
    one.run(10.0)
    assert {state.docked for state in one.states} == {True, False}
    assert one.take_sent() == b"", "nothing is sent that would end the charge"


def test_seek_dock_without_beams_ends_with_wheels_that_stand_in_passive(join: Join) -> None:
    one = join("post5").started()
    one.robot.set_fault("dock_beams_off", True)
    one.base.seek_dock(one.now)
    one.run(70.0)
    assert one.base.state is not None and one.base.state.mode is Mode.PASSIVE
    assert not one.base.state.docked and one.base.state.ir_omni == 0
    assert max(map(abs, one.wheels_mm_s)) == 0


def test_a_base_that_is_deaf_in_its_dock_is_reset(join: Join) -> None:
    one = join("dock", battery_ratio=0.5)
    one.robot.set_fault("dock_mute", True)
    one.run(31.0)
    frames = one.base.health.frames
    one.robot.set_fault("dock_mute", False)
    one.run(2.0)
    assert one.base.health.frames == frames
    one.take_sent()
    assert one.after_s(40.0) < 20
    assert bytes((RESET,)) in one.take_sent()
    one.run(0.1)
    assert one.base.health.awoken_by == "reset" and one.base.health.firmware == "3.7.7"
