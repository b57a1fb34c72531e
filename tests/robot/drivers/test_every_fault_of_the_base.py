"""Every switch of the simulated world is tested: those of the base in test_faults_of_*.py, the others elsewhere."""

from robot.simulated import SWITCHES

OF_THE_BASE = {
    "drop_byte",
    "flip_byte",
    "drop_sent_byte",
    "frozen",
    "freeze_s",
    "mode_offset",
    "mode_silent",
    "angle_bug",
    "distance_bug",
    "encoder_offset",
    "capacity_unknown",
    "slow_modes",
    "slow_line",
    "brc_dead",
    "brc_only_wakes",
    "never_sleeps",
    "sleep_after_s",
    "dock_mute",
    "bump_left",
    "bump_right",
    "lights_blind",
    "lights_dazzled",
    "cliff_left",
    "cliff_front_left",
    "cliff_front_right",
    "cliff_right",
    "wheel_drop_left",
    "wheel_drop_right",
    "over_current",
    "stuck",
    "slip",
    "slipping",
    "wheels_jammed",
    "virtual_wall",
    "dock_beams_off",
    "dock_unpowered",
    "contact_bounce",
    "charge_fault",
}
ELSEWHERE = {
    "floor_flip",
    "floor_edge_mm",
    "pins_stuck",
    "camera_dead",
    "camera_frozen",
    "darkness",
    "dirt",
    "under_voltage",
    "clock_jump",
    "disk_full",
}


def test_every_switch_is_the_bases_or_another_devices() -> None:
    """A new switch has to be put into one of the two lists, and tested there."""
    assert set(SWITCHES) == OF_THE_BASE | ELSEWHERE
