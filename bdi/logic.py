"""Formulas compiled once to functions over the belief base.

A formula becomes `solve(frame) -> bool`: it fills the frame (one slot for each variable), calls what comes after it,
and answers True as soon as that does. So a conjunction is a call, a second answer is a return, and no generator is
needed. A slot is None until its variable is met; then it holds a value or a `Var`.
"""

import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, NamedTuple, Protocol, TypeAlias

from bdi.arithmetic import OPERATION_OF, ArithmeticFailure
from bdi.beliefs import Belief, Beliefs, Derivation, Relation
from bdi.syntax import Rule
from bdi.terms import (
    AND,
    ARITHMETIC,
    FALSE,
    INTERNAL,
    NEGATIVE,
    NOT,
    OR,
    POSITIVE,
    RELATIONS,
    TRUE,
    Atom,
    Code,
    List,
    Literal,
    OpenList,
    Predicate,
    Structure,
    Term,
    Var,
    atom,
    literal_of,
    number,
    predicate,
)
from bdi.unify import (
    FIXED,
    Trail,
    annots_of,
    compare,
    deref,
    evaluated,
    parts_of,
    renamed,
    resolve,
    undo,
    unify,
    unify_all,
    unify_annots,
    variables_in,
)

Frame: TypeAlias = list[Any]
Solve: TypeAlias = Callable[[Frame], bool]
Build: TypeAlias = Callable[[Frame], Term]
Match: TypeAlias = Callable[[Frame, Term], bool]
LONGEST_PROOF = 100_000  # calls; a step of a proof takes three to five
DEEPEST_QUESTIONS = 100  # `.findall` within `.findall` of the same place
RULE_SLOTS = 2  # a rule's frame begins with what comes after the call, and the caller's frame


class Builtin(Protocol):
    """What `logic` needs to know of an internal action or function: how to call it."""

    lazy: frozenset[int]  # arguments handed over as questions, not as values
    named: bool  # whether the variables of the plan, by name, come first

    def ask(self, args: tuple[Any, ...]) -> "bool | Iterator[Any]": ...


class HasLogic(Protocol):
    logic: "Logic"


@dataclass(frozen=True, slots=True)
class Known:
    """What is known of the slots at one place of a program, before it runs."""

    filled: frozenset[Var] = frozenset()  # certainly not None
    met: frozenset[Var] = frozenset()  # perhaps not None

    def after(self, term: Term) -> "Known":
        """Once this formula has come true."""
        return Known(self.filled | filled_by(term), self.met | frozenset(variables_in(term)))

    def among(self, variables: Iterable[Var]) -> "Known":
        new = frozenset(variables)
        return Known(self.filled | new, self.met | new)


@contextmanager
def deep_stack() -> Iterator[None]:
    """Let Python functions call each other more deeply. Their frames are on the heap (CPython 3.11 and later)."""
    usual = sys.getrecursionlimit()
    sys.setrecursionlimit(max(usual, LONGEST_PROOF))
    try:
        yield
    finally:
        sys.setrecursionlimit(usual)


class Scope:
    """Which variable lives in which slot."""

    def __init__(self, first: int = 0) -> None:
        self.slots: dict[Var, int] = {}
        self.size = first

    def slot(self, variable: Var) -> int:
        found = self.slots.get(variable)
        if found is None:
            found = self.slots[variable] = self.size
            self.size += 1
        return found


class Question:
    """A formula handed to an internal action, such as the second argument of `.findall`, with the frame it is about."""

    __slots__ = ("_answers", "build", "frame", "mark")

    def __init__(self, frame: Frame, build: Build, answers: Callable[[Frame, Build], list[Term]]) -> None:
        self.frame = frame
        self.build = build
        self._answers = answers

    def answers(self, template: "Question") -> list[Term]:
        """The template once for every way in which the formula is true."""
        return self._answers(self.frame, template.build)

    def first(self) -> bool:
        """Whether the formula is true, whatever its variables."""
        return bool(self._answers(self.frame, lambda frame: TRUE))

    def term(self) -> Term:
        return resolve(self.build(self.frame))


