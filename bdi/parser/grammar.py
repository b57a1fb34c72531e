"""The grammar is `agentspeak.lark`; this is how its errors are said."""

from functools import lru_cache
from pathlib import Path

from lark import Lark, UnexpectedCharacters, UnexpectedInput, UnexpectedToken

from bdi.errors import (
    AgentSpeakSyntaxError,
    Place,
)


@lru_cache(maxsize=1)
def grammar() -> Lark:
    text = (Path(__file__).parent / "agentspeak.lark").read_text(encoding="utf-8")
    return Lark(text, parser="lalr", start=["program", "formula"], propagate_positions=True, maybe_placeholders=False)


def syntax_error(error: UnexpectedInput, text: str, source: str) -> AgentSpeakSyntaxError:
    """Lark's error in the words of the language."""
    line, column = error.line, error.column
    problem, expected = "the text ends too early", set(getattr(error, "expected", ()))
    if isinstance(error, UnexpectedCharacters):
        problem, expected = f"unexpected character {error.char!r}", error.allowed or set()
    elif isinstance(error, UnexpectedToken) and error.token.type != "$END":
        problem, expected = f"unexpected {str(error.token)!r}", set(error.accepts or expected)
    else:
        line, column = text.count("\n") + 1, len(text) - text.rfind("\n")
    return AgentSpeakSyntaxError(problem, place_in(text, source, line, column), _named(expected or set()))


_NAMES = {
    "ATOM": "a name",
    "VARIABLE": "a variable",
    "NUMBER": "a number",
    "STRING": "a string",
    "INTERNAL": "an internal action",
    "RELATION": "a comparison",
    "SUM_SIGN": "'+' or '-'",
    "TRIGGER_SIGN": "a plan",
    "PRODUCT_SIGN": "'*' or '/'",
    "POWER_SIGN": "'**'",
    "GOAL_MARK": "'!' or '?'",
    "NEGATION": "'~'",
    "$END": "the end",
}


def _named(terminals: set[str]) -> tuple[str, ...]:
    """Terminals as people write them, the punctuation first."""
    patterns = {terminal.name: terminal.pattern for terminal in grammar().terminals}
    names = {_NAMES.get(name) or f"'{patterns[name].value}'" if name in patterns else name for name in terminals}
    return tuple(sorted(names, key=lambda name: (not name.startswith("'"), name)))


def place_in(text: str, source: str, line: int, column: int) -> Place:
    lines = text.split("\n")
    return Place(source, line, column, lines[line - 1] if 0 < line <= len(lines) else "")
