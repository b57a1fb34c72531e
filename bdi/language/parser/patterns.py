"""Goals by pattern: `{ begin bdg(g) } … { end }` turns the plans of the block into plans for a declarative goal.

The patterns are those of Hübner, Bordini and Wooldridge, "Programming Declarative Goals Using Plan Patterns" (DALT
2006), also in chapter 8 of "Programming Multi-Agent Systems in AgentSpeak using Jason". A declarative goal is reached
once `g` is believed, however that came about.

dg(g)        declarative: a plan that ends without g being believed has failed
bdg(g)       backtracking: after a failure again, as long as a plan is applicable
ebdg(g)      exclusive backtracking: each plan once
bc(g)        blind commitment: again and again until g is believed; bc(g,ebdg) on top of another pattern
smc(g,f)     single-minded: blind, but given up once f is believed
rc(g,m)      relativised: blind, but dropped (it counts as reached) once the motive m is believed no longer
omc(g,f,m)   open-minded: both
mg(g)        maintained: pursued at the start, and whenever g is believed no longer; mg(g,bdg) by another pattern
sga(t,c,g)   sequenced: event t under condition c asks for g; one such goal at a time, the others wait for their turn
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from typing import TypeGuard

from bdi.language.errors import AgentSpeakSyntaxError, Place
from bdi.language.parser.steps import NO_LITERALS
from bdi.language.parser.texts import parse
from bdi.language.syntax import Body, Clause, Directive, Does, Goal, Plan, Simple, Trigger
from bdi.language.terms import (
    AND,
    IN_SPACE,
    NOT,
    THIS_SPACE,
    Atom,
    Code,
    Literal,
    String,
    Structure,
    Term,
    Var,
    atom,
    is_internal,
    literal_of,
    predicate,
    show,
    structure,
)
from bdi.language.unify import substituted, variables_in

TRIED = "tried__plan"  # tried__plan(number,goal): this plan has had its turn for this goal
WANTED = "wanted__goal"  # wanted__goal(goal): it is pursued, or waits for its turn
PURSUE = "pursue__goal"


@dataclass(slots=True)
class Pursuit:
    """The plans of one goal while a pattern is put together."""

    goal: Literal
    place: Place
    unless: Term | None = None  # what makes the goal hopeless: then nothing is tried again
    others: list[Clause] = field(default_factory=list)  # clauses of the block that are no plans for the goal
    plans: list[Plan] = field(default_factory=list)
    retries: list[Plan] = field(default_factory=list)
    last_resort: list[Plan] = field(default_factory=list)
    at_the_end: list[Simple] = field(default_factory=list)  # what is tidied up once the goal is reached

    def clauses(self) -> list[Clause]:
        reached = self.plan(Trigger.GOAL_ADDED, self.goal, self.goal)
        succeed = self.plan(
            Trigger.BELIEF_ADDED, self.goal, None, *self.at_the_end, self.about("succeed_goal", self.goal)
        )
        return [*self.others, reached, *self.plans, *self.retries, *self.last_resort, succeed]

    def plan(self, trigger: Trigger, head: Literal, context: Term | None, *steps: Simple) -> Plan:
        return Plan(atom(""), trigger, head, context, Body(steps), self.place)

    def step(self, does: Does, term: Term) -> Simple:
        return Simple(does, term, self.place)

    def call(self, name: str, *args: Term) -> Simple:
        return self.step(Does.INTERNAL, structure(f".{name}", *args))

    def about(self, name: str, literal: Literal) -> Simple:
        """.name(::literal): a belief or goal of this module"""
        key = literal.predicate
        if not key.namespace:
            key = predicate(key.name, key.arity, key.negated, THIS_SPACE)
        return self.call(name, literal_of(key, literal.args, literal.annots))

    def give_up(self, *steps: Simple) -> Plan:
        """-!g <- .fail, as last plan: the failure goes on to the plan that wanted the goal."""
        error, message = structure("error", Var("E")), structure("error_msg", Var("M"))
        failed = Structure(self.goal.predicate, self.goal.args, (error, message))
        return self.plan(Trigger.GOAL_FAILED, failed, None, *steps, self.call("fail", error, message))

    def retry(self, goal: Literal, context: Term | None) -> Plan:
        """-!g : context <- !g"""
        hopeful = None if self.unless is None else Structure(NOT, (self.unless,))
        return self.plan(Trigger.GOAL_FAILED, goal, _both(hopeful, context), self.step(Does.ACHIEVE, goal))


def declarative(pursuit: Pursuit, clauses: Iterable[Clause]) -> None:
    """+!g : g.   +!g : c <- b; ?g.   +g <- .succeed_goal(g)."""
    for clause in clauses:
        if isinstance(clause, Plan) and _is_for(clause, pursuit.goal):
            body = Body((*clause.body.steps, Simple(Does.TEST, _bare(clause), clause.place)))
            pursuit.plans.append(replace(clause, body=body))
        else:
            pursuit.others.append(clause)


def backtracking(pursuit: Pursuit, clauses: Iterable[Clause]) -> None:
    """Besides, for each plan: -!g : c <- !g; and last of all -!g <- .fail."""
    declarative(pursuit, clauses)
    pursuit.retries = [pursuit.retry(_bare(plan), plan.context) for plan in pursuit.plans]
    pursuit.last_resort = [pursuit.give_up()]


def exclusive(pursuit: Pursuit, clauses: Iterable[Clause]) -> None:
    """+!g : not tried(i,g) & c <- +tried(i,g); b; ?g.   -!g : not tried(i,g) & c <- !g."""
    declarative(pursuit, clauses)
    plans, pursuit.plans = pursuit.plans, []
    for number, plan in enumerate(plans, 1):
        mark = _tried(number, _bare(plan))
        context = _both(Structure(NOT, (mark,)), plan.context)
        body = Body((Simple(Does.ADD, mark, plan.place), *plan.body.steps))
        pursuit.plans.append(replace(plan, context=context, body=body))
        pursuit.retries.append(pursuit.retry(_bare(plan), context))
    forget = pursuit.about("abolish", _tried(Var("_"), pursuit.goal))
    pursuit.at_the_end.append(forget)
    pursuit.last_resort.append(pursuit.give_up(forget))


def blind(pursuit: Pursuit, clauses: Iterable[Clause], first: "Build" = backtracking) -> None:
    """Besides, last of all: +!g <- !g.   -!g <- !g."""
    first(pursuit, clauses)
    goal = pursuit.goal
    again = pursuit.retry(goal, None)
    pursuit.last_resort = [replace(again, body=Body((*pursuit.at_the_end, *again.body.steps))), pursuit.give_up()]
    hopeful = replace(again, trigger=Trigger.GOAL_ADDED)
    pursuit.plans.append(hopeful)


Build = Callable[..., None]
Pattern = Callable[[Directive, tuple[Clause, ...]], Iterable[Clause]]
BUILDS: dict[str, Build] = {"dg": declarative, "bdg": backtracking, "ebdg": exclusive, "bc": blind}


def goal_of(directive: Directive, clauses: tuple[Clause, ...]) -> list[Clause]:
    """dg(g)   bdg(g)   ebdg(g)"""
    (goal,) = _literals(directive, 1)
    pursuit = Pursuit(goal, directive.place)
    BUILDS[directive.term.functor](pursuit, clauses)
    return pursuit.clauses()


def blind_commitment(directive: Directive, clauses: tuple[Clause, ...]) -> list[Clause]:
    """bc(g)   bc(g,ebdg)"""
    goal, first = _goal_and_pattern(directive, "bdg")
    pursuit = Pursuit(goal, directive.place)
    blind(pursuit, clauses, first)
    return pursuit.clauses()


def commitment(directive: Directive, clauses: tuple[Clause, ...]) -> list[Clause]:
    """smc(g,f): +f <- .fail_goal(g).   rc(g,m): -m <- .succeed_goal(g).   omc(g,f,m): both."""
    name = directive.term.functor
    goal, *reasons = _literals(directive, 3 if name == "omc" else 2)
    hopeless = reasons[0] if name != "rc" else None
    pursuit = Pursuit(goal, directive.place, hopeless)
    blind(pursuit, clauses)
    built = pursuit.clauses()
    if hopeless is not None:
        built.append(pursuit.plan(Trigger.BELIEF_ADDED, hopeless, None, pursuit.about("fail_goal", goal)))
    if name != "smc":
        built.append(pursuit.plan(Trigger.BELIEF_REMOVED, reasons[-1], None, pursuit.about("succeed_goal", goal)))
    return built


def maintained(directive: Directive, clauses: tuple[Clause, ...]) -> list[Clause]:
    """!g.   -g <- !g."""
    goal, build = _goal_and_pattern(directive, "bc")
    pursuit = Pursuit(goal, directive.place)
    build(pursuit, clauses)
    lost = pursuit.plan(Trigger.BELIEF_REMOVED, goal, None, pursuit.step(Does.ACHIEVE, goal))
    return [Goal(goal, directive.place), lost, *pursuit.clauses()]


def sequenced(directive: Directive, clauses: tuple[Clause, ...]) -> list[Clause]:
    """t : not wanted(_) & c <- ++wanted(g); !!pursue(g).   t : c <- +>wanted(g).

    +!pursue(g) <- !g; -wanted(g).   -!pursue(g) <- -wanted(g).   -wanted(_) : wanted(G) <- !!pursue(G).
    """
    asked, goal = _event_and_goal(directive)
    pursuit, place = Pursuit(goal, directive.place), directive.place
    wanted, pursue, other = structure(WANTED, goal), structure(PURSUE, goal), Var("G")
    not_wanted = Structure(NOT, (structure(WANTED, Var("_")),))
    done = pursuit.step(Does.REMOVE, wanted)
    # The first step is taken at once: a second event cannot slip in between.
    start = Body((Simple(Does.ADD_APART, wanted, place), Simple(Does.ACHIEVE_APART, pursue, place)))
    at_once = literal_of(predicate(""), (), (atom("atomic"),))
    wait = Body((Simple(Does.ADD_LAST, wanted, place),))
    next_one = pursuit.step(Does.ACHIEVE_APART, structure(PURSUE, other))
    return [
        replace(asked, label=at_once, context=_both(not_wanted, asked.context), body=start),
        replace(asked, body=wait),
        pursuit.plan(Trigger.GOAL_ADDED, pursue, None, pursuit.step(Does.ACHIEVE, goal), done),
        pursuit.plan(Trigger.GOAL_FAILED, pursue, None, done),
        pursuit.plan(Trigger.BELIEF_REMOVED, structure(WANTED, Var("_")), structure(WANTED, other), next_one),
        *clauses,
    ]


PATTERNS: dict[str, Pattern] = {
    "dg": goal_of,
    "bdg": goal_of,
    "ebdg": goal_of,
    "bc": blind_commitment,
    "smc": commitment,
    "rc": commitment,
    "omc": commitment,
    "mg": maintained,
    "sga": sequenced,
}
USAGE = {"sga": 'sga("+event","condition",goal)', "smc": "smc(goal,failure)", "rc": "rc(goal,motive)"} | {
    "omc": "omc(goal,failure,motive)",
    "bc": "bc(goal) or bc(goal,ebdg)",
    "mg": "mg(goal) or mg(goal,bdg)",
}


# ---- arguments -----------------------------------------------------------------------------------------------------


def _wrong(directive: Directive) -> AgentSpeakSyntaxError:
    name = directive.term.functor
    problem = f"{{ begin {directive.term} }} has the wrong arguments"
    return AgentSpeakSyntaxError(problem, directive.place, (USAGE.get(name, f"{name}(goal)"),))


def _literals(directive: Directive, count: int) -> tuple[Literal, ...]:
    args = directive.term.args
    found = tuple(arg for arg in args if _is_literal(arg))
    if len(args) != count or len(found) != count:
        raise _wrong(directive)
    return found


def _is_literal(term: Term) -> TypeGuard[Literal]:
    """Return whether it can be believed and wanted: no comparison, no `NS::p`."""
    if not isinstance(term, Atom | Structure):
        return False
    return term.predicate not in NO_LITERALS and term.predicate is not IN_SPACE and not is_internal(term.functor)


def _goal_and_pattern(directive: Directive, usual: str) -> tuple[Literal, Build]:
    """(g), (g,ebdg) or (g,ebdg(g))"""
    goal, *inner = _literals(directive, len(directive.term.args))
    name = inner[0].functor if inner else usual
    if len(inner) > 1 or name not in BUILDS or name == directive.term.functor:
        raise _wrong(directive)
    return goal, BUILDS[name]


def _event_and_goal(directive: Directive) -> tuple[Plan, Literal]:
    """The event and condition of sga, given as texts, as a plan without body; equal names are one variable."""
    if len(directive.term.args) != 3:
        raise _wrong(directive)
    event, condition = (_text_of(arg) for arg in directive.term.args[:2])
    goal = directive.term.args[2]
    try:
        (asked,) = parse(f"{event} : {condition}.", "program", directive.place.source)
    except (AgentSpeakSyntaxError, ValueError):
        raise _wrong(directive) from None
    if not isinstance(asked, Plan) or not _is_literal(goal):
        raise _wrong(directive)
    names = {each.name: each for part in (asked.head, asked.context) if part is not None for each in variables_in(part)}
    values: dict[Var, Term] = {each: names.get(each.name, each) for each in variables_in(goal)}
    context = None if asked.context is atom("true") else asked.context
    return replace(asked, place=directive.place, context=context), substituted(goal, values)  # type: ignore[return-value]


def _text_of(term: Term) -> str:
    if isinstance(term, Code):
        return str(term.body).rstrip(".")
    return str.__str__(term) if isinstance(term, String) else show(term)


# ---- plans for a goal ----------------------------------------------------------------------------------------------


def _is_for(plan: Plan, goal: Literal) -> bool:
    head = plan.head
    return plan.trigger is Trigger.GOAL_ADDED and not isinstance(head, Var) and head.predicate is goal.predicate


def _bare(plan: Plan) -> Literal:
    """The goal that a plan is for, without annotations: they say who asked."""
    assert not isinstance(plan.head, Var)  # noqa: S101 — see `_is_for`
    return literal_of(plan.head.predicate, plan.head.args)


def _both(left: Term | None, right: Term | None) -> Term | None:
    return Structure(AND, (left, right)) if left is not None and right is not None else left or right


def _tried(number: Term, goal: Literal) -> Literal:
    return structure(TRIED, number, goal)
