"""Functions that can stand where a number can: `math.abs`, …"""

import math
import statistics
from collections.abc import Callable
from typing import Any

from bdi.builtin.kinds import ANY, NUMBER, optional, rest
from bdi.builtin.table import function
from bdi.language.terms import List, Term, number
from bdi.model.mind import Mind
from bdi.model.waiting import HasTime


def _half_up(value: float) -> float:
    return math.floor(value + 0.5)


def _of_doubles(call: Callable[[float], float], value: float) -> float:
    """Round as doubles do: not-a-number where there is no value; infinity has no nearest whole number."""
    if math.isinf(value) and call in _TO_WHOLE:
        return value
    try:
        return call(value)
    except ValueError:
        return math.nan


def _log(value: float) -> float:
    """Logarithm of doubles: -infinity for 0."""
    return math.log(value) if value else -math.inf


def _std_dev(values: list[float]) -> float:
    """Standard deviation of a sample (divided by n-1); 0 of nothing, not-a-number of one."""
    if len(values) < 2:
        return math.nan if values else 0
    return statistics.stdev(values)


def _numbers(name: str, args: tuple[Any, ...]) -> list[float]:
    items = args[0] if len(args) == 1 and isinstance(args[0], List) else args
    if not all(type(item) in (int, float) for item in items):
        raise TypeError(f"{name} takes numbers")
    return list(items)


NUMERIC: dict[str, Callable[..., float]] = {
    "abs": abs,
    "acos": math.acos,
    "asin": math.asin,
    "atan": math.atan,
    "ceil": math.ceil,
    "cos": math.cos,
    "floor": math.floor,
    "log": _log,
    "round": _half_up,
    "sin": math.sin,
    "sqrt": math.sqrt,
    "tan": math.tan,
}
OF_MANY: dict[str, Callable[[list[float]], float]] = {
    "average": statistics.fmean,
    "mean": statistics.fmean,
    "max": max,
    "median": statistics.median,
    "min": min,
    "std_dev": _std_dev,
    "sum": sum,
}
_TO_WHOLE = (math.ceil, math.floor, _half_up)
CONSTANTS = {"pi": math.pi, "e": math.e}


def _register_numeric(name: str, call: Callable[..., float]) -> None:
    function(f"math.{name}", NUMBER)(lambda value: number(_of_doubles(call, value)))


def _register_of_many(name: str, call: Callable[[list[float]], float]) -> None:
    function(f"math.{name}", ANY, rest(ANY))(lambda *args: number(call(_numbers(name, args))))


def _register_constant(name: str, value: float) -> None:
    function(f"math.{name}")(lambda: value)


for _name, _call in NUMERIC.items():
    _register_numeric(_name, _call)
for _name, _of in OF_MANY.items():
    _register_of_many(_name, _of)
for _name, _value in CONSTANTS.items():
    _register_constant(_name, _value)


@function("math.random", optional(NUMBER), asks=True)
def random_number(mind: Mind, below: float | None = None) -> Term:
    """Random number from 0 to 1; with an argument a whole number from 0 up to below it."""
    return mind.random.random() if below is None else mind.random.randrange(int(below))


@function("system.time", asks=True)
def milliseconds(mind: HasTime) -> Term:
    """Milliseconds of the clock that the agent is given."""
    return number(math.floor(mind.now * 1000))
