"""A base in real time: a thread of its own listens at the port, and stops the wheels if the drive loop hangs.

It wakes as soon as bytes arrive, so that a frame has its true time, and the drive loop can be woken by it. Whatever is
sent goes out in the caller's own thread; neither waits longer for the other than for one read or write of the port,
which take `serial_port.WRITE_TIMEOUT_S` at worst.
"""

import threading
from collections.abc import Callable

import structlog

from robot.drivers.create2.base_frames import together
from robot.drivers.create2.create2 import Create2
from robot.drivers.create2.link_health import LinkHealth
from robot.drivers.create2.serial_port import wait_for_bytes
from robot.drivers.interfaces import BaseState, Mode, Note, WheelSpeeds

log = structlog.get_logger("robot.base")

LOOK_EVERY_S = 0.02
"""So often deadline, start-up and sleep are looked after when nothing arrives."""
END_WITHIN_S = 0.5


def _alarming(state: BaseState) -> bool:
    return state.bump or state.wheel_drop or state.cliff or state.wheel_over_current or bool(state.buttons)


class PortThread:
    """A `Create2` behind a lock; see `interfaces.Base`."""

    def __init__(self, base: Create2, clock_now: Callable[[], float]) -> None:
        """`clock_now` is the daemon's clock. `start` begins."""
        self._base, self._clock_now = base, clock_now
        self._lock = threading.Lock()
        self._unseen: BaseState | None = None
        self._ending = threading.Event()
        self._alarming = False
        self.urgent = threading.Event()
        """Set when a frame shows a touch, a drop, an edge or a press that the frame before did not: the drive loop
        should look at once, and clears it."""
        self._thread = threading.Thread(target=self._listen, name="base port", daemon=True)

    def start(self) -> None:
        self._thread.start()

    def _listen(self) -> None:
        try:
            while not self._ending.is_set():
                wait_for_bytes(self._base.port, LOOK_EVERY_S)
                self._look()
        except Exception:
            # The driving thread reads the port itself from now on; if that fails as well, its loop ends and stops.
            log.exception("port_thread_failed")

    def _look(self) -> None:
        with self._lock:
            if self._ending.is_set():
                return
            state = self._base.poll(self._clock_now())
            if state is not None:
                self._unseen = together(self._unseen, state)
        if state is not None:
            was_alarming, self._alarming = self._alarming, _alarming(state)
            if self._alarming and not was_alarming:
                self.urgent.set()

    def poll(self, now: float) -> BaseState | None:
        """Return the input since the last call. Without it (not started, or ended) the port is read here."""
        if not self._thread.is_alive() and not self._ending.is_set():
            self._look()
        with self._lock:
            unseen, self._unseen = self._unseen, None
        return unseen

    @property
    def state(self) -> BaseState | None:
        return self._base.state

    @property
    def health(self) -> LinkHealth:
        return self._base.health

    def drive(self, wanted: WheelSpeeds, now: float) -> WheelSpeeds:
        with self._lock:
            return self._base.drive(wanted, now)

    def set_mode(self, mode: Mode, now: float) -> None:
        with self._lock:
            self._base.set_mode(mode, now)

    def seek_dock(self, now: float) -> None:
        with self._lock:
            self._base.seek_dock(now)

    def play(self, notes: tuple[Note, ...], now: float) -> None:
        with self._lock:
            self._base.play(notes, now)

    def show_lights(self, colour: float, brightness: float, now: float) -> None:
        with self._lock:
            self._base.show_lights(colour, brightness, now)

    def listen_in(self, heard: Callable[[bytes, float], None], sent: Callable[[bytes, float], None]) -> None:
        with self._lock:
            self._base.listen_in(heard, sent)

    def close(self) -> None:
        """Ends the thread, then stops and leaves the base in Passive."""
        self._ending.set()
        if self._thread.is_alive() and self._thread is not threading.current_thread():
            self._thread.join(END_WITHIN_S)
        with self._lock:
            self._base.close()
