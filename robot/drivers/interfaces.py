"""One door per device: what the robot asks of its base, line sensor and camera, and what they answer.

Behind each door is the real device; the simulated world works behind the real drivers, with bytes, pins and frames.
Lengths are millimetres, times are seconds of the daemon's clock. Left and right are the robot's own.
"""

from dataclasses import dataclass, field
from enum import IntEnum
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

Frame = NDArray[np.uint8]
"""A picture: height × width (grey) or height × width × 3 (BGR)."""


class WheelSpeeds(NamedTuple):
    """Speeds of both wheels in mm/s; positive is forward."""

    left_mm_s: float
    right_mm_s: float

    @property
    def still(self) -> bool:
        return self.left_mm_s == 0 and self.right_mm_s == 0


STOP = WheelSpeeds(0, 0)


class Mode(IntEnum):
    """The mode of the base (packet 35). UNKNOWN is whatever odd number a firmware reports."""

    OFF = 0
    PASSIVE = 1
    SAFE = 2
    FULL = 3
    UNKNOWN = -1


AHEAD_LIGHTS = 0b011110
# Not the outermost two: they look to the sides, and every wall that the robot passes closely shines back. The next two
# look half ahead: a wall along the way comes into their sight only where the bumper all but scrapes it.
VIRTUAL_WALL_IR = 162
"""The character that a virtual wall sends (packets 17, 52, 53)."""


class ChargingState(IntEnum):
    """Packet 21; values outside the manual count as FAULT."""

    NOT_CHARGING = 0
    RECONDITIONING = 1
    FULL_CHARGING = 2
    TRICKLE = 3
    WAITING = 4
    FAULT = 5

    @property
    def takes_current(self) -> bool:
        return self in (ChargingState.RECONDITIONING, ChargingState.FULL_CHARGING, ChargingState.TRICKLE)


@dataclass(frozen=True, slots=True)
class BaseState:
    """One frame of the base. Counts are encoder counts modulo 65536 as signed numbers; see `odometry`."""

    at_s: float
    left_count: int = 0
    right_count: int = 0
    bump_left: bool = False
    bump_right: bool = False
    wheel_drop_left: bool = False
    wheel_drop_right: bool = False
    cliff_left: bool = False
    cliff_front_left: bool = False
    cliff_front_right: bool = False
    cliff_right: bool = False
    over_currents: int = 0
    """Bits: 0 side brush, 2 main brush, 3 right wheel, 4 left wheel."""
    buttons: int = 0
    """Bits: 0 Clean, 1 Spot, 2 Dock."""
    light_bumpers: int = 0
    """Bits: 0 left, 1 front left, 2 centre left, 3 centre right, 4 front right, 5 right."""
    charging_state: ChargingState = ChargingState.NOT_CHARGING
    home_base: bool = False
    internal_charger: bool = False
    mode: Mode = Mode.PASSIVE
    song_playing: bool = False
    voltage_mv: int = 0
    current_ma: int = 0
    temperature_c: int = 0
    charge_mah: int = 0
    capacity_mah: int = 0
    ir_omni: int = 0
    ir_left: int = 0
    ir_right: int = 0
    left_motor_ma: int = 0
    right_motor_ma: int = 0
    stasis: int = 0

    @property
    def bump(self) -> bool:
        return self.bump_left or self.bump_right

    @property
    def something_ahead(self) -> bool:
        """The light bumpers see something close before the robot; dark things they overlook."""
        return bool(self.light_bumpers & AHEAD_LIGHTS)

    @property
    def wheel_drop(self) -> bool:
        return self.wheel_drop_left or self.wheel_drop_right

    @property
    def cliff(self) -> bool:
        return self.cliff_left or self.cliff_front_left or self.cliff_front_right or self.cliff_right

    @property
    def wheel_over_current(self) -> bool:
        return bool(self.over_currents & 0b11000)

    @property
    def clean_pressed(self) -> bool:
        return bool(self.buttons & 0b001)

    @property
    def spot_pressed(self) -> bool:
        return bool(self.buttons & 0b010)

    @property
    def virtual_wall(self) -> bool:
        """A virtual wall's beam reaches one of the receivers."""
        return VIRTUAL_WALL_IR in (self.ir_omni, self.ir_left, self.ir_right)

    @property
    def docked(self) -> bool:
        """The charging contacts of a home base are under power."""
        return self.home_base

    @property
    def charging(self) -> bool:
        return self.charging_state.takes_current

    @property
    def battery_ratio(self) -> float | None:
        """Charge over capacity, 0 to 1; None while the firmware does not know its capacity (just after boot)."""
        return min(1.0, max(0.0, self.charge_mah / self.capacity_mah)) if self.capacity_mah else None


Note = tuple[int, float]
"""A MIDI note (31 to 127; others rest) and its length in seconds."""


class Base(Protocol):
    """The drive base. Nothing here blocks: `poll` takes what has arrived and sends what is due."""

    def poll(self, now: float) -> BaseState | None:
        """The newest state if one arrived since the last call; also keeps deadline, start-up and reconnection going."""
        ...

    @property
    def state(self) -> BaseState | None:
        """The newest state of all; its age says whether the base still speaks."""
        ...

    def drive(self, wanted: WheelSpeeds, now: float) -> WheelSpeeds:
        """Ask for speeds, be told what was really sent. Valid for 0.4 s, then the driver stops the wheels itself."""
        ...

    def set_mode(self, mode: Mode, now: float) -> None:
        """PASSIVE, SAFE or FULL; kept up (sent again after the base fell back) until another is set."""
        ...

    def seek_dock(self, now: float) -> None:
        """The firmware drives to the dock by its infrared beams; the mode is Passive from then on."""
        ...

    def play(self, notes: tuple[Note, ...], now: float) -> None: ...

    def show_lights(self, colour: float, brightness: float, now: float) -> None:
        """The power light: colour 0 green to 1 red, brightness 0 to 1."""
        ...

    def close(self) -> None:
        """Stop, and leave the base in Passive, or it would never charge."""
        ...


