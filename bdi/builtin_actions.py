"""Internal actions about the agent itself: its intentions, goals, beliefs, plans, messages and time."""

from collections.abc import Callable, Iterator
from heapq import heappush

from bdi.builtin import Answer, internal_action, wrong_arguments
from bdi.builtin_values import items_of, text_of
from bdi.errors import AgentSpeakSyntaxError
from bdi.intentions import Intention, Means, State, StepFailed
from bdi.logic import Question
from bdi.messages import Message
from bdi.mind import Mind
from bdi.parser import parse_event, parse_plan
from bdi.syntax import Plan, Trigger
from bdi.terms import Atom, Code, List, Literal, String, Structure, Term, atom, show, structure
from bdi.unify import undo, unify
from bdi.waiting import event_waiter, formula_waiter, moment_of

# ---- words ---------------------------------------------------------------------------------------------------------


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


# ---- messages ------------------------------------------------------------------------------------------------------


@internal_action("send", 3, 5)
def send(mind: Mind, receiver: Term, performative: Term, content: Term, *answer: Term) -> Answer:
    """.send(TO, PERFORMATIVE, CONTENT, ANSWER, MS): with an answer the intention waits for it, MS at most."""
    receivers = items_of(receiver, "send") if isinstance(receiver, List) else (receiver,)
    for each in receivers:
        message_id = mind.new_message_id()
        mind.send(Message(mind.name, text_of(performative), content, text_of(each), message_id))
        if answer:
            deadline_s = moment_of(mind.now, answer[1]) if len(answer) > 1 else None
            mind.wait_for_answer(_running(mind, "send"), message_id, answer[0], deadline_s)
    return True


@internal_action("broadcast", 2)
def broadcast(mind: Mind, performative: Term, content: Term) -> Answer:
    mind.send(Message(mind.name, text_of(performative), content, "*", mind.new_message_id()))
    return True


# ---- intentions and goals ------------------------------------------------------------------------------------------


def _unifies(mind: Mind, pattern: Term, literal: Literal) -> bool:
    mark = len(mind.logic.trail)
    found = unify(pattern, literal, mind.logic.trail)
    undo(mind.logic.trail, mark)
    return found


def _pursues(mind: Mind, goal: Term) -> Callable[[Means], bool]:
    """Whether means are for this goal."""
    return lambda means: (
        means.event.trigger in (Trigger.GOAL_ADDED, Trigger.GOAL_FAILED) and _unifies(mind, goal, means.event.literal)
    )


def _running(mind: Mind, name: str) -> Intention:
    """The intention whose step this is. In a condition there is none."""
    intention: Intention | None = mind.current
    if intention is None:
        raise StepFailed("wrong_arguments", f".{name} belongs in the body of a plan, not in a condition")
    return intention


def _intentions_for(mind: Mind, goal: Term) -> list[Intention]:
    pursues = _pursues(mind, goal)
    return [each for each in list(mind.intentions.values()) if any(map(pursues, each.stack))]


def _drop_desire(mind: Mind, goal: Term) -> None:
    """Events `+!goal` that no intention waits for, and the intentions that wait for one."""
    for event in list(mind.events):
        if event.trigger is Trigger.GOAL_ADDED and event in mind.events and _unifies(mind, goal, event.literal):
            mind.events.remove(event)
            if event.intention is not None:
                mind.drop(event.intention)


@internal_action("drop_all_intentions", 0)
def drop_all_intentions(mind: Mind) -> Answer:
    """All but the one that says so; events of the world stay."""
    for intention in list(mind.intentions.values()):
        if intention is not mind.current:
            mind.drop(intention)
    return True


@internal_action("drop_all_desires", 0)
def drop_all_desires(mind: Mind) -> Answer:
    drop_all_intentions(mind)
    return drop_all_events(mind)


@internal_action("drop_all_events", 0)
def drop_all_events(mind: Mind) -> Answer:
    for intention in [event.intention for event in mind.events if event.intention is not None]:
        if intention is not mind.current:
            mind.drop(intention)
    mind.events.clear()
    return True


@internal_action("drop_intention", 0, 1)
def drop_intention(mind: Mind, goal: Term | None = None) -> Answer:
    for intention in [_running(mind, "drop_intention")] if goal is None else _intentions_for(mind, goal):
        mind.drop(intention)
    return True


@internal_action("drop_desire", 1)
def drop_desire(mind: Mind, goal: Term) -> Answer:
    _drop_desire(mind, goal)
    return drop_intention(mind, goal)


@internal_action("drop_event", 1)
def drop_event(mind: Mind, goal: Term) -> Answer:
    _drop_desire(mind, goal)
    return True


