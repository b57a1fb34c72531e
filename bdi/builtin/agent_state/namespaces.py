"""Namespaces and modules: `.namespace`, `.namespace_set_prop`, `.namespace_get_prop`, `.include`."""

from collections.abc import Iterator

from bdi.builtin.arguments import alternatives, text_of
from bdi.builtin.kinds import ANY, ATOM, OUT, STRING, optional
from bdi.builtin.table import Answer, internal_action, wrong_arguments
from bdi.language.parser import load_module
from bdi.language.terms import DEFAULT_SPACE, PRIVATE_SPACE, Atom, Term, Var, atom, space_of
from bdi.language.unify import unify
from bdi.model.intentions import StepFailed
from bdi.model.mind import Mind


@internal_action("namespace", OUT)
def namespace(mind: Mind, name: Term) -> Answer:
    """A namespace in which something is believed. A local one is found only by who knows its name."""
    found = dict.fromkeys(space_of(key) for key, relation in mind.beliefs.relations.items() if relation.facts)
    spaces = [atom(DEFAULT_SPACE), *(each for each in found if each.functor != DEFAULT_SPACE)]
    if type(name) is not Var:
        return name in spaces
    return alternatives(mind, [((name, each),) for each in spaces if not each.functor.startswith(PRIVATE_SPACE)])


@internal_action("namespace_set_prop", ATOM, ATOM, ANY)
def namespace_set_prop(mind: Mind, name: Atom, key: Atom, value: Term) -> Answer:
    mind.namespace_properties.setdefault(name, {})[key] = value
    return True


@internal_action("namespace_get_prop", ATOM, OUT, optional(OUT), optional(ANY))
def namespace_get_prop(
    mind: Mind, name: Atom, key: Term, value: Term | None = None, otherwise: Term | None = None
) -> Iterator[bool]:
    """Each property that unifies; `otherwise` is the value of one that was never set."""
    known = mind.namespace_properties.get(name, {})
    if otherwise is not None and type(key) is Atom:
        known = {key: known.get(key, otherwise)}
    wanted = Var("_") if value is None else value
    return alternatives(mind, [((key, each), (wanted, its)) for each, its in known.items()])


@internal_action("include", STRING, optional(OUT))
def include(mind: Mind, file: Term, space: Term | None = None) -> Answer:
    """Loads a file into a namespace (a variable: a fresh one), as { include(file,space) } does while it is read."""
    if mind.includes is None:
        raise StepFailed("ia_failed", ".include reads a file, and this agent may not: it was made without includes=")
    if space is not None and not isinstance(space, Atom | Var):
        raise wrong_arguments("include", "the name of a namespace", space)
    name = None if isinstance(space, Var) else "" if space is None or space.functor == DEFAULT_SPACE else space.functor
    program, loaded_into = load_module(text_of(file), name, mind.includes, mind.program)
    mind.plan_base.include(program)
    return space is None or unify(space, atom(loaded_into or DEFAULT_SPACE), mind.logic.trail)
