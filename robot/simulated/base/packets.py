"""The sensor packets as data, and how they become bytes.

Source of ids, sizes and groups: iRobot Create 2 Open Interface Specification, rev. 2016-08-10. All numbers are
big-endian; `struct` codes: B u8, b i8, H u16, h i16.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from operator import attrgetter
from struct import Struct


@dataclass(slots=True)
class Readings:
    """The robot's readings now, packet by packet, in the packets' own units."""

    bumps_wheel_drops: int = 0
    wall: int = 0
    cliff_left: int = 0
    cliff_front_left: int = 0
    cliff_front_right: int = 0
    cliff_right: int = 0
    virtual_wall: int = 0
    over_currents: int = 0
    dirt_detect: int = 0
    unused: int = 0
    ir_omni: int = 0
    buttons: int = 0
    distance_mm: int = 0
    angle_deg: int = 0
    charging_state: int = 0
    voltage_mv: int = 0
    current_ma: int = 0
    temperature_c: int = 25
    charge_mah: int = 0
    capacity_mah: int = 0
    wall_signal: int = 0
    cliff_left_signal: int = 2800
    cliff_front_left_signal: int = 2800
    cliff_front_right_signal: int = 2800
    cliff_right_signal: int = 2800
    charger_available: int = 0
    oi_mode: int = 0
    song_number: int = 0
    song_playing: int = 0
    stream_packets: int = 0
    velocity_mm_s: int = 0
    radius_mm: int = 0
    right_velocity_mm_s: int = 0
    left_velocity_mm_s: int = 0
    left_encoder: int = 0
    right_encoder: int = 0
    light_bumper: int = 0
    light_left: int = 0
    light_front_left: int = 0
    light_centre_left: int = 0
    light_centre_right: int = 0
    light_front_right: int = 0
    light_right: int = 0
    ir_left: int = 0
    ir_right: int = 0
    left_motor_ma: int = 0
    right_motor_ma: int = 0
    main_brush_ma: int = 0
    side_brush_ma: int = 0
    stasis: int = 0


# id → (field of Readings, struct code)
PACKETS: dict[int, tuple[str, str]] = {
    7: ("bumps_wheel_drops", "B"),
    8: ("wall", "B"),
    9: ("cliff_left", "B"),
    10: ("cliff_front_left", "B"),
    11: ("cliff_front_right", "B"),
    12: ("cliff_right", "B"),
    13: ("virtual_wall", "B"),
    14: ("over_currents", "B"),
    15: ("dirt_detect", "B"),
    16: ("unused", "B"),
    17: ("ir_omni", "B"),
    18: ("buttons", "B"),
    19: ("distance_mm", "h"),
    20: ("angle_deg", "h"),
    21: ("charging_state", "B"),
    22: ("voltage_mv", "H"),
    23: ("current_ma", "h"),
    24: ("temperature_c", "b"),
    25: ("charge_mah", "H"),
    26: ("capacity_mah", "H"),
    27: ("wall_signal", "H"),
    28: ("cliff_left_signal", "H"),
    29: ("cliff_front_left_signal", "H"),
    30: ("cliff_front_right_signal", "H"),
    31: ("cliff_right_signal", "H"),
    32: ("unused", "B"),
    33: ("unused", "H"),
    34: ("charger_available", "B"),
    35: ("oi_mode", "B"),
    36: ("song_number", "B"),
    37: ("song_playing", "B"),
    38: ("stream_packets", "B"),
    39: ("velocity_mm_s", "h"),
    40: ("radius_mm", "h"),
    41: ("right_velocity_mm_s", "h"),
    42: ("left_velocity_mm_s", "h"),
    43: ("left_encoder", "H"),
    44: ("right_encoder", "H"),
    45: ("light_bumper", "B"),
    46: ("light_left", "H"),
    47: ("light_front_left", "H"),
    48: ("light_centre_left", "H"),
    49: ("light_centre_right", "H"),
    50: ("light_front_right", "H"),
    51: ("light_right", "H"),
    52: ("ir_left", "B"),
    53: ("ir_right", "B"),
    54: ("left_motor_ma", "h"),
    55: ("right_motor_ma", "h"),
    56: ("main_brush_ma", "h"),
    57: ("side_brush_ma", "h"),
    58: ("stasis", "B"),
}
# Group id → the packets in it, in order.
GROUPS: dict[int, range] = {
    0: range(7, 27),
    1: range(7, 17),
    2: range(17, 21),
    3: range(21, 27),
    4: range(27, 35),
    5: range(35, 43),
    6: range(7, 43),
    100: range(7, 59),
    101: range(43, 59),
    106: range(46, 52),
    107: range(54, 59),
}
DISTANCE, ANGLE, OI_MODE = 19, 20, 35


def members(packet: int) -> tuple[int, ...]:
    """The single packets that `packet` stands for: itself, a group's own, or none for an unknown id."""
    if packet in GROUPS:
        return tuple(GROUPS[packet])
    return (packet,) if packet in PACKETS else ()


class Layout:
    """A list of packet ids, compiled once so that a frame costs a few microseconds.

    With `tagged` every id of the list stands before its data, as a stream has it; without, only data, as an answer to
    Sensors or Query List has it.
    """

    def __init__(self, ids: Iterable[int], *, tagged: bool) -> None:
        self.ids = tuple(packet for packet in ids if members(packet))
        template: list[int] = []
        codes, self._slots = "", list[int]()
        for packet in self.ids:
            if tagged:
                template.append(packet)
                codes += "B"
            for member in members(packet):
                self._slots.append(len(template))
                template.append(0)
                codes += PACKETS[member][1]
        self._template = template
        self._struct = Struct(">" + codes)
        singles = [member for packet in self.ids for member in members(packet)]
        self.size = self._struct.size
        self.takes_distance = DISTANCE in singles
        self.takes_angle = ANGLE in singles
        self.tells_mode = OI_MODE in singles
        # One name more than needed: attrgetter gives a tuple only for two names and more.
        self._values = attrgetter("unused", "unused", *(PACKETS[member][0] for member in singles))

    def encode(self, readings: Readings) -> bytes:
        values = self._values(readings)
        numbers = self._template.copy()
        for slot, value in zip(self._slots, values[2:], strict=True):
            numbers[slot] = value
        return self._struct.pack(*numbers)


def stream_frame(body: bytes) -> bytes:
    """`19 | N | body | checksum`; all bytes together sum to 0 modulo 256."""
    start = bytes((19, len(body) & 0xFF)) + body
    return start + bytes((-sum(start) & 0xFF,))
