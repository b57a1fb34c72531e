"""Numbers: all are doubles in meaning; `div` cuts to whole numbers of 32 bits first, `mod` has the dividend's sign."""

import math
from collections.abc import Callable

from bdi.language.errors import BdiError
from bdi.language.terms import Predicate, number, predicate


class ArithmeticFailure(BdiError):
    """A division of whole numbers by zero, or an operand that is no number."""


def _power(left: float, right: float) -> float:
    try:
        result = float(left) ** float(right)
    except OverflowError:
        return math.inf
    except ZeroDivisionError:
        return math.inf
    return math.nan if isinstance(result, complex) else result


def _divide(left: float, right: float) -> float:
    if right:
        return left / right
    if not left or math.isnan(left):
        return math.nan
    return math.copysign(math.inf, left) * math.copysign(1.0, right)


def _whole(value: float) -> int:
    """Cut to a whole number of 32 bits: outside the range the nearest bound, not-a-number gives 0."""
    if math.isnan(value):
        return 0
    return max(-(2**31), min(2**31 - 1, int(max(-1e18, min(1e18, value)))))


def _whole_division(left: float, right: float) -> float:
    dividend, divisor = _whole(left), _whole(right)
    if not divisor:
        raise ArithmeticFailure(f"{left} div {right} divides by zero")
    quotient = abs(dividend) // abs(divisor)
    return quotient if (dividend < 0) == (divisor < 0) else -quotient


def _remainder(left: float, right: float) -> float:
    if not right or math.isinf(left) or math.isnan(left) or math.isnan(right):
        return math.nan
    return math.fmod(left, right)


OPERATIONS: dict[str, Callable[[float, float], float]] = {
    "+": lambda left, right: left + right,
    "-": lambda left, right: left - right,
    "*": lambda left, right: left * right,
    "/": _divide,
    "div": _whole_division,
    "mod": _remainder,
    "**": _power,
}
OPERATION_OF: dict[Predicate, Callable[[float, float], float]] = {
    predicate(name, 2): operation for name, operation in OPERATIONS.items()
}


def calculate(operator: Predicate, left: float, right: float) -> int | float:
    """`left operator right` as a number of the language. Raises ArithmeticFailure."""
    return number(OPERATION_OF[operator](left, right))
