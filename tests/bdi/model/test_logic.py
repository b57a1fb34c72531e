"""Compiled formulas give the answers that the language means: all of them, in order, wherever a formula may stand.

The meaning is written down here once more, in the plainest way (unify, try, take back), and compared on formulas and
beliefs that hypothesis makes up.
"""

from collections.abc import Iterator, Sequence

import pytest
from hypothesis import HealthCheck, given, reject, settings
from hypothesis import strategies as st

from bdi import Agent, Finished, Message, Term, Var, parse_program, parse_term, show
from bdi.language.arithmetic import ArithmeticFailure
from bdi.language.terms import AND, NOT, OR, RELATIONS, List, Structure, atom
from bdi.language.unify import Trail, compare, renamed, resolve, undo, unify, unify_annots, variables_in

# ---- the meaning ---------------------------------------------------------------------------------------------------

Fact = tuple[Term, Term | None]  # a belief, or a rule with its formula


def answers(formula: Term, facts: list[Fact], trail: Trail) -> Iterator[None]:
    """Once for every way in which the formula is true, while its bindings hold. Facts: the newest first."""
    key = formula.predicate  # type: ignore[union-attr]
    mark = len(trail)
    if key is AND:
        for _ in answers(formula.args[0], facts, trail):  # type: ignore[union-attr]
            yield from answers(formula.args[1], facts, trail)  # type: ignore[union-attr]
    elif key is OR:
        for side in formula.args:  # type: ignore[union-attr]
            yield from answers(side, facts, trail)
            undo(trail, mark)
    elif key is NOT:
        found = any(True for _ in answers(formula.args[0], facts, trail))  # type: ignore[union-attr]
        undo(trail, mark)
        if not found:
            yield
    elif key in RELATIONS:
        if compared(key.name, *formula.args, trail):  # type: ignore[union-attr, call-arg]
            yield
    elif key.name.startswith("."):
        yield from asked(key.name, formula.args, facts, trail)  # type: ignore[union-attr]
    else:
        yield from believed(formula, facts, trail)
    undo(trail, mark)


def asked(name: str, args: Sequence[Term], facts: list[Fact], trail: Trail) -> Iterator[None]:
    """Internal actions."""
    mark = len(trail)
    choices = [QUESTIONS[name](args, facts, trail)] if name in QUESTIONS else members(args)
    for value, wanted in choices:
        if unify(wanted, value, trail):
            for variable in trail[mark:]:
                variables_in(variable)  # without end where X = f(X), and told in `meant`
            yield
        undo(trail, mark)


def members(args: Sequence[Term]) -> list[tuple[Term, Term]]:
    """.member(Item,List)"""
    items = resolve(args[1])
    assert isinstance(items, List)
    return [(item, args[0]) for item in items]


def all_found(args: Sequence[Term], facts: list[Fact], trail: Trail) -> tuple[Term, Term]:
    """.findall(Template,Formula,List)"""
    mark = len(trail)
    found = [renamed(args[0], {}) for _ in answers(args[1], facts, trail)]
    undo(trail, mark)
    return List(found), args[2]


def number_found(args: Sequence[Term], facts: list[Fact], trail: Trail) -> tuple[Term, Term]:
    """.count(Formula,Number)"""
    found, _ = all_found((args[0], *args), facts, trail)
    return len(found), args[1]  # type: ignore[arg-type]


def whether_found(args: Sequence[Term], facts: list[Fact], trail: Trail) -> tuple[Term, Term]:
    """.eval(Truth,Formula)"""
    found, _ = all_found((args[1], args[1], args[0]), facts, trail)
    return atom("true" if found else "false"), args[0]


QUESTIONS = {".findall": all_found, ".count": number_found, ".eval": whether_found}


def believed(literal: Term, facts: list[Fact], trail: Trail) -> Iterator[None]:
    mark = len(trail)
    for head, body in facts:
        if head.predicate is not literal.predicate:  # type: ignore[union-attr]
            continue
        names: dict[Var, Term] = {}
        fresh = renamed(head, names)
        pairs = zip(literal.args, fresh.args, strict=True)  # type: ignore[union-attr]
        if all(unify(left, right, trail) for left, right in pairs):
            wanted = literal.annots  # type: ignore[union-attr]
            if body is not None:
                yield from answers(renamed_with(body, names), facts, trail)
            elif not wanted or unify_annots(wanted, fresh.annots, trail):  # type: ignore[union-attr]
                yield
        undo(trail, mark)


