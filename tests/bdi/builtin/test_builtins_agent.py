"""Internal actions about the agent itself: its beliefs and plans, its clock, what it says, what it does next."""

from collections.abc import Sequence

import pytest

from bdi import Agent, Finished, parse_program

TENTHS_S = [cycle * 0.1 for cycle in range(60)]


def run(text: str, moments_s: Sequence[float] = TENTHS_S, seed: int = 1) -> list[str]:
    """Actions and lines, in order; actions succeed at once. Failed goals come as "failed: …"."""
    agent = Agent(parse_program(text), name="ag", random_seed=seed)
    seen: list[str] = []
    finished: list[Finished] = []
    for now in moments_s:
        outcome = agent.cycle(None, [], finished, now)
        seen += [*map(str, outcome.actions), *outcome.printed]
        seen += [f"failed: {failure.error}" for failure in outcome.failures]
        finished = [Finished(action.id) for action in outcome.actions]
    return seen


def steps(*lines: str, beliefs: str = "") -> list[str]:
    """Return the outputs of a plan of these steps."""
    return run(f"{beliefs} !g. +!g <- {'; '.join(lines)}.")


# ---- beliefs -------------------------------------------------------------------------------------------------------


def test_abolish_forgets_beliefs_of_every_source_and_raises_events() -> None:
    program = "p(1). p(2)[source(bob)]. q. !g. +!g <- .abolish(p(_)); .count(p(_),N); left(N). -p(X) <- gone(X)."
    assert sorted(run(program)) == ["gone(1)", "gone(2)", "left(0)"]


def test_abolish_forgets_all_that_an_agent_said() -> None:
    program = """p(1)[source(bob)]. q[source(bob)]. s::p(1)[source(bob)]. p(2). p(3)[source(bob), source(ann)]. !g.
        +!g <- .abolish(_[source(bob)]); .setof(X, p(X), L); left(L); .count(q, N); q(N); ?s::p(1); done."""
    assert run(program) == ["left([2])", "q(0)", "done"]


def test_a_free_variable_asks_for_whatever_is_believed() -> None:
    program = """p(1). q[source(bob)]. s::r. !g.
        +!g <- .setof(X, X[source(bob)], L); said(L); .count(Y, N); all(N); ?Z[source(bob)]; one(Z)."""
    assert run(program) == ["said([q[source(bob)]])", "all(2)", "one(q[source(bob)])"]


def test_beliefs_are_listed_in_the_same_order_in_every_run() -> None:
    percepts = [f"{letter}(1)" for letter in "abcdefghijklmnopqrs"]
    agent = Agent(parse_program("+s(_) <- .list_beliefs."))
    assert agent.cycle(set(percepts)).printed == tuple(f"{percept}[source(percept)]" for percept in percepts)


def test_assertz_puts_a_belief_behind_the_others_and_asserta_before_them() -> None:
    assert steps(".assertz(p(9))", ".asserta(p(0))", ".findall(X,p(X),L)", "say(L)", beliefs="p(1).") == [
        "say([0,1,9])"
    ]


def test_a_rule_can_be_believed_and_is_used() -> None:
    program = "q(1). q(5). !g. +!g <- M = 3; .asserta({big(X) :- q(X) & X > M}); ?big(Y); say(Y)."
    assert run(program) == ["say(5)"]


def test_assert_in_a_condition_changes_the_beliefs_too() -> None:
    assert run("!g. +!g : .asserta(seen) <- a. +seen <- b.") == ["a", "b"]


def test_beliefs_and_rules_are_listed() -> None:
    program = "p(1). q(2). r(X) :- p(X). !g. +!g <- .list_beliefs(p(_)); .list_rules."
    assert run(program) == ["p(1)[source(self)]", "r(X) :- p(X)."]


def test_relevant_rules_are_those_that_could_derive_it() -> None:
    program = (
        "r(1,X) :- p(X). r(2,X) :- q(X). s(X) :- p(X). !g. +!g <- .relevant_rules(r(2,_),L); .length(L,N); say(N)."
    )
    assert run(program) == ["say(1)"]


def test_the_source_of_a_literal_is_the_plan_that_asks() -> None:
    assert run("\n!g.\n+!g <- .get_src_info(p,P); say(P).") == ['say(p[code_src("<text>"),code_line(3)])']


# ---- plans ---------------------------------------------------------------------------------------------------------


