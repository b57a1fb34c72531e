"""Plans, compiled once: head and context to one function, the body to a chain of steps.

Uses `language`, `logic`, `beliefs` and `intentions`. Start with `compiler`, then `steps`.
"""

from bdi.model.plans.compiler import Compiler
from bdi.model.plans.library import CompiledPlan, Library, Options, applies, relevant
from bdi.model.plans.steps import Effects

__all__ = ["CompiledPlan", "Compiler", "Effects", "Library", "Options", "applies", "relevant"]
