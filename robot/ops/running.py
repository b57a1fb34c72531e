"""One run of the daemon: from settings and a wish to the last summary."""

import json
import os
import signal
import socket
import sys
import tempfile
from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from types import FrameType

import structlog

from protocol.clock import Clock, RealClock, SharedClock, SteppedClock
from robot.agent.mind import Mind, messages_from_person
from robot.core.config import ConfigError, Settings
from robot.core.errors import RobotError
from robot.core.json_socket import JsonSocket
from robot.core.service_manager import ServiceManager, SignsOfLife
from robot.link.link import Link, LinkError
from robot.ops.assembly import Parts, Simulation, assemble
from robot.ops.control import SOCKET_NAME, Control
from robot.ops.diagnostics import DiagnosticsReporter
from robot.ops.report import Ending, Refusal, Reporter
from robot.ops.runners import SWITCH_INTERVAL_S, LockstepRunner, Runner, ThreadedRunner
from robot.ops.status import StatusBoard
from robot.simulated import Door, SimulatedRobot

log = structlog.get_logger("robot.run")


class DoorInUse(RobotError):
    """Another simulated robot listens there."""

    def __init__(self, path: Path) -> None:
        super().__init__(f"Another robot's door is at {path}. Stop that one, or give another --door.")


@dataclass(frozen=True)
class RunOptions:
    """Options of the command line for this run, beside the settings."""

    tell: tuple[str, ...]
    goals: tuple[str, ...]
    limit_s: float
    as_json: bool
    speed: float | None
    door: Path | None


def clock_for(simulated: bool, path: Path | None, options: RunOptions, settings: Settings, closing: ExitStack) -> Clock:
    """The machine's time; a shared one; or, for a run that ends by itself and meets no other, as fast as it goes."""
    if path:
        try:
            return SharedClock(path)
        except (OSError, ValueError) as error:
            raise ConfigError(str(path), "--clock", f"cannot be joined: {error}") from None
    if not simulated:
        return RealClock()
    if options.goals and options.speed is None and settings.server is None:
        return SteppedClock()
    folder = closing.enter_context(tempfile.TemporaryDirectory(prefix="campus-mail-clock-"))
    return SharedClock.create(Path(folder) / "clock", options.speed or 1.0)


def run_once(settings: Settings, clock: Clock, simulation: Simulation | None, options: RunOptions) -> bool:
    """Until it is stopped or has finished; whether it did what it was asked."""
    with ExitStack() as closing:
        if options.door:
            _check_door(options.door)
        parts = assemble(settings, clock, simulation)
        runner = _runner(parts, clock, simulation, options)
        closing.callback(lambda: parts.daemon.close(runner.now_s))
        reporter = _reporter(parts, settings, clock, options)
        ending = Ending(parts.mind, options.goals, clock.now() + options.limit_s, runner.stop)
        refusal = Refusal(parts.link, runner.stop)
        parts.daemon.watchers = (reporter.look, ending.look, refusal.look)
        if options.door and parts.robot:
            closing.callback(_open_door(parts.robot, options.door, reporter).close)
        board = StatusBoard(
            settings.name, parts.daemon, parts.mind, runner, clock, clock.now(), parts.link, settings.server
        )
        control = Control(parts.daemon.drive, board.tell, lambda: parts.daemon.body.black_box.write("on_demand"))
        closing.callback(_open_control(settings.data / SOCKET_NAME, control).close)
        signs = SignsOfLife(ServiceManager.of_environment(os.environ), board.signs, board.sentence)
        closing.callback(signs.close)
        if parts.link:
            parts.daemon.watchers += (_shown_to_watchers(parts.mind, parts.link, runner, clock),)
            parts.link.start()
        _stop_on_signals(runner)
        runner.run()
    if refusal.reason:
        raise LinkError(refusal.reason)
    _tell_end(reporter, ending, options)
    return ending.problem is None


def _shown_to_watchers(mind: Mind, link: Link, runner: Runner, clock: Clock) -> Callable[[float], None]:
    """Return what runs after each tick of the mind for those who watch it from the service."""
    reporter = DiagnosticsReporter(mind, link, runner.lags, clock.utc)
    link.on_watch = lambda watch: reporter.watch(watch.for_s, watch.whole)
    return reporter.look


def _open_door(robot: SimulatedRobot, path: Path, reporter: Reporter) -> Door:
    try:
        return Door(robot, path, lambda: {"robot": reporter.summary()})
    except OSError as error:
        raise ConfigError(
            str(path), "--door", f"no socket can be made there: {error}", "Give another --door."
        ) from None


def _open_control(path: Path, control: Control) -> JsonSocket:
    try:
        return JsonSocket(path, control.answer)
    except OSError as error:
        raise ConfigError(str(path), "data", f"no socket can be made there: {error}", "Give another --data.") from None


def _check_door(path: Path) -> None:
    """A path with a listening process is occupied; one that is left over from a kill is not."""
    with socket.socket(socket.AF_UNIX) as probe:
        try:
            probe.connect(str(path))
        except OSError:
            return
    raise DoorInUse(path)


def _told_to_a_person(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


def _told_and_logged(text: str) -> None:
    _told_to_a_person(text)
    log.info(text.strip())


def _reporter(parts: Parts, settings: Settings, clock: Clock, options: RunOptions) -> Reporter:
    reporter = Reporter(
        parts.mind, parts.robot, clock.now(), _told_to_a_person if settings.log_file is None else _told_and_logged
    )
    parts.mind.hands.noted = reporter.note
    parts.mind.inbox.extend(messages_from_person(options.tell, options.goals))
    return reporter


def _runner(parts: Parts, clock: Clock, simulation: Simulation | None, options: RunOptions) -> Runner:
    if simulation is None:
        return ThreadedRunner(parts.daemon.loops(), clock)
    sys.setswitchinterval(SWITCH_INTERVAL_S)  # one thread computes all the time: the link's must get its turn at once
    most = clock.speed if isinstance(clock, SharedClock) else 1.0
    return LockstepRunner(parts.daemon.loops(), clock, options.speed or most)


def _stop_on_signals(runner: Runner) -> None:
    def stop(_: int, __: FrameType | None) -> None:
        runner.stop()

    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, stop)


def _tell_end(reporter: Reporter, ending: Ending, options: RunOptions) -> None:
    if not options.goals:
        return
    summary = {"done": ending.problem is None, "reason": ending.problem, **reporter.summary()}
    if options.as_json:
        print(json.dumps(summary))
    else:
        for key, value in summary.items():
            print(f"{key:20} {', '.join(value) if isinstance(value, list) else value}")
