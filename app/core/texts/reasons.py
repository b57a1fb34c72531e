"""Why an order or a robot waits, in the reader's language.

Robots and the service say it in English sentences, which are kept as they were said. The catalogue has those sentences
under `why.…`, those of alarms under `alarm.of.…`: by them a sentence is recognised, with what stands in its gaps, and
then said in another language. What is not recognised is shown as it is, and marked as English.

A gap may hold a code, such as an order's state or the reason for which an action failed: `gap.reason.no_one_came` says
it in words. A reason may also be such a code alone.
"""

import json
import re
from collections.abc import Iterator, Mapping
from functools import cache, lru_cache
from pathlib import Path
from string import Formatter
from typing import Final

from pydantic import BaseModel

from app.core.texts import catalogue, text

PREFIXES: Final = ("why.", "alarm.of.")
NOT_RECOGNISED: Final = "why.in_english"
OWN_CODE: Final = "why.own_code"
"""For a code of a robot's own program: words without a translation, that look like no mistake of the page."""
CODE: Final = re.compile(r"[a-z][a-zA-Z0-9]*(?:_\w+|\(.*\)|_\w+\(.*\))")
"""An atom of a program, of several words, or a structure. A single word may be anybody's."""
REASON: Final = "reason"
"""The gap in which another sentence may stand."""
EARLIER: Final = Path(__file__).with_name("earlier_sentences.json")
"""Sentences as they were once: robots with earlier software say them, and orders and alarms of that time keep them."""


class Words(BaseModel):
    """A text of the catalogue and what fills its gaps: with the catalogue it can be said in any language."""

    key: str
    facts: dict[str, str]


@lru_cache(4096)
def words_of(sentence: str) -> Words | None:
    """The sentence or code as a key with facts; None if it is neither. With or without a full stop."""
    if key := key_of_code(REASON, sentence):
        return Words(key=key, facts={})
    if CODE.fullmatch(sentence):
        return Words(key=OWN_CODE, facts={"code": sentence})
    for key, pattern in _patterns():
        if found := pattern.fullmatch(sentence.rstrip(".")):
            return Words(key=key, facts=found.groupdict())
    return None


def key_of_code(gap: str, fact: str) -> str | None:
    """The text that says what stands in a gap, where that is a code; a fault that stopped the robot is a reason too."""
    keys = (f"gap.{gap}.{fact}", *((f"why.fault.{fact}",) if gap == REASON else ()))
    return next((key for key in keys if key in catalogue("en")), None)


def in_language(language: str, sentence: str) -> str:
    """The sentence for a reader of `language`; a code as a sentence of its own."""
    words = words_of(sentence)
    if words is None:
        return text(language, NOT_RECOGNISED, {"sentence": sentence})
    said = text(language, words.key, {name: _filling(language, name, fact) for name, fact in words.facts.items()})
    return said[:1].upper() + said[1:] if key_of_code(REASON, sentence) or words.key == OWN_CODE else said


def in_words(language: str, facts: Mapping[str, str]) -> Mapping[str, str]:
    """The facts of a text, the reason among them in the reader's language."""
    return {**facts, REASON: in_language(language, facts[REASON])} if REASON in facts else facts


def _filling(language: str, gap: str, fact: str) -> str:
    """Return the text of a gap: a code in words, another sentence in the reader's language, or the fact itself."""
    if key := key_of_code(gap, fact):
        return text(language, key).rstrip(".")
    if gap != REASON:
        return fact
    words = words_of(fact) or Words(key=NOT_RECOGNISED, facts={"sentence": fact})
    return text(language, words.key, words.facts).rstrip(".")


@cache
def _patterns() -> tuple[tuple[str, re.Pattern[str]], ...]:
    """Sentences without gaps first: they are the surer find."""
    now = ((key, said) for key, said in catalogue("en").items() if key.startswith(PREFIXES) and key != NOT_RECOGNISED)
    earlier: dict[str, str] = json.loads(EARLIER.read_text(encoding="utf-8"))
    texts = sorted((*now, *earlier.items()), key=lambda one: "{" in one[1])
    return tuple((key, _pattern(said)) for key, said in texts)


def _pattern(said: str) -> re.Pattern[str]:
    return re.compile("".join(_parts(said.rstrip("."))))


def _parts(said: str) -> Iterator[str]:
    for literal, gap, _, _ in Formatter().parse(said):
        yield re.escape(literal)
        if gap:
            yield rf"(?P<{gap}>.+?)"
