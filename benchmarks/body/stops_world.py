"""A simulated robot behind a pseudo-terminal, in a process of its own, that notes when which bytes passed.

Times are of the machine's monotonic clock, which all processes share.
"""

import time
from dataclasses import asdict, dataclass
from multiprocessing.connection import Connection
from random import Random

from maps import builtin_map
from robot.drivers.create2.stream_parser import StreamParser
from robot.simulated import SimulatedRobot
from robot.simulated.base.serial_line import PtyLine

STOP = bytes((145, 0, 0, 0, 0))
POLL_EVERY_S = 0.001
STANDING_MM_S = 1.0
BUMP_S = 0.1


@dataclass
class Seen:
    """Events since `begin`; None: not yet."""

    bump_shown_s: float | None = None
    """Just before the first frame that shows it was written."""
    stop_heard_s: float | None = None
    """The last byte of the first stop after the cause had come."""
    standing_s: float | None = None


class StampedLine:
    """The robot's end of the cable, read without waiting for the robot's next step."""

    def __init__(self, line: PtyLine, seed: int) -> None:
        self._line, self._random = line, Random(seed)
        self._waiting, self._tail = bytearray(), b""
        self._parser = StreamParser()
        self.awaits_bump = False
        self.seen = Seen()

    def look(self, baud: int) -> None:
        """Wait a moment for bytes, and note when they came."""
        self._line.wait(POLL_EVERY_S)
        data = self._line.receive(baud)
        self._waiting += data
        text = self._tail + data
        self._tail = text[-len(STOP) + 1 :]
        caused = not self.awaits_bump or self.seen.bump_shown_s is not None
        if data and caused and self.seen.stop_heard_s is None and STOP in text:
            self.seen.stop_heard_s = time.monotonic()

    def receive(self, _: int) -> bytes:
        data = bytes(self._waiting)
        self._waiting.clear()
        return data

    def send(self, data: bytes, baud: int) -> None:
        frames = self._parser.feed(data)
        if self.seen.bump_shown_s is None and any(frame["bumps_and_drops"] & 3 for frame in frames):
            self.seen.bump_shown_s = time.monotonic()
        self._line.send(data, baud)

    def close(self) -> None:
        self._line.close()


def live(connection: Connection, seed: int) -> None:
    """Main function of the process. It says the port's path, then obeys until `end`."""
    robot = SimulatedRobot(builtin_map("test_track"), time.monotonic(), "post1:post2", seed)
    pty = robot.body.line
    assert isinstance(pty, PtyLine)
    line = robot.body.line = StampedLine(pty, seed)
    connection.send(robot.port_path)
    random = Random(seed)
    bump_at_s: float | None = None
    while True:
        line.look(robot.body.interface.baud)
        now = time.monotonic()
        if bump_at_s is not None and now >= bump_at_s:
            bump_at_s = None
            robot.bump("both", BUMP_S)
        robot.step_until(now)
        wheels = (robot.body.base.left.speed_mm_s, robot.body.base.right.speed_mm_s)
        standing = max(map(abs, wheels)) < STANDING_MM_S
        if standing and line.seen.standing_s is None and line.seen.stop_heard_s is not None:
            line.seen.standing_s = now
        while connection.poll():
            match connection.recv():
                case "bump soon":
                    line.seen, line.awaits_bump = Seen(), True
                    # Not in step with anything: neither the robot's slots nor the daemon's ticks.
                    bump_at_s = now + random.uniform(0.1, 0.2)
                case "begin":
                    line.seen, line.awaits_bump = Seen(), False
                case "seen":
                    connection.send({**asdict(line.seen), "standing": standing})
                case "end":
                    robot.close()
                    return
