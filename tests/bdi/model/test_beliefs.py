"""Beliefs: percepts, facts with variables, facts that change while they are asked for, refused ones."""

import pytest

from bdi import Agent, AgentSpeakError, Finished, Message, NotALiteral, parse_program, show
from bdi.language.terms import structure


def acts(program: str, *percepts: list[str] | None, told: tuple[tuple[str, str], ...] = ()) -> list[str]:
    """The actions of some cycles; each is done at once. The percepts come first, one set a cycle."""
    agent = Agent(parse_program(program))
    messages = [Message("bob", *each) for each in told]
    done: list[str] = []
    finished: list[Finished] = []
    for number in range(20):
        outcome = agent.cycle(percepts[number] if number < len(percepts) else None, messages, finished)
        messages, finished = [], [Finished(action.id) for action in outcome.actions]
        done += [show(action.term) for action in outcome.actions]
    return done


def test_a_plan_can_ask_for_what_is_perceived_and_for_nothing_that_is_said() -> None:
    program = "+p[source(percept)] <- seen. +p[source(S)] <- said(S). -p[source(percept)] <- gone."
    assert acts(program, ["p"], ["p"], []) == ["seen", "gone"]
    assert acts(program, told=(("tell", "p"),)) == ["said(bob)"]
    assert acts(program, ["p"], told=(("tell", "p"),)) == ["seen", "said(bob)"]


def test_percepts_that_differ_in_annotations_are_one_belief_as_long_as_one_is_perceived() -> None:
    agent = Agent(parse_program(""))
    for percepts in (["p(1)[a]", "p(1)"], ["p(1)"], ["p(1)", "q"]):
        agent.cycle(percepts)
        assert agent.believes("p(1)"), percepts
    agent.cycle(["q"])
    assert not agent.believes("p(1)")


@pytest.mark.parametrize(
    ("percepts", "told"), [(["at(X)"], ()), (None, (("tell", "at(X)"),))], ids=["perceived", "told"]
)
def test_a_fact_with_a_variable_holds_for_everything_again_and_again(
    percepts: list[str] | None, told: tuple[tuple[str, str], ...]
) -> None:
    """Nor does a plan that one event makes up its mind for keep the next from another."""
    program = "+at(post1) : at(post2) <- go; ?at(post3); on."
    assert acts(program, percepts, told=told) == ["go", "on"]
    again = [["at(X)"], None, None, None, None, [], ["at(X)"]]
    assert acts(program, *again) == ["go", "on", "go", "on"]


def test_what_a_plan_finds_out_after_it_has_believed_something_is_not_believed() -> None:
    assert acts("!g. +!g <- +b(X); X = 5; ?b(7); X2 = X; done(X2).") == ["done(5)"]


@pytest.mark.parametrize(
    ("step", "expected"),
    [
        (".findall(X, p(X) & .asserta(p(X+5)), All); all(All)", "all([1,2])"),
        (".findall(X, p(X) & .abolish(p(2)), All); all(All)", "all([1,2])"),
        (".findall(X, p(X) & .asserta({ p(Y) :- q(Y) }), All); all(All)", "all([1,2])"),
        (".findall(X, n(k,X) & .asserta(n(k,X+5)), All); all(All)", "all([1,2])"),
        ("?(p(X) & .asserta(p(X+5)) & X > 1); all(X)", "all(2)"),
        ("if (p(X) & .asserta(p(X+5)) & X > 1) { all(X) }", "all(2)"),
    ],
)
def test_what_changes_while_it_is_asked_for_was_what_it_was(step: str, expected: str) -> None:
    many = " ".join(f"n(other{number},0)." for number in range(9))
    assert acts(f"p(1). p(2). n(k,1). n(k,2). {many} !g. +!g <- {step}.") == [expected]


def test_beliefs_may_change_in_a_context() -> None:
    assert acts("p(1). p(2). !g. +!g : p(X) & .asserta(p(X+5)) & X > 1 <- two(X). +!g <- no.") == ["two(2)"]


def test_a_list_with_an_open_end_is_no_list_of_two() -> None:
    assert acts("!g. +!g : T = b & X = [a|T] & X == [[a],b] <- wrong. +!g <- right.") == ["right"]
    program = "p([a,b,c]). q. !g. +!g <- F = (q & p([[a],X])); G = (q & p([a|Y])); .eval(A,F); .eval(B,G); said(A,B)."
    assert acts(program) == ["said(false,true)"]


def test_the_sums_in_what_comes_in_are_worked_out() -> None:
    program = "+b(3) <- three. +!ask : b(3) <- yes. +!ask <- no."
    ask = ("achieve", "ask")
    assert acts(program, ["b(1+2)"], told=(ask,)) == ["three", "yes"]
    assert acts(program, told=(("tell", "b(1+2)"), ask)) == ["three", "yes"]
    assert acts(f"b(1+2). {program}", told=(ask,)) == ["three", "yes"]


