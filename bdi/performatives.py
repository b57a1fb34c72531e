"""What a message of another agent does, by its performative."""

from collections.abc import Callable
from typing import Any, TypeAlias

from bdi.beliefs import SOURCE
from bdi.builtin_actions import drop_desire, event_named, plan_of
from bdi.messages import Message
from bdi.syntax import Trigger
from bdi.terms import List, Literal, String, Structure, Term, atom, show

Mind: TypeAlias = Any  # the Agent; it stands above this module, which therefore cannot name it


def sourced(literal: Literal, source: Term) -> Literal:
    """The literal with this source, unless it names one itself."""
    if any(type(annot) is Structure and annot.predicate is SOURCE for annot in literal.annots):
        return literal
    return Structure(literal.predicate, literal.args, (*literal.annots, source))


def _from_sender(mind: Mind, message: Message) -> Literal:
    return sourced(mind.literal_in(message), Structure(SOURCE, (atom(message.sender),)))


def _tell(mind: Mind, message: Message) -> None:
    mind.believe(_from_sender(mind, message), None)


def _untell(mind: Mind, message: Message) -> None:
    mind.forget(_from_sender(mind, message), None)


def _achieve(mind: Mind, message: Message) -> None:
    mind.achieve_apart(_from_sender(mind, message))


def _unachieve(mind: Mind, message: Message) -> None:
    drop_desire(mind, mind.literal_in(message))


def _signal(mind: Mind, message: Message) -> None:
    literal = _from_sender(mind, message)
    mind.notice(Trigger.BELIEF_ADDED, literal)


def _ask_one(mind: Mind, message: Message) -> None:
    answers = _answers(mind, mind.literal_in(message))
    _answer(mind, message, answers[0] if answers else atom("false"))


def _ask_all(mind: Mind, message: Message) -> None:
    _answer(mind, message, List(_answers(mind, mind.literal_in(message))))


def _answers(mind: Mind, literal: Literal) -> list[Term]:
    return mind.logic.instances(literal)  # type: ignore[no-any-return]


def _answer(mind: Mind, message: Message, content: Term) -> None:
    mind.send(Message(mind.name, "tell", content, message.sender, mind.new_message_id(), reply_to=message.id))


def _ask_how(mind: Mind, message: Message) -> None:
    """The content is an event as text, "+!g"; the answer a list of plans as texts."""
    text = _text(message)
    trigger, wanted = event_named(String(text))
    plans = mind.library.options(trigger, wanted.predicate)
    _answer(mind, message, List([String(str(each.plan)) for each in plans]))


def _tell_how(mind: Mind, message: Message) -> None:
    mind.add_plan(plan_of(String(_text(message))))


def _untell_how(mind: Mind, message: Message) -> None:
    mind.remove_plan(_text(message))


def _text(message: Message) -> str:
    content = message.content
    return str.__str__(content) if isinstance(content, str) else show(content)


PERFORMATIVES: dict[str, Callable[[Mind, Message], None]] = {
    "tell": _tell,
    "untell": _untell,
    "achieve": _achieve,
    "unachieve": _unachieve,
    "askOne": _ask_one,
    "askAll": _ask_all,
    "askHow": _ask_how,
    "tellHow": _tell_how,
    "untellHow": _untell_how,
    "signal": _signal,
}
