"""Expected and real lines side by side: the longest sequence that both have in common stays, the rest differs."""

from collections.abc import Sequence
from typing import NamedTuple

from bdi.tools.trials.expectations import Kind, Line


class Difference(NamedTuple):
    """`mark` is " " as expected, "-" expected but not done, "+" done but not expected, "?" a belief that is wrong."""

    mark: str
    line: Line
    note: str = ""

    def data(self) -> dict[str, object]:
        names = {" ": "as expected", "-": "missing", "+": "unexpected", "?": "wrong belief"}
        return {
            "what": names[self.mark],
            "cycle": self.line.cycle,
            "agent": self.line.agent,
            "kind": self.line.kind.value or "action",
            "text": self.line.text,
            "note": self.note,
        }


def compared(expected: Sequence[Line], happened: Sequence[Line]) -> list[Difference]:
    """Return both in one list, in order of time."""
    start = 0
    while start < min(len(expected), len(happened)) and expected[start].agrees(happened[start]):
        start += 1
    same = [Difference(" ", line) for line in happened[:start]]
    return same + _noted(_aligned(expected[start:], happened[start:]))


def _aligned(expected: Sequence[Line], happened: Sequence[Line]) -> list[Difference]:
    lengths = [[0] * (len(happened) + 1) for _ in range(len(expected) + 1)]
    for i in range(len(expected) - 1, -1, -1):
        for j in range(len(happened) - 1, -1, -1):
            if expected[i].agrees(happened[j]):
                lengths[i][j] = lengths[i + 1][j + 1] + 1
            else:
                lengths[i][j] = max(lengths[i + 1][j], lengths[i][j + 1])
    found, i, j = [], 0, 0
    while i < len(expected) and j < len(happened):
        if expected[i].agrees(happened[j]):
            found.append(Difference(" ", happened[j]))
            i, j = i + 1, j + 1
        elif lengths[i + 1][j] > lengths[i][j + 1] or (
            lengths[i + 1][j] == lengths[i][j + 1] and _is_due(expected[i], happened[j])
        ):
            found.append(Difference("-", expected[i]))
            i += 1
        else:
            found.append(Difference("+", happened[j]))
            j += 1
    found += [Difference("-", line) for line in expected[i:]]
    return found + [Difference("+", line) for line in happened[j:]]


def _is_due(expected: Line, happened: Line) -> bool:
    return expected.cycle is None or happened.cycle is None or expected.cycle <= happened.cycle


def _noted(differences: list[Difference]) -> list[Difference]:
    """An action that came, but in another cycle, is said to be late or early."""
    unexpected = [each.line for each in differences if each.mark == "+"]
    noted = []
    for each in differences:
        line, note = each.line, ""
        if each.mark == "-" and line.kind is Kind.ACTION and line.cycle is not None:
            other = next(
                (real for real in unexpected if real.text == line.text and line.agent in ("", real.agent)), None
            )
            if other is not None and other.cycle is not None:
                unexpected.remove(other)
                away = other.cycle - line.cycle
                cycles = "1 cycle" if abs(away) == 1 else f"{abs(away)} cycles"
                note = f"came {cycles} {'later' if away > 0 else 'earlier'}, in {other.cycle}"
        noted.append(each._replace(note=note))
    return noted
