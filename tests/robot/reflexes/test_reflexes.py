"""The fault table, fault by fault: what stops the wheels, and what lets them go again."""

from dataclasses import replace

import pytest

from robot.drivers.interfaces import STOP, BaseState, WheelSpeeds
from robot.reflexes import BACK_OFF, FAULTS, LATCHED, ReflexState, Senses, decide

WANTED = WheelSpeeds(150, 150)
FINE = Senses(base=BaseState(at_s=0.0), base_age_s=0.01, mind_age_s=0.1)


class Reflexes:
    """Steps through time and keeps the last decision."""

    def __init__(self) -> None:
        self.state, self.now = ReflexState(), 0.0
        self.faults: frozenset[str] = frozenset()

    def feel(self, senses: Senses, for_s: float = 0.0) -> WheelSpeeds:
        until = self.now + for_s
        while True:
            decision = decide(self.state, senses, WANTED, self.now)
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
}


def test_every_fault_of_the_table_is_tested_here():
    assert set(CAUSES) == {fault.name for fault in FAULTS}


def test_without_a_fault_everything_wanted_is_allowed():
    assert Reflexes().feel(FINE, 5.0) == WANTED


@pytest.mark.parametrize("name", sorted(set(CAUSES) - {"camera_stale", "over_current"}))
def test_it_stops_at_once(name: str):
    reflexes = Reflexes()
    assert reflexes.feel(CAUSES[name]) == STOP
    assert reflexes.faults == {name}


@pytest.mark.parametrize(("name", "clears_s"), [("over_current", 2.0), ("bump", 3.0)])
def test_it_stands_until_the_cause_has_been_gone_for_a_while(name: str, clears_s: float):
    reflexes = Reflexes()
    reflexes.feel(CAUSES[name], 1.0)
    reflexes.feel(FINE, clears_s - 0.1)
    assert reflexes.faults == {name}
    assert reflexes.feel(FINE, 0.2) == WANTED
    assert reflexes.faults == frozenset()


@pytest.mark.parametrize("name", ["base_silent", "agent_silent"])
def test_a_silence_is_over_with_the_first_word(name: str):
    reflexes = Reflexes()
    reflexes.feel(CAUSES[name], 3.0)
    assert reflexes.feel(FINE) == WANTED


def test_an_over_current_counts_after_half_a_second():
    reflexes = Reflexes()
    assert reflexes.feel(CAUSES["over_current"], 0.4) == WANTED
    assert reflexes.feel(CAUSES["over_current"], 0.2) == STOP


def test_a_bump_stands_backs_off_once_and_waits():
    reflexes = Reflexes()
    assert reflexes.feel(CAUSES["bump"], 0.1) == STOP
    assert reflexes.feel(CAUSES["bump"], 0.2) == BACK_OFF
    assert reflexes.feel(CAUSES["bump"], 0.7) == BACK_OFF
    assert reflexes.feel(CAUSES["bump"], 3.0) == STOP, "who keeps pushing does not push it back for ever"


def test_while_the_firmware_docks_a_touch_is_no_accident():
    assert Reflexes().feel(replace(CAUSES["bump"], own_wheels=False)) == WANTED


def test_before_a_drop_it_does_not_even_back_off():
    reflexes = Reflexes()
    reflexes.feel(base(bump_left=True, cliff_left=True), 0.4)
    assert reflexes.feel(base(bump_left=True, cliff_left=True)) == STOP


@pytest.mark.parametrize("name", ["emergency_stop", "wheel_drop", "cliff"])
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


def test_a_dead_camera_is_told_but_stops_nothing():
    reflexes = Reflexes()
    assert reflexes.feel(CAUSES["camera_stale"]) == WANTED
    assert reflexes.faults == {"camera_stale"}


def test_each_fault_has_a_sentence_for_people():
    assert all(fault.told.endswith(".") for fault in FAULTS)
