"""The daemon: which loops run, how often, and what each one feeds.

| loop   | rate (setting)    | what it does                                        | feeds                      |
|--------|-------------------|-----------------------------------------------------|----------------------------|
| world  | rates.base_hz     | simulated only: lets wheels, pins and battery go on | every device               |
| line   | rates.line_hz     | one look at the three diodes                        | drive (majority vote)      |
| drive  | rates.drive_hz    | base, line, odometry, skill, reflexes, wheels       | wheels; mind (the view)    |
| camera | rates.camera_hz   | one frame: markers and hand-over codes              | drive (the view)           |
| mind   | rates.mind_hz     | percepts, reasoning, actions, heartbeat             | drive (skills); outbox     |
| tell   | rates.snapshot_hz | snapshot for the server                             | link                       |
| host   | HOST_HZ           | the computer's supply, clock, disk; stops to disk   | drive (reflexes)           |

Line and drive share a thread, since base and line sensor have one owner; it is woken before its time when the base has
felt something. Nothing in that thread waits for the mind, the network or the disk, and the last thing it does, whatever
ends it, is to stop the wheels. What is not in the table lives in threads of its own and is met through queues or by
looking at the newest view: the port of a real base, the grabbing camera, the link, the writer of the black box, the
control socket and the signs of life for systemd.
"""

from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import dataclass
from threading import Event
from typing import Protocol

from protocol.envelope import YOUNGER
from protocol.software import version
from protocol.to_server import Hello, Snapshot
from robot.agent.mind import Mind
from robot.core.config import RateSettings
from robot.drive_loop import DriveLoop
from robot.drive_loop.black_box import BlackBox
from robot.drivers.camera.marker_reader import MarkerWatch
from robot.drivers.interfaces import Base
from robot.mission.latched_stop import LatchedStop
from robot.ops.host import HostWatch
from robot.ops.runners import Loop

SOFTWARE = f"campus-mail robot {version()}"
LAST_TICKS = 30
TICK_S = 0.02
HOST_HZ = 2.0


class World(Protocol):
    """The parts that a simulation steps."""

    def step_until(self, now: float) -> None: ...

    def save(self) -> None: ...


class Server(Protocol):
    """The link, as far as the daemon is concerned."""

    def snapshot(self, snapshot: Snapshot) -> None: ...

    def stop(self) -> None: ...


@dataclass
class BodyWatch:
    """Supervision of the body from outside of the drive loop, since it waits for files."""

    host: HostWatch
    stops: LatchedStop
    black_box: BlackBox


@dataclass
class Daemon:
    """One robot with everything that belongs to it. `world` only in simulation, `server` only with a link."""

    base: Base
    drive: DriveLoop
    camera: MarkerWatch
    mind: Mind
    rates: RateSettings
    body: BodyWatch
    world: World | None = None
    server: Server | None = None
    close_devices: Callable[[], None] = lambda: None
    """Also closes memory and outbox, after everything that writes them."""
    urgent: Event | None = None
    """On threads: set when the base has felt something that must not wait for the next tick of the wheels."""
    watchers: tuple[Callable[[float], None], ...] = ()
    """Called after each tick of the mind: who prints progress, who ends the run."""

    def loops(self) -> tuple[Loop, ...]:
        """The table; in lockstep, loops that are due together run in its order."""
        rates = self.rates
        table = (
            Loop("drive", rates.drive_hz, "wheels; the view of the mind", self._drive_tick, self.base.close),
            Loop("camera", rates.camera_hz, "markers and codes for drive", self._camera_tick),
            Loop("mind", rates.mind_hz, "skills for drive; the outbox", self._mind_tick),
            Loop("tell", rates.snapshot_hz, "the link", self._tell_tick),
            Loop("host", HOST_HZ, "reflexes; latched stops on the disk", self._host_tick),
        )
        if rates.line_hz > rates.drive_hz:
            table = (self._line_and_drive(), *table[1:])
        if self.world is None:
            return table
        return (Loop("world", rates.base_hz, "every device", self.world.step_until), *table)

    def _line_and_drive(self) -> Loop:
        """Both loops in one thread: a sample at every tick, the wheels at every few, and at once when it is urgent."""
        every = round(self.rates.line_hz / self.rates.drive_hz)
        number = 0

        def tick(now: float) -> None:
            nonlocal number
            number = (number + 1) % every
            if self.urgent is not None and self.urgent.is_set():
                self.urgent.clear()
                self._drive_tick(now)
            elif number:
                self.drive.sample_line()
            else:
                self._drive_tick(now)

        return Loop(
            "line and drive", self.rates.line_hz, "wheels; the view of the mind", tick, self.base.close, self.urgent
        )

    def _drive_tick(self, now: float) -> None:
        self.drive.tick(now)

    def _camera_tick(self, now: float) -> None:
        self.drive.report(self.camera.tick(now), now)

    def _mind_tick(self, now: float) -> None:
        self.mind.tick(now)
        for watcher in self.watchers:
            watcher(now)

    def _host_tick(self, now: float) -> None:
        self.drive.report_host(self.body.host.tick(now))
        self.body.stops.keep(self.drive.view.faults)

    def _tell_tick(self, now: float) -> None:
        if self.server:
            self.server.snapshot(self.mind.snapshot())

    def hello(self) -> Hello:
        """Return the report to the server at every connection; called in the link's thread."""
        state = self.mind.snapshot()
        return Hello(
            position=state.position,
            cargo=state.cargo,
            mission=state.mission,
            battery=state.battery,
            software=SOFTWARE,
            map_version=self.mind.hands.navigator.campus.version,
            understands=YOUNGER,
            home=self.mind.hands.navigator.home,
        )

    def close(self, now: float) -> None:
        """Stop the wheels, leave the base in Passive (or it would never charge), close outbox and link."""
        with ExitStack() as last:  # each of them, even if one before it fails
            last.callback(self.body.stops.keep, self.drive.view.faults)  # its loop may not have seen the newest
            last.callback(self.close_devices)
            last.callback(self.body.black_box.close)
            if self.server:
                last.callback(self.server.stop)
            self.base.close()
            if self.world:
                for tick in range(LAST_TICKS):  # the last bytes are on their way to the simulated base
                    self.world.step_until(now + tick * TICK_S)
                self.world.save()
