"""Notifications for systemd: ready, alive, stopping. A few lines of the protocol `sd_notify(3)`, so no library.

The watchdog is fed only when every part has given a sign of life since it was last fed: a frame of the base heard, a
tick of the drive loop, a tick of the mind. If one of them hangs, systemd kills the daemon, stops the base
(`ExecStopPost`) and starts the daemon again.
"""

import os
import socket
import threading
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import structlog

FEEDS_PER_LIMIT = 4
LOOK_S = 1.0
"""Interval of the checks when systemd asks for no watchdog, but wants to know when we are ready."""

log = structlog.get_logger("robot.core.service_manager")

Signs = Mapping[str, object]
"""For each part something that changes whenever it gives a sign of life; None: it never has."""


@dataclass(frozen=True)
class ServiceManager:
    """The socket that systemd listens at; without an address, messages are discarded."""

    address: str | None = None
    watchdog_s: float | None = None
    """It must hear from us this often."""

    @classmethod
    def of_environment(cls, environment: Mapping[str, str]) -> "ServiceManager":
        """`NOTIFY_SOCKET`, and `WATCHDOG_USEC` if it is meant for this process."""
        address = environment.get("NOTIFY_SOCKET") or None
        meant_for = environment.get("WATCHDOG_PID", str(os.getpid()))
        usec = environment.get("WATCHDOG_USEC", "")
        watched = address is not None and usec.isdigit() and int(usec) > 0 and meant_for == str(os.getpid())
        return cls(address, int(usec) / 1e6 if watched else None)

    def say(self, *lines: str) -> None:
        """One datagram; an absent manager, or one that is deaf, is no reason to stop driving."""
        if self.address is None:
            return
        address = f"\0{self.address[1:]}" if self.address.startswith("@") else self.address
        try:
            with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM | socket.SOCK_CLOEXEC) as out:
                out.settimeout(0.1)
                out.sendto("\n".join(lines).encode(), address)
        except OSError as error:
            log.warning("service_manager_deaf", reason=str(error))


@dataclass
class Watchdog:
    """Decides when to feed: pure but for what it remembers."""

    fed_at: dict[str, object] = field(default_factory=dict)
    """The signs as they were when it was last fed."""

    def all_alive(self, signs: Signs) -> bool:
        """Return whether every part has given a sign since this was last true."""
        if self.silent(signs):
            return False
        self.fed_at = dict(signs)
        return True

    def silent(self, signs: Signs) -> list[str]:
        """The parts that have given none."""
        return [part for part, sign in signs.items() if sign is None or sign == self.fed_at.get(part)]


class SignsOfLife:
    """A thread of its own that looks at the signs and speaks to systemd; it never blocks on another thread."""

    def __init__(self, manager: ServiceManager, signs: Callable[[], Signs], saying: Callable[[], str]) -> None:
        """`saying`: one line for `systemctl status`."""
        self._manager, self._signs, self._saying = manager, signs, saying
        self._every_s = (manager.watchdog_s or FEEDS_PER_LIMIT * LOOK_S) / FEEDS_PER_LIMIT
        self._watchdog = Watchdog()
        self._ready = False
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._run, name="signs of life", daemon=True)
        if manager.address:
            self._thread.start()

    def _run(self) -> None:
        while not self._stopping.wait(self._every_s):
            try:
                self._look()
            except Exception:
                # What cannot be asked is no sign of life; one bad look must not end the looking.
                log.exception("signs_of_life_unread")

    def _look(self) -> None:
        signs = self._signs()
        silent = self._watchdog.silent(signs)
        if self._watchdog.all_alive(signs):
            self._feed()
        else:
            self._manager.say(f"STATUS=No sign of life from: {', '.join(silent)}")

    def _feed(self) -> None:
        ready = () if self._ready else ("READY=1",)
        self._ready = True
        self._manager.say(*ready, "WATCHDOG=1", f"STATUS={self._saying()}")

    def close(self) -> None:
        """Say that we are ending, so that a slow end is no hang."""
        self._stopping.set()
        if self._thread.is_alive():
            self._thread.join()
            self._manager.say("STOPPING=1")
