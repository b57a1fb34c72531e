"""Messages and the agent's own name: `.send`, `.broadcast`, `.my_name`, …"""

from dataclasses import replace

from bdi.builtin.arguments import running_intention, text_of
from bdi.builtin.kinds import ANY, ATOM, OUT, TIME_SPAN, optional, rest
from bdi.builtin.table import Answer, internal_action, wrong_arguments
from bdi.language.terms import Atom, List, String, Term, Var, atom, show
from bdi.language.unify import unify
from bdi.model.intentions import StepFailed
from bdi.model.messages import EVERYBODY, WAITED_FOR, Message, own_copy
from bdi.model.mind import Mind

QUESTIONS = frozenset({"askOne", "askAll", "askHow"})


@internal_action("my_name", OUT)
def my_name(mind: Mind, name: Term) -> Answer:
    return unify(name, atom(mind.name), mind.logic.trail)


@internal_action("true")
def always(mind: Mind) -> Answer:
    return True


@internal_action("fail", rest(ANY))
def fail(mind: Mind, *annots: Term) -> Answer:
    raise StepFailed("internal_action", f".fail({','.join(map(show, annots))})", annots)


@internal_action("send", ANY, ATOM, ANY, optional(ANY), optional(TIME_SPAN))
def send(
    mind: Mind,
    receiver: Term,
    performative: Atom,
    content: Term,
    answer: Term | None = None,
    longest_ms: float | None = None,
) -> Answer:
    """.send(TO, PERFORMATIVE, CONTENT)   .send(TO, ASK, CONTENT, ANSWER, MS)   .send(TO, TELL, CONTENT, QUESTION_ID)

    With an ANSWER the intention waits for it, MS milliseconds at most; of several receivers the first one counts.
    """
    receivers = [_receiver(each) for each in (receiver if isinstance(receiver, List) else (receiver,))]
    kind = text_of(performative)
    if answer is None or kind not in QUESTIONS:
        reply_to = "" if answer is None else _question_id(answer)
        for each in receivers:
            _post(mind, Message(mind.name, kind, content, each, mind.output.new_message_id(), reply_to))
        return True
    intention = running_intention(mind, "send")
    question = f"{mind.output.new_message_id()}{WAITED_FOR}"
    for each in receivers:
        _post(mind, Message(mind.name, kind, content, each, question))
    deadline_s = None if longest_ms is None else mind.now + longest_ms / 1000
    mind.message_handling.wait_for_answer(intention, question, answer, deadline_s, receivers)
    return True


@internal_action("broadcast", ATOM, ANY)
def broadcast(mind: Mind, performative: Atom, content: Term) -> Answer:
    _post(mind, Message(mind.name, text_of(performative), content, EVERYBODY, mind.output.new_message_id()))
    return True


def _post(mind: Mind, message: Message) -> None:
    if isinstance(message.content, Var):
        raise wrong_arguments("send", "something to say", message.content)
    mind.message_handling.send_checked(replace(message, content=own_copy(message.content)))


def _receiver(term: Term) -> str:
    if isinstance(term, Atom | String):
        return text_of(term)
    raise wrong_arguments("send", "the name of an agent, or a list of them", term)


def _question_id(term: Term) -> str:
    """Return the id of the question that a message answers; it comes with +!kqml_received(_, _, _, ID)."""
    if isinstance(term, Atom | String):
        return text_of(term)
    raise wrong_arguments("send", "the id of the question that it answers, for what is no question", term)
