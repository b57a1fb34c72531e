"""A Unix socket for its owner alone: one JSON object a line in, one out. And the other end of it.

Each visitor has a thread and a time limit, and there are only so many of them: one who says nothing, too much or
nonsense does not delay the others.
"""

import json
import os
import socket
import socketserver
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import structlog

from robot.core.errors import RobotError

LONGEST_LINE = 4096
MAX_VISITORS = 8
SILENT_LIMIT_S = 5.0
LONGEST_ADDRESS = 100
"""A Unix address holds 107 bytes: a longer path is reached through its folder's descriptor."""

Answer = Callable[[Any], dict[str, Any]]
log = structlog.get_logger("robot.socket")


class NoAnswer(RobotError):
    """Nothing listens at a socket, or what listens does not answer in time."""

    def __init__(self, path: Path, reason: str) -> None:
        super().__init__(f"No robot answers at {path}: {reason}.")


class JsonSocket:
    """Answers in threads of its own until `close`. Make it before other threads: the umask belongs to the process."""

    def __init__(
        self, path: Path, answer: Answer, silent_limit_s: float | None = SILENT_LIMIT_S, name: str = "control"
    ) -> None:
        """Raises OSError when no socket can be made there. One that is left over from a kill is replaced.

        `silent_limit_s` None: a visitor may say nothing for ever.
        """
        self._path = path
        path.unlink(missing_ok=True)
        old_mask = os.umask(0o177)  # the socket must never be open to others, not even for a moment
        try:
            with _address(path) as address:
                self._server = _Server(address, _Visitor)
        finally:
            os.umask(old_mask)
        self._server.answer, self._server.silent_limit_s = answer, silent_limit_s
        self._thread = threading.Thread(target=self._server.serve_forever, args=(0.1,), name=name, daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Listen no more; visitors who are being answered are not waited for."""
        self._server.shutdown()
        self._server.server_close()
        self._thread.join()
        self._path.unlink(missing_ok=True)


class _Server(socketserver.ThreadingUnixStreamServer):
    # Who knocks while others are being let in waits for a moment. In a queue of the usual five the seventh was refused.
    request_queue_size = 4 * MAX_VISITORS
    daemon_threads = True
    block_on_close = False
    answer: Answer
    silent_limit_s: float | None

    def __init__(self, *arguments: Any) -> None:
        self.room = threading.BoundedSemaphore(MAX_VISITORS)
        super().__init__(*arguments)

    def process_request(self, request: Any, client_address: Any) -> None:
        if not self.room.acquire(blocking=False):
            self.shutdown_request(request)
            return
        try:
            super().process_request(request, client_address)
        except BaseException:
            self.room.release()  # no thread could be made for this one: its place is free again
            raise

    def process_request_thread(self, request: Any, client_address: Any) -> None:
        try:
            super().process_request_thread(request, client_address)
        finally:
            self.room.release()

    def handle_error(self, request: Any, client_address: Any) -> None:
        """A visitor who hung up, or whose time is over, is no news; mistakes of ours are caught where they happen."""


class _Visitor(socketserver.StreamRequestHandler):
    server: _Server

    def setup(self) -> None:
        super().setup()
        self.request.settimeout(self.server.silent_limit_s)

    def handle(self) -> None:
        while line := self.rfile.readline(LONGEST_LINE + 1):
            if len(line) > LONGEST_LINE:
                self._say(_refused(f"a request has at most {LONGEST_LINE} bytes"))
                return
            self._say(self._answered(line))

    def _answered(self, line: bytes) -> dict[str, Any]:
        try:
            request = json.loads(line)
        except (ValueError, RecursionError) as error:
            return _refused(f"not JSON: {error}")
        try:
            return self.server.answer(request)
        except Exception as error:
            # Whatever a request makes of us, the next one is heard.
            log.exception("request_failed")
            return _refused(repr(error))

    def _say(self, answer: dict[str, Any]) -> None:
        self.wfile.write(json.dumps(answer).encode() + b"\n")


def _refused(sentence: str) -> dict[str, Any]:
    return {"ok": False, "error": sentence}


def _in_words(error: OSError) -> str:
    match error:
        case FileNotFoundError() | ConnectionRefusedError():
            return "no daemon runs on this data folder"
        case PermissionError():
            return "only the robot's own user may ask it: sudo -u campus-mail …"
        case TimeoutError():
            return "it did not answer in time"
    return error.strerror or str(error)


def ask(path: Path, request: dict[str, Any], limit_s: float = 2.0) -> dict[str, Any]:
    """The answer to one request. Raises NoAnswer."""
    try:
        with socket.socket(socket.AF_UNIX) as connection, _address(path) as address:
            connection.settimeout(limit_s)
            connection.connect(address)
            connection.sendall(json.dumps(request).encode() + b"\n")
            with connection.makefile("rb") as file:
                line = file.readline()
        answer: dict[str, Any] = json.loads(line)
    except OSError as error:
        raise NoAnswer(path, _in_words(error)) from None
    except ValueError:
        raise NoAnswer(path, "it hung up") from None
    return answer


@contextmanager
def _address(path: Path) -> Iterator[str]:
    if len(os.fsencode(path)) <= LONGEST_ADDRESS:
        yield str(path)
        return
    folder = os.open(path.parent, os.O_RDONLY | os.O_DIRECTORY)
    try:
        yield f"/proc/self/fd/{folder}/{path.name}"
    finally:
        os.close(folder)
