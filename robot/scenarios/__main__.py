"""`python -m robot.scenarios`: run a scenario, replay what was recorded, check a file."""

import json
import logging
import sys
from contextlib import ExitStack
from dataclasses import asdict
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter, sleep
from typing import Annotated, Any, NoReturn

import structlog
import typer

from maps import CampusMapError
from robot.scenarios.errors import RecordingError, ScenarioError
from robot.scenarios.judging import Ending, shortfalls
from robot.scenarios.loading import load_scenario
from robot.scenarios.replay.pictures import write_pictures
from robot.scenarios.replay.recording import Recorder
from robot.scenarios.replay.replaying import write_page
from robot.scenarios.stage import Stage
from robot.simulated import SimulatedWorldError

NOT_AS_EXPECTED, MISUSE = 1, 2

cli = typer.Typer(help=__doc__, add_completion=False, rich_markup_mode=None)
File = Annotated[str, typer.Argument(help="A scenario (TOML), or drawn:track, drawn:tunnels with --seed.")]


@cli.command()
def run(
    file: File,
    seed: Annotated[int | None, typer.Option(help="Another seed than the file's.")] = None,
    record: Annotated[Path | None, typer.Option(help="Write a recording there, for replay.")] = None,
    real_time: Annotated[bool, typer.Option("--real-time", help="No faster than the clock on the wall.")] = False,
    as_json: Annotated[bool, typer.Option("--json", help="The end as one JSON object on the output.")] = False,
    quiet: Annotated[bool, typer.Option("--quiet", help="Do not tell what happens.")] = False,
) -> None:
    """Exit status 0: it ended as expected. 1: it did not, and the sentences say what. 2: it cannot run."""
    structlog.configure(
        wrapper_class=structlog.make_filtering_bound_logger(logging.CRITICAL),
        logger_factory=lambda *_: structlog.PrintLogger(sys.stderr),
    )
    began_s = perf_counter()
    try:
        scenario, source = load_scenario(file, seed)
        with ExitStack() as closing:
            folder = Path(closing.enter_context(TemporaryDirectory(prefix="campus-mail-scenario-")))
            stage = closing.enter_context(Stage(scenario, folder, source, _nothing if quiet else _tell))
            if real_time:
                stage.watchers.append(lambda now: sleep(max(0.0, now - (perf_counter() - began_s))))
            recorder = closing.enter_context(Recorder(record, stage)) if record else None
            ending = stage.run()
            if recorder:
                recorder.end(ending)
            ran_s = stage.clock.now()
    except (ScenarioError, RecordingError, CampusMapError, SimulatedWorldError) as error:
        _refuse(str(error))
    missing = shortfalls(ending, scenario.expect)
    _say_end(ending, missing, ran_s, perf_counter() - began_s, as_json)
    raise typer.Exit(NOT_AS_EXPECTED if missing else 0)


def _tell(at_s: float, who: str, what: str) -> None:
    print(f"{at_s:8.1f} s  {who}: {what}", file=sys.stderr, flush=True)


def _nothing(_: float, __: str, ___: str) -> None:
    pass


def _say_end(ending: Ending, missing: list[str], ran_s: float, took_s: float, as_json: bool) -> None:
    if as_json:
        print(json.dumps(_as_json(ending, missing, ran_s)))
        return
    for one in ending.verdicts:
        print(f"order {one.order}: {one.fate}{f' ({one.why})' if one.why else ''}")
    print(f"{ran_s:.1f} s in {took_s:.1f} s; bumps: {ending.bumps}; searches for the line: {ending.searches}")
    for sentence in missing:
        print(f"NOT AS EXPECTED: {sentence}")


def _as_json(ending: Ending, missing: list[str], ran_s: float) -> dict[str, Any]:
    return {
        "as_expected": not missing,
        "not_as_expected": missing,
        "orders": {one.order: {"fate": one.fate, "why": one.why} for one in ending.verdicts},
        "time_s": round(ran_s, 1),
        "bumps": ending.bumps,
        "searches": ending.searches,
        "posts": ending.posts,
        "told": [asdict(one) for one in ending.told],
    }


@cli.command()
def check(file: File) -> None:
    """Say what is wrong with a file, or that nothing is. Exit status 2: something is."""
    try:
        scenario, _ = load_scenario(file)
    except (ScenarioError, CampusMapError) as error:
        _refuse(str(error))
    robots, orders = len(scenario.robot), len(scenario.order)
    print(f"{file}: {scenario.title or 'a scenario'}; {robots} robot(s), {orders} order(s). Nothing is wrong with it.")


@cli.command()
def replay(
    recording: Annotated[Path, typer.Argument(help="What `run --record` wrote.")],
    target: Annotated[Path, typer.Argument(metavar="PAGE", help="The page to write, replay.html.")],
) -> None:
    """Make one self-contained page of a recording: open it in any browser, with no network."""
    try:
        write_page(recording, target)
    except RecordingError as error:
        _refuse(str(error))
    print(f"{target}: {target.stat().st_size / 1e6:.1f} MB")


@cli.command()
def frames(
    recording: Annotated[Path, typer.Argument(help="What `run --record` wrote.")],
    folder: Annotated[Path, typer.Argument(help="Where the pictures go: 00000.png, 00001.png …")],
    every_s: Annotated[float, typer.Option("--every", min=0.1, help="One picture for so many seconds.")] = 1.0,
) -> None:
    """Draw the map as PNG pictures."""
    try:
        number = write_pictures(recording, folder, every_s)
    except RecordingError as error:
        _refuse(str(error))
    print(f"{folder}: {number} pictures")


def _refuse(sentence: str) -> NoReturn:
    typer.echo(sentence, err=True)
    raise typer.Exit(MISUSE)


if __name__ == "__main__":
    cli(prog_name="python -m robot.scenarios")