class LineReading(NamedTuple):
    """Which diodes are over the line."""

    left: bool
    centre: bool
    right: bool

    @property
    def pattern(self) -> str:
        """The paper's spelling: left, centre, right; 0 = over the line."""
        return "".join("0" if over else "1" for over in self)


NOTHING_SEEN = LineReading(False, False, False)


class LineSensor(Protocol):
    """Three diodes, sampled often and read by majority."""

    def sample(self) -> None:
        """Take one look at the pins (200 to 500 times a second)."""
        ...

    def read(self) -> LineReading:
        """The majority of the newest samples, each diode on its own."""
        ...


class Camera(Protocol):
    """A source of frames that keeps only the newest."""

    def read(self) -> tuple[bool, Frame | None]:
        """(True, a frame not handed out before), or (False, None); never waits for one."""
        ...

    def close(self) -> None: ...


@dataclass(frozen=True, slots=True)
class BodyShape:
    """Measures of the robot. Wheel base and counts: Create 2 Open Interface, 2016; the rest is how it was built."""

    wheel_base_mm: float = 235.0
    mm_per_count: float = 72.0 * 3.141592653589793 / 508.8
    sensor_lead_mm: float = 60.0
    diode_spacing_mm: float = 15.0
    tape_width_mm: float = 24.0
    camera_ahead_mm: float = 0.0
    camera_left_mm: float = 0.0


@dataclass(frozen=True, slots=True)
class Odometry:
    """Where the encoders say the robot is, since the daemon started. Heading counter-clockwise, never wrapped."""

    x_mm: float = 0.0
    y_mm: float = 0.0
    heading_rad: float = 0.0
    travelled_mm: float = 0.0
    """Sum of all movement of the axle's centre, forwards and backwards."""
    ahead_mm: float = 0.0
    """Movement of the axle's centre along its own heading, backwards taken off."""
    spot_turn_rad: float = 0.0
    """Net rotation on the spot alone: turns, not bends of the line."""


@dataclass(frozen=True, slots=True)
class Fix:
    """Where a thing of the map is, as the robot sees it from its axle: that tells its own place.

    Accuracies are standard deviations.
    """

    source: str
    """marker, or dock."""
    post: str | None
    """Whose it is; None where the source does not say (all docks send the same)."""
    at_s: float
    ahead_mm: float
    left_mm: float
    turned_rad: float | None = None
    """How far the robot is turned to the left of standing square before it; None where the source cannot tell."""
    accuracy_mm: float = 10.0
    accuracy_rad: float = 0.05


class PositionSource(Protocol):
    """Whatever knows now and then where the robot is: markers, the dock's infrared; beacons may come later."""

    def fixes(self, now: float) -> tuple[Fix, ...]:
        """Those not handed out before, oldest first; never waits."""
        ...


@dataclass(frozen=True, slots=True)
class Sighting:
    """A marker read by the camera: its text, and where its centre is as the robot sees it (from the axle's centre)."""

    text: str
    at_s: float
    ahead_mm: float = 0.0
    left_mm: float = 0.0
    turned_rad: float = 0.0
    """How far the robot is turned to the left of looking along the marker's face; see `Fix`."""
    accuracy_mm: float = 10.0
    accuracy_rad: float = 0.05

    def __repr__(self) -> str:
        """Without the text of a hand-over code: it opens the box, so that no log may have it."""
        text = repr(self.text if ":" not in self.text else self.text.partition(":")[0] + ":…")
        return f"Sighting({text}, at_s={self.at_s:.2f}, ahead_mm={self.ahead_mm:.0f}, left_mm={self.left_mm:.0f})"

    @property
    def fix(self) -> Fix:
        place = self.at_s, self.ahead_mm, self.left_mm, self.turned_rad
        return Fix("marker", self.text, *place, self.accuracy_mm, self.accuracy_rad)


@dataclass(frozen=True, slots=True)
class CameraReport:
    """The result of one camera frame: posts of the map, hand-over codes, and how old the newest frame is."""

    posts: tuple[Sighting, ...] = ()
    codes: tuple[Sighting, ...] = field(default=())
    frame_age_s: float = 0.0
    frozen_s: float = 0.0
    """The same picture has come for so long."""


class Host(Protocol):
    """The computer that the robot thinks with, as far as it can fail by itself."""

    def under_voltage(self) -> bool:
        """The supply is too low now; False where the computer cannot tell."""
        ...

    def clock_ahead_s(self) -> float:
        """The clock that records are written by, less the time that only passes: it stays what it is, unless set."""
        ...

    def disk_free_mb(self) -> float:
        """Room where the robot keeps its memory."""
        ...


@dataclass(frozen=True, slots=True)
class HostReport:
    """One reading of the computer's own state."""

    under_voltage: bool = False
    clock_jumped: bool = False
    """Since the look before, its clock went otherwise than time did."""
    disk_low: bool = False