def renamed_with(term: Term, names: dict[Var, Term]) -> Term:
    return renamed(term, names)


def compared(name: str, left: Term, right: Term, trail: Trail) -> bool:
    try:
        a, b = resolve(left), resolve(right)
    except ArithmeticFailure:
        return False
    if name == "=":
        return unify(a, b, trail)
    if name in ("==", "\\=="):
        return (a == b) == (name == "==")
    order = compare(a, b)
    if isinstance(a, int | float) and isinstance(b, int | float):
        order = (a > b) - (a < b)
    return {"<": order < 0, "<=": order <= 0, ">": order > 0, ">=": order >= 0}[name]


def shown(term: Term) -> str:
    """A value; anything with a free variable in it reads alike."""
    value = resolve(term)
    return "free" if variables_in(value) else show(value)


# ---- programs and formulas -----------------------------------------------------------------------------------------

VALUES = ["a", "b", "1", "2", "f(a)", "[a,b]", '"s"']
VARIABLES = ["X", "Y", "Z"]
simple = st.sampled_from(VALUES + VARIABLES * 3 + ["_", "f(X)", "f(Y)", "[X|Y]", "[a|Z]"])
numeric = st.sampled_from(["1", "2", "3", "X", "Y", "X+1", "Y*2", "X-Y", "X div Y"])
literals = st.one_of(
    st.builds("p({},{})".format, simple, simple),
    st.builds("q({})".format, simple),
    st.builds("r({},{},{})".format, simple, simple, simple),
    st.sampled_from(["flag", "open", "q(X)[tag]", "q(Y)[tag(Z)]", "t(X)", "t(Y)", "u(X,Y)", "w(X)", "w(f(Y))"]),
)
flat = st.sampled_from([*VALUES, *VARIABLES, *VARIABLES])  # no X = f(X): terms without an end are another matter
comparisons = st.one_of(
    st.builds("{} = {}".format, flat, flat),
    st.builds("{} {} {}".format, numeric, st.sampled_from(["<", "<=", ">", ">=", "==", "\\=="]), numeric),
    st.builds("{} = {}".format, st.sampled_from(VARIABLES), numeric),
)
formulas = st.recursive(
    st.one_of(literals, literals, comparisons),
    lambda inner: st.one_of(
        st.builds("({} & {})".format, inner, inner),
        st.builds("({} & {})".format, inner, inner),
        st.builds("({} | {})".format, inner, inner),
        st.builds("not ({})".format, inner),
    ),
    max_leaves=6,
)
lists = st.sampled_from(["[a,b]", "[1,2,1]", "[X,b]", "[f(X),Y]", "[]", "[a,[b]]"])
wider = st.recursive(
    st.one_of(
        literals,
        comparisons,
        st.builds(".member({},{})".format, simple, lists),
        st.sampled_from(["ns::q(X)", "ns::p(X,Y)", "~q(X)", "v(X,[Y|Z])", "v(Y,[X,Y])"]),
        st.sampled_from(["q(X)[tag(Y)|Z]", "q(X)[tag|_]", "q(X)[source(Y)]", "q(X)[tag,tag(Y)]", "q(X)[|Z]"]),
    ),
    lambda inner: st.one_of(
        st.builds("({} & {})".format, inner, inner),
        st.builds("({} | {})".format, inner, inner),
        st.builds("not ({})".format, inner),
        st.builds(".findall({},{},{})".format, st.sampled_from(["X", "f(X,Y)", "k(Z)"]), inner, simple),
        st.builds(".count({},{})".format, inner, st.sampled_from(["X", "Y", "0", "1"])),
        st.builds(".eval({},{})".format, st.sampled_from(["X", "true", "false"]), inner),
    ),
    max_leaves=7,
)
ground = st.sampled_from(VALUES)
beliefs = st.lists(
    st.one_of(
        st.builds("p({},{})".format, ground, ground),
        st.builds("q({})".format, ground),
        st.builds("q({})[tag]".format, ground),
        st.builds("q({})[tag({})]".format, ground, ground),
        st.builds("r({},{},{})".format, ground, ground, ground),
        st.sampled_from(["flag", "w(V)", "w(f(V))", "w(a)", "p(1,2)", "p(2,3)", "p(3,1)"]),
    ),
    max_size=14,
)
RULES = ["t(A) :- q(A) & not p(A,_).", "u(A,B) :- p(A,B) | (p(A,C) & p(C,B)).", "w(A) :- flag & A = b."]
rules = st.lists(st.sampled_from(RULES), max_size=3, unique=True)
quick = settings(
    max_examples=120, deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow], database=None
)


