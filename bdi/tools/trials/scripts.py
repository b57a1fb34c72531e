"""The closing comment of a program, which says what is put in and what must come out:

/* percepts                      one line a cycle, as in a percept file
line(center) battery(ok)

messages                         CYCLE PERFORMATIVE CONTENT; without a number in the first cycle
achieve fetch(letter)

fails drive                      actions of this name fail
prints                           what is expected
3 drive(post1)
*/
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

from bdi.language.errors import AgentSpeakSyntaxError, Place
from bdi.tools.percept_file import USER, Stimulus, stimuli_of, stimulus_of
from bdi.tools.trials.expectations import Expectation, expectation_of

_TITLE = re.compile(r"(percepts|messages|prints)|fails\s+(\S+)")
_MESSAGE = re.compile(r"(?:(\d+)\s+)?(\w+)\s+(.+)")


@dataclass(frozen=True, slots=True)
class Script:
    """`first_line` and `lines` tell where in the file the expectation stands (lines count from 1)."""

    stimuli: tuple[Stimulus, ...]
    failing: tuple[str, ...]
    expectation: Expectation
    first_line: int
    lines: int


class _Section(NamedTuple):
    title: str
    line: int  # of its first line of content
    content: list[str]


def script_in(text: str, source: str) -> Script | None:
    """Read the closing comment; None if it expects nothing. Raises AgentSpeakSyntaxError."""
    sections = list(_sections(text))
    prints = next((section for section in sections if section.title == "prints"), None)
    if prints is None:
        return None
    stimuli: list[Stimulus] = []
    for section in sections:
        if section.title == "percepts":
            stimuli += stimuli_of(section.content, source, section.line)
    for section in sections:
        if section.title == "messages":
            for number, line in enumerate(section.content, section.line):
                _add_message(stimuli, line, Place(source, number, 1, line))
    failing = tuple(section.title.split()[1] for section in sections if section.title.startswith("fails"))
    expectation = expectation_of(prints.content, source, prints.line)
    return Script(tuple(stimuli), failing, expectation, prints.line, len(prints.content))


def _sections(text: str) -> Iterator[_Section]:
    """The parts of the last comment, if the file ends with one. An empty line ends a section."""
    start, end = text.rfind("/*"), text.rfind("*/")
    if start < 0 or end < start or text[end + 2 :].strip():
        return
    first_line = text.count("\n", 0, start) + 1
    current: _Section | None = None
    for number, line in enumerate(text[start + 2 : end].split("\n"), first_line):
        title = _TITLE.fullmatch(line.strip())
        if title:
            if current:
                yield current
            current = _Section(" ".join(line.split()), number + 1, [])
        elif not line.strip():
            if current:
                yield current
            current = None
        elif current:
            current.content.append(line)
    if current:
        yield current


def _add_message(stimuli: list[Stimulus], line: str, place: Place) -> None:
    found = _MESSAGE.fullmatch(line.strip())
    if found is None:
        raise AgentSpeakSyntaxError("this is no message", place, ("CYCLE PERFORMATIVE CONTENT",))
    cycle = int(found[1] or 1)
    content = stimulus_of(found[3], place).percepts if not found[2].endswith("How") else (found[3],)
    if content is None or len(content) != 1:
        raise AgentSpeakSyntaxError("a message has one content", place, ("achieve g(1)",))
    while len(stimuli) < cycle:
        stimuli.append(Stimulus(()))
    before = stimuli[cycle - 1]
    stimuli[cycle - 1] = replace(before, messages=(*before.messages, (found[2], content[0], USER)))
