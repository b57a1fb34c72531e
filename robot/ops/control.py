"""Requests of a technician to a running daemon, through the socket `control` in its data folder.

| request                  | what happens                                                        |
|--------------------------|---------------------------------------------------------------------|
| `{"do": "status"}`       | what it does, why, battery, faults, punctuality of the loops, link  |
| `{"do": "stop"}`         | emergency stop: the wheels stand, and stay so through a restart     |
| `{"do": "rearm"}`        | it may go again, if what stopped it is over                         |
| `{"do": "black_box"}`    | the last minute is written into a file, which is named              |

Nothing here waits for the mind or the network, and only the black box for the disk: a robot whose mind hangs can
still be asked and stopped.
"""

import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

from robot.reflexes import LATCHED
from robot.skills.interfaces import View

SOCKET_NAME = "control"
SEEN_WITHIN_S = 1.0
"""So long a stop or a re-arming may take to be seen in the drive loop, fifty ticks."""
LOOK_S = 0.01
Status = Callable[[], dict[str, Any]]


class Drive(Protocol):
    """The drive loop, as far as it concerns this."""

    view: View

    def emergency_stop(self) -> None: ...

    def rearm(self) -> None: ...


@dataclass(frozen=True)
class Control:
    """Answers requests. `black_box` writes a file and names it; None: there is no black box."""

    drive: Drive
    status: Status
    black_box: Callable[[], Path | None] | None = None

    def answer(self, request: Any) -> dict[str, Any]:
        """Called in a thread of the socket. Always `ok` true, or false with an `error` in words."""
        wanted = request.get("do") if isinstance(request, dict) else None
        do = _REQUESTS.get(wanted) if isinstance(wanted, str) else None
        if do is None:
            known = ", ".join(_REQUESTS)
            return {"ok": False, "error": f'{request!r:.80} is no request. Write {{"do": WORD}}, one of: {known}.'}
        return do(self)

    def _status(self) -> dict[str, Any]:
        return {"ok": True, **self.status()}

    def _stop(self) -> dict[str, Any]:
        self.drive.emergency_stop()
        return self._seen(self._stopped)

    def _stopped(self) -> bool:
        return "emergency_stop" in self.drive.view.faults and self.drive.view.sent.still

    def _rearm(self) -> dict[str, Any]:
        self.drive.rearm()
        return self._seen(self._armed)

    def _armed(self) -> bool:
        return not self.drive.view.faults & LATCHED

    def _seen(self, holds: Callable[[], bool]) -> dict[str, Any]:
        """Report whether the drive loop has done it: an answer that only says "asked" would be no comfort."""
        until_s = time.monotonic() + SEEN_WITHIN_S
        while not (done := holds()) and time.monotonic() < until_s:
            time.sleep(LOOK_S)
        faults = sorted(self.drive.view.faults)
        return {"ok": True, "faults": faults} if done else {"ok": False, "faults": faults, "error": _not_yet(faults)}

    def _dump(self) -> dict[str, Any]:
        written = self.black_box() if self.black_box else None
        if written is None:
            return {"ok": False, "error": "there is no black box to write"}
        return {"ok": True, "file": str(written)}


def _not_yet(faults: list[str]) -> str:
    return f"not within {SEEN_WITHIN_S:g} s; faults: {', '.join(faults) or 'none'}"


_REQUESTS: dict[str, Callable[[Control], dict[str, Any]]] = {
    "status": Control._status,
    "stop": Control._stop,
    "rearm": Control._rearm,
    "black_box": Control._dump,
}
