"""Which namespace a name belongs to, settled while a program is loaded, so that nothing is left to do when it runs.

A module is a file, or a `{ begin namespace(n) }` block. Where its text names a belief, a goal or an event, the name
belongs to the namespace of the module; a term inside another one, an annotation and an action do not, unless they say
so: `::x` and `this_ns::x` mean the module's own namespace, `default::x` the one without a name.
"""

from dataclasses import dataclass, field, replace

from bdi.language.errors import AgentSpeakSyntaxError
from bdi.language.syntax import (
    Belief,
    Body,
    Clause,
    Does,
    For,
    Fork,
    Goal,
    If,
    Plan,
    Rule,
    Simple,
    Step,
    While,
    variables_of,
)
from bdi.language.terms import (
    AND,
    ANNOTATED,
    DEFAULT_SPACE,
    IN_SPACE,
    NOT,
    OPERATORS,
    OR,
    PRIVATE_SPACE,
    RELATIONS,
    THIS_SPACE,
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
    is_internal,
    literal_of,
    predicate,
    show,
)

TRUTH = ("true", "false")
CONNECTIVES = frozenset({AND, OR, NOT})


@dataclass(slots=True)
class Numbers:
    """Counts the namespaces that get a name of their own making, local and fresh ones."""

    taken: int = 0

    def next(self) -> int:
        self.taken += 1
        return self.taken