def facts_of(agent: Agent) -> list[Fact]:
    """Return the beliefs with their annotations, and the rules, in the order in which they are found."""
    found: list[Fact] = []
    for relation in agent.beliefs.relations.values():
        for key in reversed(relation.facts):
            entry = relation.facts[key]
            if hasattr(entry, "rule"):
                found.append((entry.rule.head, entry.rule.formula))
            else:
                found.append((Structure(relation.predicate, entry.args, entry.annots), None))
    return found


def meant(formula: str, agent: Agent, given: dict[str, str] | None = None) -> list[dict[str, str]]:
    """Return X, Y and Z of each answer."""
    wrapped = parse_term(f"all({formula},X,Y,Z)")
    assert isinstance(wrapped, Structure)
    term, *wanted = wrapped.args
    trail: Trail = []
    for name, value in (given or {}).items():
        assert unify(wanted["XYZ".index(name)], parse_term(value), trail)
    found = []
    try:
        for _ in answers(term, facts_of(agent), trail):
            found.append({name: shown(each) for name, each in zip("XYZ", wanted, strict=True)})
    except RecursionError:  # X = f(X), in some way or other: terms without an end mean nothing
        reject()
    return found


@quick
@given(beliefs=beliefs, rules=rules, formula=formulas)
def test_a_question_from_outside_has_all_answers_in_order(beliefs: list[str], rules: list[str], formula: str) -> None:
    agent = Agent(parse_program(" ".join([*(f"{each}." for each in beliefs), *rules])))
    wanted = meant(formula, agent)
    got = [{name: shown(answer[name]) if name in answer else "free" for name in "XYZ"} for answer in agent.ask(formula)]
    assert got == wanted


@quick
@given(beliefs=beliefs, rules=rules, formula=formulas, x=st.sampled_from([*VALUES, "Free"]))
def test_a_plan_applies_with_the_first_answer_to_its_context(
    beliefs: list[str], rules: list[str], formula: str, x: str
) -> None:
    program = " ".join([*(f"{each}." for each in beliefs), *rules, f"+!g(X) : {formula} <- act(X,Y,Z). +!g(_) <- no."])
    agent = Agent(parse_program(program))
    wanted = meant(formula, agent, {} if x == "Free" else {"X": x})
    assert done_for(agent, x) == (wanted[0] if wanted else None)


@quick
@given(beliefs=beliefs, rules=rules, formula=formulas, x=st.sampled_from([*VALUES, "Free"]))
def test_a_test_goal_binds_the_first_answer(beliefs: list[str], rules: list[str], formula: str, x: str) -> None:
    program = " ".join(
        [*(f"{each}." for each in beliefs), *rules, f"+!g(X) <- ?({formula}); act(X,Y,Z). -!g(_) <- no."]
    )
    agent = Agent(parse_program(program))
    wanted = meant(formula, agent, {} if x == "Free" else {"X": x})
    assert done_for(agent, x) == (wanted[0] if wanted else None)


@quick
@given(beliefs=beliefs, rules=rules, formula=formulas, x=st.sampled_from([*VALUES, "Free"]))
@pytest.mark.slow
def test_findall_and_for_have_every_answer(beliefs: list[str], rules: list[str], formula: str, x: str) -> None:
    body = f".findall(found(X,Y,Z),{formula},All); .length(All,N); all(N); for ({formula}) {{ act(X,Y,Z) }}; done"
    agent = Agent(parse_program(" ".join([*(f"{each}." for each in beliefs), *rules, f"+!g(X) <- {body}."])))
    wanted = meant(formula, agent, {} if x == "Free" else {"X": x})
    acts, finished, message = [], [], [Message("tester", "achieve", f"g({x})")]
    for _ in range(40 + 3 * len(wanted)):
        outcome = agent.cycle(None, message, finished)
        message, finished = [], [Finished(action.id) for action in outcome.actions]
        acts += [action.term for action in outcome.actions]
    count, *steps, end = acts
    assert show(count) == f"all({len(wanted)})"
    assert [values_of(act) for act in steps] == wanted
    assert show(end) == "done"


