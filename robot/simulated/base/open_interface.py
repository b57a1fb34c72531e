"""The byte machine of a Create 2: commands in, packets and the firmware's own text out.

It waits for missing data bytes for ever, refuses what the mode forbids, keeps driving until told otherwise (there is
no dead-man timer in the interface), stops by itself only for cliff, wheel drop and charger in Safe mode, and sleeps
after five idle minutes in Passive. Source [S] unless marked [F] (field report) or [A] (assumption).
"""

from collections.abc import Callable

from robot.simulated.base import firmware_text
from robot.simulated.base.activity import Activity, Hazards
from robot.simulated.base.actuators import ACTUATORS, Actuators
from robot.simulated.base.commands import BAUD_CODES, COMMANDS, RESET, START, CommandParser, Mode
from robot.simulated.base.packets import Readings
from robot.simulated.base.quirks import FAST_BAUD, SLOW_BAUD, Quirks
from robot.simulated.base.reports import Reports
from robot.simulated.base.songs import SongBook
from robot.simulated.base.transmitter import Transmitter
from robot.simulated.base.wakefulness import Wakefulness
from robot.simulated.faults import Faults

BAUD_CHANGE_S = 0.1
MODE_CHANGE_S = 0.02
CLEAN_BUTTONS = 0b011
DOCK_BUTTON = 0b100


