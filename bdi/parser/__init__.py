"""Text to program."""

from bdi.parser.programs import load_program, parse_program
from bdi.parser.texts import literal_from, parse_event, parse_literal, parse_plan, parse_term, term_from

__all__ = [
    "literal_from",
    "load_program",
    "parse_event",
    "parse_literal",
    "parse_plan",
    "parse_program",
    "parse_term",
    "term_from",
]
