"""The byte machine of a Create 2: commands in, packets and the firmware's own text out.

It waits for missing data bytes for ever, refuses what the mode forbids, keeps driving until told otherwise (there is
no dead-man timer in the interface), stops by itself only for cliff, wheel drop and charger in Safe mode, and sleeps
after five idle minutes in Passive. Source [S] unless marked [F] (field report) or [A] (assumption).
"""

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from struct import unpack

from . import firmware_text
from .commands import BAUD_CODES, COMMANDS, RESET, START, Mode
from .drive_base import TOP_SPEED_MM_S, WHEEL_BASE_MM
from .faults import Faults
from .packets import Layout, Readings, stream_frame
from .songs import SongBook

SLOT_S = 0.015
SLOT_BYTES = 172  # what 115200 baud carries in one slot
SLEEP_AFTER_S = 300.0
BUTTON_S = 1 / 6
BRC_PULSE_S = 0.05
BAUD_CHANGE_S = 0.1
STRAIGHT = (0x7FFF, -0x8000)
TURN_RADIUS_OF_CLIFF_MM = 165
PWM_TOP = 255
CLEAN_BUTTONS = 0b011
DOCK_BUTTON = 0b100


class Activity(Enum):
    """What the firmware does by itself."""

    NONE = "none"
    CLEANING = "cleaning"
    DOCKING = "docking"


@dataclass(frozen=True)
class Hazards:
    """What the firmware's own safety looks at."""

    cliff: bool = False
    wheel_drop: bool = False
    charger: bool = False


