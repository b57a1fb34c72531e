"""The parser itself: tokens go in, methods of a builder are called with the parts of each rule, bottom-up."""

import re
from collections.abc import Callable, Iterator
from functools import lru_cache
from typing import Any, NamedTuple, Protocol

from bdi.language.parser.tables import Production, Row, Tables, tables

END = "$END"
WORD = "ATOM"  # what a keyword is where the grammar expects none
HIGHEST = 4000  # stack; no text that is less deep needs more
DEEPEST = 120  # rules inside each other; it keeps recursion through terms within Python's stack


class Token(NamedTuple):
    kind: str
    text: str
    start: int

    @property
    def end(self) -> int:
        return self.start + len(self.text)


class Builder(Protocol):
    """An object with a method for each rule of the grammar that has a value."""

    at: int  # where the rule that is being built begins


class Stuck(Exception):
    """The parser cannot go on."""

    def __init__(self, start: int) -> None:
        self.start = start


class Unexpected(Stuck):
    """A token that cannot come now."""

    def __init__(self, token: Token) -> None:
        super().__init__(token.start)
        self.token = token


class NoToken(Stuck):
    """No token begins here."""


class TooDeep(Stuck):
    """Brackets in brackets in brackets."""


Repairer = Callable[["Parse", Token], "list[Token] | None"]


@lru_cache(maxsize=1)
def _pattern() -> tuple[re.Pattern[str], list[str]]:
    """One pattern for all tokens, and the names of its groups; a group without name is a sign of its own."""
    made = tables()
    signs = "|".join(re.escape(sign) for sign in sorted(made.signs, key=len, reverse=True))
    patterns = [*(pattern for _, pattern in made.tokens), signs]
    return re.compile("|".join(f"({pattern})" for pattern in patterns)), [
        "",
        *(name for name, _ in made.tokens),
        "SIGN",
    ]


def tokens_of(text: str) -> Iterator[Token]:
    """Raises NoToken."""
    signs = tables().signs
    pattern, kinds = _pattern()
    match, place, end = pattern.match, 0, len(text)
    while place < end:
        found = match(text, place)
        if found is None:
            raise NoToken(place)
        kind, start, place = kinds[found.lastindex or 0], place, found.end()
        if kind == "SIGN":
            yield Token(signs[found[0]], found[0], start)
        elif kind:
            yield Token(kind, found[0], start)
    yield Token(END, "", end)


class Parse:
    """One text on its way to its value."""

    def __init__(self, text: str, start: str, builder: Builder, repair: "Repairer | None" = None) -> None:
        made = tables()
        self.tables: Tables = made
        self.tokens = tokens_of(text)
        self.builder = builder
        self.repair = repair  # says what is meant by a token that cannot come
        self.methods = [getattr(builder, each.method) if each.method else None for each in made.productions]
        self.first = made.starts[start]
        self.states = [self.first]
        self.end = made.ends[start]
        self.values: list[Any] = []
        self.places: list[int] = []
        self.depths: list[int] = []
        self.before: list[Token] = []  # the tokens read so far, for the words of an error

    def run(self) -> Any:
        """The value of the text. Raises Unexpected, NoToken, TooDeep, and what the builder raises."""
        for token in self.tokens:
            named = self.named(token)
            try:
                self.feed(named)
            except Unexpected:
                for meant in self.meant(named):
                    self.feed(meant)
        return self.values[-1]

    def meant(self, token: Token) -> list[Token]:
        """Return the token that was meant where this one cannot come. Raises Unexpected."""
        tokens = self.repair(self, token) if self.repair else None
        if tokens is None:
            raise Unexpected(token)
        return tokens

    def named(self, token: Token) -> Token:
        """A word is a keyword where one is expected."""
        if token.kind == WORD:
            word = self.tables.words.get(token.text)
            if word and word in self.tables.rows[self.states[-1]]:
                return Token(word, token.text, token.start)
        return token

    def feed(self, token: Token) -> None:
        """Reduce until the token can be shifted."""
        rows, productions, states = self.tables.rows, self.tables.productions, self.states
        kind = token.kind
        while True:
            action = rows[states[-1]].get(kind)
            if action is None:
                raise Unexpected(token)
            if action >= 0:
                if len(states) > HIGHEST:
                    raise TooDeep(token.start)
                states.append(action)
                self.values.append(token.text)
                self.places.append(token.start)
                self.depths.append(0)
                self.before.append(token)
                return
            production = productions[~action]
            if production.size != 1 or self.methods[~action] or production.spliced:
                self.reduce(production, self.methods[~action], token.start)
            else:
                states.pop()
            states.append(rows[states[-1]][production.origin])
            if kind == END and states[-1] == self.end:
                return

    def reduce(self, production: Production, method: Any, start: int) -> None:
        """Take the parts of a rule off the stacks and put its value there."""
        size = production.size
        if size == 0:
            parts, depth = [], 0
        else:
            parts, start, depth = self.values[-size:], self.places[-size], max(self.depths[-size:])
            del self.values[-size:], self.places[-size:], self.depths[-size:], self.states[-size:]
        children = _children(production.kept, parts)
        if method is not None:
            depth += 1
            if depth > DEEPEST:
                raise TooDeep(start)
            self.builder.at = start
            self.values.append(method(*children))
        else:
            self.values.append(children if production.spliced else children[0])
        self.places.append(start)
        self.depths.append(depth)

    def accepts(self, *kinds: str) -> bool:
        """Return whether these tokens could follow."""
        states = self.states[:]
        return all(_shift(self.tables, states, kind) for kind in kinds)

    def accepted(self, *kinds: str) -> bool:
        """Test like `accepts`, in the state before the token that cannot come had any effect."""
        states = [self.first]
        return all(_shift(self.tables, states, kind) for kind in (*(token.kind for token in self.before), *kinds))

    def expected(self) -> list[str]:
        """The tokens of which one could follow."""
        row: Row = self.tables.rows[self.states[-1]]
        return [name for name in row if name.isupper() or name == END if self.accepts(name)]


def _children(kept: list[int], parts: list[Any]) -> list[Any]:
    children: list[Any]
    if not kept:
        return []
    if kept[0] < 0:
        children, rest = parts[~kept[0]], kept[1:]  # no other node uses that list: it grows in place
    else:
        children, rest = [], kept
    for place in rest:
        if place < 0:
            children.extend(parts[~place])
        else:
            children.append(parts[place])
    return children


def _shift(made: Tables, states: list[int], kind: str) -> bool:
    """Shift a token on a copy of the states, or say that it cannot be."""
    while True:
        action = made.rows[states[-1]].get(kind)
        if action is None:
            return False
        if action >= 0:
            states.append(action)
            return True
        production = made.productions[~action]
        if production.size:
            del states[-production.size :]
        states.append(made.rows[states[-1]][production.origin])
        if kind == END and states[-1] in made.ends.values():
            return True
