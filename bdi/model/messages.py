"""Messages between agents, and reports that an action has ended."""

from copy import copy
from dataclasses import dataclass
from typing import NamedTuple

from bdi.language.terms import Handle, List, Structure, Term
from bdi.language.unify import renamed, resolve

EVERYBODY = "*"  # the receiver of a broadcast
WAITED_FOR = "?"  # ends the ids of questions whose answer an intention waits for


@dataclass(frozen=True, slots=True)
class Message:
    """`performative` is one of tell, untell, achieve, unachieve, askOne, askAll, askHow, tellHow, untellHow, signal,
    sorry (no answer will come), or one for which the receiver has plans `+!kqml_received(…)` of its own.

    `content` is a term, or text that is parsed. `receiver` is filled in messages that go out; `id` and `reply_to`
    join a question and its answer.
    """

    sender: str
    performative: str
    content: Term | str
    receiver: str = ""
    id: str = ""
    reply_to: str = ""


class Finished(NamedTuple):
    """Action `id` is over. Without a `failure` it is done; otherwise `failure` is the reason that plans can match
    (a term, or its text), and `message` a sentence for people."""

    id: int
    failure: Term | str | None = None
    message: str = ""


def own_copy(content: Term | str) -> Term | str:
    """The content as its receiver's own: it shares no variables, maps, sets or queues with the sender."""
    return content if type(content) is str else renamed(_unshared(resolve(content)), {})  # type: ignore[arg-type]


def _unshared(term: Term) -> Term:
    if type(term) is Handle:
        return Handle(copy(term.value))
    if type(term) is List:
        return List(map(_unshared, term))
    if type(term) is Structure:
        return Structure(term.predicate, tuple(map(_unshared, term.args)), tuple(map(_unshared, term.annots)))
    return term
