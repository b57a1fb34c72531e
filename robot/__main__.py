"""The robot's daemon. `python -m robot --help`."""

import json
import signal
import socket
import sys
import tempfile
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from types import FrameType
from typing import Annotated, Any, NoReturn

import structlog
import typer

from bdi import BdiError
from maps import CampusMapError, find_map
from protocol.clock import Clock, RealClock, SharedClock, SteppedClock

from .assembly import Parts, Simulation, assemble
from .config import ConfigError, PerceptMode, Settings, load_settings
from .errors import RobotError
from .link import LinkError
from .mind import messages_from_person
from .report import Ending, Refusal, Reporter
from .runners import LockstepRunner, Runner, ThreadedRunner
from .simulated import Door, SimulatedRobot, SimulatedWorldError
from .store import StoreError

UNFINISHED, MISUSE = 1, 2
SWITCH_INTERVAL_S = 0.0005
"""In simulation one thread computes all the time: the link's thread must get its turn at once."""
DEFAULT_LIMIT_S = 7200.0
# A run of minutes would not see the battery of a Create 2 become low and full again: with --battery the simulated pack
# is assumed to be small and its charger strong.
ASSUMED_PACK = {"battery.simulated_capacity_mah": 1500.0, "battery.simulated_charger_ma": 10_000.0}
SIMULATED_LINE_HZ = 50.0
"""The simulated diodes do not flicker unless asked to: one look per tick is enough, and four times as quick."""

EPILOG = """
A robot at home in a simulated tunnel, in real time:  python -m robot --simulated

Ours, sent somewhere by hand:  python -m robot --simulated --achieve 'visit(post4)'

The run of the paper's section 6.3:  python -m robot --simulated --agent mail.asl --tell 'dockStation(post5)'
--achieve 'collectAndDeliverMail(post1,post4)'; with --battery 0.26 it becomes low on the way.
"""

cli = typer.Typer(add_completion=False, rich_markup_mode=None)


class DoorTaken(RobotError):
    """Another simulated robot listens there."""

    def __init__(self, path: Path) -> None:
        super().__init__(f"Another robot's door is at {path}. Stop that one, or give another --door.")


@dataclass(frozen=True)
class Wish:
    """What the command line asks of this run, beside the settings."""

    tell: tuple[str, ...]
    goals: tuple[str, ...]
    limit_s: float
    as_json: bool
    speed: float | None
    door: Path | None


@cli.command(epilog=EPILOG)
def run(  # typer reads the options from here
    config: Annotated[Path | None, typer.Option(help="Settings (TOML); docs/robot.md lists every key.")] = None,
    simulated: Annotated[bool, typer.Option("--simulated", help="A simulated body in a simulated tunnel.")] = False,
    campus: Annotated[str | None, typer.Option("--map", help="A built-in map by name, or a map file.")] = None,
    name: Annotated[str | None, typer.Option(help="The robot's name, as the service knows it.")] = None,
    server: Annotated[str | None, typer.Option(help="The service's robot link, wss://…; without it: alone.")] = None,
    token_file: Annotated[Path | None, typer.Option(help="File with the robot's token, mode 0600.")] = None,
    data: Annotated[Path | None, typer.Option(help="Folder of memory, outbox and simulated world.")] = None,
    clock: Annotated[Path | None, typer.Option(help="Simulation: join the shared clock in this file.")] = None,
    speed: Annotated[
        float | None, typer.Option(min=0.1, help="Simulation: at most so many seconds per second.")
    ] = None,
    door: Annotated[Path | None, typer.Option(help="Simulation: Unix socket into the world.")] = None,
    agent: Annotated[Path | None, typer.Option(help="Another agent program (AgentSpeak).")] = None,
    percepts: Annotated[PerceptMode | None, typer.Option(help="Default: drain with --agent, else latest.")] = None,
    tell: Annotated[list[str] | None, typer.Option(help="A belief told to the agent; may be repeated.")] = None,
    achieve: Annotated[
        list[str] | None, typer.Option(help="A goal for the agent; the run ends when nothing is left to do.")
    ] = None,
    start: Annotated[
        str | None,
        typer.Option(help="Simulation: dock, POST, or POST:TOWARDS. Default: dock, on the line with --agent."),
    ] = None,
    battery: Annotated[
        float | None, typer.Option(min=0, max=1, help="Simulation: charge at the start, of a small pack (assumed).")
    ] = None,
    seed: Annotated[int, typer.Option(help="Simulation: same seed, same world.")] = 0,
    limit: Annotated[float, typer.Option(help="With --achieve: give up after so many seconds.")] = DEFAULT_LIMIT_S,
    as_json: Annotated[bool, typer.Option("--json", help="With --achieve: one JSON object at the end.")] = False,
) -> None:
    """Run one robot until Ctrl-C, or until what it was told to --achieve is done.

    Exit status 0: done, or nothing was to be achieved. 1: not done within --limit, given up, or stopped before.
    2: something to put right first, which is named.
    """
    structlog.configure(logger_factory=lambda *_: structlog.PrintLogger(sys.stderr))  # stdout is for --json
    asked = {
        "map": campus,
        "name": name,
        "server": server,
        "token_file": token_file,
        "data": data,
        "mind.program": agent,
        "mind.percepts": percepts,
    }
    wish = Wish(tuple(tell or ()), tuple(achieve or ()), limit, as_json, speed, door)
    with ExitStack() as closing:
        try:
            settings = _settings(config, asked, simulated, battery, closing)
            simulation = _simulation(settings, start, battery, seed, clock) if simulated else None
            done = _run(settings, _clock(simulated, clock, wish, settings, closing), simulation, wish)
        except (ConfigError, CampusMapError, BdiError, RobotError, StoreError, SimulatedWorldError) as problem:
            _refuse(str(problem))
    raise typer.Exit(0 if done else UNFINISHED)


