"""Text to program."""

from bdi.parser.includes import Includes
from bdi.parser.programs import load_module, load_program, parse_program
from bdi.parser.texts import literal_from, parse_event, parse_literal, parse_plan, parse_term, term_from

__all__ = [
    "Includes",
    "literal_from",
    "load_module",
    "load_program",
    "parse_event",
    "parse_literal",
    "parse_plan",
    "parse_program",
    "parse_term",
    "term_from",
]
