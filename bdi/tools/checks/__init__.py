"""Checks of a program for mistakes and likely mistakes, without running it.

Uses `language` and `builtin`. Start with `reading` (what a program does with each name); the others are checks.
"""

from collections.abc import Collection

from bdi.language.syntax import Program
from bdi.tools.checks import failures, goals, names, plans, rules, variables
from bdi.tools.checks.findings import Finding, Severity
from bdi.tools.checks.reading import read

__all__ = ["Finding", "Severity", "findings_of"]

CHECKS = (
    goals.goals_without_plan,
    goals.goals_without_default,
    failures.failures_without_plan,
    plans.shadowed_plans,
    plans.uncalled_plans,
    plans.same_labels,
    plans.unreached_steps,
    names.look_alikes,
    names.forgotten_marks,
    variables.lone_variables,
    rules.endless_rules,
)


def findings_of(program: Program, percepts: Collection[str] | None = None) -> list[Finding]:
    """Return findings in the order of the program. `percepts` are the names, or name/arity, that the body declares."""
    reading = read(program)
    found = [finding for check in CHECKS for finding in check(reading)]
    found += goals.unknown_beliefs(reading, percepts)
    order = {source: number for number, source in enumerate(program.sources)}
    return sorted(
        dict.fromkeys(found),
        key=lambda each: (order.get(each.place.source, 0), each.place.line, each.severity, each.place.column),
    )