wider_beliefs = st.lists(
    st.one_of(
        beliefs.filter(bool).map(lambda several: several[0]),
        st.builds("ns::q({})".format, ground),
        st.builds("ns::p({},{})".format, ground, ground),
        st.builds("~q({})".format, ground),
        st.builds("q({})[tag({}),tag,source(bob)]".format, ground, ground),
        st.sampled_from(["v(a,[1,2])", "v(b,[])", "v(V,[V,a])", "q(V)[tag]"]),
    ),
    max_size=10,
)
WIDER_RULES = ["t(A) :- .member(A,[a,b]) & q(A).", "u(A,B) :- .findall(C,p(A,C),B).", "w(A) :- .count(q(_),A)."]
PLACES = [
    "+!g(X) : FORMULA <- act(X,Y,Z). +!g(_) <- no.",
    "+!g(X) : F = (FORMULA) & F <- act(X,Y,Z). +!g(_) <- no.",
    "+!g(X) : rule(X,Y,Z) <- act(X,Y,Z). +!g(_) <- no. rule(X,Y,Z) :- FORMULA.",
    "+!g(X) <- ?(FORMULA); act(X,Y,Z). -!g(_) <- no.",
    "+!g(X) <- F = (FORMULA); ?F; act(X,Y,Z). -!g(_) <- no.",
    "+!g(X) <- if (FORMULA) { act(X,Y,Z) } else { no }.",
    "+!g(X) <- while (FORMULA) { act(X,Y,Z); .wait(9000) }; no.",
]


@pytest.mark.parametrize("place", PLACES)
@quick
@given(
    beliefs=wider_beliefs,
    rules=st.lists(st.sampled_from(RULES + WIDER_RULES), max_size=3, unique=True),
    formula=wider,
    x=st.sampled_from([*VALUES, "Free", "[a|T]", "g(U)"]),
)
@pytest.mark.nightly
def test_a_formula_means_the_same_wherever_it_stands(
    place: str, beliefs: list[str], rules: list[str], formula: str, x: str
) -> None:
    """With internal actions in it, open annotations, namespaces; held by a variable, in a rule or a condition."""
    program = " ".join([*(f"{each}." for each in beliefs), *rules])
    wanted = meant(formula, Agent(parse_program(program)), {} if x == "Free" else {"X": x})
    agent = Agent(parse_program(f"{program} {place.replace('FORMULA', formula)}"))
    assert done_for(agent, x) == (wanted[0] if wanted else None)


def done_for(agent: Agent, x: str) -> dict[str, str] | None:
    """Return X, Y and Z of the action for g(x); None if it was the other one."""
    message, acts = [Message("tester", "achieve", f"g({x})")], []
    for _ in range(6):
        acts += agent.cycle(None, message).actions
        message = []
    (act,) = acts
    return None if show(act.term) == "no" else values_of(act.term)


def values_of(act: Term) -> dict[str, str]:
    return {name: shown(value) for name, value in zip("XYZ", act.args, strict=True)}  # type: ignore[union-attr]


@pytest.mark.parametrize("late", ["+q(V)", "+{ q(A) :- flag }"])
def test_what_was_compiled_for_plain_facts_is_compiled_again_when_others_come(late: str) -> None:
    """A context looks plain facts up in a dictionary; from the first fact with a variable on it must not."""
    program = f"flag. q(a). !g(z). +!g(X) : q(X) <- found(X). +!g(X) <- none(X); {late}; !g(X)."
    agent = Agent(parse_program(program))
    acts, finished = [], []
    for _ in range(12):
        outcome = agent.cycle(None, [], finished)
        finished = [Finished(action.id) for action in outcome.actions]
        acts += [show(action.term) for action in outcome.actions]
    assert acts == ["none(z)", "found(z)"]
