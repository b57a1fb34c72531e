"""Replies of its society to an agent, recorded while it runs and given again when the run is repeated.

An answer is `[what was asked, the answer]`, or `[what was asked, null, error, message, annotations]` where it failed.
"""

from collections import deque
from collections.abc import Callable, Iterable, Sequence
from typing import Any, cast

from bdi.language.errors import BdiError, UnknownPerformative
from bdi.language.parser import parse_term
from bdi.language.terms import show
from bdi.model.intentions import StepFailed
from bdi.model.messages import Message
from bdi.model.society import ALONE, Reader, Society

READ = "read"  # a message, by its receiver


def recorded(society: Society, replies: list[Any]) -> Society:
    """Return the same society; its replies are recorded in `replies`."""
    return cast(Society, _Recording(society, replies))


def replayed(replies: Iterable[Sequence[Any]]) -> Society:
    """A society that replies so, one after another; what was never asked then is answered as to an agent alone."""
    return cast(Society, _Replayed(replies))


class _Recording:
    def __init__(self, society: Society, replies: list[Any]) -> None:
        self._society = society
        self._replies = replies

    def readers(self, receiver: str, sender: str) -> Sequence[Reader]:
        found = self._record("readers", receiver, sender)
        self._replies[-1][1] = len(found)
        return [_RecordingReader(reader, self._replies) for reader in found]

    def __getattr__(self, what: str) -> Callable[..., Any]:
        return lambda *asked: self._record(what, *asked)

    def _record(self, what: str, *asked: Any) -> Any:
        try:
            answer = getattr(self._society, what)(*asked)
        except StepFailed as failure:
            self._replies.append([what, None, failure.error, failure.message, list(map(show, failure.annots))])
            raise
        self._replies.append([what, answer])
        return answer


class _RecordingReader:
    def __init__(self, reader: Reader, replies: list[Any]) -> None:
        self._reader = reader
        self._replies = replies

    def read(self, message: Message) -> Any:
        try:
            found = self._reader.read(message)
        except BdiError as problem:
            self._replies.append([READ, None, type(problem).__name__, str(problem), []])
            raise
        self._replies.append([READ, None])
        return found


class _Replayed:
    def __init__(self, replies: Iterable[Sequence[Any]]) -> None:
        self._replies = deque(replies)

    def readers(self, receiver: str, sender: str) -> Sequence[Reader]:
        if not self._replies:
            return ALONE.readers(receiver, sender)
        found: int = self._next_reply("readers", receiver, sender)
        return [_ReplayedReader(self._replies)] * found

    def __getattr__(self, what: str) -> Callable[..., Any]:
        return lambda *asked: self._next_reply(what, *asked)

    def _next_reply(self, what: str, *asked: Any) -> Any:
        if not self._replies:
            return getattr(ALONE, what)(*asked)
        then, answer, *failure = self._replies.popleft()
        if then != what:
            raise StepFailed("not_recorded", f"the society was asked for {then} when this was recorded, not for {what}")
        if failure:
            error, message, annots = failure
            raise StepFailed(error, message, tuple(map(parse_term, annots)))
        return answer


class _ReplayedReader:
    def __init__(self, replies: deque[Sequence[Any]]) -> None:
        self._replies = replies

    def read(self, message: Message) -> None:
        then, _, *failure = self._replies.popleft() if self._replies else (READ, None)
        if then == READ and failure:
            kind, sentence, _ = failure
            unknown = kind == UnknownPerformative.__name__
            raise UnknownPerformative(message.performative) if unknown else BdiError(sentence)
