"""Text to program: the grammar is `agentspeak.lark`, this file gives each of its rules a meaning."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Any

from lark import Lark, Token, Transformer, UnexpectedCharacters, UnexpectedInput, UnexpectedToken, v_args
from lark.exceptions import VisitError
from lark.tree import Meta

from bdi.errors import (
    AgentSpeakError,
    AgentSpeakSyntaxError,
    IncludeCircle,
    IncludeNotFound,
    NotALiteral,
    Place,
    UnknownDirective,
)
from bdi.syntax import (
    Belief,
    Body,
    Clause,
    Directive,
    Does,
    For,
    Fork,
    Goal,
    If,
    Plan,
    Program,
    Rule,
    Simple,
    Step,
    Trigger,
    While,
    variables_of,
)
from bdi.terms import (
    AND,
    INTERNAL,
    NEGATIVE,
    NOT,
    OR,
    POSITIVE,
    RELATIONS,
    Atom,
    Code,
    List,
    Literal,
    OpenList,
    String,
    Structure,
    Term,
    Var,
    atom,
    literal_of,
    number,
    predicate,
)

Read = Callable[[Path], str]

# ---- public --------------------------------------------------------------------------------------------------------


def load_program(path: str | Path) -> Program:
    """The program in this file, with everything it includes. Raises AgentSpeakError; OSError if it cannot be read."""
    return parse_program(_read_text(Path(path)), source=str(path))


def parse_program(text: str, source: str = "<text>", read: Read | None = None) -> Program:
    """A program with its includes in place. Included paths are relative to the file that includes them.

    `read` gives the text of an included file (by default from disk). Raises AgentSpeakSyntaxError, IncludeNotFound,
    IncludeCircle, UnknownDirective.
    """
    collected = _Collected(read or _read_text)
    collected.add(text, source, ())
    return Program(
        source,
        tuple(collected.beliefs),
        tuple(collected.goals),
        tuple(_with_own_labels(collected.plans)),
        tuple(collected.sources),
    )


def parse_term(text: str) -> Term:
    """A term or formula. Equal variable names are one variable."""
    built: Term = _parse(text, "formula", "<term>")
    return built


def parse_literal(text: str) -> Literal:
    """A belief, goal or action. Raises AgentSpeakSyntaxError for any other term."""
    term = parse_term(text)
    if not isinstance(term, Atom | Structure) or term.predicate in _NO_LITERALS or term.functor.startswith(INTERNAL):
        raise AgentSpeakSyntaxError(f"{text.strip()!r} is not a literal", Place("<term>", 1, 1, text), ("p(1)",))
    return term


def parse_plan(text: str) -> Plan:
    """One plan, as `.add_plan` takes it; the closing full stop may be left out."""
    clauses = _parse(text if text.rstrip().endswith((".", "}")) else f"{text}.", "program", "<plan>")
    if len(clauses) != 1 or not isinstance(clauses[0], Plan):
        raise AgentSpeakSyntaxError("this is not one plan", Place("<plan>", 1, 1, text), ("+!g : context <- body",))
    return clauses[0]


def parse_event(text: str) -> tuple[Trigger, Literal]:
    """ "+!g(X)", as `.wait` and askHow take it"""
    plan = parse_plan(f"{text}.")
    if isinstance(plan.head, Var):
        raise AgentSpeakSyntaxError("this is not an event with a name", Place("<event>", 1, 1, text), ("+!g",))
    return plan.trigger, plan.head


def term_from(content: Term | str) -> Term:
    """Text is parsed, a term is itself."""
    return parse_term(content) if type(content) is str else content  # type: ignore[return-value]


def literal_from(content: Term | str) -> Literal:
    """A belief, goal or percept. Raises AgentSpeakSyntaxError for text that is none, NotALiteral for another term."""
    if type(content) is str:
        return parse_literal(content)
    if isinstance(content, Atom | Structure):
        return content
    raise NotALiteral(content)


_NO_LITERALS = RELATIONS | {AND, OR, NOT, NEGATIVE, POSITIVE} | {predicate(name, 2) for name in "+-*/"}


# ---- files and includes --------------------------------------------------------------------------------------------


def _read_text(path: Path) -> str:
    return path.read_text(encoding="utf-8")


class _Collected:
    """A program while its files are read, each where it is included."""

    def __init__(self, read: Read) -> None:
        self.read = read
        self.beliefs: list[Belief | Rule] = []
        self.goals: list[Goal] = []
        self.plans: list[Plan] = []
        self.sources: list[str] = []

    def add(self, text: str, source: str, outer: tuple[Path, ...]) -> None:
        self.sources.append(source)
        here = (*outer, Path(source).resolve())
        for clause in _parse(text, "program", source):
            if isinstance(clause, Directive):
                self.obey(clause, Path(source).parent, here)
            else:
                self.keep(clause)

    def keep(self, clause: Clause) -> None:
        if isinstance(clause, Plan):
            self.plans.append(clause)
        elif isinstance(clause, Goal):
            self.goals.append(clause)
        elif isinstance(clause, Belief | Rule):
            self.beliefs.append(clause)

    def obey(self, directive: Directive, folder: Path, here: tuple[Path, ...]) -> None:
        """{ include("file") }"""
        term = directive.term
        if term.functor != "include" or len(term.args) != 1 or not isinstance(term.args[0], String):
            raise UnknownDirective(f"unknown directive {{ {term} }}", directive.place, ('{ include("file.asl") }',))
        path = folder / str.__str__(term.args[0])
        if path.resolve() in here:
            raise IncludeCircle(f"{path} includes itself", directive.place)
        self.add(self.text_of(path, directive), str(path), here)

    def text_of(self, path: Path, directive: Directive) -> str:
        try:
            return self.read(path)
        except (OSError, ValueError) as error:
            reason = getattr(error, "strerror", None) or "not a text file"
            raise IncludeNotFound(f"cannot include {path}: {reason}", directive.place) from error


def _with_own_labels(plans: list[Plan]) -> Iterator[Plan]:
    """Plans without a name get p__1, p__2, … in source order."""
    for count, plan in enumerate(plans, 1):
        if plan.label.functor:
            yield plan
        else:
            yield replace(plan, label=literal_of(predicate(f"p__{count}"), (), plan.label.annots))


# ---- lark ----------------------------------------------------------------------------------------------------------


@lru_cache(maxsize=1)
def _grammar() -> Lark:
    text = (Path(__file__).parent / "agentspeak.lark").read_text(encoding="utf-8")
    return Lark(text, parser="lalr", start=["program", "formula"], propagate_positions=True, maybe_placeholders=False)


def _parse(text: str, start: str, source: str) -> Any:
    try:
        tree = _grammar().parse(text, start=start)
    except UnexpectedInput as error:
        raise _syntax_error(error, text, source) from None
    try:
        return _Builder(text, source).transform(tree)
    except RecursionError:
        raise AgentSpeakSyntaxError("this is nested too deeply", _place(text, source, 1, 1)) from None
    except VisitError as error:
        if isinstance(error.orig_exc, AgentSpeakError):
            raise error.orig_exc from None
        raise


def _place(text: str, source: str, line: int, column: int) -> Place:
    lines = text.split("\n")
    return Place(source, line, column, lines[line - 1] if 0 < line <= len(lines) else "")


def _syntax_error(error: UnexpectedInput, text: str, source: str) -> AgentSpeakSyntaxError:
    """Lark's error in the words of the language."""
    line, column = error.line, error.column
    problem, expected = "the text ends too early", set(getattr(error, "expected", ()))
    if isinstance(error, UnexpectedCharacters):
        problem, expected = f"unexpected character {error.char!r}", error.allowed or set()
    elif isinstance(error, UnexpectedToken) and error.token.type != "$END":
        problem, expected = f"unexpected {str(error.token)!r}", set(error.accepts or expected)
    else:
        line, column = text.count("\n") + 1, len(text) - text.rfind("\n")
    return AgentSpeakSyntaxError(problem, _place(text, source, line, column), _named(expected or set()))