def test_a_plan_is_added_as_a_term_or_as_text_with_the_values_of_its_variables() -> None:
    program = """!g. +!g <- Place = library; .add_plan({ +!visit <- drive(Place) }); .add_plan("+!leave(P) <- out(P)");
        !visit; !leave(Place)."""
    assert run(program) == ["drive(library)", "out(library)"]


def test_an_added_plan_keeps_its_own_variables() -> None:
    program = "!g. +!g <- .add_plan({ +!h(X) : X > 1 <- big(X) }); !h(2); X = 7; !h(3); say(X)."
    assert run(program) == ["big(2)", "big(3)", "say(7)"]


def test_begin_puts_a_plan_before_the_others() -> None:
    program = "!g. +!h <- old. +!g <- .add_plan({ +!h <- newer },self,begin); !h."
    assert run(program) == ["newer"]


def test_the_same_plan_twice_is_one_and_another_of_its_name_fails() -> None:
    program = """!g. +!g <- .add_plan({ @k +!h <- a }); .add_plan({ @k +!h <- a }); .relevant_plans({+!h},L);
        .length(L,N); say(N); .add_plan({ @k +!h <- b }). -!g[error(E)] <- say(E)."""
    assert run(program) == ["say(1)", "say(ia_failed)"]


def test_a_plan_is_removed_by_its_label_if_it_is_from_that_source() -> None:
    program = """!g. +!g <- .add_plan({ @k +!h <- a },bob); .remove_plan(k); !h; .remove_plan(k,bob); !h.
        -!h[error(E)] <- say(E)."""
    assert run(program) == ["a", "say(no_relevant)"]


def test_several_plans_are_removed_by_a_list_of_labels() -> None:
    program = """@a +!h <- one. @b +!h <- two. !g. +!g <- .relevant_plans({+!h},_,LL); say(LL); .remove_plan(LL); !h.
        -!h <- nothing."""
    assert run(program) == ["say([a,b])", "nothing"]


def test_relevant_plans_are_chosen_by_event_and_head_whatever_their_contexts() -> None:
    program = """@a +!h(1) : false <- x. @b +!h(2) <- x. @c +h(1) <- x. @d +!k <- x. @e -!h(1) <- x.
        !g. +!g <- .relevant_plans({+!h(1)},_,L1); say(L1); .findall(P,.relevant_plan({+!h(_)},P),L2); .length(L2,N);
        say(N); .relevant_plans({+h(_)},_,L3); say(L3)."""
    assert run(program) == ["say([a])", "say(2)", "say([c])"]


def test_the_label_of_a_plan_and_the_plan_of_a_label() -> None:
    program = "@k[high] +!h : p <- x; y. !g. +!g <- .plan_label(P,k); .plan_label(P,L); say(P,L); .list_plans({+!h})."
    assert run(program) == ["say({@k[high] +!h : p <- x; y},k[high])", "@k[high] +!h : p <- x; y."]


@pytest.mark.parametrize("step", ["P", ".fork(and,P,{b})", ".if_then_else(true,{ +!h <- a })"])
def test_a_plan_is_no_body_that_can_be_run(step: str) -> None:
    assert run(f"!g. +!g <- P = {{ +!h <- a }}; {step}. -!g[error(E)] <- say(E).")[-1] == "say(wrong_arguments)"


# ---- control -------------------------------------------------------------------------------------------------------


def test_statements_written_as_internal_actions() -> None:
    program = """c(0). n(1). n(2). !g. +!g <- .if_then_else(n(9),{a},{b}); .if_then_else(n(X) & X > 1,{say(X)});
        .foreach(n(Y),{each(Y)}); .loop(c(C) & C < 2,{-+c(C+1)}); ?c(End); say(End);
        .fork(and,{left},{right}); .fork(or,[{first},{.wait({+never}); second}]); done."""
    assert run(program) == ["b", "say(2)", "each(1)", "each(2)", "say(2)", "left", "right", "first", "done"]


def test_a_statement_takes_a_body_that_a_variable_holds() -> None:
    assert steps("B = {a; b}", ".if_then_else(true,B)", "c") == ["a", "b", "c"]


# ---- clock and events ----------------------------------------------------------------------------------------------


def test_time_and_date_are_those_of_the_given_clock() -> None:
    program = "!g. +!g <- .date(Y,M,D); .time(H,I,S,MS); say(Y,M,D,H,I,S,MS); say(system.time)."
    said = run(program, [1_600_000_000.25] * 9)  # 2020-09-13 12:26:40 UTC
    assert said == ["say(2020,9,13,12,26,40,250)", "say(1600000000250)"]
    assert run("!g. +!g <- .nano_time(N); say(N).", [2.5] * 3) == ["say(2500000000)"]