class OpenInterface:
    """`readings` are kept up to date by the world. The time comes with `receive`, `tick` and `brc`."""

    def __init__(self, readings: Readings, faults: Faults, now: float) -> None:
        self.mode = Mode.OFF
        self.activity = Activity.NONE
        self.actuators = Actuators(readings)
        self.baud = FAST_BAUD
        self.ignored_commands = 0
        self.charging_s = 0.0
        self._out = Transmitter()
        self._wakefulness = Wakefulness(faults, now)
        self._quirks = Quirks(faults, now)
        self._battery_lines = firmware_text.BatteryLines()
        self._reports = Reports(readings, faults)
        self._faults = faults
        self._now = now
        self._parser = CommandParser()
        self._deaf_until_s = now

    # What comes in -----------------------------------------------------------------------------------------------

    def receive(self, data: bytes, now: float) -> None:
        """Bytes from the host. A robot that sleeps, boots or is frozen loses them."""
        self._now = now
        for byte in data:
            if self.asleep or now < self._deaf_until_s or self._quirks.is_frozen(now):
                return
            self._eat(byte)

    def _eat(self, byte: int) -> None:
        command = self._parser.eat(byte, self.mode)
        if command is None:
            return
        opcode, data = command
        if self.mode not in COMMANDS[opcode].modes or (self._quirks.mute and opcode != RESET):
            self.ignored_commands += 1
        elif opcode in ACTUATORS:
            ACTUATORS[opcode](self.actuators, data)
        else:
            HANDLERS[opcode](self, data)

    def brc(self, low: bool, now: float) -> None:
        """The BRC pin is pulled low, or let go."""
        if self._quirks.mute:
            return
        self._out.say(self._wakefulness.brc(low, now))
        if self._wakefulness.wants_19200():
            self.baud = SLOW_BAUD

    @property
    def _is_silent(self) -> bool:
        return self._quirks.mute or self._quirks.is_frozen(self._now)

    @property
    def asleep(self) -> bool:
        return self._wakefulness.asleep

    # What time does ----------------------------------------------------------------------------------------------

    def guard(self, hazards: Hazards) -> None:
        """The firmware's own reflexes."""
        if hazards.charger:
            self._out.say(self._wakefulness.wake(firmware_text.CHARGER_WAKEUP, self._now))
        if hazards.wheel_drop:
            self.finish_activity()
        over_cliff = hazards.cliff and self.actuators.cliff_counts
        if self.mode is Mode.SAFE and (hazards.wheel_drop or hazards.charger or over_cliff):
            self._enter(Mode.PASSIVE)

    def tick(self, now: float, on_charger: bool) -> None:
        """One slot of 15 ms: text that is due, a frame of the stream, the five minutes to sleep."""
        self._now = now
        self.baud = self._quirks.tick(now, on_charger) or self.baud
        self._out.begin_slot(self.baud)
        self._out.print_due(now)
        if not self._is_silent:
            self._out.frame(self._reports.frame(self.mode, self.actuators.songs, now))
        if self.mode is not Mode.PASSIVE or self.activity is not Activity.NONE or on_charger:
            self._wakefulness.stir(now)
        elif self._wakefulness.is_tired(now):
            self._sleep()
        if on_charger and self.mode is Mode.OFF and not self.asleep and now >= self._deaf_until_s:
            self._out.say(self._battery_lines.due(self._reports.readings, self.charging_s, now))

    def _sleep(self) -> None:
        self._out.say(self._wakefulness.sleep(self._now))
        self._shut()

    def lose_power(self) -> None:
        """The battery is empty: silent until the charger wakes it."""
        if not self.asleep:
            self._sleep()

    def finish_activity(self) -> None:
        """The dock is reached, given up, or something is in the way."""
        if self.activity is not Activity.NONE:
            self.activity = Activity.NONE
            self._wakefulness.stir(self._now)

    # What goes out -----------------------------------------------------------------------------------------------

    def print_text(self, text: bytes) -> None:
        """Something of the firmware's own, in the middle of the packets."""
        self._out.say(text)

    @property
    def has_more(self) -> bool:
        """Return whether bytes wait to be sent."""
        return self._out.waiting

    def take(self) -> bytes:
        """The bytes that are on the wire since last asked; those of a frozen robot are lost."""
        data = self._out.take()
        return b"" if self._is_silent else data

    # Modes -------------------------------------------------------------------------------------------------------

    def _enter(self, mode: Mode) -> None:
        """The wheels stop with any change of mode [A]; lights go out in Safe and Full."""
        self._wakefulness.stir(self._now)
        if mode in (Mode.SAFE, Mode.FULL):
            self.activity = Activity.NONE
            self.actuators.leds = (0, 0, 0)
        if mode is not self.mode:
            self.actuators.stop()
            if self._faults.slow_modes:
                self._deaf_until_s = max(self._deaf_until_s, self._now + MODE_CHANGE_S)
        self.mode = mode

    def _shut(self) -> None:
        self.activity = Activity.NONE
        self._enter(Mode.OFF)
        self._parser.forget()
        self._reports.forget_stream()

    def reset(self, _: bytes) -> None:
        self._shut()
        self.baud = FAST_BAUD
        self._quirks.reset()
        self.actuators.songs = SongBook()
        self._deaf_until_s = self._out.print_later(
            [(self._now + after_s, text) for after_s, text in firmware_text.BOOT]
        )

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
        self._begin(Activity.CLEANING)

    def seek_dock(self, _: bytes) -> None:
        """Drives to the dock by itself; a running cleaning cycle is only paused by it."""
        self._begin(Activity.DOCKING)

    def _begin(self, activity: Activity) -> None:
        running = self.activity is Activity.CLEANING
        self._enter(Mode.PASSIVE)
        self.activity = Activity.NONE if running else activity

    # Buttons, songs, speed of the line, sensors ------------------------------------------------------------------

    def press_buttons(self, data: bytes) -> None:
        """As a finger would: outside Safe and Full the robot obeys them."""
        self._reports.press(data[0], self._now)
        self._wakefulness.stir(self._now)
        if self.mode in (Mode.SAFE, Mode.FULL):
            return
        if data[0] & CLEAN_BUTTONS:
            self.clean(b"")
        elif data[0] & DOCK_BUTTON:
            self.seek_dock(b"")

    def play(self, data: bytes) -> None:
        self.actuators.songs.play(data[0], self._now)

    def set_baud(self, data: bytes) -> None:
        if data[0] < len(BAUD_CODES):
            self.baud = BAUD_CODES[data[0]]
            self._deaf_until_s = self._now + BAUD_CHANGE_S

    def keep(self, _: bytes) -> None:
        """Schedule and clock: taken, without an effect that this interface shows."""

    def sensors(self, data: bytes) -> None:
        self._out.say(self._reports.answer(data, self.mode, self.actuators.songs, self._now))

    def query_list(self, data: bytes) -> None:
        self.sensors(data[1:])

    def stream(self, data: bytes) -> None:
        self._reports.stream(data[1:])

    def pause_resume(self, data: bytes) -> None:
        self._reports.pause(not data[0])


HANDLERS: dict[int, Callable[[OpenInterface, bytes], None]] = {
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
    141: OpenInterface.play,
    142: OpenInterface.sensors,
    143: OpenInterface.seek_dock,
    148: OpenInterface.stream,
    149: OpenInterface.query_list,
    150: OpenInterface.pause_resume,
    165: OpenInterface.press_buttons,
    167: OpenInterface.keep,
    168: OpenInterface.keep,
    173: OpenInterface.stop,
}
"""Those of the actuators are in `actuators.ACTUATORS`."""
