"""Performatives: how the content of a message is read on arrival, and what obeying it does."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

from bdi.builtin.agent_state.goals import drop_desire
from bdi.builtin.agent_state.plans import add_plan, concerns, remove_plan
from bdi.builtin.arguments import text_of
from bdi.builtin.code import event_in, plan_in
from bdi.builtin.table import wrong_arguments
from bdi.language.parser import literal_from, parse_event, parse_plan, parse_term
from bdi.language.syntax import Plan, Trigger
from bdi.language.terms import Code, List, Literal, OpenList, String, Structure, Term, Var, atom, literal_of, predicate
from bdi.language.unify import undo
from bdi.model.beliefs import SELF, SOURCE
from bdi.model.intentions import NOT_WORKED_OUT
from bdi.model.messages import Message
from bdi.model.mind import Mind

PLAN_SIGNS = ("@", "+", "-", "^")  # what a plan begins with, and no label
OWN_NAMES = "p__"  # of plans that are written without one
NO_NAME = predicate("")
KNOW_HOW = frozenset({"askHow", "tellHow", "untellHow"})  # their contents are plans and events


class Performative(NamedTuple):
    """`read` turns the content into what `obey` takes, and raises BdiError for content that is none."""

    read: Callable[[Mind, Term | str], Any]
    obey: Callable[[Mind, Message, Any], None]


# ---- sources -------------------------------------------------------------------------------------------------------


def sourced(literal: Literal, source: Term) -> Literal:
    """The literal with this source, unless it names one itself."""
    if any(map(_is_source, literal.annots)):
        return literal
    return Structure(literal.predicate, literal.args, (*literal.annots, source))


def with_nested_source(literal: Literal, sender: Term) -> Literal:
    """Said by `sender`, who has it from others: `p[source(ann)]` from bob is `p[source(bob)[source(ann)]]`."""
    before = tuple(filter(_is_source, literal.annots))
    others = tuple(annot for annot in literal.annots if annot not in before)
    return Structure(literal.predicate, literal.args, (*others, Structure(SOURCE, (sender,), before)))


def _is_source(annot: Term) -> bool:
    return type(annot) is Structure and annot.predicate is SOURCE


def _from_sender(message: Message, literal: Literal) -> Literal:
    return with_nested_source(literal, atom(message.sender))


# ---- reading -------------------------------------------------------------------------------------------------------


def _literal(mind: Mind, content: Term | str) -> Literal:
    return mind.message_handling.literal_of(content)


def _literals(mind: Mind, content: Term | str) -> Sequence[Literal]:
    """p(1)   [p(1),p(2)]"""
    if type(content) is str and not content.lstrip().startswith("["):
        return (mind.message_handling.literal_of(content),)
    return [literal_from(each) for each in _items(content)]


def _items(content: Term | str) -> Sequence[Term]:
    """The items of a list, or the content alone. Text stays text, but for lists and values in braces."""
    if type(content) is str:
        content = parse_term(content) if content.lstrip().startswith(("[", "{")) else String(content)
    return tuple(content) if isinstance(content, List) else (content,)  # type: ignore[return-value]


def _event(mind: Mind, content: Term | str) -> tuple[Trigger, Literal]:
    """ "+!g(X)"   {+!g(X)}"""
    item = _items(content)[0]
    event = parse_event(text_of(item)) if isinstance(item, String) else event_in(item)
    if event is None:
        raise wrong_arguments("send", "an event, as {+!g(_)}", item)
    return event


def _plans(mind: Mind, content: Term | str) -> List:
    """ "+!g <- a."   { +!g <- a }   a list of them"""
    items = List(_items(content))
    for item in items:
        _plan(item)
    return items


def _plan(item: Term) -> Plan:
    return parse_plan(text_of(item)) if isinstance(item, String) else plan_in(item, "send")


def _plans_or_labels(mind: Mind, content: Term | str) -> Sequence[str | Plan]:
    """a   "a"   "+!g <- b."   { +!g <- b }   a list of them"""
    return [_plan_or_label(item) for item in _items(content)]


def _plan_or_label(item: Term) -> str | Plan:
    if isinstance(item, Code) or (isinstance(item, String) and item.startswith(PLAN_SIGNS)):
        return _plan(item)
    return text_of(item)


# ---- obeying -------------------------------------------------------------------------------------------------------


def _tell(mind: Mind, message: Message, literals: Sequence[Literal]) -> None:
    for literal in literals:
        mind.actions.believe(_from_sender(message, literal), None)


def _untell(mind: Mind, message: Message, literals: Sequence[Literal]) -> None:
    for literal in literals:
        mind.actions.forget(_from_sender(message, literal), None)


def _achieve(mind: Mind, message: Message, goals: Sequence[Literal]) -> None:
    for goal in goals:
        mind.actions.achieve_apart(_from_sender(message, goal))


def _unachieve(mind: Mind, message: Message, goal: Literal) -> None:
    """Drop the goal, whatever its source: a goal that its own plan pursues again has lost its sender."""
    drop_desire(mind, goal)


def _signal(mind: Mind, message: Message, literal: Literal) -> None:
    mind.event_queue.notice(Trigger.BELIEF_ADDED, _from_sender(message, literal))


def _ask_one(mind: Mind, message: Message, literal: Literal) -> None:
    """The first belief, else what a plan `+?literal` finds out; `untell` where there is neither."""
    answers = _answers(mind, literal)
    if answers:
        _answer(mind, message, "tell", answers[0])
    elif not mind.message_handling.answer_by_plan(message, literal):
        _answer(mind, message, "untell", literal)


def _ask_all(mind: Mind, message: Message, literal: Literal) -> None:
    _answer(mind, message, "tell", List(_answers(mind, literal)))


def _answers(mind: Mind, literal: Literal) -> list[Term]:
    """Return the beliefs with their annotations, without `source(self)`."""
    wanted = literal if literal.annots else Structure(literal.predicate, literal.args, (OpenList((), Var("Annots")),))
    try:
        return [_without_self(each) for each in mind.logic.instances(wanted)]
    except NOT_WORKED_OUT:
        undo(mind.logic.trail, 0)
        return []  # as in a context: what cannot be worked out does not hold


def _without_self(answer: Term) -> Term:
    if not isinstance(answer, Structure):
        return answer
    return literal_of(
        answer.predicate,
        answer.args,
        tuple(each for each in answer.annots if each != SELF and type(each) is not OpenList),
    )


def _ask_how(mind: Mind, message: Message, event: tuple[Trigger, Literal]) -> None:
    """The answer is a list of plans as values."""
    plans = [each.plan for each in mind.library.plans if concerns(mind, each.plan, *event)]
    _answer(mind, message, "tellHow", List([Code(_for_sending(plan)) for plan in plans]))


def _for_sending(plan: Plan) -> Plan:
    """A name that the agent gave itself (p__1) may be that of another plan elsewhere."""
    label = plan.label
    return replace(plan, label=literal_of(NO_NAME, (), label.annots)) if label.functor.startswith(OWN_NAMES) else plan


def _answer(mind: Mind, message: Message, performative: str, content: Term) -> None:
    mind.message_handling.send(
        Message(mind.name, performative, content, message.sender, mind.output.new_message_id(), reply_to=message.id)
    )


def _tell_how(mind: Mind, message: Message, plans: List) -> None:
    add_plan(mind, plans, atom(message.sender))


def _untell_how(mind: Mind, message: Message, known: Sequence[str | Plan]) -> None:
    """Remove plans, but only those that came from the sender."""
    for each in known:
        label = each if isinstance(each, str) else each.label.functor or _label_of(mind, each)
        remove_plan(mind, atom(label), atom(message.sender))


def _label_of(mind: Mind, plan: Plan) -> str:
    """The name of the first plan that is written like this one."""
    return next((each.label for each in mind.library.plans if _unnamed(each.plan) == _unnamed(plan)), "")


def _unnamed(plan: Plan) -> str:
    return str(replace(plan, label=atom("")))


PERFORMATIVES: dict[str, Performative] = {
    "tell": Performative(_literals, _tell),
    "untell": Performative(_literals, _untell),
    "achieve": Performative(_literals, _achieve),
    "unachieve": Performative(_literal, _unachieve),
    "askOne": Performative(_literal, _ask_one),
    "askAll": Performative(_literal, _ask_all),
    "askHow": Performative(_event, _ask_how),
    "tellHow": Performative(_plans, _tell_how),
    "untellHow": Performative(_plans_or_labels, _untell_how),
    "signal": Performative(_literal, _signal),
}
