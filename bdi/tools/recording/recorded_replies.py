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


def listening(society: Society, heard: list[Any]) -> Society:
    """Return the same society; its replies are recorded in `heard`."""
    return cast(Society, _Listening(society, heard))


def remembered(answers: Iterable[Sequence[Any]]) -> Society:
    """A society that answers so, one after another; what was never asked then is answered as to an agent alone."""
    return cast(Society, _Remembered(answers))


class _Listening:
    def __init__(self, society: Society, heard: list[Any]) -> None:
        self._society = society
        self._heard = heard

    def readers(self, receiver: str, sender: str) -> Sequence[Reader]:
        found = self._listened("readers", receiver, sender)
        self._heard[-1][1] = len(found)
        return [_ListeningReader(reader, self._heard) for reader in found]

    def __getattr__(self, what: str) -> Callable[..., Any]:
        return lambda *asked: self._listened(what, *asked)

    def _listened(self, what: str, *asked: Any) -> Any:
        try:
            answer = getattr(self._society, what)(*asked)
        except StepFailed as failure:
            self._heard.append([what, None, failure.error, failure.message, list(map(show, failure.annots))])
            raise
        self._heard.append([what, answer])
        return answer


class _ListeningReader:
    def __init__(self, reader: Reader, heard: list[Any]) -> None:
        self._reader = reader
        self._heard = heard

    def read(self, message: Message) -> Any:
        try:
            found = self._reader.read(message)
        except BdiError as problem:
            self._heard.append([READ, None, type(problem).__name__, str(problem), []])
            raise
        self._heard.append([READ, None])
        return found


class _Remembered:
    def __init__(self, answers: Iterable[Sequence[Any]]) -> None:
        self._answers = deque(answers)

    def readers(self, receiver: str, sender: str) -> Sequence[Reader]:
        if not self._answers:
            return ALONE.readers(receiver, sender)
        found: int = self._answered("readers", receiver, sender)
        return [_RememberedReader(self._answers)] * found

    def __getattr__(self, what: str) -> Callable[..., Any]:
        return lambda *asked: self._answered(what, *asked)

    def _answered(self, what: str, *asked: Any) -> Any:
        if not self._answers:
            return getattr(ALONE, what)(*asked)
        then, answer, *failure = self._answers.popleft()
        if then != what:
            raise StepFailed("not_recorded", f"the society was asked for {then} when this was recorded, not for {what}")
        if failure:
            error, message, annots = failure
            raise StepFailed(error, message, tuple(map(parse_term, annots)))
        return answer


class _RememberedReader:
    def __init__(self, answers: deque[Sequence[Any]]) -> None:
        self._answers = answers

    def read(self, message: Message) -> None:
        then, _, *failure = self._answers.popleft() if self._answers else (READ, None)
        if then == READ and failure:
            kind, sentence, _ = failure
            unknown = kind == UnknownPerformative.__name__
            raise UnknownPerformative(message.performative) if unknown else BdiError(sentence)
