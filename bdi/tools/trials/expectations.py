"""Expected outputs of a run: a file of lines, or the closing comment of a program.

    # a comment
    3 drive(post1)              in cycle 3 this action; `drive(_)` stands for any argument
    3 r2 drive(post1)           the same for the agent r2, where several run
    5 believes at(post1)        after cycle 5 this is believed (any formula)
    5 not at(_)                 after cycle 5 this is not believed
    7 says only 15 percent      what .print says; lines of this kind count only if there is at least one

Without numbers (all lines or none) only the order counts, and beliefs are those at the end.
"""

import re
from collections.abc import Iterable
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path

from bdi.language.errors import AgentSpeakSyntaxError, Place
from bdi.language.parser import parse_literal, parse_term
from bdi.language.terms import Term
from bdi.language.unify import renamed, unify
from bdi.tools.percept_file import read_at

_CYCLE = re.compile(r"(?:(\d+)\s+)?(.*)")
_AGENT = re.compile(r"(?P<agent>[a-z]\w*)\s+(?P<rest>[~a-z'].*)")
_COMMENT = re.compile(r"\s*(#|//)")


class Kind(StrEnum):
    ACTION = ""
    SAYS = "says"
    BELIEVES = "believes"
    NOT = "not"


_KINDS = frozenset(kind.value for kind in Kind if kind is not Kind.ACTION)


@dataclass(frozen=True, slots=True)
class Line:
    """One output, expected or real. `cycle` None: in any cycle; `agent` "": of any agent."""

    kind: Kind
    text: str
    cycle: int | None = None
    agent: str = ""
    place: Place | None = None

    def __str__(self) -> str:
        return " ".join(str(part) for part in (self.cycle, self.agent, self.kind.value, self.text) if part)

    def agrees(self, happened: "Line") -> bool:
        """Return whether this expectation is met by that."""
        return (
            self.kind is happened.kind
            and self.cycle in (None, happened.cycle)
            and self.agent in ("", happened.agent)
            and (self.text == happened.text or (self.kind is Kind.ACTION and _unifies(self.text, happened.text)))
        )


def _unifies(expected: str, happened: str) -> bool:
    return "_" in expected and unify(renamed(_term(expected), {}), renamed(_term(happened), {}), [])


def _term(text: str) -> Term:
    return parse_term(text)


@dataclass(frozen=True, slots=True)
class Expectation:
    """The expected lines. With `by_cycle` the cycles count, otherwise only the order."""

    lines: tuple[Line, ...]
    by_cycle: bool

    @property
    def events(self) -> list[Line]:
        """The expected outputs, in order."""
        return [line for line in self.lines if line.kind in (Kind.ACTION, Kind.SAYS)]

    @property
    def beliefs(self) -> list[Line]:
        """The beliefs expected at the end, or their absence."""
        return [line for line in self.lines if line.kind in (Kind.BELIEVES, Kind.NOT)]

    @property
    def says(self) -> bool:
        return any(line.kind is Kind.SAYS for line in self.lines)

    @property
    def last_cycle(self) -> int:
        return max((line.cycle or 0 for line in self.lines), default=0)


def read_expectation(path: Path) -> Expectation:
    """The file's lines. Raises AgentSpeakSyntaxError with the line; OSError if it cannot be read."""
    return expectation_of(path.read_text(encoding="utf-8").splitlines(), str(path))


def expectation_of(texts: Iterable[str], source: str, first_line: int = 1) -> Expectation:
    """Lines of text; empty ones and comments say nothing. Raises AgentSpeakSyntaxError."""
    lines = [
        _line(text, Place(source, number, 1, text))
        for number, text in enumerate(texts, first_line)
        if text.strip() and not _COMMENT.match(text)
    ]
    numbered = [line for line in lines if line.cycle is not None]
    if numbered and len(numbered) < len(lines):
        odd = next(line.place for line in lines if line.cycle is None)
        problem = "this line has no cycle, others do: give all lines a cycle, or none"
        raise AgentSpeakSyntaxError(problem, odd or Place(source), ("CYCLE ACTION",))
    return Expectation(tuple(lines), bool(numbered) or not lines)


def _line(text: str, place: Place) -> Line:
    """Two names in a row are an agent and its action."""
    cycle, rest = _CYCLE.fullmatch(text.strip()).groups()  # type: ignore[union-attr]  # it matches every text
    agent, kind, rest = "", *_kind_of(rest)
    named = _AGENT.fullmatch(rest) if kind is Kind.ACTION else None
    if named:
        agent, kind, rest = named["agent"], *_kind_of(named["rest"])
    return Line(kind, _checked(kind, rest, place), None if cycle is None else int(cycle), agent, place)


def _kind_of(text: str) -> tuple[Kind, str]:
    word, _, rest = text.partition(" ")
    return (Kind(word), rest.strip()) if word in _KINDS and rest.strip() else (Kind.ACTION, text)


def _checked(kind: Kind, text: str, place: Place) -> str:
    """The text as AgentSpeak writes it, so that spaces make no difference."""
    if kind is Kind.SAYS:
        return text
    try:
        return read_at(place, text, parse_literal if kind is Kind.ACTION else parse_term)
    except AgentSpeakSyntaxError as error:
        hint = error.expected or ("CYCLE ACTION", "CYCLE believes FORMULA", "CYCLE not FORMULA", "CYCLE says TEXT")
        raise AgentSpeakSyntaxError(error.problem, error.place, hint) from None
