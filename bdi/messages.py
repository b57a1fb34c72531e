"""What comes in and goes out besides percepts: messages between agents, and the news that an action is over."""

from dataclasses import dataclass

from bdi.terms import Term


@dataclass(frozen=True, slots=True)
class Message:
    """`performative` is one of tell, untell, achieve, unachieve, askOne, askAll, askHow, tellHow, untellHow, signal.

    `content` is a term, or text that is parsed. `receiver` is filled in messages that go out; `id` and `reply_to`
    join a question and its answer.
    """

    sender: str
    performative: str
    content: Term | str
    receiver: str = ""
    id: str = ""
    reply_to: str = ""


@dataclass(frozen=True, slots=True)
class Finished:
    """Action `id` is over. Without a `failure` it is done; otherwise `failure` is the reason that plans can match
    (a term, or its text), and `message` a sentence for people."""

    id: int
    failure: Term | str | None = None
    message: str = ""
