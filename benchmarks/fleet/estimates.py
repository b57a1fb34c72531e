"""ETA accuracy: arrivals as the service's own estimates tell them, in a simulated fleet, beside
those by lengths alone: `placed` with each order, `under_way` once a robot has it, which it has at once here.

The orders of a first time teach and are not scored (`WARM_UP`). "Not corrected" is the simulated plan alone: it does
not know of orders to come, for which the schedule is changed; `fleet.eta.calibration` has to make up for it.
"""

from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any, Final

from benchmarks.body.report import Wanted, say
from benchmarks.fleet.estimated_study import study
from benchmarks.fleet.samples import Samples
from fleet.eta.calibration import Basis
from fleet.eta.intervals import quantile
from fleet.eta.score import Truth, score_of

DAYS: Final = 40.0
WARM_UP: Final = 100
TOGETHER: Final = 200
"""Orders of one point of the plot."""
WANTED = [
    wanted
    for basis in Basis
    for wanted in (
        Wanted(f"{basis}.told.inside", at_least=0.78, at_most=0.82),
        Wanted(f"{basis}.told.median_error", at_most=0.15),
        Wanted(f"{basis}.told.pinball_of_map", at_most=0.99),
    )
]
Run = dict[Basis, tuple[list[Truth], list[Truth]]]
"""Of one seed, on each basis: as people were told, and as it was worked out."""


def measure(samples: Samples) -> dict[str, Any]:
    """Measure all seeds together, and what each had inside."""
    runs = list(samples.each(run, [(seed, DAYS) for seed in samples.some_seeds()]))
    for one in runs:
        say("  " + ", ".join(f"{basis}: {len(told)} orders scored" for basis, (told, _) in one.items()))
    draw(samples.plots, [one[Basis.UNDER_WAY] for one in runs])
    return figures(runs)


def run(job: tuple[int, float]) -> Run:
    """One seed for so many days, after the warm-up."""
    its = study(*job).promises
    return {basis: (its.scored[basis][WARM_UP:], its.raw[basis][WARM_UP:]) for basis in Basis}


def figures(runs: Sequence[Run]) -> dict[str, Any]:
    return {basis: _of_basis([one[basis] for one in runs]) for basis in Basis}


def _of_basis(runs: Sequence[tuple[list[Truth], list[Truth]]]) -> dict[str, Any]:
    told = [truth for theirs, _ in runs for truth in theirs]
    raw = [truth for _, theirs in runs for truth in theirs]
    took_s = sorted(truth.seconds for truth in told)
    return {
        "orders": len(told),
        "median_s": quantile(took_s, 0.5),
        "p95_s": quantile(took_s, 0.95),
        "told": _figures(told),
        "not_corrected": _figures(raw),
        "inside_by_seed": [score_of(theirs).inside for theirs, _ in runs],
    }


def _figures(truths: Sequence[Truth]) -> dict[str, Any]:
    score = score_of(truths)
    return asdict(score) | {"pinball_of_map": score.pinball_s / score.pinball_by_map_s}


def draw(folder: Path, runs: Sequence[tuple[list[Truth], list[Truth]]]) -> None:
    """Draw the share that came inside, of so many orders one after the other."""
    import matplotlib as mpl

    mpl.use("svg")
    mpl.rcParams |= {"svg.fonttype": "none", "svg.hashsalt": "campus-mail", "font.size": 9}
    from matplotlib import pyplot

    figure, axis = pyplot.subplots(figsize=(6.4, 3.2))
    for told, raw in runs:
        axis.plot(_inside(told), color="#2d6a8e", linewidth=1.2, label="told")
        axis.plot(_inside(raw), color="#b3541e", linewidth=0.8, label="not corrected")
    axis.axhspan(0.78, 0.82, color="#e0a458", alpha=0.4, linewidth=0)
    axis.set(xlabel="orders", ylabel=f"inside, of the last {TOGETHER}", ylim=(0.0, 1.0))
    handles, labels = axis.get_legend_handles_labels()
    axis.legend(handles[:2], labels[:2], frameon=False, loc="lower right")
    axis.spines[["top", "right"]].set_visible(False)
    folder.mkdir(parents=True, exist_ok=True)
    figure.savefig(folder / "estimates_inside.svg", bbox_inches="tight", metadata={"Date": None})
    pyplot.close(figure)


def _inside(truths: Sequence[Truth]) -> list[float]:
    held = [truth.told.holds(truth.seconds) for truth in truths]
    return [sum(held[max(0, at - TOGETHER) : at]) / min(at, TOGETHER) for at in range(1, len(held) + 1)]
