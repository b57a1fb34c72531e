"""The Create 2 over a serial port: bytes in, states out; speeds in, bytes out. Nothing here waits.

One thread owns it and calls `poll` often. The stream with its checksum is the only data path. Drive commands latch in
the base (it has no dead-man timer), so a speed that is not renewed within its deadline is stopped here.
"""

from collections.abc import Callable
from typing import Any

from . import open_interface as oi
from .base_frames import state_of
from .base_modes import OPCODES, ModeKeeper
from .cable import Cable, LinkHealth
from .interfaces import STOP, BaseState, Mode, Note, WheelSpeeds
from .serial_port import NoWakeUpLine, SerialPort, WakeUpLine
from .stream_parser import StreamParser, battery_text
from .wheel_speeds import DEADLINE_S, SPEED_CAP_MM_S, LatchedSpeeds, possible

__all__ = ["Create2", "possible"]

MODE_GAP_S = 0.025
"""Older manuals ask for 20 ms between a change of mode and the next command."""
SILENT_S = 1.0
RETRY_S = 1.0
WAKE_UP_LOW_S = 0.5
WAKE_UP_EVERY_S = 60.0
LONGEST_COMMAND = 5
"""A program that died in the middle of a drive command left the base waiting for up to four bytes, for ever."""


class Create2:
    """See `interfaces.Base`. Raises PortAbsent or PortBusy at once if the first opening fails; later it tries again."""

    def __init__(
        self,
        open_port: Callable[[], SerialPort],
        wake_up_line: WakeUpLine | None = None,
        deadline_s: float = DEADLINE_S,
        speed_cap_mm_s: float = SPEED_CAP_MM_S,
    ) -> None:
        self._speeds = LatchedSpeeds(deadline_s, speed_cap_mm_s)
        self._modes = ModeKeeper()
        self._cable = Cable(open_port, self._lost_port)
        self._wake_up_line = wake_up_line or NoWakeUpLine()
        self._parser = StreamParser()
        self._next_start_s = 0.0
        self._wake_up_low, self._wake_up_s = False, 0.0
        self.state: BaseState | None = None

    @property
    def health(self) -> LinkHealth:
        return self._cable.health

    # What comes in

    def poll(self, now: float) -> BaseState | None:
        """See `interfaces.Base.poll`. An unplugged port is noticed here and tried again every second."""
        data = self._cable.read(now)
        newest = None
        for values in self._parser.feed(data) if data else []:
            newest = self._heard(values, now)
        if self._parser.lines:
            self._keep_text(self._parser.take_lines())
        if newest:
            self._keep_mode(newest, now)
        self._restart_if_silent(now)
        self._keep_awake(now)
        if self._speeds.overdue(now):
            self._cable.send(oi.drive_direct(STOP), now)
        self._cable.flush(now)
        return newest

    def _heard(self, values: tuple[Any, ...], now: float) -> BaseState:
        raw = dict(zip(oi.FIELDS, values, strict=True))
        new = state_of(raw, self._modes.read(raw["mode"], now), now)
        self._speeds.heard(self.state, new)
        self.state = new
        self.health.frames += 1
        return new

    def _keep_text(self, lines: list[str]) -> None:
        self.health.firmware_lines = (*self.health.firmware_lines, *lines)[-20:]
        for line in lines:
            self.health.battery_text = battery_text(line) or self.health.battery_text

    def _lost_port(self) -> None:
        self._parser = StreamParser()
        self._speeds.hand_over()

    # Modes

    def set_mode(self, mode: Mode, now: float) -> None:
        """See `interfaces.Base.set_mode`."""
        if mode is self._modes.wanted:
            return
        self._modes.wanted = mode
        if self._modes.known:
            self._send_mode(mode, now)

    def _send_mode(self, mode: Mode, now: float) -> None:
        self._modes.asked(mode, now)
        self._cable.send(bytes((OPCODES[mode],)), now, MODE_GAP_S)

    def _keep_mode(self, state: BaseState, now: float) -> None:
        standing = self._speeds.still and not self._speeds.sent.still
        if self._modes.lost(state, standing, now):
            self._send_mode(self._modes.wanted, now)

    def seek_dock(self, now: float) -> None:
        """See `interfaces.Base.seek_dock`."""
        self._modes.asked(Mode.PASSIVE, now)
        self._speeds.hand_over()
        self._cable.send(bytes((oi.Opcode.SEEK_DOCK,)), now, MODE_GAP_S)

    # Wheels, sound and light

    def drive(self, wanted: WheelSpeeds, now: float) -> WheelSpeeds:
        """See `interfaces.Base.drive`. In Passive the wheels are the firmware's, so nothing is sent."""
        if self._modes.wanted is Mode.PASSIVE or not self._cable.is_open:
            return STOP
        speeds, due = self._speeds.ask(wanted, now)
        if due:
            self._cable.send(oi.drive_direct(speeds), now)
        return speeds

    def play(self, notes: tuple[Note, ...], now: float) -> None:
        """See `interfaces.Base.play`."""
        self._cable.send(oi.song(notes) + oi.play(), now)

    def show_lights(self, colour: float, brightness: float, now: float) -> None:
        """See `interfaces.Base.show_lights`."""
        self._cable.send(oi.leds(colour, brightness), now)

    def close(self) -> None:
        """See `interfaces.Base.close`."""
        self._cable.close(oi.drive_direct(STOP) + bytes((oi.Opcode.START,)))

    # Starting and waking

    def _restart_if_silent(self, now: float) -> None:
        """Start, and ask for the stream: at first, after an unplug, and after a reset or sleep of the base."""
        heard_s = self.state.at_s if self.state else -SILENT_S
        if not self._cable.is_open or now - heard_s < SILENT_S or now < self._next_start_s:
            return
        self._next_start_s = now + RETRY_S
        self._modes.started(now)
        self._speeds.started_anew()
        self.health.starts += 1
        self._pull_wake_up_line(True, now)
        self._cable.forget()
        self._cable.send(bytes((oi.Opcode.START,)) * LONGEST_COMMAND, now, MODE_GAP_S)
        self._cable.send(oi.start_stream(), now)

    def _keep_awake(self, now: float) -> None:
        """Left alone in Passive the base sleeps after five minutes; a pulse on BRC every minute prevents it."""
        if self._wake_up_low and now - self._wake_up_s >= WAKE_UP_LOW_S:
            self._pull_wake_up_line(False, now)
        elif self._modes.wanted is Mode.PASSIVE and now - self._wake_up_s >= WAKE_UP_EVERY_S:
            self._pull_wake_up_line(True, now)

    def _pull_wake_up_line(self, low: bool, now: float) -> None:
        self._wake_up_low, self._wake_up_s = low, now
        self._wake_up_line.low(low)
