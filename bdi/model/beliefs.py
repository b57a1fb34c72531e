"""Beliefs of an agent: one relation for each predicate, newest first, indexed by the first argument."""

from collections.abc import Callable, Iterable, Iterator
from itertools import combinations
from typing import Any
from weakref import WeakMethod

from bdi.language.terms import Literal, OpenList, Predicate, Structure, Term, Var, atom, literal_of, predicate
from bdi.language.unify import FIXED, Trail, deref, in_order, parts_of, renamed, undo, unify, unify_annots, variables_in

Arguments = tuple[Term, ...]
SOURCE = predicate("source", 1)
SELF = Structure(SOURCE, (atom("self"),))
FROM_SELF = (SELF,)  # of a goal that a plan posts, unless it says otherwise
PERCEPT = Structure(SOURCE, (atom("percept"),))
FEW = 50
INDEX_FROM = 8  # facts; below it, looking at each is quicker than an index


class Belief:
    """One fact of a relation. Its arguments never change, its annotations (where it comes from) do."""

    __slots__ = ("annots", "args", "open")

    def __init__(self, args: Arguments, annots: Arguments) -> None:
        self.args = args
        self.annots = annots
        self.open = False  # whether it has variables


class Derivation:
    """A rule in its place among the facts of its predicate; `proof.call(args, then)` is filled in by `logic`."""

    __slots__ = ("proof", "rule")

    def __init__(self, rule: Any, proof: Any) -> None:
        self.rule = rule
        self.proof = proof


class Relation:
    """The beliefs with one predicate. `facts` goes from the oldest to the newest: read it reversed."""

    __slots__ = ("_crowded", "_dependents", "by_first", "facts", "irregular", "predicate")

    def __init__(self, key: Predicate) -> None:
        self.predicate = key
        self.facts: dict[Any, Belief | Derivation] = {}
        self._crowded = FEW  # dependents, before the dead are removed
        self.irregular = 0  # entries that equality does not find: rules, facts with variables or annotated parts
        self.by_first: dict[Term, dict[Arguments, None]] | None = None
        self._dependents: dict[int, WeakMethod[Callable[[], None]]] = {}  # by object; see depend

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
        self._count_irregular(1)
        if last:
            self.facts = {derivation: self.facts.pop(derivation), **self.facts}

    def discard_rule(self, derivation: Derivation) -> None:
        if self.facts.pop(derivation, None) is not None:
            self._count_irregular(-1)

    def discard(self, args: Arguments) -> None:
        """Forget the fact with exactly these arguments, whatever its source."""
        if self.facts.pop(args, None) is not None:
            self._note(args, -1)

    def _note(self, args: Arguments, change: int) -> None:
        """Keep `irregular` and the index in step with `facts`."""
        for arg in args:
            if type(arg) not in FIXED and _is_loose(arg):
                self._count_irregular(change)
                return
        if self.by_first is not None and args:
            bucket = self.by_first.setdefault(args[0], {})
            if change > 0:
                bucket[args] = None
            else:
                del bucket[args]
                if not bucket:
                    del self.by_first[args[0]]

    def _count_irregular(self, change: int) -> None:
        self.irregular += change
        self.by_first = None
        if self._dependents:
            found = [reference() for reference in self._dependents.values()]
            self._dependents = {}
            for forget in found:
                if forget is not None:
                    forget()

    def depend(self, forget: Callable[[], None]) -> None:
        """Call this method of an object that takes the relation for regular once it is no longer. As long as there is
        such an object: no object is kept alive."""
        known = self._dependents
        if len(known) >= self._crowded:
            known = self._dependents = {key: each for key, each in known.items() if each() is not None}
            self._crowded = 2 * len(known) + FEW
        known[id(forget.__self__)] = WeakMethod(forget)  # type: ignore[attr-defined]

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
        if type(exact) is Belief and (not annots or (annots == exact.annots and not self.irregular)):
            return exact
        for belief in self:
            mark = len(trail)
            if agrees(belief, args, annots, trail):
                return belief
            undo(trail, mark)
        return None

    def find_in(self, belief: Belief, args: Arguments, annots: Arguments, trail: Trail) -> bool:
        """Return whether this fact unifies; nothing stays bound."""
        mark = len(trail)
        found = agrees(belief, args, annots, trail)
        undo(trail, mark)
        return found


def agrees(belief: Belief, args: Arguments, annots: Arguments, trail: Trail) -> bool:
    """Return whether the fact unifies. Its own variables stay free: it means the same the next time."""
    stored = belief.args
    if belief.open:
        names: dict[Var, Term] = {}
        stored = tuple([renamed(arg, names) for arg in stored])
    for arg, fact in zip(args, stored, strict=True):
        if not unify(arg, fact, trail):
            return False
    return not annots or unify_annots(annots, belief.annots, trail)


def agreements(belief: Belief, args: Arguments, annots: Arguments, trail: Trail) -> Iterator[None]:
    """The ways in which the fact unifies: b[source(S)] once for every source. A tail takes all in one way."""
    mark = len(trail)
    for chosen in _choices(belief.annots, annots):
        if agrees(belief, args, (), trail) and unify_annots(annots, chosen, trail):
            yield
        undo(trail, mark)


def _choices(present: Arguments, wanted: Arguments) -> Iterable[Arguments]:
    """Yield as many annotations as are wanted, in every choice that can make a difference."""
    if len(present) <= len(wanted) or type(wanted[-1]) is OpenList or not any(map(variables_in, wanted)):
        return (present,)
    return combinations(sorted(present, key=in_order), len(wanted))


def _is_loose(term: Term) -> bool:
    if type(term) is Var or (type(term) is Structure and term.annots):
        return True
    return any(_is_loose(deref(part)) for part in parts_of(term))


def annots_from_self(annots: Arguments) -> Arguments:
    """The annotations of a goal or belief of our own; a source that is written there stays the only one."""
    if not annots:
        return FROM_SELF
    named = any(type(annot) is Structure and annot.predicate is SOURCE for annot in annots)
    return annots if named else (*annots, SELF)


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
        """Yield all facts with their annotations, relation by relation, newest first."""
        for key, relation in self.relations.items():
            for belief in relation:
                yield literal_of(key, belief.args, belief.annots)

    def __len__(self) -> int:
        return sum(1 for _ in self)
