"""Internal actions and functions on terms: lists, strings, containers, annotations, formulas, numbers.

Uses the tools of `builtin` (`table`, `kinds`, `arguments`). Start with `lists`.
"""
