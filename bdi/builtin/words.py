"""What the agent says and sends, what it is called: `.print`, `.send`, `.my_name`, …"""

from bdi.builtin.arguments import items_of, running_intention, text_of
from bdi.builtin.table import Answer, internal_action
from bdi.intentions import StepFailed
from bdi.messages import Message
from bdi.mind import Mind
from bdi.terms import List, Term, atom, show
from bdi.unify import unify
from bdi.waiting import moment_of


def _line(args: tuple[Term, ...]) -> str:
    return "".join(map(text_of, args))


@internal_action("print", 0, None)
def print_line(mind: Mind, *args: Term) -> Answer:
    mind.say(_line(args))
    return True


@internal_action("log", 1, None)
def log(mind: Mind, level: Term, *args: Term) -> Answer:
    mind.say(f"[{text_of(level)}] {_line(args)}")
    return True


for _name in ("println", "puts", "printf"):
    internal_action(_name, 0, None)(print_line)


@internal_action("my_name", 1)
def my_name(mind: Mind, name: Term) -> Answer:
    return unify(name, atom(mind.name), mind.logic.trail)


@internal_action("true", 0)
def always(mind: Mind) -> Answer:
    return True


@internal_action("fail", 0, None)
def fail(mind: Mind, *annots: Term) -> Answer:
    raise StepFailed("internal_action", f".fail({','.join(map(show, annots))})", annots)


@internal_action("send", 3, 5)
def send(mind: Mind, receiver: Term, performative: Term, content: Term, *answer: Term) -> Answer:
    """.send(TO, PERFORMATIVE, CONTENT, ANSWER, MS): with an answer the intention waits for it, MS at most."""
    receivers = items_of(receiver, "send") if isinstance(receiver, List) else (receiver,)
    for each in receivers:
        message_id = mind.new_message_id()
        mind.send(Message(mind.name, text_of(performative), content, text_of(each), message_id))
        if answer:
            deadline_s = moment_of(mind.now, answer[1]) if len(answer) > 1 else None
            mind.wait_for_answer(running_intention(mind, "send"), message_id, answer[0], deadline_s)
    return True


@internal_action("broadcast", 2)
def broadcast(mind: Mind, performative: Term, content: Term) -> Answer:
    mind.send(Message(mind.name, text_of(performative), content, "*", mind.new_message_id()))
    return True
