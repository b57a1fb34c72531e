"""Formulas that are asked: `.findall`, `.count`, `.eval`, …"""

from bdi.builtin.arguments import bind, unique
from bdi.builtin.kinds import ANY, FORMULA, OUT
from bdi.builtin.table import Answer, function, internal_action
from bdi.language.terms import List, Term, atom
from bdi.language.unify import unify
from bdi.model.logic import HasLogic, Question


@internal_action("findall", FORMULA, FORMULA, OUT)
def findall(mind: HasLogic, template: Question, formula: Question, result: Term) -> Answer:
    return bind(mind, result, List(formula.answers(template)))


@internal_action("setof", FORMULA, FORMULA, OUT)
def setof(mind: HasLogic, template: Question, formula: Question, result: Term) -> Answer:
    return bind(mind, result, unique(formula.answers(template)))


@internal_action("count", FORMULA, OUT)
def count(mind: HasLogic, formula: Question, result: Term) -> Answer:
    return bind(mind, result, len(formula.answers(formula)))


@function(".count", ANY, asks=True)
def count_of(mind: HasLogic, formula: Term) -> int:
    """`.count(p(_)) + 1`: how many answers there are."""
    return mind.logic.count(formula)


@internal_action("eval", OUT, FORMULA)
def evaluate(mind: HasLogic, result: Term, formula: Question) -> Answer:
    return unify(result, atom("true" if formula.first() else "false"), mind.logic.trail)
