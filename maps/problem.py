"""One problem of a map, in a sentence by which its keeper can mend it."""

from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True)
class Problem:
    """`kind` is for programs, the sentence for people; an error makes the map unfit for robots, a warning does not."""

    severity: Literal["error", "warning"]
    kind: str
    place: str
    sentence: str
    way_out: str

    def __str__(self) -> str:
        return f"{self.severity}: {self.place}: {self.sentence}. {self.way_out}"


def error(kind: str, place: str, sentence: str, way_out: str) -> Problem:
    return Problem("error", kind, place, sentence, way_out)


def warning(kind: str, place: str, sentence: str, way_out: str) -> Problem:
    return Problem("warning", kind, place, sentence, way_out)
