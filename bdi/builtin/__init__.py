"""Internal actions and functions. To add one: write it in the module it belongs to, and decorate it."""

from bdi.builtin import beliefs, collections, formulas, functions, goals, lists, plans, strings, time, words
from bdi.builtin.table import ACTIONS, FUNCTIONS, find_builtin

__all__ = [
    "ACTIONS",
    "FUNCTIONS",
    "beliefs",
    "collections",
    "find_builtin",
    "formulas",
    "functions",
    "goals",
    "lists",
    "plans",
    "strings",
    "time",
    "words",
]