def _refuse(sentence: str) -> NoReturn:
    typer.echo(sentence, err=True)
    raise typer.Exit(MISUSE)


def _settings(
    config: Path | None, asked: dict[str, Any], simulated: bool, battery: float | None, closing: ExitStack
) -> Settings:
    """From the file and the command line. A simulated robot that nobody gave a folder leaves nothing behind."""
    if simulated and config is None and asked["data"] is None and asked["server"] is None:
        asked["data"] = Path(closing.enter_context(tempfile.TemporaryDirectory(prefix="campus-mail-robot-")))
    if simulated:
        asked["rates.line_hz"] = SIMULATED_LINE_HZ
    if simulated and battery is not None:
        asked.update(ASSUMED_PACK)
    return load_settings(config, asked)


def _simulation(
    settings: Settings, start: str | None, battery: float | None, seed: int, clock: Path | None
) -> Simulation:
    """A foreign program need not know that it stands in a dock: it begins on the line, on the way to the first post."""
    if start is None and settings.mind.program:
        campus = find_map(settings.map)
        first = next(iter(campus.posts))
        start = f"{campus.neighbours(first)[0][0].name}:{first}"
    return Simulation(start, battery, seed)


def _clock(simulated: bool, path: Path | None, wish: Wish, settings: Settings, closing: ExitStack) -> Clock:
    """The machine's time; a shared one; or, for a run that ends by itself and meets nobody, as fast as it goes."""
    if path:
        try:
            return SharedClock(path)
        except (OSError, ValueError) as error:
            raise ConfigError(str(path), "--clock", f"cannot be joined: {error}") from None
    if not simulated:
        return RealClock()
    if wish.goals and wish.speed is None and settings.server is None:
        return SteppedClock()
    folder = closing.enter_context(tempfile.TemporaryDirectory(prefix="campus-mail-clock-"))
    return SharedClock.create(Path(folder) / "clock", wish.speed or 1.0)


def _run(settings: Settings, clock: Clock, simulation: Simulation | None, wish: Wish) -> bool:
    """Until it is stopped or has finished; whether it did what it was asked."""
    with ExitStack() as closing:
        if wish.door:
            _check_door(wish.door)
        parts = assemble(settings, clock, simulation)
        runner = _runner(parts, clock, simulation, wish)
        closing.callback(lambda: parts.daemon.close(runner.now_s))
        reporter = _reporter(parts, clock, wish)
        ending = Ending(parts.mind, wish.goals, clock.now() + wish.limit_s, runner.stop)
        refusal = Refusal(parts.link, runner.stop)
        parts.daemon.watchers = (reporter.look, ending.look, refusal.look)
        if wish.door and parts.robot:
            closing.callback(_open_door(parts.robot, wish.door, reporter).close)
        if parts.link:
            parts.link.start()
        _stop_on_signals(runner)
        runner.run()
    if refusal.reason:
        raise LinkError(refusal.reason)
    _tell_end(reporter, ending, wish)
    return ending.problem is None


def _open_door(robot: SimulatedRobot, path: Path, reporter: Reporter) -> Door:
    try:
        return Door(robot, path, lambda: {"robot": reporter.summary()})
    except OSError as error:
        raise ConfigError(
            str(path), "--door", f"no socket can be made there: {error}", "Give another --door."
        ) from None


def _check_door(path: Path) -> None:
    """A path that somebody listens at is taken; one that is left over from a kill is not."""
    with socket.socket(socket.AF_UNIX) as probe:
        try:
            probe.connect(str(path))
        except OSError:
            return
    raise DoorTaken(path)


def _reporter(parts: Parts, clock: Clock, wish: Wish) -> Reporter:
    reporter = Reporter(parts.mind, parts.robot, clock.now(), lambda text: print(text, file=sys.stderr, flush=True))
    parts.mind.hands.noted = reporter.note
    parts.mind.inbox.extend(messages_from_person(wish.tell, wish.goals))
    return reporter


def _runner(parts: Parts, clock: Clock, simulation: Simulation | None, wish: Wish) -> Runner:
    if simulation is None:
        return ThreadedRunner(parts.daemon.loops(), clock)
    sys.setswitchinterval(SWITCH_INTERVAL_S)
    most = clock.speed if isinstance(clock, SharedClock) else 1.0
    return LockstepRunner(parts.daemon.loops(), clock, wish.speed or most)


def _stop_on_signals(runner: Runner) -> None:
    def stop(_: int, __: FrameType | None) -> None:
        runner.stop()

    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, stop)


def _tell_end(reporter: Reporter, ending: Ending, wish: Wish) -> None:
    if not wish.goals:
        return
    summary = {"done": ending.problem is None, "reason": ending.problem, **reporter.summary()}
    if wish.as_json:
        print(json.dumps(summary))
    else:
        for key, value in summary.items():
            print(f"{key:20} {', '.join(value) if isinstance(value, list) else value}")


if __name__ == "__main__":
    cli(prog_name="python -m robot")
