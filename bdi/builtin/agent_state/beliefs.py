"""Beliefs: `.abolish`, `.belief`, `.asserta`, `.list_beliefs`, …"""

from collections.abc import Iterator

from bdi.builtin.arguments import unifiable
from bdi.builtin.code import rule_in
from bdi.builtin.kinds import LITERAL, Kind, optional
from bdi.builtin.table import Answer, internal_action, wrong_arguments
from bdi.language.terms import Atom, Code, Literal, Structure, Term, literal_of, show
from bdi.language.unify import undo, unify
from bdi.model.mind import Mind

BELIEVED = Kind("a literal or a rule", lambda value: type(value) in (Atom, Structure, Code))


@internal_action("abolish", LITERAL)
def abolish(mind: Mind, pattern: Literal) -> Answer:
    """Forget every belief that unifies, whatever its source."""
    mind.actions.forget_all(pattern)
    return True


@internal_action("belief", LITERAL)
def belief(mind: Mind, pattern: Literal) -> Answer:
    """Every belief that is a fact, not derived by a rule."""
    return _facts_like(mind, pattern)


def _facts_like(mind: Mind, pattern: Literal) -> Iterator[bool]:
    trail = mind.logic.trail
    for fact in list(mind.beliefs.relation(pattern.predicate)):
        mark = len(trail)
        if unify(pattern, literal_of(pattern.predicate, fact.args, fact.annots), trail):
            yield True
        undo(trail, mark)


@internal_action("asserta", BELIEVED)
def asserta(mind: Mind, term: Term) -> Answer:
    """Add like `+<b`, but in a rule too; and for a rule { p(X) :- q(X) }."""
    return _believe(mind, term, last=False)


@internal_action("assertz", BELIEVED)
def assertz(mind: Mind, term: Term) -> Answer:
    """Add like `+>b`, but in a rule too; and for a rule { p(X) :- q(X) }."""
    return _believe(mind, term, last=True)


def _believe(mind: Mind, term: Term, last: bool) -> bool:
    rule = rule_in(term)
    if rule is not None:
        mind.beliefs.relation(rule.head.predicate).add_rule(mind.logic.derivation(rule), last)
    elif isinstance(term, Atom | Structure):
        mind.actions.believe(term, None, last)
    else:
        raise wrong_arguments("asserta", "a literal or a rule", term)
    return True


@internal_action("list_beliefs", optional(LITERAL))
def list_beliefs(mind: Mind, pattern: Term | None = None) -> Answer:
    for literal in mind.beliefs:
        if pattern is None or unifiable(mind, pattern, literal):
            mind.say(show(literal))
    return True
