"""Measure the mind beside other interpreters."""

import json
import os
import platform
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Annotated, Any

import typer

from benchmarks.mind import engines
from benchmarks.mind.engines import CHECKOUT, Engine, EngineFailed
from benchmarks.mind.figures import FIGURES, FULL, QUICK, Figure, Sample, Sizes
from benchmarks.mind.report import figure_report, table
from benchmarks.mind.workloads import write_workloads

NAMES = [figure.name for figure in FIGURES]
FOLDER = CHECKOUT / "var" / "bench" / "mind"
LEGEND = "each: least / median of the rounds; ratio: ours of python-agentspeak's"
QUICK_LEGEND = "--quick: nothing was warm; these figures say that the benchmark works, and nothing about speed"

app = typer.Typer(add_completion=False, pretty_exceptions_enable=False)


@app.command()
def measure(
    *,
    only: Annotated[
        list[str] | None, typer.Option(help=f"Only this figure; may be repeated: {', '.join(NAMES)}")
    ] = None,
    alone: Annotated[bool, typer.Option("--alone", help="Only our interpreter: needs no network and no Java.")] = False,
    quick: Annotated[
        bool, typer.Option("--quick", help="Little of everything: shows that it works, judges nothing.")
    ] = False,
    folder: Annotated[Path, typer.Option(help="Where programs, percepts and environments are kept.")] = FOLDER,
) -> None:
    """Print how long our interpreter takes, beside python-agentspeak and, where JASON_JAR names its archive, Jason.

    JSON goes to the output, progress and a table for people to the error stream. Rounds of the interpreters alternate;
    "least" and "median" are over these rounds, "ratio" is the median of ours divided by python-agentspeak's in the
    same round. Times are CPU time of the process, but for the cycles one by one. A target on ours is judged by the
    least, since whatever else the machine does only adds.
    """
    unknown = set(only or ()) - set(NAMES)
    if unknown:
        raise typer.BadParameter(f"no figure is called {', '.join(sorted(unknown))}; there are {', '.join(NAMES)}")
    chosen = [figure for figure in FIGURES if not only or figure.name in only]
    paper = write_workloads(folder)
    running, state = _engines(folder, alone)
    figures: dict[str, Any] = {}
    try:
        for figure in chosen:
            samples = _samples(figure, running, QUICK if quick else FULL, 1 if quick else figure.rounds)
            figures[figure.name] = figure_report(figure, samples, judged=not quick)
    finally:
        for engine in running.values():
            engine.close()
    _say(f"\n{table(figures)}\n{QUICK_LEGEND if quick else LEGEND}")
    print(
        json.dumps(
            {"machine": _machine(), "paper": paper, "quick": quick, "engines": state, "figures": figures}, indent=2
        )
    )


def _engines(folder: Path, alone: bool) -> tuple[dict[str, Engine], dict[str, str]]:
    """Return what can be run here, and for every interpreter what it is or why it is not run."""
    makers: Mapping[str, Callable[[Path], Engine]] = {
        "ours": engines.ours,
        "python-agentspeak": engines.python_agentspeak,
        "jason": engines.jason,
    }
    versions = {"python-agentspeak": engines.PYTHON_AGENTSPEAK, "jason": os.environ.get("JASON_JAR", "")}
    running, state = {}, {}
    for name, make in makers.items():
        if alone and name != "ours":
            state[name] = "not run: --alone"
            continue
        try:
            running[name] = make(folder)
            state[name] = versions.get(name, "this checkout")
        except EngineFailed as reason:
            state[name] = f"not run: {reason}"
            _say(f"{name} is not run: {reason}")
    return running, state


def _samples(figure: Figure, running: Mapping[str, Engine], sizes: Sizes, rounds: int) -> dict[str, list[Sample]]:
    """A round of each interpreter in turn, so that whatever else the machine does is shared fairly."""
    taking_part = {name: engine for name, engine in running.items() if name in figure.engines}
    samples: dict[str, list[Sample]] = {name: [] for name in taking_part}
    _say(f"{figure.name}: {figure.what}")
    for name, engine in taking_part.items():
        try:
            if figure.warm and rounds > 1:
                for _ in range(engine.warm_ups):
                    figure.sample(engine, sizes)
        except EngineFailed as reason:
            _say(f"  {reason}")
            del samples[name]
    for _ in range(rounds):
        for name in list(samples):
            try:
                samples[name].append(figure.sample(taking_part[name], sizes))
            except EngineFailed as reason:
                _say(f"  {reason}")
                del samples[name]
    return samples


def _machine() -> dict[str, Any]:
    return {"python": platform.python_version(), "system": platform.platform(), "cores": os.cpu_count()}


def _say(line: str) -> None:
    print(line, file=sys.stderr, flush=True)


if __name__ == "__main__":
    app(prog_name="python -m benchmarks.mind")
