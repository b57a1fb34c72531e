"""The fault table, fault by fault: what stops the wheels, and what lets them go again."""

from dataclasses import replace

import pytest

from robot.drivers.interfaces import STOP, BaseState, HostReport, LineReading, WheelSpeeds
from robot.reflexes import BACK_OFF, FAULTS, LATCHED, Lasting, ReflexState, Response, Senses, decide

WANTED = WheelSpeeds(150, 150)
FINE = Senses(base=BaseState(at_s=0.0), base_age_s=0.01, mind_age_s=0.1)


class Reflexes:
    """Steps through time and keeps the last decision."""

    def __init__(self) -> None:
        self.state, self.now = ReflexState(), 0.0
        self.faults: frozenset[str] = frozenset()

    def feel(self, senses: Senses, for_s: float = 0.0, wanted: WheelSpeeds = WANTED) -> WheelSpeeds:
        until = self.now + for_s
        while True:
            decision = decide(self.state, senses, wanted, self.now)
            self.state, self.faults = decision.state, decision.faults
            self.now = round(self.now + 0.02, 6)
            if self.now > until:
                return decision.allowed


def base(**fields: object) -> Senses:
    return replace(FINE, base=BaseState(at_s=0.0, **fields))  # type: ignore[arg-type]


CAUSES = {
    "emergency_stop": base(buttons=0b001),
    "wheel_drop": base(wheel_drop_left=True),
    "cliff": base(cliff_front_right=True),
    "base_silent": replace(FINE, base_age_s=0.6),
    "agent_silent": replace(FINE, mind_age_s=1.1),
    "over_current": base(over_currents=0b10000),
    "bump": base(bump_left=True),
    "camera_stale": replace(FINE, camera_age_s=1.5),
    "camera_frozen": replace(FINE, camera_frozen_s=1.5),
    "camera_lost": replace(FINE, camera_age_s=61.0),
    "stall": replace(FINE, standing=True),
    "stasis": replace(FINE, slipping_s=2.1),
    "virtual_wall": base(ir_omni=162),
    "line_sensor": replace(FINE, constant_mm=3100.0, sees_line=True),
    "battery_critical": base(charge_mah=90, capacity_mah=1000),
    "under_voltage": replace(FINE, host=HostReport(under_voltage=True)),
    "clock_jump": replace(FINE, host=HostReport(clock_jumped=True)),
    "disk_low": replace(FINE, host=HostReport(disk_low=True)),
    "link_loss": replace(FINE, offline_s=11.0),
}
ROWS = {fault.name: fault for fault in FAULTS}


def test_every_fault_of_the_table_is_tested_here():
    assert set(CAUSES) == {fault.name for fault in FAULTS}


def test_without_a_fault_everything_wanted_is_allowed():
    assert Reflexes().feel(FINE, 5.0) == WANTED


@pytest.mark.parametrize("name", sorted(CAUSES))
def test_each_counts_when_it_has_lasted_as_long_as_the_table_says_and_then_does_what_it_says(name: str):
    reflexes, row = Reflexes(), ROWS[name]
    if row.after_s:
        assert reflexes.feel(CAUSES[name], row.after_s - 0.04) == WANTED
    allowed = reflexes.feel(CAUSES[name], 0.04)
    assert reflexes.faults == {name}
    assert allowed == (WANTED if row.response is Response.NOTHING else STOP)


@pytest.mark.parametrize("name", sorted(set(CAUSES) - LATCHED))
def test_each_is_over_when_the_cause_has_been_gone_for_as_long_as_the_table_says(name: str):
    reflexes, row = Reflexes(), ROWS[name]
    clears_s = row.clears_s or 0.0
    reflexes.feel(CAUSES[name], row.after_s + 1.0)
    if clears_s:
        reflexes.feel(FINE, clears_s - 0.1)
        assert reflexes.faults == {name}
    assert reflexes.feel(FINE, 0.2) == WANTED
    assert reflexes.faults == frozenset()


def test_a_moment_that_is_shorter_than_the_table_allows_for_is_forgotten():
    reflexes = Reflexes()
    for _ in range(10):
        assert reflexes.feel(CAUSES["over_current"], 0.4) == WANTED
        reflexes.feel(FINE)
    assert reflexes.faults == frozenset()


def test_a_bump_stands_backs_off_once_and_waits():
    reflexes = Reflexes()
    assert reflexes.feel(CAUSES["bump"], 0.1) == STOP
    assert reflexes.feel(CAUSES["bump"], 0.2) == BACK_OFF
    assert reflexes.feel(CAUSES["bump"], 0.7) == BACK_OFF
    assert reflexes.feel(CAUSES["bump"], 3.0) == STOP, "who keeps pushing does not push it back for ever"


