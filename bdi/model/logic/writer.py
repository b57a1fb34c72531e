"""Python source as it is written line by line, and the function that it becomes."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from bdi.language.terms import Term, Var

DEEPEST_LOOPS = 12  # CPython allows 20 blocks within each other in one function


class Flow:
    """The local names that hold variables at one point of the source.

    A variable without a name has not been met. `plain` are those whose values equality compares: ground, and without
    annotations. A flow never changes; each branch of a formula goes on with its own.
    """

    __slots__ = ("names", "plain")

    def __init__(self, names: dict[Var, str] | None = None, plain: frozenset[Var] = frozenset()) -> None:
        self.names = names or {}
        self.plain = plain

    def with_name(self, variable: Var, name: str, plain: bool = False) -> "Flow":
        return Flow({**self.names, variable: name}, self.plain | {variable} if plain else self.plain)

    def is_plain(self, term: Term) -> bool:
        return type(term) is not Var or term in self.plain


class Writer:
    """The source of one function."""

    def __init__(self, runtime: dict[str, Any], once: bool) -> None:
        self.namespace = dict(runtime)
        self.once = once  # whether the first answer is all that is wanted
        self.loops = 0  # `for` around the current line, in the current function
        self._otherwise = "return None"  # what failing outside of them means
        self._lines: list[str] = []
        self._depth = 0
        self._constants: dict[int, str] = {}
        self._count = 0

    def line(self, text: str) -> None:
        self._lines.append("    " * self._depth + text)

    @contextmanager
    def function(self, name: str, parameters: str = "") -> Iterator[None]:
        """Within it, a line that fails returns None."""
        around, self.loops, self._otherwise = (self.loops, self._otherwise), 0, "return None"
        self.line(f"def {name}({parameters}):")
        with self._indented():
            yield
        self.loops, self._otherwise = around

    @contextmanager
    def attempt(self, giving_up_on: str) -> Iterator[None]:
        """Within it, a line that fails goes on after it; so does one of these exceptions."""
        self.line("try:")
        with self._indented():
            self.line("while True:")
            otherwise, self._otherwise = self._otherwise, "break"
            with self._indented():
                yield
                self.line("break")
            self._otherwise = otherwise
        self.line(f"except {giving_up_on}: pass")

    @contextmanager
    def loop(self, header: str) -> Iterator[None]:
        """Within it, a line that fails goes on with the next round, whose first deed is to take back bindings."""
        self.line(header)
        self.loops += 1
        with self._indented():
            yield
        self.loops -= 1

    @contextmanager
    def block(self, header: str) -> Iterator[None]:
        self.line(header)
        with self._indented():
            yield

    @contextmanager
    def _indented(self) -> Iterator[None]:
        self._depth += 1
        before = len(self._lines)
        yield
        if len(self._lines) == before:
            self.line("pass")
        self._depth -= 1

    def fail(self) -> str:
        """The statement for "not this way"."""
        return "continue" if self.loops else self._otherwise

    def require(self, condition: str) -> None:
        """Go on only if it holds. Conditions that have an operator come in brackets."""
        if condition.startswith("not "):
            self.refuse(condition[4:])
        else:
            self.line(f"if not {condition}: {self.fail()}")

    def refuse(self, condition: str) -> None:
        self.line(f"if {_bare(condition)}: {self.fail()}")

    def fresh(self, hint: str) -> str:
        """A local name that is not taken."""
        self._count += 1
        hint = hint if hint.isascii() and hint.isidentifier() else "v"
        return f"{hint}_{self._count}"

    def constant(self, value: object, hint: str = "C") -> str:
        """A name for this very object."""
        name = self._constants.get(id(value))
        if name is None:
            name = self._constants[id(value)] = self.fresh(hint)
            self.namespace[name] = value
        return name

    def mentions(self, words: tuple[str, ...], since: int) -> bool:
        """Return whether a line from there on has one of these words in it."""
        return any(word in line for line in self._lines[since:] for word in words)

    @property
    def place(self) -> int:
        return len(self._lines)

    def insert(self, place: int, text: str, depth: int) -> None:
        self._lines.insert(place, "    " * depth + text)

    def replace(self, place: int, text: str, depth: int) -> None:
        self._lines[place] = "    " * depth + text

    @property
    def depth(self) -> int:
        return self._depth

    @property
    def source(self) -> str:
        return "\n".join(self._lines) + "\n"

    def made(self, name: str) -> Any:
        """The function of this name, compiled. Raises RecursionError for what Python finds nested too deeply."""
        try:
            exec(compile(self.source, f"<{name}>", "exec"), self.namespace)  # noqa: S102 (our own source, no input text)
        except (SyntaxError, MemoryError) as error:
            raise RecursionError(f"Python cannot compile it: {error}") from error
        return self.namespace[name]


def _bare(condition: str) -> str:
    """Without brackets around the whole, but for `a if b else c`, which reads better with them."""
    if " if " in condition:
        return condition
    depth = 0
    for place, sign in enumerate(condition):
        depth += (sign == "(") - (sign == ")")
        if not depth:  # what was opened first is closed: at the end, or before
            return condition[1:-1] if place and place == len(condition) - 1 and condition[0] == "(" else condition
    return condition
