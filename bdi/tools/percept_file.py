"""A percept file: percepts and messages of an agent, one line a cycle.

    line(center) battery(ok)
    {"percepts": ["line(lost)"], "messages": [["achieve", "g(1)"]]}
    {"percepts": null}
    {"percepts": ["p"], "agents": {"r2": {"percepts": ["q"], "messages": [["tell", "r", "r1"]]}}}

Plain lines hold literals separated by spaces (the format of the paper's scripts), an empty one means that nothing is
perceived. In JSON `null` means nothing new; a message may name its sender; `agents` says what some of several agents
get instead.
"""

import json
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from bdi.language.errors import AgentSpeakSyntaxError, Place
from bdi.language.parser import parse_literal
from bdi.language.terms import Term, show
from bdi.model.messages import Message

USER = "user"  # who a message is from if the file does not say


@dataclass(frozen=True, slots=True)
class Stimulus:
    """The input of one cycle. `percepts` None: nothing new; `messages` are (performative, content, sender); `others`
    is what agents of these names get instead."""

    percepts: tuple[str, ...] | None
    messages: tuple[tuple[str, str, str], ...] = ()
    others: tuple[tuple[str, "Stimulus"], ...] = ()

    def of(self, agent: str) -> "Stimulus":
        """Return the input of the agent of this name."""
        return dict(self.others).get(agent, self)

    def messages_to(self, agent: str) -> list[Message]:
        return [Message(sender, kind, content, agent) for kind, content, sender in self.messages]


NOTHING = Stimulus(())


def read_percepts(path: Path) -> tuple[Stimulus, ...]:
    """The lines of the file. Raises AgentSpeakSyntaxError with the line; OSError if it cannot be read."""
    return stimuli_of(path.read_text(encoding="utf-8").splitlines(), str(path))


def stimuli_of(lines: Iterable[str], source: str, first_line: int = 1) -> tuple[Stimulus, ...]:
    """One for each line. Raises AgentSpeakSyntaxError."""
    return tuple(stimulus_of(line, Place(source, number, 1, line)) for number, line in enumerate(lines, first_line))


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


def read_at(place: Place, text: str, read: Callable[[str], Term]) -> str:
    """Return a part of a line in the notation of AgentSpeak, so that equal terms are equal texts. Raises
    AgentSpeakSyntaxError with the place in the file."""
    try:
        return show(read(text))
    except AgentSpeakSyntaxError:
        before = "\n" * (place.line - 1) + " " * place.text.find(text)
    try:
        return show(read(before + text))
    except AgentSpeakSyntaxError as error:
        here = Place(place.source, place.line, max(error.column, 1), place.text)
        raise AgentSpeakSyntaxError(error.problem, here, error.expected) from None


def _checked(text: str, place: Place) -> str:
    if len(text) > 1 and text[-1] in ",;.&":
        here = Place(place.source, place.line, place.text.find(text) + len(text), place.text)
        raise AgentSpeakSyntaxError(f"percepts are separated by spaces, without {text[-1]!r}", here)
    return read_at(place, text, parse_literal)


def _from_json(line: str, place: Place) -> Stimulus:
    try:
        entry = json.loads(line)
    except ValueError as error:
        here = Place(place.source, place.line, getattr(error, "colno", 1), place.text)
        raise AgentSpeakSyntaxError(f"this line is no JSON: {getattr(error, 'msg', error)}", here) from None
    if not isinstance(entry, dict):
        raise AgentSpeakSyntaxError("this line is no JSON object", place)
    return _stimulus(entry, place)


def _stimulus(entry: dict[str, Any], place: Place) -> Stimulus:
    percepts, messages, others = entry.get("percepts"), entry.get("messages") or [], entry.get("agents") or {}
    unknown = sorted(set(entry) - {"percepts", "messages", "agents"})
    if unknown:
        raise AgentSpeakSyntaxError(f"unknown key {unknown[0]!r}", place, ("percepts", "messages", "agents"))
    if not _is_texts(percepts or []) or not isinstance(messages, list):
        raise AgentSpeakSyntaxError("percepts must be a list of texts, messages a list of pairs", place)
    if not all(_is_texts(message) and len(message) in (2, 3) for message in messages):
        raise AgentSpeakSyntaxError('a message is a pair such as ["achieve", "g(1)"], its sender may follow', place)
    if not isinstance(others, dict) or not all(isinstance(each, dict) for each in others.values()):
        raise AgentSpeakSyntaxError('agents must be an object such as {"r1": {"percepts": ["p"]}}', place)
    return Stimulus(
        None if percepts is None else tuple(_checked(text, place) for text in percepts),
        tuple((kind, _content(kind, text, place), *(sender or [USER])) for kind, text, *sender in messages),
        tuple((name, _stimulus(each, place)) for name, each in others.items()),
    )


def _content(kind: str, text: str, place: Place) -> str:
    """Plans and events are read by the agent; everything else is a literal."""
    return text if kind.endswith("How") else _checked(text, place)


def _is_texts(value: Any) -> bool:
    return isinstance(value, list) and all(isinstance(each, str) for each in value)