class OpenInterface:
    """`readings` is shared with the world, which keeps the physical packets in it up to date."""

    def __init__(self, readings: Readings, faults: Faults, now: float) -> None:
        self.mode = Mode.OFF
        self.activity = Activity.NONE
        self.left_mm_s = 0.0
        self.right_mm_s = 0.0
        self.baud = 115200
        self.songs = SongBook()
        self.leds: tuple[int, int, int] = (0, 0, 0)
        self.digits = b"    "
        self.brushes: tuple[int, int, int] = (0, 0, 0)
        self.asleep = False
        self.out = bytearray()
        self.ignored_commands = 0
        self.charging_s = 0.0
        self._readings = readings
        self._faults = faults
        self._now = now
        self._pending = bytearray()
        self._stream: Layout | None = None
        self._streaming = False
        self._printing: deque[tuple[float, bytes]] = deque()
        self._deaf_until_s = now
        self._idle_since_s = now
        self._slept_at_s = now
        self._buttons_until_s = now
        self._brc_low_since_s: float | None = None
        self._battery_line_at_s = now

    # What comes in -----------------------------------------------------------------------------------------------

    def receive(self, data: bytes, now: float) -> None:
        """Bytes from the host. A robot that sleeps, boots or is frozen loses them."""
        self._now = now
        for byte in data:
            if self.asleep or now < self._deaf_until_s or self._faults.frozen:
                return
            self._eat(byte)

    def _eat(self, byte: int) -> None:
        if not self._pending and (byte not in COMMANDS or self._shut_for(byte)):
            return
        self._pending.append(byte)
        opcode, data = self._pending[0], bytes(self._pending[1:])
        command = COMMANDS[opcode]
        if command.missing(data) > 0:
            return
        self._pending.clear()
        if self.mode in command.modes:
            HANDLERS[opcode](self, data)
        else:
            self.ignored_commands += 1

    def _shut_for(self, opcode: int) -> bool:
        """In Off mode bytes are looked at one by one, and only Start and Reset mean anything."""
        return self.mode is Mode.OFF and opcode not in (START, RESET)

    def brc(self, low: bool, now: float) -> None:
        """The BRC pin. A low pulse of 50 ms or more wakes the robot and restarts its five minutes."""
        if low:
            self._brc_low_since_s = now if self._brc_low_since_s is None else self._brc_low_since_s
            return
        since_s, self._brc_low_since_s = self._brc_low_since_s, None
        if since_s is not None and now - since_s >= BRC_PULSE_S and not self._faults.brc_dead:
            self._idle_since_s = now
            self._wake(firmware_text.KEY_WAKEUP, now)

    # What time does ----------------------------------------------------------------------------------------------

    def guard(self, hazards: Hazards) -> None:
        """The firmware's own reflexes."""
        if hazards.charger and self.asleep:
            self._wake(firmware_text.CHARGER_WAKEUP, self._now)
        if hazards.wheel_drop:
            self.finish_activity()
        if self.mode is Mode.SAFE and (
            hazards.wheel_drop or hazards.charger or (hazards.cliff and self._cliff_counts())
        ):
            self._enter(Mode.PASSIVE)

    def _cliff_counts(self) -> bool:
        """While it drives forward, or backward in a turn tighter than the robot itself."""
        left, right = self.left_mm_s, self.right_mm_s
        if not left and not right:
            return False
        if left + right > 0 or left == right:
            return left + right > 0
        radius_mm = WHEEL_BASE_MM / 2 * abs((right + left) / (right - left))
        return radius_mm < TURN_RADIUS_OF_CLIFF_MM

    def tick(self, now: float, on_charger: bool) -> None:
        """One slot of 15 ms: text that is due, a frame of the stream, the five minutes to sleep."""
        self._now = now
        while self._printing and self._printing[0][0] <= now:
            self.out += self._printing.popleft()[1]
        if self._streaming and self._stream and not self.asleep and not self._faults.frozen:
            self.out += self._frame(self._stream)
        self._fall_asleep_when_idle(now, on_charger)
        if on_charger and self.mode is Mode.OFF and not self.asleep:
            self._print_battery(now)

    def _frame(self, layout: Layout) -> bytes:
        # What does not fit into its slot is lost, so that too long a list gives only broken frames.
        return stream_frame(self._encode(layout))[:SLOT_BYTES]

    def _fall_asleep_when_idle(self, now: float, on_charger: bool) -> None:
        if self.mode is not Mode.PASSIVE or self.activity is not Activity.NONE or on_charger:
            self._idle_since_s = now
        elif now - self._idle_since_s >= SLEEP_AFTER_S and not self._faults.never_sleeps:
            self._sleep()

    def _sleep(self) -> None:
        self.out += firmware_text.SLEEP
        self.asleep, self._slept_at_s = True, self._now
        self._shut()

    def lose_power(self) -> None:
        """The battery is empty: silent until the charger wakes it."""
        if not self.asleep:
            self._sleep()

    def _wake(self, cause: str, now: float) -> None:
        """Awake, with the interface Off."""
        if self.asleep:
            self.asleep = False
            self.out += firmware_text.wakeup(cause, now - self._slept_at_s)

    def _print_battery(self, now: float) -> None:
        if now < self._battery_line_at_s or now < self._deaf_until_s:
            return
        self._battery_line_at_s = now + 1.0
        told = self._readings
        self.out += firmware_text.battery_line(
            self.charging_s, told.voltage_mv, told.current_ma, told.temperature_c, told.charge_mah
        )

    def finish_activity(self) -> None:
        """The dock is reached, given up, or something is in the way."""
        if self.activity is not Activity.NONE:
            self.activity = Activity.NONE
            self._idle_since_s = self._now

    # What goes out -----------------------------------------------------------------------------------------------

    def _encode(self, layout: Layout) -> bytes:
        told = self._readings
        mode = int(self.mode) + self._faults.mode_offset
        told.oi_mode = mode & 0xFF
        told.song_number = self.songs.number
        told.song_playing = int(self.songs.playing(self._now))
        told.stream_packets = len(self._stream.ids) if self._stream else 0
        if self._now >= self._buttons_until_s:
            told.buttons = 0
        data = layout.encode(told)
        # Reading packet 19 or 20 clears it.
        told.distance_mm = 0 if layout.takes_distance else told.distance_mm
        told.angle_deg = 0 if layout.takes_angle else told.angle_deg
        return data

    def _answer(self, layout: Layout) -> None:
        if not (layout.tells_mode and self._faults.mode_silent):
            self.out += self._encode(layout)

    # Modes -------------------------------------------------------------------------------------------------------

    def _enter(self, mode: Mode) -> None:
        """The wheels stop with any change of mode [A]; lights go out in Safe and Full."""
        self._idle_since_s = self._now
        if mode in (Mode.SAFE, Mode.FULL):
            self.activity = Activity.NONE
            self.leds = (0, 0, 0)
        if mode is not self.mode:
            self._drive(0, 0)
            self.brushes = (0, 0, 0)
        self.mode = mode

    def _shut(self) -> None:
        self.activity = Activity.NONE
        self._enter(Mode.OFF)
        self._pending.clear()
        self._stream, self._streaming = None, False

    def reset(self, _: bytes) -> None:
        self._shut()
        self.baud = 115200
        self.songs = SongBook()
        self._printing = deque((self._now + after_s, text) for after_s, text in firmware_text.BOOT)
        self._deaf_until_s = self._printing[-1][0]

    def start(self, _: bytes) -> None:
        self.activity = Activity.NONE
        self._enter(Mode.PASSIVE)

    def stop(self, _: bytes) -> None:
        self._shut()

    def safe(self, _: bytes) -> None:
        self._enter(Mode.SAFE)

    def full(self, _: bytes) -> None:
        self._enter(Mode.FULL)

    def power(self, _: bytes) -> None:
        self._enter(Mode.PASSIVE)
        self._sleep()

    def clean(self, _: bytes) -> None:
        """Starts a cleaning cycle or, in one, pauses it."""
        running = self.activity is Activity.CLEANING
        self._enter(Mode.PASSIVE)
        self.activity = Activity.NONE if running else Activity.CLEANING

    def seek_dock(self, _: bytes) -> None:
        """Drives to the dock by itself; a running cleaning cycle is only paused by it."""
        running = self.activity is Activity.CLEANING
        self._enter(Mode.PASSIVE)
        self.activity = Activity.NONE if running else Activity.DOCKING

    # Actuators ---------------------------------------------------------------------------------------------------

    def _drive(self, left_mm_s: float, right_mm_s: float) -> None:
        """Speeds beyond the range are cut to it [A]."""
        self.left_mm_s = min(max(left_mm_s, -TOP_SPEED_MM_S), TOP_SPEED_MM_S)
        self.right_mm_s = min(max(right_mm_s, -TOP_SPEED_MM_S), TOP_SPEED_MM_S)
        told = self._readings
        told.left_velocity_mm_s, told.right_velocity_mm_s = round(self.left_mm_s), round(self.right_mm_s)
        told.velocity_mm_s, told.radius_mm = 0, 0

    def drive(self, data: bytes) -> None:
        velocity, radius = unpack(">hh", data)
        if radius in STRAIGHT or radius == 0:
            self._drive(velocity, velocity)
        elif abs(radius) == 1:
            self._drive(-radius * velocity, radius * velocity)
        else:
            share = WHEEL_BASE_MM / 2 / min(max(radius, -2000), 2000)
            self._drive(velocity * (1 - share), velocity * (1 + share))
        self._readings.velocity_mm_s = min(max(velocity, -TOP_SPEED_MM_S), TOP_SPEED_MM_S)
        self._readings.radius_mm = radius

    def drive_direct(self, data: bytes) -> None:
        right, left = unpack(">hh", data)
        self._drive(left, right)

    def drive_pwm(self, data: bytes) -> None:
        right, left = unpack(">hh", data)
        self._drive(left * TOP_SPEED_MM_S / PWM_TOP, right * TOP_SPEED_MM_S / PWM_TOP)

    def motors(self, data: bytes) -> None:
        bits = data[0]
        side = 127 if bits & 1 else 0
        main = 127 if bits & 4 else 0
        self.brushes = (-main if bits & 16 else main, -side if bits & 8 else side, 127 if bits & 2 else 0)

    def pwm_motors(self, data: bytes) -> None:
        self.brushes = unpack(">bbb", data)

    def set_leds(self, data: bytes) -> None:
        self.leds = (data[0], data[1], data[2])

    def set_digits(self, data: bytes) -> None:
        self.digits = data

    def song(self, data: bytes) -> None:
        self.songs.define(data[0], tuple(zip(data[2::2], data[3::2], strict=True)))

    def play(self, data: bytes) -> None:
        self.songs.play(data[0], self._now)

    def press_buttons(self, data: bytes) -> None:
        """As a finger would: outside Safe and Full the robot obeys them."""
        self._readings.buttons = data[0]
        self._buttons_until_s = self._now + BUTTON_S
        self._idle_since_s = self._now
        if self.mode in (Mode.SAFE, Mode.FULL):
            return
        if data[0] & CLEAN_BUTTONS:
            self.clean(b"")
        elif data[0] & DOCK_BUTTON:
            self.seek_dock(b"")

    def set_baud(self, data: bytes) -> None:
        if data[0] < len(BAUD_CODES):
            self.baud = BAUD_CODES[data[0]]
            self._deaf_until_s = self._now + BAUD_CHANGE_S

    def keep(self, _: bytes) -> None:
        """Schedule, clock and scheduling lights: taken, without an effect that this interface shows."""

    # Sensors -----------------------------------------------------------------------------------------------------

    def sensors(self, data: bytes) -> None:
        self._answer(Layout(data, tagged=False))

    def query_list(self, data: bytes) -> None:
        self._answer(Layout(data[1:], tagged=False))

    def stream(self, data: bytes) -> None:
        self._stream = Layout(data[1:], tagged=True)
        self._streaming = bool(self._stream.ids)

    def pause_resume(self, data: bytes) -> None:
        self._streaming = bool(data[0]) and self._stream is not None

    def print_text(self, text: bytes) -> None:
        """Something of the firmware's own, in the middle of the packets."""
        self.out += text

    def take(self) -> bytes:
        """The bytes that are on the wire since last asked."""
        data = bytes(self.out)
        self.out.clear()
        return data if not self._faults.frozen else b""


Handler = Callable[[OpenInterface, bytes], None]
HANDLERS: dict[int, Handler] = {
    RESET: OpenInterface.reset,
    START: OpenInterface.start,
    129: OpenInterface.set_baud,
    130: OpenInterface.safe,
    131: OpenInterface.safe,
    132: OpenInterface.full,
    133: OpenInterface.power,
    134: OpenInterface.clean,
    135: OpenInterface.clean,
    136: OpenInterface.clean,
    137: OpenInterface.drive,
    138: OpenInterface.motors,
    139: OpenInterface.set_leds,
    140: OpenInterface.song,
    141: OpenInterface.play,
    142: OpenInterface.sensors,
    143: OpenInterface.seek_dock,
    144: OpenInterface.pwm_motors,
    145: OpenInterface.drive_direct,
    146: OpenInterface.drive_pwm,
    148: OpenInterface.stream,
    149: OpenInterface.query_list,
    150: OpenInterface.pause_resume,
    162: OpenInterface.keep,
    163: OpenInterface.keep,
    164: OpenInterface.set_digits,
    165: OpenInterface.press_buttons,
    167: OpenInterface.keep,
    168: OpenInterface.keep,
    173: OpenInterface.stop,
}
