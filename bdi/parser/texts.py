"""Text to clauses, terms, plans and events."""

from typing import Any

from lark import UnexpectedInput
from lark.exceptions import VisitError

from bdi.errors import (
    AgentSpeakError,
    AgentSpeakSyntaxError,
    NotALiteral,
    Place,
)
from bdi.parser.clauses import Clauses
from bdi.parser.grammar import grammar, place_in, syntax_error
from bdi.parser.steps import NO_LITERALS
from bdi.syntax import (
    Plan,
    Trigger,
)
from bdi.terms import (
    INTERNAL,
    Atom,
    Literal,
    Structure,
    Term,
    Var,
)


def parse(text: str, start: str, source: str) -> Any:
    try:
        tree = grammar().parse(text, start=start)
    except UnexpectedInput as error:
        raise syntax_error(error, text, source) from None
    try:
        return Clauses(text, source).transform(tree)
    except RecursionError:
        raise AgentSpeakSyntaxError("this is nested too deeply", place_in(text, source, 1, 1)) from None
    except VisitError as error:
        if isinstance(error.orig_exc, AgentSpeakError):
            raise error.orig_exc from None
        raise


def parse_term(text: str) -> Term:
    """A term or formula. Equal variable names are one variable."""
    built: Term = parse(text, "formula", "<term>")
    return built


def parse_literal(text: str) -> Literal:
    """A belief, goal or action. Raises AgentSpeakSyntaxError for any other term."""
    term = parse_term(text)
    if not isinstance(term, Atom | Structure) or term.predicate in NO_LITERALS or term.functor.startswith(INTERNAL):
        raise AgentSpeakSyntaxError(f"{text.strip()!r} is not a literal", Place("<term>", 1, 1, text), ("p(1)",))
    return term


def parse_plan(text: str) -> Plan:
    """One plan, as `.add_plan` takes it; the closing full stop may be left out."""
    clauses = parse(text if text.rstrip().endswith((".", "}")) else f"{text}.", "program", "<plan>")
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
