"""Internal actions and functions.

Uses `model` and `language`. To add one: write it in the module it belongs to and decorate it; start with `table`.
"""

from bdi.builtin import statements
from bdi.builtin.agent_state import beliefs, events, goals, namespaces, plans
from bdi.builtin.outside import agents, chance, clock, messages, printing, time
from bdi.builtin.table import ACTIONS, FUNCTIONS, STANDARD, Definition, Table, find_builtin
from bdi.builtin.terms import annotations, collections, formulas, functions, lists, strings, types
from bdi.builtin.unsupported import NOT_SUPPORTED

__all__ = [
    "ACTIONS",
    "FUNCTIONS",
    "NOT_SUPPORTED",
    "STANDARD",
    "Definition",
    "Table",
    "agents",
    "annotations",
    "beliefs",
    "chance",
    "clock",
    "collections",
    "events",
    "find_builtin",
    "formulas",
    "functions",
    "goals",
    "lists",
    "messages",
    "namespaces",
    "plans",
    "printing",
    "statements",
    "strings",
    "time",
    "types",
]