def test_a_virtual_wall_lets_it_turn_and_go_back():
    reflexes, wall = Reflexes(), CAUSES["virtual_wall"]
    assert reflexes.feel(wall, wanted=WheelSpeeds(0, 60)) == STOP, "a bend leads forward, too"
    for free in (WheelSpeeds(-80, 80), WheelSpeeds(-100, -100)):
        assert reflexes.feel(wall, wanted=free) == free


@pytest.mark.parametrize("name", sorted(CAUSES))
def test_while_the_firmware_docks_only_what_the_table_says_takes_the_wheels_from_it(name: str):
    docking = replace(CAUSES[name], own_wheels=False)
    decision = decide(ReflexState(), docking, WANTED, 0.0)
    for now in (1.0, 2.0, 3.0, 4.0):
        decision = decide(decision.state, docking, WANTED, now)
    assert decision.stopping == ({name} if ROWS[name].from_firmware else set())


def test_before_a_drop_it_does_not_even_back_off():
    reflexes = Reflexes()
    reflexes.feel(base(bump_left=True, cliff_left=True), 0.4)
    assert reflexes.feel(base(bump_left=True, cliff_left=True)) == STOP


@pytest.mark.parametrize("name", sorted(LATCHED))
def test_what_only_a_person_can_judge_is_latched_until_somebody_rearms_the_robot(name: str):
    reflexes = Reflexes()
    reflexes.feel(CAUSES[name])
    assert reflexes.feel(FINE, 60.0) == STOP
    assert reflexes.feel(replace(FINE, rearm=True)) == WANTED
    assert reflexes.feel(FINE, 1.0) == WANTED


def test_rearming_does_not_help_while_the_button_is_held():
    reflexes = Reflexes()
    reflexes.feel(CAUSES["emergency_stop"])
    assert reflexes.feel(replace(CAUSES["emergency_stop"], rearm=True)) == STOP


def test_what_was_latched_before_a_restart_still_is_and_nothing_else():
    woken = ReflexState.woken(set(CAUSES), 100.0)
    decision = decide(woken, FINE, WANTED, 100.1)
    assert decision.faults == LATCHED
    assert decision.allowed == STOP


def test_a_nearly_empty_battery_does_not_go_on_because_it_recovers_while_it_rests():
    reflexes = Reflexes()
    under_load = base(voltage_mv=12_400)
    rested = base(voltage_mv=12_900)
    assert reflexes.feel(under_load, 3.1) == STOP
    assert reflexes.feel(rested, 60.0) == STOP
    assert reflexes.feel(base(voltage_mv=13_300), 5.2) == WANTED


@pytest.mark.parametrize(
    "why",
    [
        base(charge_mah=10, capacity_mah=1000, home_base=True),
        base(charge_mah=10, capacity_mah=1000, internal_charger=True),
        base(charge_mah=0, capacity_mah=0, voltage_mv=0),
    ],
    ids=["on its dock", "at a charger", "a base that does not know yet"],
)
def test_no_battery_is_critical_while(why: Senses):
    assert Reflexes().feel(why, 10.0) == WANTED


def test_no_line_for_metres_is_no_broken_sensor_until_every_search_is_over():
    assert Reflexes().feel(replace(FINE, constant_mm=14_000.0)) == WANTED
    assert Reflexes().feel(replace(FINE, constant_mm=15_100.0)) == STOP


@pytest.mark.parametrize("senses", [replace(FINE, diodes_broken=True), replace(FINE, impossible_mm=301.0)])
def test_a_sensor_that_cannot_be_read_or_says_what_cannot_be_stops_the_robot(senses: Senses):
    reflexes = Reflexes()
    assert reflexes.feel(senses) == STOP
    assert reflexes.faults == {"line_sensor"}


def test_each_fault_has_a_sentence_for_people_and_a_time_within_which_the_wheels_stand():
    assert all(fault.told.endswith(".") for fault in FAULTS)
    assert all((fault.stands_within_s is None) == (fault.response is Response.NOTHING) for fault in FAULTS)


def test_slipping_counts_from_the_last_change_of_what_it_saw() -> None:
    lasting = Lasting()
    turning = [BaseState(at_s=at_s, left_count=100 * at_s, right_count=100 * at_s) for at_s in range(4)]
    lasting.feel(turning[0], replace(turning[1], stasis=0b01), WANTED)
    lasting.feel(turning[1], turning[2], WANTED)
    assert lasting.slipping_s == 1.0
    lasting.look(LineReading(left=False, centre=True, right=False), 150.0, None)
    assert lasting.slipping_s == 0.0
    lasting.feel(turning[2], turning[3], WANTED)
    assert lasting.slipping_s == 1.0
