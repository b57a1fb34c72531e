"""AgentSpeak programs with the meaning that Jason gives them, one reasoning cycle at a time.

Uses Lark, and nothing else of this checkout: no robot, clock or thread. What callers need is exported here; start with
`Agent.cycle`, or with the table of packages in README.md.
"""

from bdi.builtin.user_actions import InternalActions
from bdi.communication.system import MultiAgentSystem, Stimuli
from bdi.debug.explain import Why
from bdi.debug.trace import Changed, Deliberated, Failed, GoalFailure, Stepped, TraceEntry, Verdict
from bdi.language.errors import (
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
from bdi.language.parser import Includes, load_program, parse_literal, parse_plan, parse_program, parse_term
from bdi.language.syntax import Program
from bdi.language.terms import Atom, List, Literal, String, Structure, Term, Var, atom, show, structure
from bdi.model.messages import Finished, Message
from bdi.model.mind import Mind
from bdi.reasoning.agent import Agent
from bdi.reasoning.output import Action, Outcome
from bdi.reasoning.perception import Drain, Latest, Perception

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
    "Mind",
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
