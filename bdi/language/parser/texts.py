"""Text to clauses, terms, plans and events."""

from typing import Any

from bdi.language.arithmetic import ArithmeticFailure
from bdi.language.errors import (
    AgentSpeakSyntaxError,
    NotALiteral,
    Place,
)
from bdi.language.parser.clauses import Clauses, Warn
from bdi.language.parser.lalr import Parse, Repairer, Stuck, Token
from bdi.language.parser.namespaces import Module, in_default_space
from bdi.language.parser.steps import NO_LITERALS
from bdi.language.syntax import (
    CompatibilityWarning,
    Plan,
    Trigger,
)
from bdi.language.terms import (
    ANNOTATED,
    IN_SPACE,
    INTERNAL,
    THIS_SPACE,
    Atom,
    Literal,
    Structure,
    Term,
    Var,
)
from bdi.language.unify import resolve

WAITING = frozenset({IN_SPACE, ANNOTATED})  # NS::p, X[a]: which literal it is depends on variables
NOT_NAMED = NO_LITERALS | WAITING


def parse(text: str, start: str, source: str, warn: Warn | None = None) -> Any:
    """Parse a text. With `warn` older notations are read too, and reported to it. Raises AgentSpeakSyntaxError."""
    builder = Clauses(text, source, warn)
    under_way = Parse(text, start, builder, _repairer(builder, warn) if warn else None)
    try:
        return under_way.run()
    except Stuck as stuck:
        from bdi.language.parser.mistakes import mistake  # only for who needs it

        raise mistake(stuck, under_way, builder.places) from None


def _repairer(builder: Clauses, warn: Warn) -> Repairer:
    from bdi.language.parser.repairs import repair

    def repaired(under_way: Parse, token: Token) -> list[Token] | None:
        found = repair(under_way, token)
        if found is None:
            return None
        warn(CompatibilityWarning(builder.places.at(found.start), found.sentence, found.today))
        return found.tokens

    return repaired


def parse_term(text: str) -> Term:
    """A term or formula. Equal variable names are one variable."""
    built: Term = parse(text, "formula", "<term>")
    return in_default_space(built) if THIS_SPACE in text or "::" in text else built


def parse_literal(text: str) -> Literal:
    """A belief, goal or action. Raises AgentSpeakSyntaxError for any other term."""
    term = parse_term(text)
    if not isinstance(term, Atom | Structure) or term.predicate in NOT_NAMED or term.functor.startswith(INTERNAL):
        raise AgentSpeakSyntaxError(f"{text.strip()!r} is not a literal", Place("<term>", 1, 1, text), ("p(1)",))
    return term


def parse_plan(text: str) -> Plan:
    """One plan, as `.add_plan` takes it; the closing full stop may be left out."""
    clauses = parse(text if text.rstrip().endswith((".", "}")) else f"{text}.", "program", "<plan>")
    if len(clauses) != 1 or not isinstance(clauses[0], Plan):
        raise AgentSpeakSyntaxError("this is not one plan", Place("<plan>", 1, 1, text), ("+!g : context <- body",))
    return Module().plan(clauses[0]) if "::" in text else clauses[0]


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
    """A belief, goal or percept, with its sums worked out. Raises AgentSpeakSyntaxError for text that is none,
    NotALiteral for another term, and for one with something in it that is no term or cannot be worked out."""
    given: Any = parse_literal(content) if type(content) is str else content
    try:
        value = resolve(given)
    except (ArithmeticFailure, KeyError, RecursionError) as problem:
        raise NotALiteral(content, problem) from problem
    if isinstance(value, Atom | Structure) and value.predicate not in WAITING:
        return value
    raise NotALiteral(content)
