"""The result of a check."""

from dataclasses import dataclass
from enum import IntEnum
from pathlib import Path

from bdi.language.errors import Place


class Severity(IntEnum):
    """An error fails whenever it is reached, a warning is most likely a mistake, a hint is worth a look."""

    ERROR = 0
    WARNING = 1
    HINT = 2

    def __str__(self) -> str:
        return self.name.lower()


@dataclass(frozen=True, slots=True)
class Finding:
    """`problem` is a sentence without its full stop, `advice` what to do about it."""

    code: str
    severity: Severity
    place: Place
    problem: str
    advice: str

    def data(self) -> dict[str, object]:
        return {
            "code": self.code,
            "severity": str(self.severity),
            "source": self.place.source,
            "line": self.place.line,
            "column": self.place.column,
            "problem": self.problem,
            "advice": self.advice,
        }


def place_of(word: str, start: Place) -> Place:
    """Find a word from this place on; the place itself if it is not found."""
    path = Path(start.source)
    if not path.is_file():
        return start
    lines = path.read_text(encoding="utf-8").splitlines()
    for number in range(start.line, len(lines) + 1):
        line = lines[number - 1]
        begin = start.column - 1 if number == start.line else 0
        column = _word_in(line, word, begin)
        if column is not None:
            return Place(start.source, number, column + 1, line)
    return start


def _word_in(line: str, word: str, begin: int) -> int | None:
    code = line.split("//", maxsplit=1)[0]
    at = code.find(word, begin)
    while at >= 0:
        before, after = code[at - 1 : at], code[at + len(word) : at + len(word) + 1]
        if not (before.isalnum() or before == "_" or after.isalnum() or after == "_"):
            return at
        at = code.find(word, at + 1)
    return None
