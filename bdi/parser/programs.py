"""Text to program, with everything that it includes."""

from collections.abc import Callable
from pathlib import Path

from bdi.errors import (
    IncludeCircle,
    IncludeNotFound,
    UnknownDirective,
)
from bdi.parser.clauses import with_own_labels
from bdi.parser.texts import parse
from bdi.syntax import (
    Belief,
    Clause,
    Directive,
    Goal,
    Plan,
    Program,
    Rule,
)
from bdi.terms import (
    String,
)

Read = Callable[[Path], str]


def load_program(path: str | Path) -> Program:
    """The program in this file, with everything it includes. Raises AgentSpeakError; OSError if it cannot be read."""
    return parse_program(_read_text(Path(path)), source=str(path))


def parse_program(text: str, source: str = "<text>", read: Read | None = None) -> Program:
    """A program with its includes in place. Included paths are relative to the file that includes them.

    `read` gives the text of an included file (by default from disk). Raises AgentSpeakSyntaxError, IncludeNotFound,
    IncludeCircle, UnknownDirective.
    """
    collected = _Collected(read or _read_text)
    collected.add(text, source, ())
    return Program(
        source,
        tuple(collected.beliefs),
        tuple(collected.goals),
        tuple(with_own_labels(collected.plans)),
        tuple(collected.sources),
    )


def _read_text(path: Path) -> str:
    return path.read_text(encoding="utf-8")


class _Collected:
    """A program while its files are read, each where it is included."""

    def __init__(self, read: Read) -> None:
        self.read = read
        self.beliefs: list[Belief | Rule] = []
        self.goals: list[Goal] = []
        self.plans: list[Plan] = []
        self.sources: list[str] = []

    def add(self, text: str, source: str, outer: tuple[Path, ...]) -> None:
        self.sources.append(source)
        here = (*outer, Path(source).resolve())
        for clause in parse(text, "program", source):
            if isinstance(clause, Directive):
                self.obey(clause, Path(source).parent, here)
            else:
                self.keep(clause)

    def keep(self, clause: Clause) -> None:
        if isinstance(clause, Plan):
            self.plans.append(clause)
        elif isinstance(clause, Goal):
            self.goals.append(clause)
        elif isinstance(clause, Belief | Rule):
            self.beliefs.append(clause)

    def obey(self, directive: Directive, folder: Path, here: tuple[Path, ...]) -> None:
        """{ include("file") }"""
        term = directive.term
        if term.functor != "include" or len(term.args) != 1 or not isinstance(term.args[0], String):
            raise UnknownDirective(f"unknown directive {{ {term} }}", directive.place, ('{ include("file.asl") }',))
        path = folder / str.__str__(term.args[0])
        if path.resolve() in here:
            raise IncludeCircle(f"{path} includes itself", directive.place)
        self.add(self.text_of(path, directive), str(path), here)

    def text_of(self, path: Path, directive: Directive) -> str:
        try:
            return self.read(path)
        except (OSError, ValueError) as error:
            reason = getattr(error, "strerror", None) or "not a text file"
            raise IncludeNotFound(f"cannot include {path}: {reason}", directive.place) from error
