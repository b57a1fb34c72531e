"""From samples to figures: the least and the middle of the rounds, ratios side by side, targets met or not."""

from collections.abc import Iterable, Mapping, Sequence
from statistics import median
from typing import Any

from benchmarks.mind.figures import ALL, Figure, Sample


def figure_report(figure: Figure, samples: Mapping[str, Sequence[Sample]], judged: bool) -> dict[str, Any]:
    """`samples` holds for each engine one sample a round; rounds were run in turn, so equal places belong together."""
    report: dict[str, Any] = {"what": figure.what, "unit": figure.unit}
    for engine, rounds in samples.items():
        values = [sample["value"] for sample in rounds]
        others = {key: _rounded(median(sample[key] for sample in rounds)) for key in rounds[0] if key != "value"}
        report[engine] = {"least": _rounded(min(values)), "median": _rounded(median(values)), **others}
    if "ours" in samples and "python-agentspeak" in samples:
        pairs = zip(samples["ours"], samples["python-agentspeak"], strict=False)
        report["ratio"] = _rounded(median(ours["value"] / theirs["value"] for ours, theirs in pairs))
    if "ours" in samples:
        report["targets"] = list(_targets(figure, report, judged))
    return report


def _targets(figure: Figure, report: Mapping[str, Any], judged: bool) -> Iterable[dict[str, Any]]:
    if figure.at_most is not None:
        met = report["ours"][figure.judged_by] <= figure.at_most
        yield {"ours": figure.judged_by, "at_most": figure.at_most, "met": met if judged else None}
    if figure.ratio_at_most is not None and "ratio" in report:
        met = report["ratio"] <= figure.ratio_at_most
        yield {"of": "python-agentspeak", "at_most": figure.ratio_at_most, "met": met if judged else None}


def _rounded(value: float) -> float:
    return float(f"{value:.4g}")


def table(figures: Mapping[str, Mapping[str, Any]]) -> str:
    """The report for people: one line a figure, least / median."""
    rows: list[tuple[str, ...]] = [("figure", *ALL, "ratio", "targets")]
    for name, figure in figures.items():
        cells = [f"{figure[e]['least']:g} / {figure[e]['median']:g}" if e in figure else "–" for e in ALL]
        ratio = f"{figure['ratio']:g}" if "ratio" in figure else "–"
        rows.append((f"{name} [{figure['unit']}]", *cells, ratio, ", ".join(map(_target, figure.get("targets", ())))))
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows]
    return "\n".join(lines)


def _target(target: Mapping[str, Any]) -> str:
    verdict = {True: "met", False: "MISSED", None: "not judged"}[target["met"]]
    return f"{'ratio ' if 'of' in target else ''}≤ {target['at_most']:g} {verdict}"
