"""A part of the benchmark: what it takes and gives, and how it is judged.

A part is a module of this package with a function `measure(samples: Samples) -> dict` whose figures are plain JSON, and
with `WANTED`, what these figures have to be. A figure is named by its path: `lead_60.completed_share`.
"""

import logging
import sys
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol, TypeAlias

import structlog

PLOTS = Path(__file__).parent / "plots"
Figures: TypeAlias = Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class Samples:
    """The amount measured, and the first seed: seed number `index` is `first_seed + index`."""

    seeds: int = 20
    missions: int = 150
    kills: int = 200
    hour_s: float = 3600.0  # how much of the simulated hour is run
    first_seed: int = 1
    plots: Path = PLOTS

    def some_seeds(self, number: int | None = None) -> range:
        return range(self.first_seed, self.first_seed + (self.seeds if number is None else number))


@dataclass(frozen=True, slots=True)
class Wanted:
    """A bound on one figure. Give shares rather than counts, so that it can be judged at every number of samples."""

    figure: str
    at_most: float | None = None
    at_least: float | None = None
    unit: str = ""

    def judged(self, figures: Figures) -> dict[str, Any]:
        """Not met if nothing was measured."""
        value = at_path(figures, self.figure)
        met = value is not None and (self.at_most is None or value <= self.at_most)
        met = met and (self.at_least is None or value >= self.at_least)
        bounds = {"at_most": self.at_most, "at_least": self.at_least}
        report = {"figure": self.figure, "measured": value, "unit": self.unit, "met": met}
        return report | {name: bound for name, bound in bounds.items() if bound is not None}


class Part(Protocol):
    """A module of this package."""

    WANTED: Sequence[Wanted]

    def measure(self, samples: Samples) -> dict[str, Any]: ...


def at_path(figures: Figures, path: str) -> Any:
    """The figure that the path names, keys joined by dots; None where there is none."""
    value: Any = figures
    for key in path.split("."):
        value = value.get(key) if isinstance(value, Mapping) else None
    return value


def part_report(part: Part, samples: Samples) -> dict[str, Any]:
    figures = part.measure(samples)
    return {"figures": figures, "wanted": [wanted.judged(figures) for wanted in part.WANTED]}


def missed(parts: Mapping[str, Figures]) -> list[str]:
    """The parts that failed, and the bounds that do not hold, as part and figure."""
    failed = [f"{name}: {part['failed']}" for name, part in parts.items() if "failed" in part]
    rows = ((name, row) for name, part in parts.items() for row in part["wanted"])
    return failed + [f"{name}: {row['figure']}" for name, row in rows if not row["met"]]


def table(parts: Mapping[str, Figures]) -> str:
    """The report for people: figure, measured, wanted, met."""
    return aligned([("figure", "measured", "wanted", "met"), *_rows(parts)])


def _rows(parts: Mapping[str, Figures]) -> Iterable[tuple[str, ...]]:
    for name, part in parts.items():
        if "failed" in part:
            yield (name, part["failed"], "", "MISSED")
        for row in part["wanted"]:
            yield (f"{name}: {row['figure']}", _number(row["measured"]), _bound(row), "met" if row["met"] else "MISSED")


def _number(value: object) -> str:
    return "–" if value is None else f"{value:.4g}" if isinstance(value, float) else str(value)


def _bound(row: Figures) -> str:
    signs = {"at_least": "≥", "at_most": "≤"}
    bounds = " and ".join(f"{sign} {row[name]:g}" for name, sign in signs.items() if name in row)
    return f"{bounds} {row['unit']}".rstrip()


def aligned(rows: Sequence[tuple[str, ...]]) -> str:
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = ("  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows)
    return "\n".join(lines)


def log_to_error_stream() -> None:
    """Log to the error stream, not as JSON: call it where a process begins whose output is read."""
    structlog.configure(logger_factory=lambda *_: structlog.PrintLogger(sys.stderr))


def quietly() -> None:
    """Of what the robots log only what is critical: call it where a process of a pool begins."""
    structlog.configure(wrapper_class=structlog.make_filtering_bound_logger(logging.CRITICAL))


def say(line: str) -> None:
    """Progress goes to the error stream: the output is one JSON object."""
    print(line, file=sys.stderr, flush=True)
