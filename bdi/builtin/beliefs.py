"""Beliefs: `.abolish`, `.belief`, `.asserta`, …"""

from bdi.builtin.table import Answer, internal_action, wrong_arguments
from bdi.mind import Mind
from bdi.terms import Atom, Literal, Structure, Term, show
from bdi.unify import unify


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
