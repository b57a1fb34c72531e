"""What the agent believes: one relation for each predicate, newest first, indexed by the first argument."""

from collections.abc import Callable, Iterable, Iterator
from typing import Any

from bdi.terms import Literal, Predicate, Structure, Term, Var, atom, literal_of, predicate
from bdi.unify import FIXED, Trail, deref, parts_of, undo, unify_all, unify_annots, variables_in

Arguments = tuple[Term, ...]
SOURCE = predicate("source", 1)
SELF = Structure(SOURCE, (atom("self"),))
PERCEPT = Structure(SOURCE, (atom("percept"),))
INDEX_FROM = 8  # facts; below it, looking at each is quicker than an index


class Belief:
    """One fact of a relation. Its arguments never change, its annotations (where it comes from) do."""

    __slots__ = ("annots", "args", "open")

    def __init__(self, args: Arguments, annots: Arguments) -> None:
        self.args = args
        self.annots = annots
        self.open = False  # whether it has variables


class Derivation:
    """A rule in its place among the facts of its predicate; `solve(args, resume, frame)` is filled in by `logic`."""

    __slots__ = ("rule", "solve")

    def __init__(self, rule: Any, solve: Callable[..., bool]) -> None:
        self.rule = rule
        self.solve = solve


class Relation:
    """All beliefs with one predicate. `facts` goes from the oldest to the newest: read it reversed."""

    __slots__ = ("by_first", "facts", "irregular", "predicate")

    def __init__(self, key: Predicate) -> None:
        self.predicate = key
        self.facts: dict[Any, Belief | Derivation] = {}
        self.irregular = 0  # entries that equality does not find: rules, facts with variables or annotated parts
        self.by_first: dict[Term, dict[Arguments, None]] | None = None

    # -- reading

    def candidates(self, first: Term | None) -> Iterable[Any]:
        """The keys of the facts that can have this first argument (None: any), newest first."""
        found: dict[Any, Any] | None = self.facts
        if first is not None and type(first) in FIXED and not self.irregular and len(self.facts) >= INDEX_FROM:
            if self.by_first is None:
                self.by_first = self._index()
            found = self.by_first.get(first)
        return reversed(found) if found else ()

    def _index(self) -> dict[Term, dict[Arguments, None]]:
        index: dict[Term, dict[Arguments, None]] = {}
        for args in self.facts:
            index.setdefault(args[0], {})[args] = None
        return index

    def __iter__(self) -> Iterator[Belief]:
        return (fact for fact in reversed(list(self.facts.values())) if type(fact) is Belief)

    # -- changing

    def add(self, args: Arguments, annots: Arguments, last: bool = False) -> bool:
        """Believe it. False if nothing is new: neither the fact nor one of its annotations."""
        known = self.facts.get(args)
        if type(known) is Belief:
            new = tuple([annot for annot in annots if annot not in known.annots])
            known.annots += new
            return bool(new)
        self.facts[args] = belief = Belief(args, annots)
        if last:
            self._move_to_the_old_end(args)
        self._note(args, 1)
        if self.irregular:
            belief.open = any(variables_in(arg) for arg in args)
        return True

    def _move_to_the_old_end(self, args: Arguments) -> None:
        newest = self.facts.pop(args)
        self.facts = {args: newest, **self.facts}
        self.by_first = None

    def add_rule(self, derivation: Derivation, last: bool = False) -> None:
        self.facts[derivation] = derivation
        self.irregular += 1
        if last:
            self.facts = {derivation: self.facts.pop(derivation), **self.facts}

    def discard(self, args: Arguments) -> None:
        """Forget the fact with exactly these arguments, whoever said it."""
        if self.facts.pop(args, None) is not None:
            self._note(args, -1)

    def _note(self, args: Arguments, change: int) -> None:
        """Keep `irregular` and the index in step with `facts`."""
        for arg in args:
            if type(arg) not in FIXED and _is_loose(arg):
                self.irregular += change
                self.by_first = None
                return
        if self.by_first is not None and args:
            bucket = self.by_first.setdefault(args[0], {})
            if change > 0:
                bucket[args] = None
            else:
                del bucket[args]
                if not bucket:
                    del self.by_first[args[0]]

    def take_back(self, args: Arguments, annots: Arguments) -> bool:
        """Remove these annotations of the fact, and the fact itself once no source is left. False: no such fact."""
        belief = self.facts.get(args)
        if type(belief) is not Belief:
            return False
        left = tuple([annot for annot in belief.annots if annot not in annots]) if belief.annots != annots else ()
        if left and annots and any(type(annot) is Structure and annot.predicate is SOURCE for annot in left):
            belief.annots = left
        else:
            self.discard(args)
        return True

    def find(self, args: Arguments, annots: Arguments, trail: Trail) -> Belief | None:
        """The newest fact that unifies, with the variables of `args` and `annots` bound to it."""
        exact = self.facts.get(args)
        if type(exact) is Belief and not annots:
            return exact
        for belief in self:
            mark = len(trail)
            if _agrees(belief, args, annots, trail):
                return belief
            undo(trail, mark)
        return None

    def find_in(self, belief: Belief, args: Arguments, annots: Arguments, trail: Trail) -> bool:
        """Whether this fact unifies; nothing stays bound."""
        mark = len(trail)
        found = _agrees(belief, args, annots, trail)
        undo(trail, mark)
        return found


def _agrees(belief: Belief, args: Arguments, annots: Arguments, trail: Trail) -> bool:
    return unify_all(args, belief.args, trail) and (not annots or unify_annots(annots, belief.annots, trail))


def _is_loose(term: Term) -> bool:
    if type(term) is Var or (type(term) is Structure and term.annots):
        return True
    return any(_is_loose(deref(part)) for part in parts_of(term))


class Beliefs:
    """The belief base."""

    def __init__(self) -> None:
        self.relations: dict[Predicate, Relation] = {}

    def relation(self, key: Predicate) -> Relation:
        """The relation of this predicate, the same object for ever."""
        found = self.relations.get(key)
        if found is None:
            found = self.relations[key] = Relation(key)
        return found

    def __iter__(self) -> Iterator[Literal]:
        """All facts with their annotations, relation by relation, newest first."""
        for key, relation in self.relations.items():
            for belief in relation:
                yield literal_of(key, belief.args, belief.annots)

    def __len__(self) -> int:
        return sum(1 for _ in self)