@dataclass(slots=True)
class Module:
    """One namespace while its text is read, with the local namespaces that only this text can name."""

    space: str = ""
    local: dict[str, str] = field(default_factory=dict)
    numbers: Numbers = field(default_factory=Numbers)
    prefixes: bool = True  # whether its text has any

    def inner(self, name: str) -> "Module":
        """The module of `{ begin namespace(name) }`."""
        return Module(self.named(name), self.local, self.numbers)

    def of_file(self, text: str, space: str) -> "Module":
        """The module of a file that is loaded into this namespace: it cannot name our local ones."""
        return Module(space, {}, self.numbers, prefixes="::" in text or THIS_SPACE in text)

    def declare_local(self, name: str) -> None:
        if name not in self.local:
            self.local[name] = f"{PRIVATE_SPACE}{self.numbers.next()}{name}"

    def fresh(self) -> str:
        """The name of a namespace that nothing else is in."""
        return f"ns__{self.numbers.next()}"

    def named(self, written: str) -> str:
        """The namespace that a prefix names."""
        if written == THIS_SPACE:
            return self.space
        return "" if written == DEFAULT_SPACE else self.local.get(written, written)

    # ---- clauses and plans

    def clause(self, clause: Clause) -> Clause:
        if not self.space and not self.prefixes:
            return clause
        if isinstance(clause, Plan):
            return self.plan(clause)
        if isinstance(clause, Rule):
            return replace(clause, head=self._named_ours(clause.head, clause), formula=self.formula(clause.formula))
        if isinstance(clause, Belief | Goal):
            return replace(clause, literal=self._named_ours(clause.literal, clause))
        return clause

    def _named_ours(self, literal: Literal, clause: Belief | Goal | Rule) -> Literal:
        if literal.predicate is IN_SPACE:
            raise AgentSpeakSyntaxError(f"{show(literal)} has no namespace yet", clause.place, ("a namespace by name",))
        return self._ours(literal)

    def plan(self, plan: Plan) -> Plan:
        return replace(
            plan,
            label=self._ours(plan.label) if plan.label.functor else plan.label,
            head=self.literal(plan.head),  # type: ignore[arg-type]
            head_annots=tuple(map(self.term, plan.head_annots)),
            context=None if plan.context is None else self.formula(plan.context),
            condition=None if plan.condition is None else self.formula(plan.condition),
            body=self.body(plan.body),
            subplans=tuple(self.plan(each) for each in plan.subplans),
        )

    # ---- bodies

    def body(self, body: Body) -> Body:
        return Body(tuple(self.step(step) for step in body.steps))

    def step(self, step: Step) -> Step:
        if isinstance(step, Simple):
            return replace(step, term=self._object(step))
        if isinstance(step, If):
            then, otherwise = self.body(step.then), self.body(step.otherwise)
            return If(self.formula(step.condition), then, otherwise, step.place)
        if isinstance(step, Fork):
            return replace(step, branches=tuple(self.body(branch) for branch in step.branches))
        assert isinstance(step, While | For)  # noqa: S101 — for mypy
        return replace(step, condition=self.formula(step.condition), body=self.body(step.body))

    def _object(self, step: Simple) -> Term:
        """Resolve the names in a step: an action belongs to the body, any other name to the module."""
        if step.does in (Does.ACTION, Does.INTERNAL, Does.VARIABLE):
            return self.term(step.term)
        return self.formula(step.term)

    # ---- formulas and terms

    def formula(self, term: Term) -> Term:
        """A condition: what it asks for belongs to the module."""
        if not isinstance(term, Atom | Structure):
            return self.term(term)
        key = term.predicate
        if key in CONNECTIVES:
            return literal_of(key, tuple(self.formula(part) for part in term.args))
        if key in RELATIONS:
            return self._comparison(term)
        return self.term(term) if is_internal(key.name) or key.name in TRUTH else self.literal(term)

    def _comparison(self, term: Literal) -> Term:
        """Terms are compared as they are; `p(X) =.. L` takes our p apart."""
        left, right = term.args
        taken_apart = term.predicate.name == "=.." and isinstance(left, Structure)
        return Structure(term.predicate, (self.literal(left) if taken_apart else self.term(left), self.term(right)))

    def literal(self, term: Term) -> Term:
        """A belief, goal or event: without a prefix it belongs to the module."""
        if isinstance(term, Var):  # +!G in a module takes the goals of this module
            return Structure(IN_SPACE, (atom(self.space), term)) if self.space else term
        if isinstance(term, Atom | Structure) and not term.predicate.namespace and self._can_be_ours(term.predicate):
            return self._ours(term)
        return self.term(term)

    def _can_be_ours(self, key: Predicate) -> bool:
        return key not in (IN_SPACE, ANNOTATED) and key.name not in OPERATORS and not is_internal(key.name)

    def _ours(self, literal: Literal) -> Literal:
        """The literal in the namespace that it names, or in ours."""
        return self._placed(literal, self.named(literal.predicate.namespace or THIS_SPACE))

    def term(self, term: Term) -> Term:
        """A value: only what has a prefix gets a namespace."""
        if type(term) is Atom and term.functor == THIS_SPACE and not term.predicate.namespace:
            return atom(self.space or DEFAULT_SPACE)
        if isinstance(term, Atom | Structure):
            key = term.predicate
            if key is IN_SPACE:
                return self._in_named_space(term)
            return self._placed(term, self.named(key.namespace) if key.namespace else "")
        if isinstance(term, List):
            return List(map(self.term, term))
        if isinstance(term, OpenList):
            return OpenList(tuple(map(self.term, term.items)), self.term(term.tail))
        return self._code(term) if isinstance(term, Code) else term

    def _placed(self, literal: Literal, space: str) -> Literal:
        key = literal.predicate
        if key.namespace != space:
            key = predicate(key.name, key.arity, key.negated, space)
        args, annots = tuple(map(self.term, literal.args)), tuple(map(self.term, literal.annots))
        return literal_of(key, args, annots)

    def _in_named_space(self, term: Literal) -> Term:
        """`NS::p(X)` or `n::X`"""
        space, inner = term.args
        if isinstance(space, Atom):
            name = self.named(space.functor)
            space = atom(name or DEFAULT_SPACE)
        return Structure(IN_SPACE, (space, self.term(inner)))

    def _code(self, code: Code) -> Code:
        """`{ a; !g }`: a plan body, plan or rule as a value is written in this module, too."""
        content = code.body
        if isinstance(content, Body):
            content = self.body(content)
            return Code(content, {variable: variable for variable in variables_of(content)})
        return Code(self.clause(content), dict(code.scope))


def in_default_space(term: Term) -> Term:
    """A term that stands in no program: `default::x` is x."""
    return Module().term(term)