def filled_by(term: Term) -> frozenset[Var]:
    """The variables whose slots are certainly filled once the formula has come true."""
    key = term.predicate if isinstance(term, Atom | Structure) else None
    if key is NOT:
        return frozenset()
    if isinstance(term, Structure) and key in (AND, OR):
        left, right = (filled_by(part) for part in term.args)
        return left | right if key is AND else left & right
    if key is not None and key.name.startswith(INTERNAL):
        return frozenset()
    return frozenset(variables_in(term))


def succeed(frame: Frame) -> bool:
    return True


def _fail(frame: Frame) -> bool:
    return False


def _proved(frame: Frame) -> bool:
    """The end of a rule: go on where it was called."""
    answer: bool = frame[0](frame[1])
    return answer


class Logic:
    """Compiles formulas and terms against one belief base. One for each agent."""

    def __init__(self, beliefs: Beliefs, builtin: Callable[[Predicate], Builtin | None]) -> None:
        self.beliefs = beliefs
        self.builtin = builtin
        self.trail: Trail = []
        self._asked = False  # whether a formula is being asked that may be asked again with more stack

    # ---- terms -----------------------------------------------------------------------------------------------------

    def build(self, term: Term, scope: Scope) -> Build:
        """A function that makes the term from a frame. Values may still hold variables bound later: `resolve` them."""
        if type(term) in FIXED:
            return lambda frame: term
        if type(term) is Var:
            return self._build_variable(scope.slot(term), term.name)
        if type(term) is Code:
            return self._build_code(term, scope)
        if not variables_in(term) and not self._has_functions(term):
            return self._build_ground(term)
        if type(term) is Structure:
            return self._build_structure(term, scope)
        return self._build_sequence(term, scope)

    def _build_variable(self, slot: int, name: str) -> Build:
        def variable(frame: Frame) -> Term:
            value = frame[slot]
            if value is None:
                value = frame[slot] = Var(name)
            elif type(value) is Var:
                return deref(value)
            return value  # type: ignore[no-any-return]

        return variable

    def _build_ground(self, term: Term) -> Build:
        try:
            value = resolve(term)
        except ArithmeticFailure:
            return lambda frame: resolve(term)
        return lambda frame: value

    def _build_code(self, term: Code, scope: Scope) -> Build:
        parts = [(variable, self.build(value, scope)) for variable, value in term.scope.items()]
        return lambda frame: Code(term.body, {variable: part(frame) for variable, part in parts})

    def _has_functions(self, term: Term) -> bool:
        if isinstance(term, Structure) and self._function(term.predicate):
            return True
        return any(self._has_functions(part) for part in parts_of(term))

    def _function(self, key: Predicate) -> Any:
        """The arithmetic function of this name, such as `math.abs`, if there is one."""
        if "." not in key.name and key.name != "time":
            return None
        return getattr(self.builtin(key), "function", None)

    def _build_structure(self, term: Structure, scope: Scope) -> Build:
        key = term.predicate
        if key in ARITHMETIC:
            return self._build_arithmetic(term, scope)
        parts = [self.build(arg, scope) for arg in term.args]
        annots = [self.build(annot, scope) for annot in term.annots]
        function = self._function(key)
        if function:
            return lambda frame: function(tuple([resolve(part(frame)) for part in parts]))
        if key is NEGATIVE or key is POSITIVE:
            return lambda frame: evaluated(Structure(key, (resolve(parts[0](frame)),)))
        if not annots:
            return lambda frame: Structure(key, tuple([part(frame) for part in parts]))
        return lambda frame: Structure(
            key, tuple([part(frame) for part in parts]), annots_of(tuple([annot(frame) for annot in annots]))
        )

    def _build_arithmetic(self, term: Structure, scope: Scope) -> Build:
        left, right = (self.build(arg, scope) for arg in term.args)
        key = term.predicate
        calculate = OPERATION_OF[key]

        def arithmetic(frame: Frame) -> Term:
            a, b = left(frame), right(frame)
            if type(a) in (int, float) and type(b) in (int, float):
                return number(calculate(a, b))  # type: ignore[arg-type]
            return evaluated(Structure(key, (resolve(a), resolve(b))))

        return arithmetic

    def _build_sequence(self, term: Term, scope: Scope) -> Build:
        if isinstance(term, OpenList):
            items = [self.build(item, scope) for item in term.items]
            tail = self.build(term.tail, scope)
            return lambda frame: resolve(OpenList(tuple([item(frame) for item in items]), tail(frame)))
        parts = [self.build(item, scope) for item in parts_of(term)]
        return lambda frame: List([part(frame) for part in parts])

    # ---- matching a value against a pattern ------------------------------------------------------------------------

    def match(self, pattern: Term, scope: Scope, met: set[Var]) -> Match:
        """A function that makes a pattern and a value equal; `met` are the variables seen to the left of here."""
        if type(pattern) is Var:
            first = pattern not in met
            met.add(pattern)
            return self._match_first(scope.slot(pattern)) if first else self._match_again(scope.slot(pattern))
        if type(pattern) in FIXED:
            return self._match_constant(pattern)
        met.update(variables_in(pattern))
        build, trail = self.build(pattern, scope), self.trail
        return lambda frame, value: unify(build(frame), value, trail)

    def _match_first(self, slot: int) -> Match:
        def first(frame: Frame, value: Term) -> bool:
            frame[slot] = value
            return True

        return first

    def _match_again(self, slot: int) -> Match:
        trail = self.trail
        return lambda frame, value: unify(frame[slot], value, trail)

    def _match_constant(self, constant: Term) -> Match:
        trail = self.trail
        return lambda frame, value: value == constant or (type(value) not in FIXED and unify(constant, value, trail))

    def formula(self, term: Term, scope: Scope, known: Known, then: Solve) -> Solve:
        """`compile` for what a plan or somebody outside asks: long proofs by rules get the stack they need.

        A proof is a chain of calls. Where rules are involved it may be longer than Python's usual limit; then the
        formula is asked again with a higher one, which holds only for that time.
        """
        solve = self.compile(term, scope, known, then)
        if not self._may_need_rules(term):
            return solve
        unfilled = [scope.slot(variable) for variable in variables_in(term) if variable not in known.filled]
        trail = self.trail

        def ask(frame: Frame) -> bool:
            if self._asked:
                return solve(frame)  # a question within a question: the outer one takes care
            mark = len(trail)
            before = [frame[slot] for slot in unfilled]
            self._asked = True
            try:
                return solve(frame)
            except RecursionError:
                undo(trail, mark)
            finally:
                self._asked = False
            for slot, value in zip(unfilled, before, strict=True):
                frame[slot] = value
            return self._ask_deeply(solve, frame)

        return ask

    def _ask_deeply(self, solve: Solve, frame: Frame) -> bool:
        self._asked = True
        try:
            with deep_stack():
                return solve(frame)
        finally:
            self._asked = False

    def _may_need_rules(self, term: Term) -> bool:
        if not isinstance(term, Atom | Structure):
            return type(term) is Var
        key = term.predicate
        if key in (AND, OR, NOT) or key.name.startswith(INTERNAL):
            return any(self._may_need_rules(part) for part in term.args)
        return self.beliefs.relation(key).irregular > 0

    # ---- formulas --------------------------------------------------------------------------------------------------

    def compile(self, term: Term, scope: Scope, known: Known, then: Solve) -> Solve:
        """The formula as a function; `then` is called for every way in which it is true."""
        if type(term) is Var or type(term) is Code:
            return self._solve_variable(term, scope, then)
        if not isinstance(term, Atom | Structure):
            return _fail
        key = term.predicate
        compiler = self._formulas().get(key)
        if compiler:
            return compiler(term, scope, known, then)
        if key in RELATIONS and isinstance(term, Structure):
            return self._solve_relation(term, scope, then)
        if key.name.startswith(INTERNAL):
            return self._solve_builtin(term, scope, then)
        return self._solve_literal(term, scope, known, then)

    def _formulas(self) -> dict[Predicate, Callable[[Any, Scope, Known, Solve], Solve]]:
        return {
            AND: self._solve_and,
            OR: self._solve_or,
            NOT: self._solve_not,
            TRUE.predicate: lambda term, scope, known, then: then,
            FALSE.predicate: lambda term, scope, known, then: _fail,
        }

    def _solve_and(self, term: Structure, scope: Scope, known: Known, then: Solve) -> Solve:
        left, right = term.args
        return self.compile(left, scope, known, self.compile(right, scope, known.after(left), then))

    def _solve_or(self, term: Structure, scope: Scope, known: Known, then: Solve) -> Solve:
        left, right = (self.compile(part, scope, known, then) for part in term.args)
        return lambda frame: left(frame) or right(frame)

    def _solve_not(self, term: Structure, scope: Scope, known: Known, then: Solve) -> Solve:
        inner = self.compile(term.args[0], scope, known, succeed)
        slots = [scope.slot(variable) for variable in variables_in(term) if variable not in known.filled]
        trail = self.trail

        def refute(frame: Frame) -> bool:
            mark = len(trail)
            before = [frame[slot] for slot in slots]
            if not inner(frame):
                return then(frame)
            undo(trail, mark)
            for slot, value in zip(slots, before, strict=True):
                frame[slot] = value
            return False

        return refute

    def _solve_variable(self, term: Term, scope: Scope, then: Solve) -> Solve:
        """A formula that is only known when it is asked: compiled then."""
        build = self.build(term, scope)

        def ask(frame: Frame) -> bool:
            inner = Scope(RULE_SLOTS)
            formula = resolve(build(frame))
            solve = self.compile(formula, inner, Known(), _proved) if type(formula) is not Var else _fail
            return solve([then, frame, *inner.slots])

        return ask

    # ---- beliefs and rules -----------------------------------------------------------------------------------------

    def _solve_literal(self, term: Literal, scope: Scope, known: Known, then: Solve) -> Solve:
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
        body = self.compile(rule.formula, scope, Known().among(dict.fromkeys(met)), _proved)
        empty = [None] * (scope.size - RULE_SLOTS)

        def solve(args: tuple[Term, ...], then: Solve, caller: Frame) -> bool:
            frame = [then, caller, *empty]
            for match, arg in zip(matches, args, strict=True):
                if not match(frame, arg):
                    return False
            return body(frame)

        return solve

    # ---- comparisons -----------------------------------------------------------------------------------------------

    def _solve_relation(self, term: Structure, scope: Scope, then: Solve) -> Solve:
        """X < Y   X == Y   X = Y   X =.. [name,args,annots]"""
        left, right = (self.build(arg, scope) for arg in term.args)
        name = term.predicate.name
        if name == "=":
            return self._solve_equation(left, right, then)
        if name == "=..":
            return self._solve_decomposition(left, right, then)
        test = _TESTS[name]

        def compared(frame: Frame) -> bool:
            try:
                a, b = left(frame), right(frame)
                holds = test(a, b) if type(a) is int and type(b) is int else _holds(name, resolve(a), resolve(b))
            except ArithmeticFailure:
                return False
            return holds and then(frame)

        return compared

    def _solve_equation(self, left: Build, right: Build, then: Solve) -> Solve:
        trail = self.trail

        def equation(frame: Frame) -> bool:
            mark = len(trail)
            try:
                if unify(resolve(left(frame)), resolve(right(frame)), trail) and then(frame):
                    return True
            except ArithmeticFailure:
                pass
            undo(trail, mark)
            return False

        return equation

    def _solve_decomposition(self, left: Build, right: Build, then: Solve) -> Solve:
        trail = self.trail

        def decomposition(frame: Frame) -> bool:
            mark = len(trail)
            value, pattern = resolve(left(frame)), resolve(right(frame))
            if isinstance(value, Atom | Structure):
                parts: Term = List([atom(value.functor), List(value.args), List(value.annots)])
                done = unify(parts, pattern, trail)
            else:
                made = _composed(pattern)
                done = made is not None and unify(value, made, trail)
            if done and then(frame):
                return True
            undo(trail, mark)
            return False

        return decomposition

    # ---- internal actions ------------------------------------------------------------------------------------------

    def arguments(self, term: Literal, builtin: Builtin, scope: Scope) -> Callable[[Frame], tuple[Any, ...]]:
        """What an internal action is called with: values, and questions where it asks for them."""
        parts = [
            self.question(arg, scope) if place in builtin.lazy else self._value(arg, scope)
            for place, arg in enumerate(term.args)
        ]
        if builtin.named:
            return lambda frame: (_by_name(scope, frame), *[part(frame) for part in parts])
        return lambda frame: tuple([part(frame) for part in parts])

    def _value(self, term: Term, scope: Scope) -> Build:
        build = self.build(term, scope)
        return lambda frame: resolve(build(frame))

    def question(self, term: Term, scope: Scope) -> Callable[[Frame], Question]:
        build = self.build(term, scope)
        collectors: list[tuple[list[Term], Build]] = []

        def collect(frame: Frame) -> bool:
            found, template = collectors[-1]
            found.append(renamed(template(frame), {}))
            return False

        solve = self.formula(term, scope, Known(met=frozenset(variables_in(term))), collect)

        def answers(frame: Frame, template: Build) -> list[Term]:
            found: list[Term] = []
            if len(collectors) >= DEEPEST_QUESTIONS:
                raise RecursionError("a formula asks itself")
            collectors.append((found, template))
            try:
                solve(frame)
            finally:
                collectors.pop()
            return found

        return lambda frame: Question(frame, build, answers)

    def _solve_builtin(self, term: Literal, scope: Scope, then: Solve) -> Solve:
        builtin = self.builtin(term.predicate)
        if builtin is None:
            return _fail
        arguments, trail, ask = self.arguments(term, builtin, scope), self.trail, builtin.ask

        def solve(frame: Frame) -> bool:
            mark = len(trail)
            answer = ask(arguments(frame))
            if answer is True and then(frame):
                return True
            if answer is not True and answer:
                for _ in answer:
                    if then(frame):
                        return True
                    undo(trail, mark)
            undo(trail, mark)
            return False

        return solve

    # ---- asking from outside ---------------------------------------------------------------------------------------

    def query(self, formula: Term) -> list[dict[str, Term]]:
        """All answers to a formula, each as name → value of the variables that got one."""
        scope = Scope()
        variables = [variable for variable in variables_in(formula) if variable.name != "_"]
        answers: list[dict[str, Term]] = []

        def collect(frame: Frame) -> bool:
            values = [(variable.name, resolve(frame[scope.slot(variable)] or variable)) for variable in variables]
            answers.append({name: value for name, value in values if type(value) is not Var})
            return False

        solve = self.formula(formula, scope, Known(), collect)
        for variable in variables:
            scope.slot(variable)
        solve([None] * scope.size)
        undo(self.trail, 0)
        return answers

    def instances(self, literal: Literal) -> list[Term]:
        """Every way in which the literal is believed."""
        scope = Scope()
        question = self.question(literal, scope)
        for variable in variables_in(literal):
            scope.slot(variable)
        asked = question([None] * scope.size)
        answers = asked.answers(asked)
        undo(self.trail, 0)
        return answers


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


