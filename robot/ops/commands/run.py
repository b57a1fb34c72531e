"""`run`: the daemon, real or simulated."""

import tempfile
from contextlib import ExitStack
from pathlib import Path
from typing import Annotated, Any

import typer

from bdi import BdiError
from maps import CampusMapError, find_map
from robot.core.config import ConfigError, PerceptMode, Settings, load_settings
from robot.core.errors import RobotError
from robot.core.logs import configure_logs
from robot.ops.assembly import Simulation
from robot.ops.commands.asking import UNFINISHED, refuse
from robot.ops.running import RunOptions, clock_for, run_once
from robot.simulated import SimulatedWorldError

DEFAULT_LIMIT_S = 7200.0
# A run of minutes would not see the battery of a Create 2 become low and full again: with --battery the simulated pack
# is assumed to be small and its charger strong.
ASSUMED_PACK = {"battery.simulated_capacity_mah": 1500.0, "battery.simulated_charger_ma": 10_000.0}
SIMULATED_LINE_HZ = 50.0
"""The simulated diodes do not flicker unless asked to: one look per tick is enough, and four times as quick."""


def run(  # typer reads the options from here
    config: Annotated[Path | None, typer.Option(help="Settings (TOML); docs/reference/settings.md lists all.")] = None,
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
    world: Annotated[
        Path | None, typer.Option(help="Simulation: file of a world that robots of several processes share.")
    ] = None,
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
    asked = {
        "map": campus,
        "name": name,
        "server": server,
        "token_file": token_file,
        "data": data,
        "mind.program": agent,
        "mind.percepts": percepts,
    }
    options = RunOptions(tuple(tell or ()), tuple(achieve or ()), limit, as_json, speed, door)
    with ExitStack() as closing:
        try:
            settings = _settings(config, asked, simulated, battery, closing)
            configure_logs(settings.log_file)
            simulation = _simulation(settings, start, battery, seed, world) if simulated else None
            done = run_once(settings, clock_for(simulated, clock, options, settings, closing), simulation, options)
        except (ConfigError, CampusMapError, BdiError, RobotError, SimulatedWorldError) as problem:
            refuse(str(problem))
    raise typer.Exit(0 if done else UNFINISHED)


def _settings(
    config: Path | None, asked: dict[str, Any], simulated: bool, battery: float | None, closing: ExitStack
) -> Settings:
    """From the file and the command line. A simulated robot without a folder leaves nothing behind."""
    if simulated and config is None and asked["data"] is None and asked["server"] is None:
        asked["data"] = Path(closing.enter_context(tempfile.TemporaryDirectory(prefix="campus-mail-robot-")))
    if simulated:
        asked["rates.line_hz"] = SIMULATED_LINE_HZ
    if simulated and battery is not None:
        asked.update(ASSUMED_PACK)
    return load_settings(config, asked)


def _simulation(
    settings: Settings, start: str | None, battery: float | None, seed: int, world: Path | None
) -> Simulation:
    """A foreign program need not know that it stands in a dock: it begins on the line, on the way to the first post."""
    if start is None and settings.mind.program:
        campus = find_map(settings.map)
        first = next(iter(campus.posts))
        start = f"{campus.neighbours(first)[0][0].name}:{first}"
    return Simulation(start, battery, seed, shared=world)
