"""The fleet's throughput, as SVG."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

LABELS = {
    "plain_2_bays": "first come, 2 bays",
    "joint_2_bays": "nearest five jointly, 2 bays",
    "1_bay": "planner, 1 bay",
    "2_bays": "planner, 2 bays",
    "3_bays": "planner, 3 bays",
    "2_bays_late": "planner, 2 bays, ways ±20 %",
    "2_bays_following": "planner, 2 bays, following",
    "3_bays_following": "planner, 3 bays, following",
}
COLOURS = ("#b3541e", "#e0a458", "#2d6a8e", "#7a9e7e", "#6b5b95", "#444444", "#a23b72", "#9bb7d4")


def throughput(
    folder: Path, figures: Mapping[str, Mapping[str, Mapping[str, Any]]], least: Mapping[str, Sequence[float]]
) -> None:
    """One group of bars for each number of robots, one bar for each case; a line across it where `least` is wanted."""
    pyplot = pyplot_for(folder)
    figure, axis = pyplot.subplots(figsize=(9.0, 3.8))
    robots = sorted({int(name.split("_")[0]) for cases in figures.values() for name in cases})
    width = 0.85 / len(figures)
    for number, (case, of_case) in enumerate(figures.items()):
        shown = [(at, of_case[f"{one}_robots"]) for at, one in enumerate(robots) if f"{one}_robots" in of_case]
        places = [at + (number - (len(figures) - 1) / 2) * width for at, _ in shown]
        shares = [100 * one["of_same_rule"] for _, one in shown]
        axis.bar(places, shares, width * 0.92, label=LABELS[case], color=COLOURS[number % len(COLOURS)])
        for place, share in zip(places, least.get(case, ()), strict=False):
            axis.hlines(100 * share, place - width / 2, place + width / 2, color="black", linewidth=1.4)
    axis.axhline(100, color="#999999", linewidth=0.8)
    axis.set_xticks(range(len(robots)), [f"{one} robots" for one in robots])
    axis.set_ylabel("delivered, of the same without conflicts, %")
    axis.set_ylim(0, 105)
    axis.legend(fontsize=8, loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    save(figure, folder / "throughput.svg")


def baselines(folder: Path, figures: Mapping[str, Any], rules: Sequence[str]) -> None:
    """Delivered with orders always waiting; mean and p95 of the time of an order in days with rush hours."""
    pyplot = pyplot_for(folder)
    figure, axes = pyplot.subplots(1, 3, figsize=(11, 2.6), sharey=True)
    labels = {
        "delivered": "delivered, orders always waiting",
        "mean_min": "mean order time, min",
        "p95_min": "p95, min",
    }
    names = [rule.replace("_", " ") for rule in rules][::-1]
    for axis, (key, label) in zip(axes, labels.items(), strict=True):
        bars = axis.barh(names, [figures[rule][key] for rule in rules][::-1], color=COLOURS[2])
        axis.bar_label(bars, fmt="%.0f", padding=3)
        axis.set_xlabel(label)
        axis.margins(x=0.16)
    save(figure, folder / "baselines.svg")


def pyplot_for(folder: Path) -> Any:
    import matplotlib as mpl

    mpl.use("svg")
    mpl.rcParams |= {"svg.fonttype": "none", "svg.hashsalt": "campus-mail", "font.size": 9}
    mpl.rcParams |= {"axes.spines.top": False, "axes.spines.right": False}
    folder.mkdir(parents=True, exist_ok=True)
    from matplotlib import pyplot

    return pyplot


def save(figure: Any, path: Path) -> None:
    from matplotlib import pyplot

    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None}, bbox_inches="tight")
    pyplot.close(figure)
