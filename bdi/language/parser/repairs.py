"""Notations of older programs, and the present ones.

`and` and `or` for `&` and `|` (as papers print them), steps without `;` between them, labels with a capital letter
(both of Jason 2). In the compatibility mode they are read with a warning; otherwise the same words make the error.
"""

from typing import NamedTuple

from bdi.language.parser.lalr import WORD, Parse, Token
from bdi.language.parser.tables import tables

WORDS_OF_OLD = {"and": "&", "or": "|"}


class Repair(NamedTuple):
    """A present notation for an old one."""

    tokens: list[Token]  # instead of the one that cannot come
    start: int  # of the old notation
    sentence: str
    today: str


def repair(parse: Parse, token: Token) -> Repair | None:
    """Return the present notation for a token of an old program, if there is one."""
    return _connective(parse, token) or _label(parse, token) or _separator(parse, token)


def _connective(parse: Parse, token: Token) -> Repair | None:
    sign = WORDS_OF_OLD.get(token.text, "")
    if not sign or not parse.accepts(kind_of(sign)):
        return None
    return Repair([Token(kind_of(sign), sign, token.start)], token.start, f"'{token.text}' is written '{sign}'", sign)


def _label(parse: Parse, token: Token) -> Repair | None:
    """@L1"""
    before = parse.before[-1].text if parse.before else ""
    if before != "@" or token.kind != "VARIABLE" or "::" in token.text:
        return None
    name = token.text.lstrip("_")
    name = f"{name[:1].lower()}{name[1:]}" if name[:1].isalpha() else f"l{token.text}"
    sentence = f"'{token.text}' cannot be the name of a plan: names begin with a small letter"
    return Repair([Token(WORD, name, token.start)], token.start, sentence, f"@{name}")


def _separator(parse: Parse, token: Token) -> Repair | None:
    """The step before is complete, and this begins another one."""
    if not parse.before or not parse.accepts(kind_of(";"), token.kind):
        return None
    end = parse.before[-1].end
    return Repair([Token(kind_of(";"), ";", end), token], end, "';' is missing between two steps", ";")


def kind_of(sign: str) -> str:
    return tables().signs[sign]