@internal_action("intend", 1)
def intend(mind: Mind, goal: Term) -> Answer:
    return _goals_that_unify(mind, goal, _intended(mind))


@internal_action("desire", 1)
def desire(mind: Mind, goal: Term) -> Answer:
    waiting = [event.literal for event in mind.events if event.trigger is Trigger.GOAL_ADDED]
    return _goals_that_unify(mind, goal, waiting + _intended(mind))


def _intended(mind: Mind) -> list[Literal]:
    return [
        means.event.literal
        for intention in mind.intentions.values()
        for means in intention.stack
        if means.event.trigger is Trigger.GOAL_ADDED
    ]


def _goals_that_unify(mind: Mind, goal: Term, goals: list[Literal]) -> Iterator[bool]:
    for literal in goals:
        mark = len(mind.logic.trail)
        if unify(goal, literal, mind.logic.trail):
            yield True
        undo(mind.logic.trail, mark)


@internal_action("suspend", 0, 1)
def suspend(mind: Mind, goal: Term | None = None) -> Answer:
    for intention in [_running(mind, "suspend")] if goal is None else _intentions_for(mind, goal):
        mind.hold(intention)
    return True


@internal_action("resume", 1)
def resume(mind: Mind, goal: Term) -> Answer:
    for intention in _intentions_for(mind, goal):
        mind.release(intention)
    return True


@internal_action("suspended", 2)
def suspended(mind: Mind, goal: Term, reason: Term) -> Answer:
    held = [intention for intention in _intentions_for(mind, goal) if intention.held]
    return bool(held) and unify(reason, String("suspended"), mind.logic.trail)


@internal_action("current_intention", 1)
def current_intention(mind: Mind, result: Term) -> Answer:
    intention = mind.current
    if intention is None:
        return False
    plans = List([_described(means) for means in reversed(intention.stack)])
    return unify(result, structure("intention", intention.number, plans), mind.logic.trail)


def _described(means: Means) -> Term:
    return structure("im", atom(means.plan.label), String(str(means.event)))


@internal_action("succeed_goal", 1)
def succeed_goal(mind: Mind, goal: Term) -> Answer:
    for intention in _intentions_for(mind, goal):
        mind.reach_goal(intention, _pursues(mind, goal))
    return True


@internal_action("done", 1)
def done(mind: Mind, goal: Term) -> Answer:
    return succeed_goal(mind, goal)


@internal_action("fail_goal", 1, None)
def fail_goal(mind: Mind, goal: Term, *annots: Term) -> Answer:
    for intention in _intentions_for(mind, goal):
        mind.give_up_goal(intention, _pursues(mind, goal), annots)
    return True


# ---- time ----------------------------------------------------------------------------------------------------------


@internal_action("wait", 1, 3, lazy=(0,))
def wait(mind: Mind, what: Question, timeout: Term | None = None, elapsed: Term | None = None) -> Answer:
    """.wait(MS)   .wait("+event", MS)   .wait(formula, MS): with a third argument a time-out is no failure."""
    condition = what.term()
    intention = _running(mind, "wait")
    if isinstance(condition, int | float):
        moment = mind.now + condition / 1000
        intention.waits_for = moment
        intention.state = State.TIME
        heappush(mind.timers, (moment, intention.number, intention))
        return True
    deadline_s = None if timeout is None else moment_of(mind.now, timeout)
    trigger = _trigger_in(condition)
    if trigger is None and what.first():
        return True
    waiter = event_waiter(intention, *trigger, deadline_s) if trigger else formula_waiter(intention, what, deadline_s)
    waiter.quiet = elapsed is not None
    intention.state = State.TIME
    intention.waits_for = waiter
    mind.waiters.append(waiter)
    return True


def _trigger_in(condition: Term) -> tuple[Trigger, Literal] | None:
    """ "+b(X)" or {+b(X)}; None for anything else."""
    if isinstance(condition, String):
        return event_named(condition)
    if isinstance(condition, Code) and len(condition.body.steps) == 1:
        return event_named(String(str(condition.body)))
    return None


def event_named(text: String) -> tuple[Trigger, Literal]:
    """ "+!g(X)" """
    try:
        return parse_event(str.__str__(text))
    except AgentSpeakSyntaxError as error:
        raise wrong_arguments("wait", "an event with a name", text) from error


