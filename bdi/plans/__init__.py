"""Plans, compiled once."""

from bdi.plans.compiler import Compiler
from bdi.plans.library import CompiledPlan, Library, Options, applies, relevant
from bdi.plans.steps import Doer

__all__ = ["CompiledPlan", "Compiler", "Doer", "Library", "Options", "applies", "relevant"]
