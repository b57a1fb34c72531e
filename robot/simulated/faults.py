"""Faults, as switches. Everything is off at first; `python -m robot.simulated` and the door list them."""

from dataclasses import dataclass, fields
from typing import Any

from robot.simulated.errors import UnknownSwitch, WrongValue


@dataclass
class Faults:
    """The present position of every switch. The table SWITCHES says what each does."""

    drop_byte: float = 0.0
    flip_byte: float = 0.0
    drop_sent_byte: float = 0.0
    frozen: bool = False
    freeze_s: float = 0.0
    mode_offset: int = 0
    mode_silent: bool = False
    angle_bug: bool = False
    distance_bug: bool = False
    encoder_offset: int = 0
    capacity_unknown: bool = False
    slow_modes: bool = False
    slow_line: bool = False
    brc_dead: bool = False
    brc_only_wakes: bool = False
    never_sleeps: bool = False
    sleep_after_s: float = 0.0
    dock_mute: bool = False
    bump_left: bool = False
    bump_right: bool = False
    lights_blind: bool = False
    lights_dazzled: bool = False
    cliff_left: bool = False
    cliff_front_left: bool = False
    cliff_front_right: bool = False
    cliff_right: bool = False
    wheel_drop_left: bool = False
    wheel_drop_right: bool = False
    over_current: bool = False
    stuck: bool = False
    slipping: bool = False
    slip: float = 0.0
    wheels_jammed: bool = False
    virtual_wall: bool = False
    dock_beams_off: bool = False
    dock_unpowered: bool = False
    contact_bounce: bool = False
    charge_fault: bool = False
    floor_flip: float = 0.0
    floor_edge_mm: float = 0.0
    pins_stuck: bool = False
    camera_dead: bool = False
    camera_frozen: bool = False
    darkness: float = 0.0
    dirt: float = 0.0
    under_voltage: bool = False
    clock_jump: bool = False
    disk_full: bool = False

    def set(self, name: object, value: Any) -> None:
        """Raises UnknownSwitch or WrongValue; a switch never takes a value that it cannot mean."""
        if not isinstance(name, str) or name not in SWITCHES:
            raise UnknownSwitch("fault", name, SWITCHES)
        kind = type(getattr(Faults, name))
        setattr(self, name, _checked(name, kind, value))

    def on(self) -> dict[str, float | bool]:
        """The switches that are not in their resting position."""
        present = {row.name: getattr(self, row.name) for row in fields(self)}
        return {name: value for name, value in present.items() if value != getattr(Faults, name)}


LARGEST = {"_mm": 10.0, "_s": 3600.0}
"""By the unit in its name; chances and shares end at 1."""


def _checked(name: str, kind: type, value: Any) -> Any:
    is_number = isinstance(value, int | float) and not isinstance(value, bool)
    if kind is bool and isinstance(value, bool):
        return value
    if kind is int and isinstance(value, int) and not isinstance(value, bool):
        return value
    most = next((most for ending, most in LARGEST.items() if name.endswith(ending)), 1.0)
    if kind is float and is_number and 0 <= value <= most:
        return float(value)
    expected = {bool: "true or false", int: "a whole number", float: f"a number from 0 to {most:g}"}
    raise WrongValue(name, value, expected[kind])


SWITCHES: dict[str, str] = {
    "drop_byte": "chance that a byte from the robot is lost",
    "flip_byte": "chance that one bit of a byte from the robot is turned over",
    "drop_sent_byte": "chance that a byte to the robot is lost",
    "frozen": "the robot neither hears nor says anything; its wheels go on",
    "freeze_s": "the robot is frozen for so many seconds from now on",
    "mode_offset": "added to the mode that packet 35 tells (some report one more, one was seen at 32)",
    "mode_silent": "no answer and no stream that holds packet 35 ever comes (old firmware)",
    "angle_bug": "packet 20 is too small by the factor of firmware up to 3.4.0",
    "distance_bug": "packet 19 tells a tenth of the way (firmware before 3.3.0 told it wrong; how is assumed)",
    "encoder_offset": "added to both encoder counts, as after a reset of the base",
    "capacity_unknown": "packet 26 reads 0, as just after a start of the firmware",
    "slow_modes": "what comes within 20 ms after a change of mode is lost (older manuals warn of it)",
    "slow_line": "the robot speaks at 19200 baud until it is told another speed (Clean was held at power-off)",
    "brc_dead": "pulses on the BRC pin have no effect",
    "brc_only_wakes": "pulses on the BRC pin wake, but do not keep awake (firmware 3.2.6)",
    "never_sleeps": "Passive mode does not fall asleep after five minutes",
    "sleep_after_s": "Passive mode falls asleep after so many seconds and not after 300",
    "dock_mute": "after 30 s on the dock the robot hears nothing but Reset (some of the 600 series)",
    "bump_left": "the left half of the bumper is pressed",
    "bump_right": "the right half of the bumper is pressed",
    "lights_blind": "the light bumpers see nothing, as of dark clothes",
    "lights_dazzled": "all light bumpers see something, as in low sun",
    "cliff_left": "the left cliff sensor sees no floor",
    "cliff_front_left": "the front left cliff sensor sees no floor",
    "cliff_front_right": "the front right cliff sensor sees no floor",
    "cliff_right": "the right cliff sensor sees no floor",
    "wheel_drop_left": "the left wheel hangs down",
    "wheel_drop_right": "the right wheel hangs down",
    "over_current": "both wheel motors report over-current",
    "stuck": "the wheels turn and count, the robot does not move (stasis reads 0)",
    "slipping": "the wheels turn freely and count, the robot does not move, no motor notices (stasis reads 0)",
    "slip": "share of what the wheels turn and count that is lost on the floor, ahead and in turns",
    "wheels_jammed": "no wheel turns, whatever it is told",
    "virtual_wall": "the virtual wall beam is seen",
    "dock_beams_off": "the docks send no infrared",
    "dock_unpowered": "the docks have no mains",
    "contact_bounce": "the charging contacts lose touch again and again",
    "charge_fault": "the charger reports a fault (state 5) and does not charge",
    "floor_flip": "chance that a line diode reads the opposite of what is under it",
    "floor_edge_mm": "width of the reflecting tape edge in which a diode reads by chance, in mm",
    "pins_stuck": "the line pins keep their last value",
    "camera_dead": "the camera gives no frame",
    "camera_frozen": "the camera gives the same picture again and again",
    "darkness": "share of the light that is missing",
    "dirt": "share of every marker that is covered by dirt",
    "under_voltage": "the robot's computer gets too little voltage",
    "clock_jump": "the clock of the robot's computer is an hour ahead",
    "disk_full": "the disk of the robot's computer has hardly any room",
}
