"""The parser: text to program.

Uses `language` only; the grammar is `agentspeak.lark`. Start with `programs` (files) and `texts` (one term or plan).
"""

from bdi.language.parser.includes import Includes
from bdi.language.parser.programs import load_module, load_program, parse_program
from bdi.language.parser.texts import literal_from, parse_event, parse_literal, parse_plan, parse_term, term_from

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
