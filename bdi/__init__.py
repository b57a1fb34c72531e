"""A mind for hire: AgentSpeak programs with the meaning that Jason gives them, one reasoning cycle at a time."""

from bdi.agent import Agent
from bdi.errors import (
    AgentSpeakError,
    AgentSpeakSyntaxError,
    BdiError,
    DuplicateAgent,
    IncludeCircle,
    IncludeNotFound,
    NotALiteral,
    OtherSensor,
    Place,
    UnknownAction,
    UnknownActionId,
    UnknownAgent,
    UnknownDirective,
    UnknownInternalAction,
    UnknownPerformative,
)
from bdi.explain import Why
from bdi.messages import Finished, Message
from bdi.outcome import Action, GoalFailure, Outcome
from bdi.parser import Includes, load_program, parse_literal, parse_plan, parse_program, parse_term
from bdi.perception import Drain, Latest, Perception
from bdi.syntax import Program
from bdi.system import MultiAgentSystem, Stimuli
from bdi.terms import Atom, List, Literal, String, Structure, Term, Var, atom, show, structure
from bdi.trace import Changed, Deliberated, Failed, Stepped, TraceEntry, Verdict
from bdi.user_actions import InternalActions

__all__ = [
    "Action",
    "Agent",
    "AgentSpeakError",
    "AgentSpeakSyntaxError",
    "Atom",
    "BdiError",
    "Changed",
    "Deliberated",
    "Drain",
    "DuplicateAgent",
    "Failed",
    "Finished",
    "GoalFailure",
    "IncludeCircle",
    "IncludeNotFound",
    "Includes",
    "InternalActions",
    "Latest",
    "List",
    "Literal",
    "Message",
    "MultiAgentSystem",
    "NotALiteral",
    "OtherSensor",
    "Outcome",
    "Perception",
    "Place",
    "Program",
    "Stepped",
    "Stimuli",
    "String",
    "Structure",
    "Term",
    "TraceEntry",
    "UnknownAction",
    "UnknownActionId",
    "UnknownAgent",
    "UnknownDirective",
    "UnknownInternalAction",
    "UnknownPerformative",
    "Var",
    "Verdict",
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
