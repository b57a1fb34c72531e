"""Why an order or a robot waits, in the reader's language.

Robots and the service say it in English sentences, which are kept as they were said. The catalogue has those sentences
under `why.…`, those of alarms under `alarm.of.…`: by them a sentence is recognised, with what stands in its gaps, and
then said in another language. What is not recognised is shown as it is, and marked as English.
"""

import re
from collections.abc import Iterator, Mapping
from functools import cache, lru_cache
from string import Formatter
from typing import Final

from pydantic import BaseModel

from app.texts import catalogue, text

PREFIXES: Final = ("why.", "alarm.of.")
NOT_RECOGNISED: Final = "why.in_english"
REASON: Final = "reason"
"""The gap in which another sentence may stand."""


class Words(BaseModel):
    """A text of the catalogue and what fills its gaps: whoever has the catalogue can say it in any language."""

    key: str
    facts: dict[str, str]


@lru_cache(4096)
def words_of(sentence: str) -> Words | None:
    """The sentence as a key with facts; None if it is not in the catalogue. With or without a full stop."""
    for key, pattern in _patterns():
        if found := pattern.fullmatch(sentence.rstrip(".")):
            return Words(key=key, facts=found.groupdict())
    return None


def in_language(language: str, sentence: str) -> str:
    """The sentence for somebody who reads `language`."""
    words = words_of(sentence)
    if words is None:
        return text(language, NOT_RECOGNISED, {"sentence": sentence})
    inner = {name: _inner(language, fact) if name == REASON else fact for name, fact in words.facts.items()}
    return text(language, words.key, inner)


def in_words(language: str, facts: Mapping[str, str]) -> Mapping[str, str]:
    """The facts of a text, the reason among them in the reader's language."""
    return {**facts, REASON: in_language(language, facts[REASON])} if REASON in facts else facts


def _inner(language: str, sentence: str) -> str:
    return in_language(language, sentence).rstrip(".") if words_of(sentence) else sentence


@cache
def _patterns() -> tuple[tuple[str, re.Pattern[str]], ...]:
    """Sentences without gaps first: they are the surer find."""
    texts = {key: said for key, said in catalogue("en").items() if key.startswith(PREFIXES) and key != NOT_RECOGNISED}
    return tuple((key, _pattern(said)) for key, said in sorted(texts.items(), key=lambda one: "{" in one[1]))


def _pattern(said: str) -> re.Pattern[str]:
    return re.compile("".join(_parts(said.rstrip("."))))


def _parts(said: str) -> Iterator[str]:
    for literal, gap, _, _ in Formatter().parse(said):
        yield re.escape(literal)
        if gap:
            yield rf"(?P<{gap}>.+?)"