def _by_name(scope: Scope, frame: Frame) -> dict[str, Term]:
    for variable, slot in scope.slots.items():
        if slot < len(frame) and frame[slot] is None:
            frame[slot] = Var(variable.name)
    return {variable.name: frame[slot] for variable, slot in scope.slots.items() if slot < len(frame)}


def _composed(pattern: Term) -> Term | None:
    """[p,[a],[x]] → p(a)[x]"""
    if not isinstance(pattern, List) or len(pattern) != 3:
        return None
    name, args, annots = pattern
    if not isinstance(name, Atom) or not isinstance(args, List) or not isinstance(annots, List):
        return None
    return literal_of(predicate(name.functor, len(args)), tuple(args), tuple(annots))


_TESTS: dict[str, Callable[[Any, Any], bool]] = {
    "<": lambda a, b: a < b,
    "<=": lambda a, b: a <= b,
    ">": lambda a, b: a > b,
    ">=": lambda a, b: a >= b,
    "==": lambda a, b: a == b,
    "\\==": lambda a, b: a != b,
}


def _holds(name: str, a: Term, b: Term) -> bool:
    """Numbers by value, other terms by the standard order."""
    if name in ("==", "\\==") or (type(a) in (int, float) and type(b) in (int, float)):
        return _TESTS[name](a, b)
    return _TESTS[name](compare(a, b), 0)
