"""Rules that ask themselves before anything else."""

from collections.abc import Iterator

from bdi.language.syntax import Belief, Program, Rule
from bdi.language.terms import AND, NOT, OR, RELATIONS, Atom, Predicate, Structure, Term, is_internal
from bdi.tools.checks.findings import Finding, Severity
from bdi.tools.checks.reading import Reading


def endless_rules(reading: Reading) -> Iterator[Finding]:
    """A rule whose first question leads back to itself with nothing before it that could answer."""
    for number, clause in enumerate(reading.program.beliefs):
        if not isinstance(clause, Rule) or not _leads_back(reading, clause):
            continue
        key = clause.head.predicate
        others = [each for each in _clauses(reading.program, key) if each is not clause]
        base = [each for each in others if not isinstance(each, Rule) or not _leads_back(reading, each)]
        before = [each for each in reading.program.beliefs[:number] if each in base]
        if not base:
            problem = f"asking {key.name} never ends: its rule asks itself first, and no other clause answers"
            yield Finding("endless-rule", Severity.ERROR, clause.place, problem, "add a fact or a rule that ends it")
        else:
            when = "once the other clauses have no more answers" if before else "before the other clauses are asked"
            problem = f"this rule asks itself first: it never ends {when}"
            advice = "ask something else first, so that each step is nearer to the end"
            yield Finding("endless-rule", Severity.WARNING, clause.place, problem, advice)


def _clauses(program: Program, key: Predicate) -> list[Belief | Rule]:
    return [
        clause
        for clause in program.beliefs
        if (clause.head if isinstance(clause, Rule) else clause.literal).predicate is key
    ]


def _leads_back(reading: Reading, rule: Rule) -> bool:
    seen: set[Predicate] = set()
    waiting = _first_asked(rule.formula)
    while waiting:
        key = waiting.pop()
        if key is rule.head.predicate:
            return True
        if key not in seen:
            seen.add(key)
            for other in reading.rules:
                if other.head.predicate is key:
                    waiting += _first_asked(other.formula)
    return False


def _first_asked(formula: Term) -> list[Predicate]:
    """The predicates that may be asked first of all."""
    if not isinstance(formula, Atom | Structure):
        return []
    key = formula.predicate
    if key in (AND, NOT):
        return _first_asked(formula.args[0])
    if key is OR:
        return [first for side in formula.args for first in _first_asked(side)]
    return [] if key in RELATIONS or is_internal(key.name) else [key]
