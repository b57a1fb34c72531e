"""The paper's Figures 7 to 10 again, contenders side by side, as SVG."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.paper.contenders import Contender

COLOURS = ("#b3541e", "#e0a458", "#2d6a8e")
MOST_BARS = 12
PAPERS_CYCLE_MS = (100.0, 106.0)


def draw(folder: Path, contenders: Sequence[Contender], reports: Mapping[str, Any], samples: Mapping[str, Any]) -> None:
    """`samples` are those of real time, by contender."""
    import matplotlib as mpl

    mpl.use("svg")
    mpl.rcParams |= {"svg.fonttype": "none", "svg.hashsalt": "campus-mail", "font.size": 9}
    folder.mkdir(parents=True, exist_ok=True)
    timed = [contender for contender in contenders if contender.name in samples]
    if timed:
        _histograms(folder / "figure-07-perception.svg", timed, samples, "percepts_ms", "between percepts of the mind")
        _histograms(folder / "figure-08-cycle.svg", timed, samples, "cycle_ms", "one reasoning cycle computes")
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
    """All on the same axes, or they could not be compared; what lies beyond is in the outermost bars."""
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
            note = f"the paper: {left:g} to {right:g} ms,\nthe wait for percepts included"
            axis.text(0.97, 0.95, note, transform=axis.transAxes, ha="right", va="top", fontsize=8)
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
