"""What a message of another agent does, by its performative: first it is read, at the door, later obeyed."""

from collections.abc import Callable
from typing import Any, NamedTuple

from bdi.beliefs import SOURCE
from bdi.builtin.goals import drop_desire
from bdi.intentions import NOT_WORKED_OUT
from bdi.messages import Message
from bdi.mind import Mind
from bdi.parser import parse_event, parse_plan
from bdi.syntax import Plan, Trigger
from bdi.terms import List, Literal, String, Structure, Term, atom, show
from bdi.unify import undo


class Performative(NamedTuple):
    """`read` turns the content into what `obey` takes, and raises BdiError for content that is none."""

    read: Callable[[Mind, Term | str], Any]
    obey: Callable[[Mind, Message, Any], None]


def sourced(literal: Literal, source: Term) -> Literal:
    """The literal with this source, unless it names one itself."""
    if any(type(annot) is Structure and annot.predicate is SOURCE for annot in literal.annots):
        return literal
    return Structure(literal.predicate, literal.args, (*literal.annots, source))


# ---- reading -------------------------------------------------------------------------------------------------------


def _literal(mind: Mind, content: Term | str) -> Literal:
    return mind.literal_of(content)


def _event(mind: Mind, content: Term | str) -> tuple[Trigger, Literal]:
    return parse_event(_text(mind, content))


def _plan(mind: Mind, content: Term | str) -> Plan:
    return parse_plan(_text(mind, content))


def _text(mind: Mind, content: Term | str) -> str:
    return str.__str__(content) if isinstance(content, str) else show(content)


# ---- obeying -------------------------------------------------------------------------------------------------------


def _from_sender(message: Message, literal: Literal) -> Literal:
    return sourced(literal, Structure(SOURCE, (atom(message.sender),)))


def _tell(mind: Mind, message: Message, literal: Literal) -> None:
    mind.believe(_from_sender(message, literal), None)


def _untell(mind: Mind, message: Message, literal: Literal) -> None:
    mind.forget(_from_sender(message, literal), None)


def _achieve(mind: Mind, message: Message, goal: Literal) -> None:
    mind.achieve_apart(_from_sender(message, goal))


def _unachieve(mind: Mind, message: Message, goal: Literal) -> None:
    drop_desire(mind, goal)


def _signal(mind: Mind, message: Message, literal: Literal) -> None:
    mind.notice(Trigger.BELIEF_ADDED, _from_sender(message, literal))


def _ask_one(mind: Mind, message: Message, literal: Literal) -> None:
    answers = _answers(mind, literal)
    _answer(mind, message, answers[0] if answers else atom("false"))


def _ask_all(mind: Mind, message: Message, literal: Literal) -> None:
    _answer(mind, message, List(_answers(mind, literal)))


def _answers(mind: Mind, literal: Literal) -> list[Term]:
    try:
        return mind.logic.instances(literal)
    except NOT_WORKED_OUT:
        undo(mind.logic.trail, 0)
        return []  # as in a context: what cannot be worked out does not hold


def _answer(mind: Mind, message: Message, content: Term) -> None:
    mind.send(Message(mind.name, "tell", content, message.sender, mind.new_message_id(), reply_to=message.id))


def _ask_how(mind: Mind, message: Message, event: tuple[Trigger, Literal]) -> None:
    """The answer is a list of plans as texts."""
    trigger, wanted = event
    plans = mind.library.options(trigger, wanted.predicate)
    _answer(mind, message, List([String(str(each.plan)) for each in plans]))


def _tell_how(mind: Mind, message: Message, plan: Plan) -> None:
    mind.add_plan(plan)


def _untell_how(mind: Mind, message: Message, label: str) -> None:
    mind.remove_plan(label)


PERFORMATIVES: dict[str, Performative] = {
    "tell": Performative(_literal, _tell),
    "untell": Performative(_literal, _untell),
    "achieve": Performative(_literal, _achieve),
    "unachieve": Performative(_literal, _unachieve),
    "askOne": Performative(_literal, _ask_one),
    "askAll": Performative(_literal, _ask_all),
    "askHow": Performative(_event, _ask_how),
    "tellHow": Performative(_plan, _tell_how),
    "untellHow": Performative(_text, _untell_how),
    "signal": Performative(_literal, _signal),
}
