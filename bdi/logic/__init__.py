"""Terms and formulas, compiled once."""

from bdi.logic.formulas import HasLogic, Logic
from bdi.logic.frames import Build, Builtin, Frame, Known, Match, Question, Scope, Solve, succeed

__all__ = ["Build", "Builtin", "Frame", "HasLogic", "Known", "Logic", "Match", "Question", "Scope", "Solve", "succeed"]
