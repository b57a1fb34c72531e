"""Atomic plans and branches: what the body sees of them."""

from tests.bdi.runs import Run, said

# ---- atomic plans --------------------------------------------------------------------------------------------------


def test_an_atomic_plan_is_alone_through_sub_goals_actions_and_waits() -> None:
    program = "!a. !b. @[atomic] +!a <- a1; !sub; .wait(300); a4. +!sub <- a2; a3. +!b <- b1; b2."
    assert said(program) == ["a1", "a2", "a3", "a4", "b1", "b2"]


def test_the_plan_for_the_failure_of_an_atomic_plan_is_atomic_too() -> None:
    program = "!a. !b. @[atomic] +!a <- a1; .fail. -!a <- r1; r2; r3. +!b <- b1; b2; b3."
    assert said(program) == ["a1", "r1", "r2", "r3", "b1", "b2", "b3"]
    program = "!a. !b. +!a <- !c; a1; a2. @[atomic] +!c <- .fail. -!c <- r1; r2. +!b <- b1; b2; b3."
    assert said(program) == ["b1", "r1", "r2", "a1", "b2", "a2", "b3"]


def test_after_an_atomic_plan_its_intention_has_the_next_step() -> None:
    program = "!a. !c. +!a <- +b; a1; a2. @[atomic] +b <- b1; b2. +!c <- c1; c2; c3."
    assert said(program) == ["c1", "b1", "b2", "a1", "c2", "a2", "c3"]


def test_branches_of_an_atomic_plan_are_alone_together() -> None:
    program = "!a. !b. @[atomic] +!a <- (a1; a2) |&| (c1; c2); a3. +!b <- b1; b2."
    got = said(program)
    assert sorted(got[:4]) == ["a1", "a2", "c1", "c2"]
    assert got[4:] == ["a3", "b1", "b2"]


def test_an_atomic_sub_goal_that_is_ended_lets_the_others_go_on() -> None:
    run = Run("!g. !o. +!g <- !h; c. @[atomic] +!h <- .succeed_goal(h); no. +!o <- o1.", quick=False)
    assert sorted(run.more(10)) == ["c", "o1"]


# ---- branches ------------------------------------------------------------------------------------------------------


def test_branches_within_branches() -> None:
    assert said("!g. +!g <- ((a; b) |&| c) ||| (.wait(5000); d); e.") == ["a", "c", "b", "e"]
    assert said("!g. +!g <- ((.wait(5000); a) ||| b) |&| c; e.")[-1] == "e"


def test_a_branch_that_fails_fails_the_goal_and_cancels_the_others() -> None:
    run = Run("!g. +!g <- drive |&| (walk |&| .fail); no. -!g <- rescue.", quick=False)
    assert sorted(run.more(10)) == ["drive", "rescue", "walk"]
    assert sorted(run.cancelled) == ["drive", "walk"]


def test_of_alternatives_one_may_fail_as_long_as_another_runs() -> None:
    run = Run("!g. +!g <- drive |&| ((walk |&| .fail) ||| .wait(9000)); no. -!g <- rescue.", quick=False)
    assert sorted(run.more(10)) == ["drive", "walk"]
    assert run.cancelled == ["walk"]
    assert said("!g. +!g <- (a; .fail) ||| (b; c; d); e. -!g <- no.") == ["a", "b", "c", "d", "e"]
    assert said("!g. +!g <- !none ||| (b; c); e. -!g <- no.") == ["b", "c", "e"]


def test_branches_have_variables_of_their_own_until_they_meet() -> None:
    assert said("!g. +!g <- (X=1; a(X)) |&| (X=2; b(X)); e.") == ["a(1)", "b(2)", "e"]
    assert said("!g. +!g <- !one(X) |&| !two(Y); e(X,Y). +!one(1). +!two(2).") == ["e(1,2)"]
    assert said("!g. +!g <- (X=1; .wait(900)) ||| (Y=2; a(Y)); X=3; e(X).") == ["a(2)", "e(3)"]


def test_a_failure_within_a_branch_can_be_rescued_there() -> None:
    assert sorted(said("!g. +!g <- !h |&| a; c. +!h <- .fail. -!h <- r.")) == ["a", "c", "r"]


def test_the_goal_condition_of_a_goal_around_branches_ends_them() -> None:
    run = Run(
        "!g. !s. +!g <: enough <- (drive; no) |&| !idle; no. +!idle <- .wait(100); !idle. +!s <- .wait(700); +enough.",
        False,
    )
    run.more(20)
    assert (run.said, run.cancelled) == (["drive"], ["drive"])
    assert run.agent.idle
