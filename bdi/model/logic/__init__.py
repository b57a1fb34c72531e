"""Formulas over beliefs, compiled once to Python functions.

Uses `language`, `beliefs` and `intentions`. Start with `logic` (questions), then `formulas` (the generated code).
"""

from bdi.model.logic.frames import Builtin, Frame, Known, Question, Scope
from bdi.model.logic.functions import Compiled
from bdi.model.logic.logic import HasLogic, Logic

__all__ = ["Builtin", "Compiled", "Frame", "HasLogic", "Known", "Logic", "Question", "Scope"]
