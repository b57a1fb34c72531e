"""Functions that can stand where a number can: `math.abs`, …"""

import math
import statistics
from collections.abc import Callable
from typing import Any

from bdi.builtin.table import function
from bdi.terms import (
    List,
    number,
)


def _half_up(value: float) -> float:
    return math.floor(value + 0.5)


def _numbers(name: str, args: tuple[Any, ...]) -> list[float]:
    items = args[0] if len(args) == 1 and isinstance(args[0], List) else args
    if not all(type(item) in (int, float) for item in items):
        raise TypeError(f"{name} takes numbers")
    return list(items)


NUMERIC: dict[str, tuple[Callable[..., float], int]] = {
    "abs": (abs, 1),
    "acos": (math.acos, 1),
    "asin": (math.asin, 1),
    "atan": (math.atan, 1),
    "ceil": (math.ceil, 1),
    "cos": (math.cos, 1),
    "floor": (math.floor, 1),
    "log": (math.log, 1),
    "round": (_half_up, 1),
    "sin": (math.sin, 1),
    "sqrt": (math.sqrt, 1),
    "tan": (math.tan, 1),
}
OF_MANY: dict[str, Callable[[list[float]], float]] = {
    "average": statistics.fmean,
    "mean": statistics.fmean,
    "max": max,
    "median": statistics.median,
    "min": min,
    "std_dev": statistics.pstdev,
    "sum": sum,
}


def _register_numeric(name: str, call: Callable[..., float], count: int) -> None:
    function(f"math.{name}", count)(lambda *args: number(call(*_numbers(name, args))))


def _register_of_many(name: str, call: Callable[[list[float]], float]) -> None:
    function(f"math.{name}", 1, None)(lambda *args: number(call(_numbers(name, args))))


for _name, (_call, _count) in NUMERIC.items():
    _register_numeric(_name, _call, _count)
for _name, _of in OF_MANY.items():
    _register_of_many(_name, _of)
