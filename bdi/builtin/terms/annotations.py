"""Annotations of literals, alone or in lists: `.add_annot`, `.add_nested_source`, `.remove_source_annot`, …"""

from collections.abc import Callable

from bdi.builtin.arguments import bind
from bdi.builtin.kinds import ANY, LITERAL, LITERALS, OUT
from bdi.builtin.table import Answer, internal_action
from bdi.language.terms import Atom, List, Literal, String, Structure, Term, literal_of, structure
from bdi.model.beliefs import SOURCE
from bdi.model.logic import HasLogic
from bdi.model.mind import Mind

Annots = tuple[Term, ...]


def _with_annots(term: Term, change: Callable[[Annots], Annots]) -> Term:
    """A literal with other annotations; each of a list; any other term is itself."""
    if isinstance(term, List):
        return List([_with_annots(item, change) for item in term])
    if isinstance(term, Atom | Structure):
        return literal_of(term.predicate, term.args, change(term.annots))
    return term


def _is_source(annot: Term) -> bool:
    return isinstance(annot, Structure) and annot.predicate is SOURCE


def with_source(annots: Annots, source: Term) -> Annots:
    """`source(bob)`, which told what it has from the sources before: `source(bob)[source(ann)]`."""
    before = tuple(annot for annot in annots if _is_source(annot))
    return (*without_sources(annots), Structure(SOURCE, (source,), before))


def without_sources(annots: Annots) -> Annots:
    return tuple(annot for annot in annots if not _is_source(annot))


@internal_action("add_annot", LITERALS, ANY, OUT)
def add_annot(mind: HasLogic, term: Term, annot: Term, result: Term) -> Answer:
    def added(annots: Annots) -> Annots:
        return annots if annot in annots else (*annots, annot)

    return bind(mind, result, _with_annots(term, added))


@internal_action("add_nested_source", LITERALS, ANY, OUT)
def add_nested_source(mind: HasLogic, term: Term, source: Term, result: Term) -> Answer:
    return bind(mind, result, _with_annots(term, lambda annots: with_source(annots, source)))


@internal_action("remove_source_annot", LITERALS, OUT)
def remove_source_annot(mind: HasLogic, term: Term, result: Term) -> Answer:
    return bind(mind, result, _with_annots(term, without_sources))


@internal_action("get_src_info", LITERAL, OUT)
def get_src_info(mind: Mind, literal: Literal, result: Term) -> Answer:
    """The literal with `code_src(FILE)` and `code_line(N)` of the plan that asks. In a condition there is none."""
    if mind.current is None:
        return False
    place = mind.current.stack[-1].plan.plan.place
    where = (structure("code_src", String(place.source)), structure("code_line", place.line))
    return bind(mind, result, _with_annots(literal, lambda annots: (*annots, *where)))