@internal_action("time", 3)
def clock(mind: Mind, hours: Term, minutes: Term, seconds: Term) -> Answer:
    """Hours, minutes and seconds of the clock that the agent is given, which need not be the time of day."""
    whole = int(mind.now)
    parts = (whole // 3600, whole // 60 % 60, whole % 60)
    return all(unify(a, b, mind.logic.trail) for a, b in zip((hours, minutes, seconds), parts, strict=True))


# ---- chance --------------------------------------------------------------------------------------------------------


@internal_action("random", 1, 2)
def random(mind: Mind, *args: Term) -> Answer:
    """.random(X): from 0 to 1. .random(LIST, X): one of them."""
    if len(args) == 1:
        return unify(args[0], mind.random.random(), mind.logic.trail)
    items = items_of(args[0], "random")
    return bool(items) and unify(args[1], mind.random.choice(items), mind.logic.trail)


@internal_action("set_random_seed", 1)
def set_random_seed(mind: Mind, seed: Term) -> Answer:
    mind.random.seed(show(seed))
    return True


@internal_action("shuffle", 2)
def shuffle(mind: Mind, items: Term, result: Term) -> Answer:
    mixed = list(items_of(items, "shuffle"))
    mind.random.shuffle(mixed)
    return unify(result, List(mixed), mind.logic.trail)


# ---- beliefs -------------------------------------------------------------------------------------------------------


@internal_action("abolish", 1)
def abolish(mind: Mind, pattern: Term) -> Answer:
    """Forget every belief that unifies, whoever said it."""
    if not isinstance(pattern, Atom | Structure):
        raise wrong_arguments("abolish", "a literal", pattern)
    mind.forget_all(pattern)
    return True


@internal_action("belief", 1)
def belief(mind: Mind, pattern: Term) -> Answer:
    """A belief that is a fact, not derived by a rule."""
    if not isinstance(pattern, Atom | Structure):
        raise wrong_arguments("belief", "a literal", pattern)
    relation = mind.beliefs.relation(pattern.predicate)
    return relation.find(pattern.args, pattern.annots, mind.logic.trail) is not None


@internal_action("asserta", 1)
def asserta(mind: Mind, literal: Term) -> Answer:
    mind.believe(_believable(literal, "asserta"), None)
    return True


@internal_action("assertz", 1)
def assertz(mind: Mind, literal: Term) -> Answer:
    mind.believe(_believable(literal, "assertz"), None, last=True)
    return True


def _believable(literal: Term, name: str) -> Literal:
    if not isinstance(literal, Atom | Structure):
        raise wrong_arguments(name, "a literal", literal)
    return literal


@internal_action("list_beliefs", 0)
def list_beliefs(mind: Mind) -> Answer:
    for literal in mind.beliefs:
        mind.say(show(literal))
    return True


@internal_action("add_annot", 3)
def add_annot(mind: Mind, literal: Term, annot: Term, result: Term) -> Answer:
    if not isinstance(literal, Atom | Structure):
        raise wrong_arguments("add_annot", "a literal", literal)
    annots = literal.annots if annot in literal.annots else (*literal.annots, annot)
    return unify(result, Structure(literal.predicate, literal.args, annots), mind.logic.trail)


# ---- plans ---------------------------------------------------------------------------------------------------------


@internal_action("add_plan", 1, 3)
def add_plan(mind: Mind, plans: Term, source: Term | None = None, place: Term | None = None) -> Answer:
    """One plan or a list of them, as text; `begin` puts them before the others."""
    for each in plans if isinstance(plans, List) else (plans,):
        mind.add_plan(plan_of(each), first=place == atom("begin"))
    return True


def plan_of(term: Term) -> Plan:
    if not isinstance(term, String):
        raise wrong_arguments("add_plan", "a plan as text", term)
    try:
        return parse_plan(term)
    except AgentSpeakSyntaxError as error:
        raise StepFailed("wrong_arguments", str(error)) from error


@internal_action("remove_plan", 1, 2)
def remove_plan(mind: Mind, labels: Term, source: Term | None = None) -> Answer:
    found = [mind.remove_plan(text_of(each)) for each in (labels if isinstance(labels, List) else (labels,))]
    return all(found)


@internal_action("relevant_plans", 2, 3)
def relevant_plans(mind: Mind, trigger: Term, plans: Term, labels: Term | None = None) -> Answer:
    wanted = _trigger_in(trigger)
    if wanted is None:
        raise wrong_arguments("relevant_plans", "an event", trigger)
    found = mind.library.options(wanted[0], wanted[1].predicate)
    texts = unify(plans, List([String(str(each.plan)) for each in found]), mind.logic.trail)
    return texts and (labels is None or unify(labels, List([atom(each.label) for each in found]), mind.logic.trail))


@internal_action("eval", 2, lazy=(1,))
def evaluate(mind: Mind, result: Term, formula: Question) -> Answer:
    return unify(result, atom("true" if formula.first() else "false"), mind.logic.trail)