@pytest.mark.parametrize("performative", ["tell", "untell", "achieve", "unachieve", "askOne", "askAll", "signal"])
def test_what_cannot_be_worked_out_is_refused_at_the_door(performative: str) -> None:
    agent = Agent(parse_program("b(5). +b(5) <- a. +!b(X) <- a. -b(X) <- a. +?b(X) <- a."))
    with pytest.raises(NotALiteral, match="divides by zero"):
        agent.cycle(None, [Message("bob", performative, "b(1 div 0)")])
    with pytest.raises(NotALiteral, match="divides by zero"):
        agent.cycle(["b(1 div 0)"])
    assert agent.cycles == 0


@pytest.mark.parametrize("value", [True, None, "text", 1j])
def test_what_is_no_term_is_refused_at_the_door(value: object) -> None:
    agent = Agent(parse_program("p(1). +p(X) <- a."))
    with pytest.raises(NotALiteral):
        agent.cycle([structure("p", value)])  # type: ignore[arg-type]


def test_a_question_that_is_no_event_is_refused_at_the_door() -> None:
    for performative in ("askHow", "tellHow"):
        with pytest.raises(NotALiteral):
            Agent(parse_program("")).cycle(None, [Message("bob", performative, "[b(5)]")])


@pytest.mark.parametrize("program", ["b(1 div 0).", "!g(1 div 0). +!g(X) <- a(X)."])
def test_a_program_that_begins_with_what_cannot_be_worked_out_is_refused_with_its_place(program: str) -> None:
    with pytest.raises(AgentSpeakError, match=r"1:1: .* cannot be worked out"):
        Agent(parse_program(program))


def test_a_head_that_cannot_be_worked_out_is_about_nothing() -> None:
    assert acts("+b(1 div 0) <- no. +b(X div X) <- no. +b(X) <- b(X).", ["b(0)"]) == ["b(0)"]


@pytest.mark.parametrize(("body", "error"), [("Y = 1 div Z; Z = 0", "arithmetic"), ("Y = f(Z); Z = Y", "recursion")])
def test_an_answer_that_cannot_be_worked_out_fails_in_the_plan_that_asked(body: str, error: str) -> None:
    program = f"!s. +!s <- !g(Y); said(Y). +!g(Y) <- {body}. -!s[error(E)] <- failed(E)."
    assert acts(program) == [f"failed({error})"]


@pytest.mark.parametrize(
    "step",
    [
        "?count(9000)",
        ".wait(count(9000))",
        "if (count(9000)) { yes }",
        ".eval(true, count(9000))",
        "F = count(9000); ?F",
    ],
)
def test_a_proof_may_be_long_wherever_it_is_asked_for(step: str) -> None:
    rule = "count(0). count(N) :- N > 0 & count(N-1)."
    assert acts(f"{rule} !g. +!g <- {step}; done. -!g[error(E)] <- failed(E).")[-1] == "done"


def test_branches_do_not_take_each_others_variables() -> None:
    """Branches combine their values where they join."""
    assert acts("!g. +!g <- (X = 1; a(X)) |&| (Y = 2; b(Y)); c(X,Y).") == ["a(1)", "b(2)", "c(1,2)"]
    program = "!g. +!g <- (X = 1; a(X)) |&| (.wait(0); X = 2; b(X)). -!g[error(E)] <- failed(E)."
    assert acts(program) == ["a(1)", "b(2)"]


def test_the_event_of_a_belief_tells_what_was_new_or_taken_back() -> None:
    told = "+b(X)[note, source(self)] <- both(X). +b(X)[source(self)] <- fact(X). +b(X)[note] <- note(X)."
    assert acts("!g. +!g <- +b(1); +b(1)[note]; +b(2)[note]. " + told) == ["fact(1)", "note(1)", "both(2)"]
    gone = "-b(X)[note] <- no. -b(X) <- gone(X)."
    assert acts("b(1)[note]. b(2)[note]. !g. +!g <- -b(1); -b(Y). " + gone) == ["gone(1)", "gone(2)"]
    assert acts("b(1)[source(bob)]. b(1). !g. +!g <- -b(1); ?b(1)[source(S)]; by(S). " + gone) == ["gone(1)", "by(bob)"]


def test_a_fact_is_replaced_by_one_with_the_same_annotations_only() -> None:
    assert acts("n(1). !g. +!g <- -+n(2)[x]; .findall(N,n(N),L); all(L).") == ["all([2,1])"]
    assert acts("n(1)[x]. !g. +!g <- -+n(2)[x]; .findall(N,n(N),L); all(L).") == ["all([2])"]
    assert acts("n(1)[x]. !g. +!g <- -+n(2); .findall(N,n(N),L); all(L).") == ["all([2])"]


def test_annotations_are_shown_in_standard_order() -> None:
    assert acts("!g. +!g <- a(b(1)[z,c(2),1,c(1),a]).") == ["a(b(1)[1,a,c(1),c(2),z])"]
