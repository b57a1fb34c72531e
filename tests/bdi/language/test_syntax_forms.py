"""Every form of the language, by what it does."""

import pytest

from bdi import Agent, Finished, parse_program


def deeds(text: str, cycles: int = 30) -> list[str]:
    """The actions and printed lines, in order; a failure as its sentence."""
    agent = Agent(parse_program(text))
    seen: list[str] = []
    finished: list[Finished] = []
    for _ in range(cycles):
        outcome = agent.cycle(None, [], finished)
        seen += [*map(str, outcome.actions), *outcome.printed, *(failure.error for failure in outcome.failures)]
        finished = [Finished(action.id) for action in outcome.actions]
    return seen


# ---- values in braces ----------------------------------------------------------------------------------------------


def test_a_plan_is_learnt_and_forgotten() -> None:
    program = """!g.
    +!g <- +{ @new +!h(X) : X > 1 <- said(X) }; !h(2); -{ @new +!h(_) }; !h(3).
    -!h(X)[error(E)] <- failed(X,E)."""
    assert deeds(program) == ["said(2)", "failed(3,no_relevant)"]


def test_a_plan_without_name_is_forgotten_as_it_was_written() -> None:
    assert deeds("!g. +!g <- +{+!h <- a}; !h; -{+!h <- a}; !h. -!h <- gone.") == ["a", "gone"]


def test_a_plan_is_learnt_with_the_values_it_has() -> None:
    assert deeds("!g. +!g <- X = 7; P = {+!h(Y) <- said(X,Y)}; +P; !h(8).") == ["said(7,8)"]


def test_a_plan_may_be_learnt_before_all_others() -> None:
    assert deeds("!g. +!g <- +<{+!h <- first}; !h. +!h <- last.") == ["first"]
    assert deeds("!g. +!g <- +{+!h <- last}; !h. +!h <- first.") == ["first"]


def test_a_rule_is_learnt_and_forgotten() -> None:
    program = """q(1). q(2). !g.
    +!g <- +{ p(X) :- q(X) & X > 1 }; ?p(Y); found(Y); -{ p(X) :- q(X) & X > 1 }; ?p(_).
    -!g <- none."""
    assert deeds(program) == ["found(2)", "none"]


def test_a_plan_body_is_no_plan_to_learn() -> None:
    assert deeds("!g. +!g <- +{ a; b }. -!g[error(E)] <- said(E).") == ["said(wrong_arguments)"]


def test_a_body_with_the_values_it_has_runs_as_a_step() -> None:
    assert deeds("!g. +!g <- X = 1; B = {p(X); !h}; B; !B. +!h <- q.") == ["p(1)", "q", "p(1)", "q"]


# ---- bodies --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ("a; b;", ["a", "b"]),
        ("if (true) {a} b", ["a", "b"]),
        ("if (true) {a}; b", ["a", "b"]),
        ("if (false) {a} elif (true) {b} else {c}; d", ["b", "d"]),
        ("if (false) {a} else if (false) {b} else {c}", ["c"]),
        ("for (.member(X,[1,2])) {p(X)} d", ["p(1)", "p(2)", "d"]),
        ("+c(1); while (c(N) & N < 3) {p(N); -+c(N+1)} d", ["p(1)", "p(2)", "d"]),
        ("(a; b); c", ["a", "b", "c"]),
        ("((a; b); (c))", ["a", "b", "c"]),
        ("a |&| b; c", ["a", "b", "c"]),
        ("a ||| b |&| c", ["a"]),
        ("if (true) {a} |&| b; c", ["b", "a", "c"]),
        ("{a; b}; c", ["a", "b", "c"]),
        ("++b(1); ?b(X); p(X)", ["p(1)"]),
        ("+<b(1); +>b(2); ?b(X); p(X)", ["p(1)"]),
        ("+b(1); --b(1); if (not b(_)) {none}", ["none"]),
        ("?(1 < 2 & not b); p", ["p"]),
        ("X = .5 + 1e3; p(X)", ["p(1000.5)"]),
        ("X = p(9); X", ["p(9)"]),
        ("begin; end(1); p(div,mod,not_yet)", ["begin", "end(1)", "p(div,mod,not_yet)"]),
        ("X = p; X[a]", ["p[a]"]),
        ("B = b(1); +B[x]; ?b(Y)[x]; p(Y)", ["p(1)"]),
        ('.print("a\\tb\\"c\\\\")', ['a\tb"c\\']),
    ],
)
def test_a_body(body: str, expected: list[str]) -> None:
    assert deeds(f"!g. +!g <- {body}.") == expected


