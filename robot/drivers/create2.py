"""The Create 2 over a serial port: bytes in, states out; speeds in, bytes out. Nothing here waits.

One thread owns it and calls `poll` often. The stream with its checksum is the only data path. Drive commands latch in
the base (it has no dead-man timer), so a speed that is not renewed within its deadline is stopped here.
"""

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from ..errors import RobotError
from . import open_interface as oi
from .interfaces import STOP, BaseState, ChargingState, Mode, Note, WheelSpeeds
from .serial_port import NoWakeUpLine, SerialPort, WakeUpLine
from .stream_parser import BatteryText, StreamParser, battery_text

SPEED_CAP_MM_S = 200.0
"""A dead computer leaves the base driving: this caps what that can do."""
SLOWEST_MM_S = 30.0
"""One encoder count in 15 ms; below it the base veers (field reports; the paper's prototype drove there)."""
DEADLINE_S = 0.4
REPEAT_S = 0.1
"""An unchanged speed is sent again this often: a byte may have been lost."""
MODE_GAP_S = 0.025
"""Older manuals ask for 20 ms between a change of mode and the next command."""
SILENT_S = 1.0
RETRY_S = 1.0
MODE_RETRY_S = 0.5
READ_AT_ONCE = 4096
WAKE_UP_LOW_S = 0.5
WAKE_UP_EVERY_S = 60.0
STILL_FRAMES = 3
"""So many frames with equal counts are a standstill: at 30 mm/s single frames show none either."""
MODE_KNOWN_AFTER_S = 0.06
"""Older frames may have been on their way when the base was started."""
LONGEST_COMMAND = 5
"""A program that died in the middle of a drive command left the base waiting for up to four bytes, for ever."""

_MODE_OPCODES = {Mode.PASSIVE: oi.Opcode.START, Mode.SAFE: oi.Opcode.SAFE, Mode.FULL: oi.Opcode.FULL}


@dataclass
class LinkHealth:
    """What a maintainer asks about the cable."""

    frames: int = 0
    starts: int = 0
    reconnections: int = 0
    problem: str | None = None
    """Why the port cannot be used now."""
    battery_text: BatteryText | None = None
    firmware_lines: tuple[str, ...] = ()
    """The last few lines that the firmware printed."""


