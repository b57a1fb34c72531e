"""A mind for hire: AgentSpeak programs with the meaning that Jason gives them, one reasoning cycle at a time."""

from bdi.agent import Agent
from bdi.errors import (
    AgentSpeakError,
    AgentSpeakSyntaxError,
    BdiError,
    IncludeCircle,
    IncludeNotFound,
    NotALiteral,
    Place,
    UnknownAction,
    UnknownActionId,
    UnknownDirective,
    UnknownInternalAction,
    UnknownPerformative,
)
from bdi.explain import Why
from bdi.messages import Finished, Message
from bdi.outcome import Action, GoalFailure, Outcome
from bdi.parser import load_program, parse_literal, parse_plan, parse_program, parse_term
from bdi.syntax import Program
from bdi.terms import Atom, List, Literal, String, Structure, Term, Var, atom, show, structure
from bdi.trace import Deliberated, Failed, Stepped, TraceEntry

__all__ = [
    "Action",
    "Agent",
    "AgentSpeakError",
    "AgentSpeakSyntaxError",
    "Atom",
    "BdiError",
    "Deliberated",
    "Failed",
    "Finished",
    "GoalFailure",
    "IncludeCircle",
    "IncludeNotFound",
    "List",
    "Literal",
    "Message",
    "NotALiteral",
    "Outcome",
    "Place",
    "Program",
    "Stepped",
    "String",
    "Structure",
    "Term",
    "TraceEntry",
    "UnknownAction",
    "UnknownActionId",
    "UnknownDirective",
    "UnknownInternalAction",
    "UnknownPerformative",
    "Var",
    "Why",
    "atom",
    "load_program",
    "parse_literal",
    "parse_plan",
    "parse_program",
    "parse_term",
    "show",
    "structure",
]