def test_of_branches_of_which_one_is_enough_the_others_are_left() -> None:
    # |&| binds tighter: (a; b) alone, or c together with d
    assert deeds("!g. +!g <- (a; b) ||| c |&| d; e.").count("e") == 1


# ---- plans ---------------------------------------------------------------------------------------------------------


def test_components_come_in_any_order() -> None:
    assert deeds("+!g : p(X) & r <- a(X). !g. p(1). r :- p(_).") == ["a(1)"]


def test_a_variable_takes_any_goal_with_its_annotations() -> None:
    assert deeds("!g(1)[u]. !h. +!G[u] <- with(G). +!G <- without(G).") == [
        "with(g(1)[u,source(self)])",
        "without(h[source(self)])",
    ]


def test_a_variable_takes_any_failure_with_its_reason() -> None:
    assert deeds("!g. +!g <- .fail. -!P[error(E)] <- failed(E).") == ["failed(internal_action)"]
    assert deeds("!g. +!g <- ?no. -!P[error(ia_failed)] <- failed. -!P[error(E)] <- other(E).") == [
        "other(test_goal_failed)"
    ]


def test_annotations_may_have_a_rest() -> None:
    assert deeds("b(1)[x,y]. !g. +!g <- ?b(1)[x|T]; .length(T,N); p(N).") == ["p(2)"]


def test_a_label_may_be_annotations_alone() -> None:
    program = parse_program("@[atomic] +!g <- a. @l(1)[x] +!h.")
    assert [str(plan) for plan in program.plans] == ["@p__1[atomic] +!g <- a.", "@l(1)[x] +!h."]
    assert program.plans[0].has("atomic")


def test_numbered_unnamed_variables_are_one_variable_and_others_are_not() -> None:
    assert deeds("!g. +!g : _12 = 1 <- p(_12); if (_ = 1 & _ = 2) {q}.") == ["p(1)", "q"]


# ---- as text -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "plan",
    [
        '@l[atomic] +!g(X)[u] : b(X) & not (c | d) <: done <- a(X); !!h; ?t(Y); -+b(2); .print("x\\n\\"").',
        "@l +!g <- X = {@m +!h : c <- a}; Y = {p(Z) :- q(Z)}; W = {-!g[error(E)]}; V = {+b}; +{+!k}; -{p :- q}.",
        "@l +!g <- if (a) {b; c} elif (d) {e} else {}; while (x) {y}; for (z(N)) {w(N)}; {a}; V; !V; !!g.",
        "@l +!g <- ((a; +b) |&| c) ||| (!d; e); f.",
        "@l -!P[error(E),source(S)|T] : P = f(_12) <- X[a]; +X[b]; ?q[|R].",
        "@l ^!g[state(S)].",
        "@l +!g <- X = -3 + 2 ** 4 mod 5 div 2 / 1.5E-7; Y = \"it's\"; Z = 'a b'; ~p(~q).",
        "@l +!g : X =.. [p,[1],[]] & a \\== b & 3 >= 2 <- a. { @m +!h. { @n +!i <- j. } @o +!k. }",
        "@l +!g : (a & b) | c & not not d <- ?(a | b); .x.y; p(a.b).",
    ],
)
def test_what_is_printed_of_a_plan_is_read_as_the_same_plan(plan: str) -> None:
    first = str(parse_program(plan).plans[0])
    again = str(parse_program(first).plans[0])
    assert again == first
    assert (
        again.replace("(", "").replace(")", "").replace(" ", "")[:12]
        == plan.replace("(", "").replace(")", "").replace(" ", "")[:12]
    )
