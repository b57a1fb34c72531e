"""Formulas over what is believed, compiled once."""

from bdi.logic.frames import Builtin, Frame, Known, Question, Scope
from bdi.logic.functions import Compiled
from bdi.logic.logic import HasLogic, Logic

__all__ = ["Builtin", "Compiled", "Frame", "HasLogic", "Known", "Logic", "Question", "Scope"]
