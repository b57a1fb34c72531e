"""Annotations of a failure event: the kind of error, a sentence, the step and its place."""

import pytest

from bdi import Agent, Finished, parse_program

TELL = '\n-!g[error(E), code(C), code_line(L)] <- .print(E, " ", C, " ", L).'
REST = """
b(1). b(4).
+!none : no <- a.
+!inner <- !unknown.
+?asked(X) : X > 5 <- a.
+!slow <- .wait(300); end.
+!twice <- .fail. -!twice <- again; 1 > 2.
far(X) :- X > 1 & .nth(9,[a],_)."""


def said(program: str, cycles: int = 30, fail: str = "fail_action") -> list[str]:
    agent = Agent(parse_program(program, source="robot.asl"))
    lines: list[str] = []
    finished: list[Finished] = []
    for cycle in range(1, cycles + 1):
        outcome = agent.cycle(None, (), finished, cycle / 10)
        lines += [
            *outcome.printed,
            *map(str, outcome.actions),
            *(f"given up: {each.error}" for each in outcome.failures),
        ]
        finished = [
            Finished(action.id, "jammed" if action.term.functor == fail else None) for action in outcome.actions
        ]
    return lines


@pytest.mark.parametrize(
    ("step", "told"),
    [
        ("!unknown", "no_relevant +!unknown 2"),
        ("!none", "no_applicable +!none 2"),
        ("!inner", "no_relevant +!unknown 5"),
        ("?missing(X)", "test_goal_failed missing(X) 2"),
        ("?(b(X) & X > 9)", "test_goal_failed (b(X) & (X>9)) 2"),
        ("?asked(3)", "no_applicable +?asked(3) 2"),
        ("1 > 2", "constraint_failed (1>2) 2"),
        ("X = 1; X = 2", "constraint_failed (X=2) 2"),
        (".fail", "internal_action .fail 2"),
        (".member(c, [a,b])", "ia_failed .member(c,[a,b]) 2"),
        (".nth(9, [a], X)", "wrong_arguments .nth(9,[a],X) 2"),
        (".wait({+never}, 200)", "wait_timeout .wait({+never},200) 2"),
        (".send(bob, askOne, x, Y, 200); Y == z", "ask_failed"),
        ("!Goal", "body_var_without_value Goal 2"),
        ("Step", "body_var_without_value Step 2"),
        ("P = uc; fail_action(P)", "action_failed fail_action(uc) 2"),
        ("!twice", "constraint_failed (1>2) 8"),
        ("a |&| .fail", "internal_action .fail 2"),
        ("if (far(2)) { a }", "wrong_arguments if (far(2)) {a} 2"),
        ("for (b(X)) { X > 2 }", "constraint_failed (X>2) 2"),
        ("!g(1)[hard_deadline(200)]", "no_relevant +!g(1) 2"),
    ],
)
def test_a_failure_says_what_failed_and_where(step: str, told: str) -> None:
    lines = said("!g.\n+!g <- " + step + "; no." + TELL.replace("\n", " ") + REST)
    if told == "ask_failed":
        assert any(line.startswith("constraint_failed") for line in lines)  # the answer is timeout, which is not z
    else:
        assert told in lines
    assert "no" not in lines


def test_the_file_of_the_failed_step_is_told() -> None:
    assert said("!g. +!g <- .fail. -!g[code_src(F)] <- .print(F).") == ["robot.asl"]
    assert said("!g. +!g <- fail_action. -!g[code_src(F)] <- .print(F).") == ["fail_action", "robot.asl"]


def test_the_sentence_names_what_failed() -> None:
    assert said("!g. +!g <- 1 > 2. -!g[error_msg(M)] <- .print(M).") == ["(1>2) is not the case"]
    assert said("!g. +!g <- ?b(7). -!g[error_msg(M)] <- .print(M).") == ["?b(7) is not the case"]


def test_annotations_of_the_goal_stay_with_its_failure() -> None:
    assert said("!g[urgent]. +!g <- .fail. -!g[urgent, source(S)] <- .print(S).") == ["self"]


def test_a_goal_whose_plans_for_failure_do_not_apply_ends_its_intention() -> None:
    program = "!a. +!a <- !b; no. +!b <- {}. -!b[error(action_failed)] <- inner. -!a[error(E)] <- .print(E)."
    assert said(program.format("?x")) == ["given up: test_goal_failed"]
    assert said("!a. +!a <- !b; no. +!b <- .fail. -!b : no <- no. -!a <- no.") == ["given up: internal_action"]
    assert said(program.format("fail_action")) == ["fail_action", "inner", "no"]


def test_a_failed_test_goal_has_plans_of_its_own() -> None:
    program = "!a. +!a <- ?where(X); at(X). +?where(X) <- .fail. -?where(X)[error(E)] <- .print(E); X = home."
    assert said(program) == ["internal_action", "at(home)"]


def test_what_a_failed_plan_found_out_is_forgotten() -> None:
    program = "!a. +!a <- !find(X); at(X). +!find(X) <- X = uc; .fail. -!find(X) <- .print(X); X = library."
    assert said(program) == ["X", "at(library)"]


def test_a_failure_of_the_plan_for_a_failure_goes_to_the_goal_below() -> None:
    program = "!a. +!a <- !b; no. +!b <- .fail. -!b <- r1; fail_action; r2. -!a[error(E)] <- .print(E)."
    assert said(program) == ["r1", "fail_action", "action_failed"]


def test_a_goal_that_no_plan_rescues_is_given_up_with_the_first_error() -> None:
    assert said("!a. +!a <- !b. +!b <- ?x. -!b : never <- no.") == ["given up: test_goal_failed"]


def test_a_plan_for_a_belief_that_fails_ends_the_intention_that_waits_for_it() -> None:
    assert said("!a. +!a <- +b; no. +b <- .fail.") == ["given up: internal_action"]
    assert said("!a. +!a <- ++b; after. +b <- .fail.") == ["after", "given up: internal_action"]
    assert said("!a. +!a <- +b; no. +b <- .fail. -!a <- no.") == ["given up: internal_action"]
    assert said("!a. +!a <- +b; no. +b <- !c; no. +!c <- .fail. -!a <- rescue.") == ["rescue"]


def test_a_condition_that_cannot_be_worked_out_does_not_hold() -> None:
    assert said("!g. +!g : .nth(9,[a],_) <- no. +!g <- yes.") == ["yes"]
    assert said("far :- .nth(9,[a],_). !g. +!g : far <- no. +!g <- yes.") == ["yes"]


@pytest.mark.parametrize(
    "program",
    [
        "!dock. +!dock <- .fail. -!dock <- .fail.",
        "!dock. +!dock : near <- a. -!dock : far <- a.",
        "!dock. {begin dg(dock)} +!dock <- .fail. {end}",
    ],
)
def test_a_goal_that_is_given_up_is_named_as_it_was_wanted(program: str) -> None:
    agent = Agent(parse_program(program))
    given_up = [each.goal for _ in range(20) for each in agent.cycle(None, (), (), 0).failures]
    assert given_up == ["+!dock"]
    assert "given up" in str(agent.why("dock"))
