"""Runs of agents, written to a file.

    recorder = Recorder(agent, file, program)       # before the first cycle
    outcome = recorder.cycle(percepts, messages, finished, now)
    recorder.close()

`replaying` reads it again. One JSON object a line: for each agent a head (program with all its text, chance, declared
actions), then its cycles (what came in, what came out) and an end. `percepts` is left out where they are those of the
cycle before; `society` is what those around it answered (`.all_names`, `.df_search`). Anything else that is done to the
agent from outside, such as `add_plan`, is not recorded: a replay names the first difference.
"""

import hashlib
import json
from array import array
from base64 import b64encode
from collections.abc import Iterable, Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any, TextIO

from bdi.language.errors import BdiError
from bdi.language.syntax import Belief, Goal, Program
from bdi.language.terms import Term, show
from bdi.model.messages import Finished, Message
from bdi.model.society import ALONE, Society
from bdi.reasoning.agent import Agent
from bdi.reasoning.output import Outcome
from bdi.tools.recording.recorded_replies import recorded

VERSION = 1


class RecordedTooLate(BdiError):
    """An agent that has already had a cycle: its run could not be replayed."""


class Recorder:
    """An agent whose every cycle is written down. Recorders of several agents may share a file."""

    def __init__(
        self,
        agent: Agent,
        file: TextIO,
        program: Program,
        *,
        texts: Mapping[str, str] | None = None,
        entries: bool = False,
        compatible: bool = False,
    ) -> None:
        """`texts` are the sources of a program that does not come from files; with `entries` what is chosen is
        written too. Raises RecordedTooLate; OSError if a source cannot be read."""
        if agent.cycles:
            raise RecordedTooLate(f"{agent.name} has already had {agent.cycles} cycles: record from the first one on")
        self.agent = agent
        self._cycle = agent.cycle
        self._file = file
        self._percepts: list[str] | None = None
        self._society: Society = ALONE
        self._replies: list[Any] = []
        self._entries = entries
        if entries:
            agent.listen(lambda entry: None)
        self._write(_head(agent, program, texts or _read_sources(program), compatible))

    @property
    def name(self) -> str:
        return self.agent.name

    def cycle(
        self,
        percepts: Iterable[Term | str] | None = None,
        messages: Iterable[Message] = (),
        finished: Iterable[Finished] = (),
        now: float = 0.0,
    ) -> Outcome:
        """One cycle of the agent. What it refuses is not recorded: nothing has happened then."""
        percepts = None if percepts is None else list(percepts)
        messages, finished = list(messages), list(finished)
        self._record_society()
        outcome = self._cycle(percepts, messages, finished, now)
        line: dict[str, Any] = {"agent": self.name, "cycle": self.agent.cycles, "now": now}
        texts = None if percepts is None else sorted(map(_text, percepts))
        if texts is None or texts != self._percepts:
            line["percepts"] = texts
            self._percepts = self._percepts if texts is None else texts
        if messages:
            line["messages"] = [_plain(message) for message in messages]
        if finished:
            line["finished"] = [_plain(news) for news in finished]
        if self._replies:
            line["society"] = self._replies[:]
            self._replies.clear()
        self._write({**line, **result_of(self.agent, outcome, self._entries)})
        return outcome

    def _record_society(self) -> None:
        """Record the replies of the society, which may have changed since the last cycle."""
        if self.agent.society is not self._society:
            alone = self.agent.society is ALONE
            self._society = ALONE if alone else recorded(self.agent.society, self._replies)
            self.agent.society = self._society

    def close(self) -> None:
        """Without this the recording counts as cut off. The file stays open."""
        self._write({"agent": self.name, "end": self.agent.cycles})

    def _write(self, line: dict[str, Any]) -> None:
        self._file.write(json.dumps(line, ensure_ascii=False) + "\n")


def record(agent: Agent, file: TextIO, program: Program, *, compatible: bool = False) -> Recorder:
    """Record an agent whose cycles are run by other code, such as a system of several agents."""
    recorder = Recorder(agent, file, program, compatible=compatible)
    agent.recorder = recorder
    return recorder


def _head(agent: Agent, program: Program, texts: Mapping[str, str], compatible: bool) -> dict[str, Any]:
    return {
        "recording": VERSION,
        "agent": agent.name,
        "program": program.source,
        "sha256": digest(texts),
        "sources": dict(texts),
        "chance": _chance_text(agent.random.getstate()),
        "actions": None if agent.known_actions is None else sorted(agent.known_actions),
        "compatible": compatible,
        **_given(program, texts),
    }


def _given(program: Program, texts: Mapping[str, str]) -> dict[str, list[str]]:
    """Beliefs and goals that an agent was created with, and that stand in no source."""
    found = {
        "beliefs": [str(each.literal) for each in program.beliefs if isinstance(each, Belief) and _extra(each, texts)],
        "goals": [str(each.literal) for each in program.goals if _extra(each, texts)],
    }
    return {key: value for key, value in found.items() if value}


def _extra(clause: Belief | Goal, texts: Mapping[str, str]) -> bool:
    return clause.place.source not in texts


def _read_sources(program: Program) -> dict[str, str]:
    return {source: Path(source).read_text(encoding="utf-8") for source in program.sources}


def digest(texts: Mapping[str, str]) -> str:
    """One number for a program with all that it includes."""
    return hashlib.sha256(json.dumps(sorted(texts.items())).encode()).hexdigest()


def _chance_text(state: Any) -> list[Any]:
    version, words, gauss = state
    return [version, b64encode(array("I", words).tobytes()).decode(), gauss]


def _text(term: Term | str) -> str:
    return term if type(term) is str else show(term)


def _plain(record: Message | Finished) -> dict[str, Any]:
    """The fields that say something; terms as text."""
    fields = record._asdict() if isinstance(record, Finished) else asdict(record)
    filled = {key: value for key, value in fields.items() if value not in ("", None)}
    return {key: value if type(value) in (int, float, bool) else _text(value) for key, value in filled.items()}


def result_of(agent: Agent, outcome: Outcome, entries: bool) -> dict[str, Any]:
    """Return the outputs of a cycle; empty parts are left out."""
    found: dict[str, Any] = {
        "actions": [[action.id, show(action.term), action.intention] for action in outcome.actions],
        "cancelled": list(outcome.cancelled),
        "messages_out": [_plain(message) for message in outcome.messages],
        "printed": list(map(str.__str__, outcome.printed)),
        "failures": [list(failure) for failure in outcome.failures],
        "trace": [str(entry) for entry in outcome.trace] if entries else [],
        "events": len(agent.events),
        "intentions": len(agent.intentions),
    }
    return {key: value for key, value in found.items() if value}
