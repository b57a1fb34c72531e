"""The Create 2 over a serial port: bytes in, states out; speeds in, bytes out. Nothing here waits.

One thread at a time calls it, and calls `poll` often. The stream with its checksum is the only data path. Drive
commands latch in the base (it has no dead-man timer), so a speed that is not renewed within its deadline is stopped
here.
"""

from collections.abc import Callable

import structlog

from robot.drivers.create2 import open_interface as oi
from robot.drivers.create2 import start_ladder as ladder
from robot.drivers.create2.base_frames import HeldButtons, state_of, together
from robot.drivers.create2.base_modes import OPCODES, ModeKeeper
from robot.drivers.create2.cable import Cable, Chunk
from robot.drivers.create2.encoder_counts import EncoderCounts
from robot.drivers.create2.link_health import LinkHealth
from robot.drivers.create2.serial_port import SerialPort
from robot.drivers.create2.stream_parser import StreamParser
from robot.drivers.create2.wake_up import KeepAwake, NoWakeUpLine, WakeUpLine
from robot.drivers.create2.wheel_speeds import DEADLINE_S, SPEED_CAP_MM_S, LatchedSpeeds, possible
from robot.drivers.interfaces import STOP, BaseState, Mode, Note, WheelSpeeds

__all__ = ["Create2", "possible"]

log = structlog.get_logger("robot.base")

MODE_GAP_S = 0.025
"""Older manuals ask for 20 ms between a change of mode and the next command."""


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
        self._counts, self._buttons = EncoderCounts(), HeldButtons()
        self._cable = Cable(open_port, self._lost_port)
        self._awake = KeepAwake(wake_up_line or NoWakeUpLine())
        self._ladder = ladder.StartLadder()
        self._parser = StreamParser()
        self._heard_s: float | None = None
        self._silent_since_s: float | None = None
        self._now = 0.0
        self._lights = b""
        self.state: BaseState | None = None

    @property
    def health(self) -> LinkHealth:
        return self._cable.health

    @property
    def port(self) -> SerialPort | None:
        """The port to wait at for bytes; None while the cable is pulled."""
        return self._cable.port

    def listen_in(self, heard: Chunk, sent: Chunk) -> None:
        """Be called with every piece that is read and written, and when: for the black box."""
        self._cable.heard, self._cable.sent = heard, sent

    # What comes in

    def poll(self, now: float) -> BaseState | None:
        """See `interfaces.Base.poll`. An unplugged port is noticed here and tried again every second."""
        self._now = now
        was_open = self._cable.is_open
        data = self._cable.read(now)
        if self._cable.is_open and not was_open:
            # Whatever it was told before the cable was pulled, it may still be driving.
            self._do(ladder.Start(), now)
        newest = self._take(data, now) if data else None
        if newest:
            self._keep_mode(newest, now)
        self._keep_talking(now)
        if self._speeds.overdue(now):
            self._cable.send(oi.drive_direct(STOP), now)
        if self._speeds.runs_on(now):
            # A lost byte may have left the base waiting for the data of a long command, which eats what we send.
            self._cable.send(oi.LONGEST_FILLING + oi.drive_direct(STOP), now)
        self._cable.flush(now)
        return newest

    def _take(self, data: bytes, now: float) -> BaseState | None:
        """The newest state in these bytes, with the touches of those that came along with it."""
        newest = None
        for raw in self._parser.feed(data):
            counts = self._counts.accept(raw["left_count"], raw["right_count"], now)
            if counts is None:
                self.health.corrupt += 1
            else:
                newest = together(newest, self._heard(raw, counts, now))
        self.health.corrupt += self._parser.take_corrupt()
        if self._parser.lines:
            self.health.take_lines(self._parser.take_lines())
        return newest

    def _heard(self, raw: dict[str, int], counts: tuple[int, int], now: float) -> BaseState:
        raw["buttons"] = self._buttons.seen(raw["buttons"], now)
        new = state_of(raw, counts, self._modes.read(raw.get("mode"), now), now)
        self._speeds.heard(self.state, new)
        self.state, self._heard_s = new, now
        self.health.frames += 1
        self.health.tells_mode = "mode" in raw
        return new

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
        if self._lights and mode is not Mode.PASSIVE:
            # Entering Safe or Full puts all lights out.
            self._cable.send(self._lights, now)

    def _keep_mode(self, state: BaseState, now: float) -> None:
        if self._modes.doubtful:
            self._modes.doubtful = False
            self._cable.send(bytes((oi.Opcode.START,)), now, MODE_GAP_S)
        if self._modes.lost(state, self._speeds.stalled(now), now):
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
        self._lights = oi.leds(colour, brightness)
        self._cable.send(self._lights, now)

    def close(self) -> None:
        """See `interfaces.Base.close`."""
        self._cable.close(oi.drive_direct(STOP) + bytes((oi.Opcode.START,)), self._now)

    # Starting and waking

    def _keep_talking(self, now: float) -> None:
        """Start a silent base again; keep one that has nothing to do from falling asleep."""
        heard_s = self._heard_s
        silent = heard_s is None or now - heard_s >= ladder.SILENT_S
        if self._silent_since_s is None or not silent:
            self._silent_since_s = now if heard_s is None else heard_s
        self._tell_silence(now - self._silent_since_s)
        if not silent:
            self._speaks(now)
        elif self._cable.is_open:
            for act in self._ladder.due(self._awake.wired, now):
                self._do(act, now)
        idle = self._modes.wanted is Mode.PASSIVE and self._speeds.still and not silent
        if self._awake.step(idle, self.state is not None and self.state.docked, now):
            self._cable.send(bytes((oi.Opcode.SAFE,)), now, MODE_GAP_S)
            self._cable.send(bytes((oi.Opcode.START,)), now, MODE_GAP_S)

    def _tell_silence(self, silent_s: float) -> None:
        health = self.health
        health.silent_s, was_down = silent_s, health.down
        health.down = silent_s > ladder.DOWN_S
        if health.down and not was_down:
            log.error("base_link_down", silent_s=round(silent_s), problem=health.problem)

    def _speaks(self, now: float) -> None:
        step = self._ladder.heard()
        if step is None:
            return
        self._cable.speak_at(oi.BAUD, now)
        self.health.awoken_by = step.name
        if step is ladder.AT_19200:
            self.health.spoke_at_baud = oi.SLOW_BAUD
            log.warning("base_spoke_at_19200_baud", now_at=oi.BAUD)

    def _do(self, act: ladder.Act, now: float) -> None:
        match act:
            case ladder.Pulse():
                self._awake.pulse(now)
            case ladder.Listen(baud):
                self._cable.speak_at(baud, now)
            case ladder.Send(data, gap_s):
                self._cable.send(data, now, gap_s)
                if data == ladder.RESET_BYTES:
                    self._counts.base_was_reset()
            case ladder.Start(stream):
                self._start(stream, now)

    def _start(self, stream: oi.StreamLayout, now: float) -> None:
        self._modes.started(now)
        self._speeds.started_anew()
        self.health.starts += 1
        self._cable.forget()
        self._cable.send(oi.FILLING + bytes((oi.Opcode.START,)), now, MODE_GAP_S)
        self._cable.send(stream.command(), now)
