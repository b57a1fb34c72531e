"""Formulas about what is believed: one look into a dictionary where that is enough, else unification; and rules."""

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import NamedTuple

from bdi.beliefs import Belief, Beliefs, Derivation, Relation
from bdi.logic.frames import RULE_SLOTS, Builtin, Frame, Known, Scope, Solve, proved
from bdi.logic.terms import Terms
from bdi.syntax import Rule
from bdi.terms import (
    Literal,
    Predicate,
    Term,
    Var,
)
from bdi.unify import (
    FIXED,
    Trail,
    annots_of,
    deref,
    renamed,
    undo,
    unify_all,
    unify_annots,
)


class Believed(Terms, ABC):
    """Compiles literals and rules against one belief base."""

    def __init__(self, beliefs: Beliefs, builtin: Callable[[Predicate], Builtin | None]) -> None:
        super().__init__(builtin)
        self.beliefs = beliefs

    @abstractmethod
    def compile(self, term: Term, scope: Scope, known: Known, then: Solve) -> Solve: ...

    def literal(self, term: Literal, scope: Scope, known: Known, then: Solve) -> Solve:
        relation = self.beliefs.relation(term.predicate)
        any_way = self._solve_any_way(relation, term, scope, then)
        if term.annots or not all(type(arg) in FIXED or type(arg) is Var for arg in term.args):
            return any_way
        variables = [arg for arg in term.args if type(arg) is Var]
        free = [variable for variable in variables if variable not in known.filled]
        if len(free) != len(set(free)) or known.met.intersection(free):
            return any_way
        fixed = [(place, arg) for place, arg in enumerate(term.args) if type(arg) is not Var]
        filled = [(place, scope.slot(arg)) for place, arg in enumerate(term.args) if arg in known.filled]
        if not variables:
            return self._solve_fact(relation, term.args, then, any_way)
        if not free:
            return self._solve_look_up(relation, term.args, filled, then, any_way)
        places = [(place, scope.slot(arg)) for place, arg in enumerate(term.args) if arg in free]
        return self._solve_scan(relation, _Pattern(tuple(fixed), tuple(filled), tuple(places)), then, any_way)

    def _solve_fact(self, relation: Relation, args: tuple[Term, ...], then: Solve, any_way: Solve) -> Solve:
        """Nothing but constants: `docked`, `battery(low)`."""

        def fact(frame: Frame) -> bool:
            if relation.irregular:
                return any_way(frame)
            return args in relation.facts and then(frame)

        return fact

    def _solve_look_up(
        self,
        relation: Relation,
        args: tuple[Term, ...],
        filled: list[tuple[int, int]],
        then: Solve,
        any_way: Solve,
    ) -> Solve:
        """Every variable has its value: one look into a dictionary."""

        def look_up(frame: Frame) -> bool:
            if relation.irregular:
                return any_way(frame)
            wanted = list(args)
            for place, slot in filled:
                value = wanted[place] = frame[slot]
                if type(value) not in FIXED:
                    return any_way(frame)
            return tuple(wanted) in relation.facts and then(frame)

        return look_up

    def _solve_scan(self, relation: Relation, pattern: "_Pattern", then: Solve, any_way: Solve) -> Solve:
        """Some variables get their value here: `dockStation(D)`."""
        fixed, filled, free = pattern

        def scan(frame: Frame) -> bool:
            if relation.irregular:
                return any_way(frame)
            if not relation.facts:
                return False
            wanted = fixed
            if filled:
                wanted = (*fixed, *[(place, frame[slot]) for place, slot in filled])
                for _, value in wanted:
                    if type(value) not in FIXED:
                        return any_way(frame)
            for args in relation.candidates(_first_of(wanted)) if wanted else reversed(relation.facts):
                for place, value in wanted:
                    if args[place] != value:
                        break
                else:
                    for place, slot in free:
                        frame[slot] = args[place]
                    if then(frame):
                        return True
            for _, slot in free:
                frame[slot] = None
            return False

        return scan

    def _solve_any_way(self, relation: Relation, term: Literal, scope: Scope, then: Solve) -> Solve:
        """By unification: patterns with parts or annotations, facts with variables, rules."""
        parts = [self.build(arg, scope) for arg in term.args]
        annots = [self.build(annot, scope) for annot in term.annots]
        trail = self.trail

        def any_way(frame: Frame) -> bool:
            if not relation.facts:
                return False
            args = tuple([part(frame) for part in parts])
            wanted = annots_of(tuple([annot(frame) for annot in annots])) if annots else ()
            mark = len(trail)
            for key in tuple(relation.candidates(deref(args[0]) if args else None)):
                entry = relation.facts.get(key)
                if type(entry) is Belief:
                    if _agree(entry, args, wanted, trail) and then(frame):
                        return True
                elif type(entry) is Derivation and entry.solve(args, then, frame):
                    return True
                undo(trail, mark)
            return False

        return any_way

    def derivation(self, rule: Rule) -> Derivation:
        """A rule as an entry of its relation, compiled when it is first needed."""
        compiled: list[Callable[..., bool]] = []

        def solve(args: tuple[Term, ...], then: Solve, frame: Frame) -> bool:
            if not compiled:
                compiled.append(self._compile_rule(rule))
            return compiled[0](args, then, frame)

        return Derivation(rule, solve)

    def _compile_rule(self, rule: Rule) -> Callable[..., bool]:
        scope, met = Scope(RULE_SLOTS), set[Var]()
        matches = [self.match(arg, scope, met) for arg in rule.head.args]
        body = self.compile(rule.formula, scope, Known().among(dict.fromkeys(met)), proved)
        empty = [None] * (scope.size - RULE_SLOTS)

        def solve(args: tuple[Term, ...], then: Solve, caller: Frame) -> bool:
            frame = [then, caller, *empty]
            for match, arg in zip(matches, args, strict=True):
                if not match(frame, arg):
                    return False
            return body(frame)

        return solve


def _agree(belief: Belief, args: tuple[Term, ...], annots: tuple[Term, ...], trail: Trail) -> bool:
    stored = belief.args
    if belief.open:
        names: dict[Var, Term] = {}
        stored = tuple([renamed(arg, names) for arg in stored])
    return unify_all(args, stored, trail) and (not annots or unify_annots(annots, belief.annots, trail))


class _Pattern(NamedTuple):
    """How a belief is looked for: what is at which place, by value, by filled slot, by slot to fill."""

    fixed: tuple[tuple[int, Term], ...]
    filled: tuple[tuple[int, int], ...]
    free: tuple[tuple[int, int], ...]


def _first_of(wanted: tuple[tuple[int, Term], ...]) -> Term | None:
    """The first argument, if it is known."""
    return next((value for place, value in wanted if place == 0), None)
