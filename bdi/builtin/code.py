"""Plans, rules and events as terms, `{ +!g(X) <- a }`, with the values that their variables have."""

from bdi.builtin.table import wrong_arguments
from bdi.language.errors import AgentSpeakSyntaxError, Place
from bdi.language.parser import parse_event, parse_plan
from bdi.language.syntax import Body, Plan, Rule, Trigger, event_of, with_terms
from bdi.language.terms import Atom, Code, Literal, String, Structure, Term, Var, atom
from bdi.language.unify import deref, renamed, substituted


def plan_in(term: Term, name: str) -> Plan:
    """ "+!g <- a"   { +!g <- a }   {+b}; its variables are its own."""
    if isinstance(term, String):
        try:
            return parse_plan(str.__str__(term))
        except AgentSpeakSyntaxError as error:
            raise wrong_arguments(name, f"a plan ({error.problem})", term) from error
    quoted = with_values(term) if isinstance(term, Code) else None
    event = None if quoted is None else event_of(quoted)
    if event is None or not isinstance(event[1], Atom | Structure | Var):
        raise wrong_arguments(name, "a plan, as { +!g <- a } or as a string", term)
    return quoted if isinstance(quoted, Plan) else Plan(atom(""), *event, None, Body(), Place())


def rule_in(term: Term) -> Rule | None:
    """{ p(X) :- q(X) }"""
    quoted = with_values(term) if isinstance(term, Code) else None
    return quoted if isinstance(quoted, Rule) else None


def with_values(code: Code) -> Plan | Body | Rule:
    """Return the quoted code with the values of its variables; free ones become its own."""
    names: dict[Var, Term] = {}
    values = {variable: renamed(value, names) for variable, value in code.scope.items()}
    quoted: Plan | Body | Rule = code.body
    return with_terms(quoted, lambda term: substituted(term, values)) if values else quoted


# ---- events --------------------------------------------------------------------------------------------------------


def event_in(condition: Term) -> tuple[Trigger, Literal] | None:
    """ "+b(X)" or {+b(X)}; None for anything else."""
    event = trigger_in(condition)
    return (event[0], event[1]) if event is not None and isinstance(event[1], Atom | Structure) else None


def trigger_in(condition: Term) -> tuple[Trigger, Literal | Var] | None:
    """Read an event as `event_in` does, and {+!_} too. Its variables are those of the plan that wrote it."""
    if isinstance(condition, String):
        return _event_named(condition)
    event = event_of(condition.body) if isinstance(condition, Code) else None
    if event is None or not isinstance(condition, Code):
        return None
    head = deref(substituted(event[1], condition.scope))
    return (event[0], head) if isinstance(head, Atom | Structure | Var) else None


def _event_named(text: String) -> tuple[Trigger, Literal]:
    """ "+!g(X)" """
    try:
        return parse_event(str.__str__(text))
    except AgentSpeakSyntaxError as error:
        raise wrong_arguments("wait", "an event with a name", text) from error