def test_events_at_a_time_come_in_the_order_of_their_moments() -> None:
    program = """!g. +!g <- .at("now +2 s",{+!second}); .at("now +1500",{+first(1)});
        .at("now + 1 minute",{+!last}); go. +!second <- b. +first(X) <- a(X). +!last <- c."""
    beginning = TENTHS_S[:6]
    assert run(program, beginning) == ["go"]
    assert run(program, TENTHS_S) == ["go", "a(1)", "b"]
    assert run(program, [*beginning, 90.0, 90.1, 90.2]) == ["go", "a(1)", "b", "c"]


@pytest.mark.parametrize("when", ["soon", "now", "now +x", "now +3 parsecs", "now -1 s"])
def test_a_moment_that_is_none_fails_by_name(when: str) -> None:
    program = f'!g. +!g <- .at("{when}",{{+!h}}). -!g[error(E)] <- say(E). +!h <- a.'
    assert run(program) == ["say(wrong_arguments)"]


def test_a_signal_is_an_event_without_a_belief() -> None:
    program = "!g. +!g <- .signal({+alarm(1)}); .signal({+!help(2)}); .wait(200); ?alarm(_). +alarm(X) <- hear(X). \
        +!help(X)[source(S)] <- help(X,S). -!g[error(E)] <- say(E)."
    assert run(program) == ["hear(1)", "help(2,self)", "say(test_goal_failed)"]


def test_perceiving_and_talking_levels_need_nothing() -> None:
    assert steps(".perceive", ".verbose(2)", ".version(V)", "say(V)") == ['say("3.3")']


# ---- what is said --------------------------------------------------------------------------------------------------

SAID = [
    ('.print("a ",b(1),[c,"d"])', 'a b(1)[c,"d"]'),
    (".print", ""),
    ('.println("x")', "x"),
    ('.log(info,"n=",3)', "[info] n=3"),
    ('.printf("%08.0f|%10.3f|%s|%-4s|%d%%%n",461012,3.14159,f(a),ab,7)', "00461012|     3.142|f(a)|ab  |7%"),
    ('.puts("x #{X} #{X+1} #{math.sqrt(X)} #{Unknown} #{)} {X}")', "x 4 5 2 Unknown #{)} {X}"),
    (".print_unifier", '{X=4, Y="s"}'),
]


@pytest.mark.parametrize(("call", "line"), SAID, ids=str)
def test_it_says(call: str, line: str) -> None:
    assert steps("X = 4", 'Y = "s"', call) == [line]


def test_puts_with_a_variable_gives_the_text() -> None:
    assert steps("X = 4", '.puts("x=#{X}",T)', "say(T)") == ['say("x=4")']


@pytest.mark.parametrize("call", ['.printf("%d",a)', '.printf("%s %s",a)', '.printf("%q",1)'])
def test_a_format_that_does_not_fit_fails_by_name(call: str) -> None:
    assert run(f"!g. +!g <- {call}. -!g[error(E)] <- say(E).") == ["say(wrong_arguments)"]


# ---- chance --------------------------------------------------------------------------------------------------------


def test_equal_seeds_give_equal_chances() -> None:
    program = "!g. +!g <- .random(X); say(X); .shuffle([a,b,c,d,e],L); say(L); Y = math.random; say(Y)."
    assert run(program, seed=3) == run(program, seed=3) != run(program, seed=4)


def test_a_program_sets_its_own_seed() -> None:
    program = "!g. +!g <- .set_random_seed(9); .random(X); say(X)."
    assert run(program, seed=3) == run(program, seed=4)


# ---- failures ------------------------------------------------------------------------------------------------------


def test_a_wrong_value_reaches_the_plan_with_action_place_and_value() -> None:
    program = "!g(foo). +!g(X) <- .nth(0,X,Y). -!g(_)[error(E),error_msg(M)] <- say(E,M)."
    message = "argument 2 of .nth is a list, string, map, set or queue, not foo"
    assert run(program) == [f'say(wrong_arguments,"{message}")']


def test_a_wrong_value_in_a_condition_makes_it_false() -> None:
    assert run("!g(foo). +!g(X) : .nth(0,X,Y) <- a. +!g(_) <- b.") == ["b"]


def test_what_is_not_the_case_fails_as_such() -> None:
    assert run("!g. +!g <- .member(a,[]). -!g[error(E)] <- say(E).") == ["say(ia_failed)"]
