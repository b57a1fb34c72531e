"""A percept file: what an agent perceives and is told, one line a cycle.

    line(center) battery(ok)
    {"percepts": ["line(lost)"], "messages": [["achieve", "g(1)"]]}
    {"percepts": null}

Plain lines hold literals separated by spaces (the format of the paper's scripts), an empty one means that nothing is
perceived. In JSON `null` means nothing new.
"""

import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from bdi.errors import AgentSpeakSyntaxError, Place
from bdi.parser import parse_literal
from bdi.terms import show


@dataclass(frozen=True, slots=True)
class Stimulus:
    """What one cycle gets. `percepts` None: nothing new; `messages` are (performative, content)."""

    percepts: tuple[str, ...] | None
    messages: tuple[tuple[str, str], ...] = ()


def read_percepts(path: Path) -> Iterator[Stimulus]:
    """The lines of the file. Raises AgentSpeakSyntaxError with the line; OSError if it cannot be read."""
    lines = path.read_text(encoding="utf-8").splitlines()
    return iter([stimulus_of(line, Place(str(path), number, 1, line)) for number, line in enumerate(lines, 1)])


def stimulus_of(line: str, place: Place) -> Stimulus:
    """One line. Raises AgentSpeakSyntaxError."""
    if line.lstrip().startswith("{"):
        return _from_json(line, place)
    return Stimulus(tuple(_checked(text, place) for text in split_literals(line)))


def split_literals(line: str) -> list[str]:
    """Literals separated by spaces; spaces inside brackets or strings separate nothing."""
    words, word, depth, quoted = [], "", 0, False
    for char in line:
        if char == '"':
            quoted = not quoted
        elif not quoted:
            depth += (char in "([") - (char in ")]")
        if char.isspace() and not quoted and depth <= 0:
            words.append(word)
            word = ""
        else:
            word += char
    return [each for each in [*words, word] if each]


def _checked(text: str, place: Place) -> str:
    """The literal as AgentSpeak writes it, so that equal percepts are equal texts."""
    try:
        return show(parse_literal(text))
    except AgentSpeakSyntaxError as error:
        column = place.text.find(text) + max(error.column, 1)
        here = Place(place.source, place.line, column, place.text)
        raise AgentSpeakSyntaxError(error.problem, here, error.expected) from None


def _from_json(line: str, place: Place) -> Stimulus:
    try:
        entry = json.loads(line)
    except ValueError as error:
        raise AgentSpeakSyntaxError(f"this line is no JSON: {error}", place) from None
    percepts, messages = entry.get("percepts"), entry.get("messages") or []
    if not _is_texts(percepts or []) or not isinstance(messages, list):
        raise AgentSpeakSyntaxError("percepts must be a list of texts, messages a list of pairs", place)
    if not all(_is_texts(message) and len(message) == 2 for message in messages):
        raise AgentSpeakSyntaxError('a message is a pair such as ["achieve", "g(1)"]', place)
    return Stimulus(
        None if percepts is None else tuple(_checked(text, place) for text in percepts),
        tuple((kind, _checked(content, place)) for kind, content in messages),
    )


def _is_texts(value: Any) -> bool:
    return isinstance(value, list) and all(isinstance(each, str) for each in value)
