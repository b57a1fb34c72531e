"""Two yardsticks of the machine, taken in the same run as the service's figures: machines differ, and from hour to hour
one differs from itself. Both are processor time, which other work on the machine changes least.
"""

import asyncio
import time
from pathlib import Path
from statistics import median
from typing import Any, Final

from benchmarks.service.orders import AT_ONCE, Load
from benchmarks.service.samples import Samples
from benchmarks.service.servers import bare

TURNS: Final = 200_000
REPEATS: Final = 7
INSERTS_S: Final = 1.5

KEPT: Final = Path(__file__).with_name("kept_ratios.json")
"""What a short run has given on a machine with nothing else to do, and at which commit."""

Yardsticks = dict[str, float]


def measure(samples: Samples) -> Yardsticks:
    """Milliseconds of processor time: `python_loop_ms`, `bare_insert_ms`."""
    with samples.folder() as folder, bare(folder) as plain:
        load = Load(plain, ["" for _ in range(AT_ONCE)], "ada@campus.example")
        asyncio.run(_insert(load))
    return {"python_loop_ms": python_loop_ms(), "bare_insert_ms": round(load.processor_ms[AT_ONCE][-1], 3)}


async def _insert(load: Load) -> None:
    await load.round(1, 0.5)  # what is made at the first request is made now
    await load.round(AT_ONCE, INSERTS_S)


def python_loop_ms() -> float:
    """The median of a fixed loop: numbers, a dictionary, attributes and calls, as a service does them."""
    return round(median(_loop_ms() for _ in range(REPEATS)), 2)


class _Counter:
    def __init__(self) -> None:
        self.counts: dict[int, int] = {}

    def count(self, key: int) -> None:
        self.counts[key] = self.counts.get(key, 0) + 1


def _loop_ms() -> float:
    counter, begun_s = _Counter(), time.process_time()
    for turn in range(TURNS):
        counter.count(turn % 97)
    return (time.process_time() - begun_s) * 1e3


def middle(of: list[Yardsticks]) -> Yardsticks:
    """Of those taken before, between and after the parts."""
    return {name: round(median(one[name] for one in of), 3) for name in of[0]}


def ratios(parts: dict[str, Any], yardsticks: Yardsticks) -> dict[str, dict[str, float]]:
    """The service's own processor time, as a multiple of each yardstick; without the parts that were not measured."""
    found = {name: _at(parts, *path) for name, path in OWN.items()}
    return {
        name: {f"to_{yardstick}": round(own / ms, 3) for yardstick, ms in yardsticks.items()}
        for name, own in found.items()
        if own is not None
    }


OWN: Final = {
    "order_alone": ("orders", "alone", "processor_ms"),
    "order_among_many": ("orders", "together", "processor_ms"),
    "order_to_robot": ("instructions", "processor_ms_per_order"),
    "report": ("robots", "processor_ms_per_report"),
}
"""Part and path of each figure, in milliseconds of processor time."""


def _at(parts: dict[str, Any], part: str, *path: str) -> float | None:
    value: Any = parts.get(part, {}).get("figures", {})
    for key in path:
        value = value.get(key) if isinstance(value, dict) else None
    return value


def slower_by(now: dict[str, dict[str, float]], kept: dict[str, dict[str, float]]) -> dict[str, float]:
    """By which factor each figure has grown, by the yardstick that speaks for it: a machine of another kind changes the
    ratio to one of them, a slower service both."""
    return {name: min(now[name][one] / ratio for one, ratio in ratios.items()) for name, ratios in kept.items()}
