"""An agent as it is now, for a clone or a file: what it believes and the plans that it has, without its intentions."""

from collections.abc import Iterable, Iterator

from bdi.language.parser.namespaces import Module
from bdi.language.syntax import Plan, Program, Rule
from bdi.language.terms import PRIVATE_SPACE, Atom, Literal, Structure, Term, atom, literal_of, show
from bdi.model.beliefs import PERCEPT, SELF, Belief, Relation
from bdi.reasoning.agent import Agent

DEFAULT_PLANS = "kqml"  # the namespace of plans that an agent has without being given them


def text_of(agent: Agent, goals: Iterable[Literal] = ()) -> str:
    """The agent as a program. Percepts are left out: an agent that starts from this text perceives for itself."""
    relations = agent.beliefs.relations.values()
    names = _Readable(relation.predicate.namespace for relation in relations)
    beliefs = [_clause(entry, names) for relation in relations for entry in reversed(list(_kept(relation)))]
    intended = [f"!{show(names.literal(goal))}." for goal in goals]
    plans = [str(names.plan(plan)) for plan in plans_of(agent)]
    spaces = [f"{{ namespace({name},local) }}" for name in names.local.values() if name not in names.handed_out]
    return "".join(f"{line}\n" for line in [*spaces, *beliefs, *intended, *plans])


def plans_of(agent: Agent) -> list[Plan]:
    return [each.plan for each in agent.library.plans if not _is_default(each.plan)]


def program_of(agent: Agent) -> Program:
    """The plans alone: see `copy_beliefs`."""
    return Program(agent.name, plans=tuple(plans_of(agent)))


def copy_beliefs(source: Agent, target: Agent) -> None:
    """Facts and rules in their order. There are no events: the clone has believed all this before."""
    for relation in source.beliefs.relations.values():
        copy = target.beliefs.relation(relation.predicate)
        for entry in _kept(relation):
            if isinstance(entry, Rule):
                copy.add_rule(target.logic.derivation(entry))
            else:
                copy.add(entry.args, entry.annots)


def _kept(relation: Relation) -> Iterator[Literal | Rule]:
    """Rules, and facts that are believed for another reason than being perceived; the newest comes last."""
    for entry in relation.facts.values():
        if not isinstance(entry, Belief):
            yield entry.rule
            continue
        annots = _without(PERCEPT, entry.annots)
        if annots or not entry.annots:
            yield literal_of(relation.predicate, entry.args, annots)


class _Readable(Module):
    """Gives local namespaces names that a program can say: `priv_1` for the first one, called priv.

    One that is handed out as a value (`!ask(this_ns)`) is no longer local: a program cannot write such a value.
    """

    def __init__(self, taken: Iterable[str]) -> None:
        super().__init__()
        self._taken = set(taken)
        self.handed_out: set[str] = set()

    def named(self, written: str) -> str:
        if not written.startswith(PRIVATE_SPACE):
            return super().named(written)
        if written not in self.local:
            name = written.removeprefix(PRIVATE_SPACE)
            number = name[: len(name) - len(name.lstrip("0123456789"))]
            readable = f"{name.removeprefix(number)}_{number}"
            while readable in self._taken:
                readable += "_"
            self._taken.add(readable)
            self.local[written] = readable
        return self.local[written]

    def term(self, term: Term) -> Term:
        if type(term) is Atom and term.functor.startswith(PRIVATE_SPACE):
            self.handed_out.add(self.named(term.functor))
            return atom(self.named(term.functor))
        return super().term(term)


def _clause(entry: Literal | Rule, names: Module) -> str:
    """`source(self)` says nothing in a program."""
    if isinstance(entry, Rule):
        return str(names.clause(entry))
    return f"{show(names.literal(literal_of(entry.predicate, entry.args, _without(SELF, entry.annots))))}."


def _without(annot: Term, annots: tuple[Term, ...]) -> tuple[Term, ...]:
    return tuple(each for each in annots if each != annot)


def _is_default(plan: Plan) -> bool:
    return isinstance(plan.head, Structure) and plan.head.predicate.namespace == DEFAULT_PLANS
