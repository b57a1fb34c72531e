"""The paper's evaluation (its section 6.4) again."""

import json
import subprocess
import sys
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path
from typing import Annotated, Any

import typer

from benchmarks.body.report import aligned, log_to_error_stream, say
from benchmarks.mind.engines import CHECKOUT
from benchmarks.mind.workloads import RECORDED
from benchmarks.paper.contenders import Contender, contenders
from benchmarks.paper.figures import figures_of, most_stages, real_time_figures
from benchmarks.paper.logged_run import Log, logged

PLOTS = Path(__file__).parent / "plots"
WITHOUT = (
    "not run: the paper's program is not at hand; type its Listings 2 to 6 (CC BY 4.0) into a file: --program FILE"
)

app = typer.Typer(add_completion=False, pretty_exceptions_enable=False)


@app.command()
def measure(
    *,
    runs: Annotated[int, typer.Option(min=1, help="Logged runs of each program; the paper had 28.")] = 28,
    first_seed: Annotated[int, typer.Option(help="The seeds are this one and the following.")] = 1,
    real_s: Annotated[float, typer.Option(min=0, help="Seconds of each program at real time; 0: none.")] = 60.0,
    program: Annotated[Path, typer.Option(help="The paper's program, Listings 2 to 6.", show_default=False)] = RECORDED
    / "mail.asl",
    plots: Annotated[Path, typer.Option(help="Where the plots are written.", show_default=False)] = PLOTS,
    as_json: Annotated[bool, typer.Option("--json", help="JSON alone, without the table.")] = False,
) -> None:
    """Log runs of the paper's own program and of ours on the test track, and draw its Figures 6 to 10 side by side.

    Each run: a letter from post1 to post4, and a battery that becomes low on the way. The runs are stepped, with the
    time of the simulated clock; a part at real time then measures perception and reasoning. No outliers are removed.
    JSON goes to the output, progress and a table for people to the error stream.
    """
    from benchmarks.paper.plots import draw

    log_to_error_stream()
    at_hand = program if program.exists() else None
    taking_part = contenders(at_hand)
    if at_hand is None:
        say(WITHOUT)
    logs = {one.name: _logged_runs(one, runs, first_seed) for one in taking_part}
    reports = {name: figures_of(of_one) for name, of_one in logs.items()}
    samples = {one.name: _real_time(one, real_s, first_seed, at_hand) for one in taking_part} if real_s else {}
    for name, kept in samples.items():
        reports[name]["real_time"] = real_time_figures(kept, real_s)
    draw(plots, taking_part, reports, samples, {name: most_stages(of_one) for name, of_one in logs.items()})
    if not as_json:
        say("\n" + _table(taking_part, reports))
    state = {
        "papers_program": WITHOUT if at_hand is None else "run",
        "plots": sorted(file.name for file in plots.iterdir()),
    }
    print(json.dumps({"first_seed": first_seed, **state, "contenders": reports}, indent=2))


def _logged_runs(contender: Contender, runs: int, first_seed: int) -> list[Log]:
    say(f"{contender.title}: {runs} runs")
    logs = []
    with ProcessPoolExecutor() as processes:
        for log in processes.map(partial(logged, contender), range(first_seed, first_seed + runs)):
            logs.append(log)
            outcome = "delivered" if log.delivered else f"lost: {log.reason}"
            say(f"  seed {log.seed}: {outcome}, {log.time_s:.0f} s, {log.looking_s:.0f} s looking for the line")
    return logs


def _real_time(contender: Contender, duration_s: float, seed: int, program: Path | None) -> dict[str, list[float]]:
    """In a process of its own: nothing of the runs before slows it down."""
    say(f"{contender.title}: {duration_s:g} s of real time")
    command = [sys.executable, "-m", "benchmarks.paper.real_time", contender.name, f"{duration_s:g}", str(seed)]
    command += [str(program.resolve())] if program else []
    finished = subprocess.run(command, cwd=CHECKOUT, stdout=subprocess.PIPE, check=True, text=True)
    return dict(json.loads(finished.stdout))


def _table(taking_part: tuple[Contender, ...], reports: dict[str, Any]) -> str:
    rows = [("program", "lost", "mission s", "without charging", "looking for the line", "cycle p50 / p99 ms")]
    for contender in taking_part:
        report = reports[contender.name]
        cycle = report["cycle_compute_ms"]
        rows.append(
            (
                contender.title,
                f"{report['missions_lost']} of {report['runs']}",
                _median(report["mission_s"]),
                _median(report["mission_without_charging_s"]),
                f"{report['looking_for_line_share']:.1%} of driving",
                f"{cycle['p50']:.3f} / {cycle['p99']:.3f}",
            )
        )
    return aligned(rows)


def _median(spread: dict[str, float] | None) -> str:
    return "–" if spread is None else f"{spread['median']:.0f}"


if __name__ == "__main__":
    app(prog_name="python -m benchmarks.paper")
