"""Plans, compiled once: head and context to one function, the body to a chain of steps.

Uses `language`, `logic`, `beliefs` and `intentions`. Start with `compiler`, then `steps`.
"""

from bdi.model.plans.compiler import Compiler
from bdi.model.plans.library import CompiledPlan, Library, Options, applies, relevant
from bdi.model.plans.steps import Doer

__all__ = ["CompiledPlan", "Compiler", "Doer", "Library", "Options", "applies", "relevant"]