class Create2:
    """See `interfaces.Base`. Raises PortAbsent or PortBusy at once if the first opening fails; later it tries again."""

    def __init__(
        self,
        open_port: Callable[[], SerialPort],
        wake_up_line: WakeUpLine | None = None,
        deadline_s: float = DEADLINE_S,
        speed_cap_mm_s: float = SPEED_CAP_MM_S,
    ) -> None:
        self._open_port = open_port
        self._wake_up_line = wake_up_line or NoWakeUpLine()
        self._deadline_s, self._speed_cap_mm_s = deadline_s, speed_cap_mm_s
        self._port: SerialPort | None = open_port()
        self._parser = StreamParser()
        self._outgoing: deque[tuple[bytes, float]] = deque()
        self._quiet_until_s = 0.0
        self._next_try_s = 0.0
        self._wanted_mode = Mode.PASSIVE
        self._mode_sent_s = 0.0
        self._mode_offset: int | None = None
        self._sent, self._sent_s = STOP, 0.0
        self._drive_until_s: float | None = None
        self._still_frames = STILL_FRAMES
        self._started_s = -SILENT_S
        self._wake_up_low, self._wake_up_s = False, 0.0
        self.state: BaseState | None = None
        self.health = LinkHealth()

    # What comes in

    def poll(self, now: float) -> BaseState | None:
        """See `interfaces.Base.poll`. An unplugged port is noticed here and tried again every second."""
        data = self._read(now)
        frames = self._parser.feed(data) if data else []
        newest = None
        for values in frames:
            newest = self._heard(self._state(values, now))
        if self._parser.lines:
            self._keep_text(self._parser.take_lines())
        if newest:
            self._keep_mode(newest, now)
        self._restart_if_silent(now)
        self._keep_awake(now)
        self._stop_past_deadline(now)
        self._flush(now)
        return newest

    def _read(self, now: float) -> bytes:
        if self._port is None and not self._reopened(now):
            return b""
        try:
            return self._port.read(READ_AT_ONCE) if self._port else b""
        except OSError as error:
            self._lose_port(str(error), now)
            return b""

    def _heard(self, state: BaseState) -> BaseState:
        old, self.state = self.state, state
        self.health.frames += 1
        moved = old is not None and (old.left_count, old.right_count) != (state.left_count, state.right_count)
        self._still_frames = 0 if moved else self._still_frames + 1
        return state

    @property
    def _still(self) -> bool:
        return self._still_frames >= STILL_FRAMES

    def _state(self, values: tuple[Any, ...], now: float) -> BaseState:
        raw = dict(zip(oi.FIELDS, values, strict=True))
        bumps, chargers = raw["bumps_and_drops"], raw["chargers"]
        return BaseState(
            at_s=now,
            left_count=raw["left_count"],
            right_count=raw["right_count"],
            bump_left=bool(bumps & 2),
            bump_right=bool(bumps & 1),
            wheel_drop_left=bool(bumps & 8),
            wheel_drop_right=bool(bumps & 4),
            cliff_left=bool(raw["cliff_left"]),
            cliff_front_left=bool(raw["cliff_front_left"]),
            cliff_front_right=bool(raw["cliff_front_right"]),
            cliff_right=bool(raw["cliff_right"]),
            over_currents=raw["over_currents"],
            buttons=raw["buttons"],
            charging_state=_charging_state(raw["charging_state"]),
            home_base=bool(chargers & 2),
            internal_charger=bool(chargers & 1),
            mode=self._mode(raw["mode"], now),
            song_playing=bool(raw["song_playing"]),
            voltage_mv=raw["voltage_mv"],
            current_ma=raw["current_ma"],
            temperature_c=raw["temperature_c"],
            charge_mah=raw["charge_mah"],
            capacity_mah=raw["capacity_mah"],
            ir_omni=raw["ir_omni"],
            ir_left=raw["ir_left"],
            ir_right=raw["ir_right"],
            left_motor_ma=raw["left_motor_ma"],
            right_motor_ma=raw["right_motor_ma"],
            stasis=raw["stasis"],
        )

    def _keep_text(self, lines: list[str]) -> None:
        self.health.firmware_lines = (*self.health.firmware_lines, *lines)[-20:]
        for line in lines:
            self.health.battery_text = battery_text(line) or self.health.battery_text

    # Modes

    def _mode(self, reported: int, now: float) -> Mode:
        """Some firmware reports every mode one too high. Just after a start it must be Passive: that tells."""
        if self._mode_offset is None and now - self._started_s >= MODE_KNOWN_AFTER_S:
            self._mode_offset = 1 if reported == Mode.SAFE else 0
        number = reported - (self._mode_offset or 0)
        return Mode(number) if number in _MODE_OPCODES or number == Mode.OFF else Mode.UNKNOWN

    def set_mode(self, mode: Mode, now: float) -> None:
        """See `interfaces.Base.set_mode`."""
        if mode is self._wanted_mode:
            return
        self._wanted_mode = mode
        if self._mode_offset is not None:
            self._send_mode(now)

    def _send_mode(self, now: float) -> None:
        self._mode_sent_s = now
        self._queue(bytes((_MODE_OPCODES[self._wanted_mode],)), now, MODE_GAP_S)

    def _keep_mode(self, state: BaseState, now: float) -> None:
        """A base that fell back to Passive is taken again, but only when the reason for it is gone."""
        if self._wanted_mode is Mode.PASSIVE or self._mode_offset is None or now - self._mode_sent_s < MODE_RETRY_S:
            return
        refused = self._wanted_mode is Mode.SAFE and (state.cliff or state.wheel_drop or state.docked)
        # An odd number says nothing: then only wheels that stand although they should turn show that the mode is lost.
        standing = state.mode is Mode.UNKNOWN and self._still and not self._sent.still
        lost = state.mode not in (self._wanted_mode, Mode.UNKNOWN) or standing
        if lost and not refused:
            self._send_mode(now)

    def seek_dock(self, now: float) -> None:
        """See `interfaces.Base.seek_dock`."""
        self._wanted_mode = Mode.PASSIVE
        self._drive_until_s, self._sent = None, STOP
        self._mode_sent_s = now
        self._queue(bytes((oi.Opcode.SEEK_DOCK,)), now, MODE_GAP_S)

    # Wheels, sound and light

    def drive(self, wanted: WheelSpeeds, now: float) -> WheelSpeeds:
        """See `interfaces.Base.drive`. In Passive the wheels are the firmware's, so nothing is sent."""
        if self._wanted_mode is Mode.PASSIVE or self._port is None:
            return STOP
        speeds = possible(wanted, self._speed_cap_mm_s)
        self._drive_until_s = now + self._deadline_s
        settled = speeds == self._sent and (now - self._sent_s < REPEAT_S or (speeds.still and self._still))
        if not settled:
            self._send_speeds(speeds, now)
        return speeds

    def _send_speeds(self, speeds: WheelSpeeds, now: float) -> None:
        self._sent, self._sent_s = speeds, now
        self._queue(oi.drive_direct(speeds), now)

    def _stop_past_deadline(self, now: float) -> None:
        """Past the deadline stop, and again until the encoders stand: one lost byte must not leave the base driving."""
        if self._drive_until_s is None or now <= self._drive_until_s:
            return
        if self._sent.still and self._still:
            self._drive_until_s = None
        elif not self._sent.still or now - self._sent_s >= REPEAT_S:
            self._send_speeds(STOP, now)

    def play(self, notes: tuple[Note, ...], now: float) -> None:
        """See `interfaces.Base.play`."""
        self._queue(oi.song(notes) + oi.play(), now)

    def show_lights(self, colour: float, brightness: float, now: float) -> None:
        """See `interfaces.Base.show_lights`."""
        self._queue(oi.leds(colour, brightness), now)

    def close(self) -> None:
        """See `interfaces.Base.close`."""
        if self._port is None:
            return
        try:
            self._port.write(oi.drive_direct(STOP) + bytes((oi.Opcode.START,)))
            self._port.close()
        except OSError:
            # Unplugged at the very end: nothing is left to be told.
            pass
        self._port = None

    # The cable

    def _queue(self, data: bytes, now: float, gap_after_s: float = 0.0) -> None:
        if self._port is not None:
            self._outgoing.append((data, gap_after_s))
            self._flush(now)

    def _flush(self, now: float) -> None:
        while self._outgoing and self._port is not None and now >= self._quiet_until_s:
            data, gap_s = self._outgoing.popleft()
            try:
                self._port.write(data)
            except OSError as error:
                self._lose_port(str(error), now)
            self._quiet_until_s = now + gap_s

    def _restart_if_silent(self, now: float) -> None:
        """Start, and ask for the stream: at first, after an unplug, and after a reset or sleep of the base."""
        heard_s = self.state.at_s if self.state else -SILENT_S
        if self._port is None or now - heard_s < SILENT_S or now < self._next_try_s:
            return
        self._next_try_s = now + RETRY_S
        self._mode_offset = None
        self._started_s, self._mode_sent_s = now, now - MODE_RETRY_S
        self._sent = STOP
        self.health.starts += 1
        self._pull_wake_up_line(True, now)
        self._outgoing.clear()
        self._queue(bytes((oi.Opcode.START,)) * LONGEST_COMMAND, now, MODE_GAP_S)
        self._queue(oi.start_stream(), now)

    def _keep_awake(self, now: float) -> None:
        """Left alone in Passive the base sleeps after five minutes; a pulse on BRC every minute prevents it."""
        if self._wake_up_low and now - self._wake_up_s >= WAKE_UP_LOW_S:
            self._pull_wake_up_line(False, now)
        elif self._wanted_mode is Mode.PASSIVE and now - self._wake_up_s >= WAKE_UP_EVERY_S:
            self._pull_wake_up_line(True, now)

    def _pull_wake_up_line(self, low: bool, now: float) -> None:
        self._wake_up_low, self._wake_up_s = low, now
        self._wake_up_line.low(low)

    def _reopened(self, now: float) -> bool:
        if now < self._next_try_s:
            return False
        self._next_try_s = now + RETRY_S
        try:
            self._port = self._open_port()
        except (RobotError, OSError) as error:
            self.health.problem = str(error)
            return False
        self._next_try_s = now
        self.health.problem = None
        self.health.reconnections += 1
        self._parser = StreamParser()
        return True

    def _lose_port(self, problem: str, now: float) -> None:
        if self._port is not None:
            self._port.close()
        self._port = None
        self._outgoing.clear()
        self._sent, self._drive_until_s = STOP, None
        self.health.problem = problem
        self._next_try_s = now + RETRY_S


def possible(wanted: WheelSpeeds, cap_mm_s: float = SPEED_CAP_MM_S) -> WheelSpeeds:
    """The nearest speeds that the base does well: whole mm/s, none between 0 and 30, none above the cap.

    Too fast a pair is scaled as one, so that the curve stays the same.
    """
    fastest = max(abs(wanted.left_mm_s), abs(wanted.right_mm_s))
    share = min(1.0, cap_mm_s / fastest) if fastest else 1.0
    return WheelSpeeds(_possible(wanted.left_mm_s * share), _possible(wanted.right_mm_s * share))


def _possible(speed_mm_s: float) -> int:
    size = abs(speed_mm_s)
    if size < SLOWEST_MM_S / 2:
        return 0
    whole = round(max(size, SLOWEST_MM_S))
    return whole if speed_mm_s > 0 else -whole


def _charging_state(number: int) -> ChargingState:
    return ChargingState(number) if number <= ChargingState.FAULT else ChargingState.FAULT
