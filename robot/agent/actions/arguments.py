"""The arguments of actions, declared once and checked before anything moves."""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

from maps import CampusMap

Value = str | float


class Kind(StrEnum):
    """The kinds of argument."""

    WORD = "word"
    """One of a few atoms."""
    NAME = "name"
    """An atom or a string."""
    POST = "post"
    """A post of the map."""
    NUMBER = "number"
    TERM = "term"
    """Anything, as it is written."""


class WrongArguments(ValueError):
    """An action cannot be begun with these arguments. `reason` is the atom that the plan gets to see."""

    def __init__(self, reason: str, sentence: str) -> None:
        self.reason = reason
        super().__init__(sentence)


@dataclass(frozen=True)
class Argument:
    """One argument: its name, its kind, and the words it may be."""

    name: str
    kind: Kind
    words: tuple[str, ...] = ()

    def __str__(self) -> str:
        return "|".join(self.words) or self.name


def word(name: str, *words: str) -> Argument:
    return Argument(name, Kind.WORD, words)


def checked(name: str, declared: Sequence[Argument], given: Sequence[object], campus: CampusMap) -> tuple[Value, ...]:
    """The arguments as Python values. Raises WrongArguments, which names the action, the argument and what fits."""
    if len(given) != len(declared):
        form = f"{name}({','.join(map(str, declared))})"
        raise WrongArguments("wrong_arguments", f"{form} takes {len(declared)} arguments, not {len(given)}")
    return tuple(_value(name, argument, term, campus) for argument, term in zip(declared, given, strict=True))


def _value(name: str, argument: Argument, term: object, campus: CampusMap) -> Value:
    if argument.kind is Kind.NUMBER:
        if isinstance(term, int | float):
            return term
        raise WrongArguments("wrong_arguments", f"{name}: {argument.name} is a number, not {term}")
    text = text_of(term)
    if text is None and argument.kind is Kind.TERM:
        return str(term)
    if text is None:
        raise WrongArguments("wrong_arguments", f"{name}: {argument.name} is a name, not {term}")
    if argument.words and text not in argument.words:
        raise WrongArguments("wrong_arguments", f"{name}: {argument.name} is one of {argument}, not {text}")
    if argument.kind is Kind.POST and text not in campus.posts:
        raise WrongArguments("unknown_post", f"{name}: there is no post {text} on the map {campus.name}")
    return text


def text_of(term: object) -> str | None:
    """The text of an atom or a string; None for anything else."""
    if isinstance(term, str):
        return str.__str__(term)
    functor = getattr(term, "functor", None)
    return functor if isinstance(functor, str) and not getattr(term, "args", ()) else None