_NAMES = {
    "ATOM": "a name",
    "VARIABLE": "a variable",
    "NUMBER": "a number",
    "STRING": "a string",
    "INTERNAL": "an internal action",
    "RELATION": "a comparison",
    "SUM_SIGN": "'+' or '-'",
    "TRIGGER_SIGN": "a plan",
    "PRODUCT_SIGN": "'*' or '/'",
    "POWER_SIGN": "'**'",
    "GOAL_MARK": "'!' or '?'",
    "NEGATION": "'~'",
    "$END": "the end",
}


def _named(terminals: set[str]) -> tuple[str, ...]:
    """Terminals as people write them, the punctuation first."""
    patterns = {terminal.name: terminal.pattern for terminal in _grammar().terminals}
    names = {_NAMES.get(name) or f"'{patterns[name].value}'" if name in patterns else name for name in terminals}
    return tuple(sorted(names, key=lambda name: (not name.startswith("'"), name)))


# ---- rule by rule --------------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class _Braces:
    """Arguments or annotations on their way to the literal that they belong to."""

    annotations: bool
    terms: tuple[Term, ...]


class _Marked:
    """A part of a plan on its way to the plan."""

    def __init__(self, kind: str, value: Any) -> None:
        self.kind = kind
        self.value = value


@v_args(inline=True)
class _Builder(Transformer[Token, Any]):
    """Builds clauses bottom-up. One variable object for each name within a clause."""

    def __init__(self, text: str, source: str) -> None:
        super().__init__(visit_tokens=False)
        self.lines = text.split("\n")
        self.source = source
        self.variables: dict[str, Var] = {}

    def place(self, meta: Meta) -> Place:
        if meta.empty:
            return Place(self.source)
        return Place(self.source, meta.line, meta.column, self.lines[meta.line - 1])

    # -- clauses

    def program(self, *clauses: Clause | tuple[Plan, ...]) -> list[Clause]:
        kept: list[Clause] = []
        for clause in clauses:
            if not isinstance(clause, tuple):
                kept.append(clause)
            elif kept and isinstance(kept[-1], Plan):
                kept[-1] = replace(kept[-1], subplans=clause)
            else:
                raise AgentSpeakSyntaxError("these sub-plans follow no plan", clause[0].place)
        return kept

    @v_args(meta=True)
    def belief(self, meta: Meta, children: list[Literal]) -> Belief:
        self.variables = {}
        return Belief(children[0], self.place(meta))

    @v_args(meta=True)
    def rule(self, meta: Meta, children: list[Any]) -> Rule:
        self.variables = {}
        return Rule(children[0], children[1], self.place(meta))

    @v_args(meta=True)
    def goal(self, meta: Meta, children: list[Literal]) -> Goal:
        self.variables = {}
        return Goal(children[0], self.place(meta))

    @v_args(meta=True)
    def directive(self, meta: Meta, children: list[Literal]) -> Directive:
        return Directive(children[0], self.place(meta))

    @v_args(meta=True)
    def plan(self, meta: Meta, children: list[Any]) -> Plan:
        self.variables = {}
        parts = {child.kind: child.value for child in children if isinstance(child, _Marked)}
        trigger, head = parts["trigger"]
        body = next((child for child in children if isinstance(child, Body)), Body())
        label = parts.get("label") or atom("")
        return Plan(label, trigger, head, parts.get("context"), body, self.place(meta), parts.get("condition"))

    def subplans(self, *plans: Plan) -> tuple[Plan, ...]:
        return tuple(_with_own_labels(list(plans)))

    def label(self, label: Literal | _Braces) -> _Marked:
        if isinstance(label, _Braces):
            label = literal_of(predicate(""), (), label.terms)
        return _Marked("label", label)

    def trigger(self, *children: Any) -> _Marked:
        *signs, head = children
        return _Marked("trigger", (Trigger("".join(signs)), head))

    def context(self, formula: Term) -> _Marked:
        return _Marked("context", formula)

    def condition(self, formula: Term) -> _Marked:
        return _Marked("condition", formula)

    # -- bodies

    def body(self, *steps: Step) -> Body:
        return Body(steps)

    @v_args(meta=True)
    def formula_step(self, meta: Meta, children: list[Term]) -> Simple:
        """p(1)   .x(1)   X > 2   +b   ++b   -b   --b   -+b   X"""
        return _step_of(children[0], self.place(meta))

    @v_args(meta=True)
    def achieve(self, meta: Meta, children: list[Term]) -> Simple:
        return Simple(Does.ACHIEVE, self.goal_term(children[0], meta), self.place(meta))

    @v_args(meta=True)
    def achieve_apart(self, meta: Meta, children: list[Term]) -> Simple:
        return Simple(Does.ACHIEVE_APART, self.goal_term(children[0], meta), self.place(meta))

    def goal_term(self, term: Term, meta: Meta) -> Term:
        if isinstance(term, Atom | Structure | Var | Code) and getattr(term, "predicate", None) not in _NO_LITERALS:
            return term
        raise AgentSpeakSyntaxError(f"{term} cannot be a goal", self.place(meta), ("a name", "a variable"))

    @v_args(meta=True)
    def test(self, meta: Meta, children: list[Term]) -> Simple:
        return Simple(Does.TEST, children[0], self.place(meta))

    @v_args(meta=True)
    def add_first(self, meta: Meta, children: list[Term]) -> Simple:
        return Simple(Does.ADD_FIRST, _believed(children[0], self.place(meta)), self.place(meta))

    @v_args(meta=True)
    def add_last(self, meta: Meta, children: list[Term]) -> Simple:
        return Simple(Does.ADD_LAST, _believed(children[0], self.place(meta)), self.place(meta))

    @v_args(meta=True)
    def bracket(self, meta: Meta, children: list[Body]) -> Step:
        """( a; b ) is the condition-free `if`."""
        return If(atom("true"), children[0], Body(), self.place(meta))

    @v_args(meta=True)
    def or_fork(self, meta: Meta, children: list[Step]) -> Fork:
        return Fork(False, tuple(_branch(child) for child in children), self.place(meta))

    @v_args(meta=True)
    def and_fork(self, meta: Meta, children: list[Step]) -> Fork:
        return Fork(True, tuple(_branch(child) for child in children), self.place(meta))

    @v_args(meta=True)
    def if_step(self, meta: Meta, children: list[Any]) -> If:
        condition, then, *rest = children
        otherwise = rest[0] if rest else Body()
        return If(condition, then, otherwise if isinstance(otherwise, Body) else Body((otherwise,)), self.place(meta))

    elif_step = if_step

    @v_args(meta=True)
    def while_step(self, meta: Meta, children: list[Any]) -> While:
        return While(children[0], children[1], self.place(meta))

    @v_args(meta=True)
    def for_step(self, meta: Meta, children: list[Any]) -> For:
        return For(children[0], children[1], self.place(meta))

    # -- formulas and terms

    def either(self, left: Term, right: Term) -> Term:
        return Structure(OR, (left, right))

    def both(self, left: Term, right: Term) -> Term:
        return Structure(AND, (left, right))

    def negated(self, formula: Term) -> Term:
        return Structure(NOT, (formula,))

    def operation(self, left: Term, sign: Token, right: Term) -> Term:
        return Structure(predicate(str(sign), 2), (left, right))

    def signed(self, sign: Token, term: Term) -> Term:
        return Structure(NEGATIVE if sign == "-" else POSITIVE, (term,))

    def number(self, token: Token) -> Term:
        return number(float(token)) if any(mark in token for mark in ".eE") else number(int(token))

    def string(self, token: Token) -> Term:
        return String(_unescaped(token[1:-1]))

    def variable(self, token: Token, annots: _Braces | None = None) -> Term:
        if token == "_":  # noqa: S105 — the unnamed variable
            return Var("_")
        return self.variables.setdefault(str(token), Var(str(token)))

    def literal(self, *children: Any) -> Literal:
        negated = children[0] == "~"
        name, *braces = children[1:] if negated else children
        space, _, plain = name.rpartition("::")
        if name.startswith("'"):
            space, plain = "", str(name)  # 'x' is not x: the quotes belong to the name
        return _literal(plain, braces, negated, space)

    def internal(self, name: Token, *braces: _Braces) -> Term:
        return _literal(str(name), list(braces))

    def arguments(self, *terms: Term) -> _Braces:
        return _Braces(False, terms)

    def annotations(self, terms: Term) -> _Braces:
        # [a|T] is kept whole, as the last annotation.
        return _Braces(True, tuple(terms) if isinstance(terms, List) else (terms,))

    def sequence(self, *children: Any) -> Term:
        if children and isinstance(children[-1], _Marked):
            return OpenList(children[:-1], children[-1].value)
        return List(children)

    def tail(self, term: Term) -> _Marked:
        return _Marked("tail", term)

    @v_args(meta=True)
    def code(self, meta: Meta, children: list[Body]) -> Term:
        return Code(children[0], {variable: variable for variable in variables_of(children[0])})


