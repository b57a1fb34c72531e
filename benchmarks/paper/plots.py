"""The paper's Figures 6 to 10 again, contenders side by side, as SVG."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.paper.contenders import Contender
from benchmarks.paper.stages import Stage
from maps import find_map

COLOURS = ("#b3541e", "#e0a458", "#2d6a8e")
MOST_BARS = 12
PAPERS_CYCLE_MS = (100.0, 106.0)
"""Its section 6.4.1. A sleep of 100 ms in the bridge around its reasoner, while no percept waited, was part of it."""


def draw(
    folder: Path,
    contenders: Sequence[Contender],
    reports: Mapping[str, Any],
    samples: Mapping[str, Any],
    stages: Mapping[str, Sequence[Stage]],
) -> None:
    """By contender: `samples` of real time, `stages` of one logged run."""
    import matplotlib as mpl

    mpl.use("svg")
    mpl.rcParams |= {"svg.fonttype": "none", "svg.hashsalt": "campus-mail", "font.size": 9}
    folder.mkdir(parents=True, exist_ok=True)
    timed = [contender for contender in contenders if contender.name in samples]
    if timed:
        _histograms(folder / "figure-07-perception.svg", timed, samples, "view_ms", "between views of the body")
        _histograms(folder / "figure-08-cycle.svg", timed, samples, "cycle_ms", "one reasoning cycle computes")
        _queue(folder / "percept-queue.svg", timed, samples)
    for contender in contenders:
        if stages.get(contender.name):
            _stages(folder / f"figure-06-stages-{contender.name}.svg", stages[contender.name])
    _bars(folder / "figure-09-plans.svg", contenders, reports, "plans")
    _bars(folder / "figure-10-actions.svg", contenders, reports, "actions")
    _outcomes(folder / "missions.svg", contenders, reports)


def _panels(contenders: Sequence[Contender], height: float) -> tuple[Any, Any]:
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(1, len(contenders), figsize=(4.6 * len(contenders), height), squeeze=False)
    for axis, contender in zip(axes[0], contenders, strict=True):
        axis.set_title(contender.title, fontsize=10)
        axis.spines[["top", "right"]].set_visible(False)
    return figure, axes[0]


def _histograms(path: Path, contenders: Sequence[Contender], samples: Mapping[str, Any], name: str, label: str) -> None:
    """Draw all on the same axes, or they could not be compared; what lies beyond is in the outermost bars."""
    figure, axes = _panels(contenders, 3.0)
    low, high = np.quantile(np.concatenate([samples[one.name][name] for one in contenders]), (0.005, 0.995))
    bins = np.linspace(low, max(high, low + 1e-6), 41)
    for axis, contender, colour in zip(axes, contenders, COLOURS, strict=False):
        values = np.clip(samples[contender.name][name], bins[0], bins[-1])
        axis.hist(values, bins=bins, weights=np.full(len(values), 100 / len(values)), color=colour)
        axis.set_ylim(0, 100)
        axis.set_xlabel(f"{label}, ms")
        axis.set_ylabel("share, %")
        if name == "cycle_ms":
            left, right = PAPERS_CYCLE_MS
            note = f"the paper: {left:g} to {right:g} ms,\n100 ms of sleep included"
            axis.text(0.97, 0.95, note, transform=axis.transAxes, ha="right", va="top", fontsize=8)
    _save(figure, path)


def _queue(path: Path, contenders: Sequence[Contender], samples: Mapping[str, Any]) -> None:
    """Draw the length that the paper's queue would reach; without it the mind reads the newest view, as old as is
    said."""
    figure, axes = _panels(contenders, 3.0)
    for axis, contender, colour in zip(axes, contenders, COLOURS, strict=False):
        taken = samples[contender.name]
        axis.plot(taken["would_wait"], color=colour)
        axis.set_xlabel("ticks of the mind")
        axis.set_ylabel("views that would wait")
        middle, most = np.quantile(taken["view_age_ms"], (0.5, 1.0))
        note = f"read, not queued: {middle:.0f} ms old\nat the median, {most:.0f} at most"
        axis.text(0.03, 0.95, note, transform=axis.transAxes, ha="left", va="top", fontsize=8)
    _save(figure, path)


def _stages(path: Path, stages: Sequence[Stage]) -> None:
    """A picture of the track for each, from above: the line, the way until then and where the robot looks."""
    from matplotlib import pyplot

    campus = find_map("test_track")
    figure, axes = pyplot.subplots(2, 3, figsize=(11, 6), sharex=True, sharey=True)
    for axis, stage, letter in zip(axes.flat, stages, "abcdef", strict=False):
        for corridor in campus.corridors:
            axis.plot(*zip(*corridor.tape_from(corridor.a), strict=True), color="#bbbbbb", linewidth=3, zorder=1)
        for post in campus.posts.values():
            axis.annotate(post.name, (post.x_m, post.y_m), (4, 4), textcoords="offset points", fontsize=7)
        x_m, y_m, heading_rad = stage.place
        axis.plot(*zip(*stage.trail, strict=True), color=COLOURS[2], linewidth=1, zorder=2)
        axis.plot(x_m, y_m, "o", color=COLOURS[0], markersize=8, zorder=3)
        axis.arrow(
            x_m, y_m, 0.3 * np.cos(heading_rad), 0.3 * np.sin(heading_rad), color=COLOURS[0], width=0.03, zorder=3
        )
        axis.set_title(f"({letter}) {stage.name}, {stage.time_s:.0f} s", fontsize=9)
        axis.set_aspect("equal")
        axis.set_axis_off()
    _save(figure, path)


def _bars(path: Path, contenders: Sequence[Contender], reports: Mapping[str, Any], name: str) -> None:
    figure, axes = _panels(contenders, 4.2)
    for axis, contender, colour in zip(axes, contenders, COLOURS, strict=False):
        used = list(reports[contender.name][name].items())[:MOST_BARS][::-1]
        axis.barh([label for label, _ in used], [100 * row["share"] for _, row in used], color=colour)
        axis.set_xlabel(f"share of all {name}, %")
    _save(figure, path)


def _outcomes(path: Path, contenders: Sequence[Contender], reports: Mapping[str, Any]) -> None:
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(1, 3, figsize=(11, 2.6), sharey=True)
    titles = [contender.title for contender in contenders]
    rows = [reports[contender.name] for contender in contenders]
    values = {
        "missions lost, %": [100 * row["missions_lost"] / row["runs"] for row in rows],
        "of driving spent looking for the line, %": [100 * row["looking_for_line_share"] for row in rows],
        "mission without charging, s (median)": [
            (row["mission_without_charging_s"] or {}).get("median") for row in rows
        ],
    }
    for axis, (label, shown) in zip(axes, values.items(), strict=True):
        bars = axis.barh(titles[::-1], [value or 0 for value in shown[::-1]], color=COLOURS[: len(titles)][::-1])
        said = ["none delivered" if value is None else f"{value:.3g}" for value in shown[::-1]]
        axis.bar_label(bars, said, padding=3)
        axis.set_xlabel(label)
        axis.margins(x=0.18)
        axis.spines[["top", "right"]].set_visible(False)
    _save(figure, path)


def _save(figure: Any, path: Path) -> None:
    from matplotlib import pyplot

    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None}, bbox_inches="tight")
    pyplot.close(figure)
