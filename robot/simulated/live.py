"""A thread that lets a simulated robot live by a clock, for clients that know no stepping (`pycreate2`, a terminal)."""

import threading
from types import TracebackType

from protocol.clock import Clock
from robot.simulated.errors import WorldStopped
from robot.simulated.robot import SimulatedRobot

PAUSE_S = 0.005
LOOK_EVERY_S = 0.2


class Live:
    """`with Live(robot, RealClock()): …`; the robot must have been made at the clock's present time.

    Raises WorldStopped at the end of the block if the thread has failed.
    """

    def __init__(self, robot: SimulatedRobot, clock: Clock) -> None:
        self._robot = robot
        self._clock = clock
        self._stop = threading.Event()
        self._failure: Exception | None = None
        self._thread = threading.Thread(target=self._run, name="simulated world", daemon=True)

    def _run(self) -> None:
        try:
            while not self._stop.wait(PAUSE_S):
                self._robot.step_until(self._clock.now())
        except Exception as failure:
            self._failure = failure  # for the thread that waits: no caller asks this one

    def stop(self) -> None:
        """End `wait`; a signal handler may call it."""
        self._stop.set()

    def wait(self) -> None:
        """Until `stop`, or until the thread fails."""
        while not self._stop.wait(LOOK_EVERY_S) and self._thread.is_alive():
            pass

    def __enter__(self) -> "Live":
        self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._stop.set()
        self._thread.join()
        if self._failure and error is None:
            raise WorldStopped(self._failure) from self._failure