def _literal(name: str, braces: list[_Braces], negated: bool = False, space: str = "") -> Literal:
    args = next((brace.terms for brace in braces if not brace.annotations), ())
    annots = next((brace.terms for brace in braces if brace.annotations), ())
    return literal_of(predicate(name, len(args), negated, space), args, annots)


_ESCAPES = {"n": "\n", "t": "\t", "r": "\r"}


def _unescaped(text: str) -> str:
    if "\\" not in text:
        return text
    parts = iter(text)
    return "".join((_ESCAPES.get(after := next(parts, ""), after)) if char == "\\" else char for char in parts)


def _branch(step: Step) -> Body:
    """A branch of a fork: `(a; b)` counts as its steps."""
    if isinstance(step, If) and step.condition is atom("true"):
        return step.then
    return Body((step,))


_BELIEF_STEPS = {
    (POSITIVE,): Does.ADD,
    (POSITIVE, POSITIVE): Does.ADD_APART,
    (NEGATIVE,): Does.REMOVE,
    (NEGATIVE, NEGATIVE): Does.REMOVE_APART,
    (NEGATIVE, POSITIVE): Does.UPDATE,
}


def _step_of(term: Term, place: Place) -> Simple:
    """What a formula does as a step: signs make it a change of belief."""
    signs, inner = [], term
    while isinstance(inner, Structure) and inner.predicate in (NEGATIVE, POSITIVE):
        signs.append(inner.predicate)
        inner = inner.args[0]
    if signs:
        if tuple(signs) not in _BELIEF_STEPS:
            raise AgentSpeakSyntaxError(f"{term} is no step of a plan", place, ("+b", "-b", "-+b", "++b", "--b"))
        return Simple(_BELIEF_STEPS[tuple(signs)], _believed(inner, place), place)
    return Simple(_deed_of(term, place), term, place)


def _deed_of(term: Term, place: Place) -> Does:
    if isinstance(term, Var | Code):
        return Does.VARIABLE
    if isinstance(term, Atom | Structure):
        if term.predicate in RELATIONS or term.predicate in (AND, OR, NOT) or term.functor in ("true", "false"):
            return Does.CONSTRAINT
        if term.functor.startswith(INTERNAL):
            return Does.INTERNAL
        if term.predicate not in _NO_LITERALS:
            return Does.ACTION
    raise AgentSpeakSyntaxError(f"{term} is no step of a plan", place, ("an action", "a goal", "a belief"))


def _believed(term: Term, place: Place) -> Term:
    good = isinstance(term, Var) or (
        isinstance(term, Atom | Structure)
        and term.predicate not in _NO_LITERALS
        and not term.functor.startswith(INTERNAL)
    )
    if not good:
        raise AgentSpeakSyntaxError(f"{term} cannot be believed", place, ("a name",))
    return term
