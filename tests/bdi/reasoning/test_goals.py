"""Suspending, dropping, succeeding and failing goals: what the body sees of it."""

import pytest

from bdi import Finished
from tests.bdi.runs import Run, said

# ---- suspend and resume --------------------------------------------------------------------------------------------


def test_a_suspended_goal_takes_no_steps_until_it_is_resumed() -> None:
    program = """!g. !s. +!g <- a; .wait(200); b; c. +!s <- .suspend(g); .wait(1000); s; .resume(g)."""
    assert said(program) == ["a", "s", "b", "c"]


def test_an_action_goes_on_while_its_goal_is_suspended_but_not_what_comes_after() -> None:
    run = Run("!g. !s. +!g <- drive; after. +!s <- .wait(100); .suspend(g); .wait(1000); .resume(g).", quick=False)
    assert run.more(5) == ["drive"]
    assert run.more(5, "drive") == []
    assert run.cancelled == []
    assert run.more(10) == ["after"]


def test_what_fails_while_it_is_suspended_is_rescued_when_it_is_resumed() -> None:
    run = Run("!g. !s. +!g <- drive. -!g <- rescue. +!s <- .wait(100); .suspend(g); .wait(1000); .resume(g).", False)
    run.more(5)
    run.news = [Finished(1, "jammed")]
    assert run.more(5) == []
    assert run.more(10) == ["rescue"]


def test_an_event_that_is_waited_for_counts_while_suspended() -> None:
    program = """!g. !s. +!g <- .wait({+door(X)}); through(X).
        +!s <- .wait(100); .suspend(g); ++door(1); .wait(500); s; .resume(g)."""
    assert said(program) == ["s", "through(1)"]


def test_a_plan_that_suspends_itself_is_resumed_by_another() -> None:
    assert said("!g. !s. +!g <- a; .suspend; b. +!s <- .wait(1000); s; .resume(g).") == ["a", "s", "b"]


def test_a_plan_whose_last_step_suspends_it_is_not_done_before_it_is_resumed() -> None:
    program = "!g. !s. +!g <- !h; after. +!h <- .suspend. +!s <- .wait(1000); s; .resume(h)."
    assert said(program) == ["s", "after"]


def test_an_atomic_plan_that_suspends_itself_lets_the_others_go_on() -> None:
    program = "!g. !s. @[atomic] +!g <- a; .suspend; b; c. +!s <- s1; .resume(g); s2; s3."
    assert said(program) == ["a", "s1", "b", "c", "s2", "s3"]


def test_suspending_a_goal_suspends_the_sub_goals_on_top_of_it() -> None:
    program = (
        "!g. !s. +!g <- !h; c. +!h <- a; .wait(300); b. +!s <- .wait(100); .suspend(g); .wait(900); s; .resume(g)."
    )
    assert said(program) == ["a", "s", "b", "c"]


def test_suspending_a_sub_goal_suspends_who_wants_it() -> None:
    program = (
        "!g. !s. +!g <- !h; c. +!h <- a; .wait(300); b. +!s <- .wait(100); .suspend(h); .wait(900); s; .resume(g)."
    )
    assert said(program) == ["a", "s", "b", "c"]


def test_suspend_is_by_pattern() -> None:
    program = """!go(uc). !go(library). !stay(uc). !s. +!go(P) <- .wait(800); go(P). +!stay(P) <- .wait(800); stay(P).
        +!s <- .wait(100); .suspend(go(_)); .wait(1500); s; .resume(go(library))."""
    assert said(program) == ["stay(uc)", "s", "go(library)"]


def test_no_plan_is_chosen_for_a_suspended_goal() -> None:
    """The context is asked when the goal is resumed, not before."""
    program = """!s. @[atomic] +!s <- !!g; .suspend(g); !!later. +!later <- .wait(500); +ready; .resume(g).
        +!g : ready <- good. +!g <- bad."""
    assert said(program) == ["good"]


def test_why_says_that_a_goal_without_a_plan_is_suspended() -> None:
    run = Run("!s. @[atomic] +!s <- !!g; .suspend(g). +!g <- a.")
    run.more(5)
    assert run.agent.why("g").sentence == "g is suspended: no plan is chosen until it is resumed."


def test_a_sub_goal_that_is_only_an_event_can_be_suspended() -> None:
    program = """!g. !s. +!g <- a; !h; c. +!h : ready <- good. +!h <- bad.
        +!s <- .wait(2000); +ready; .resume(g)."""
    run = Run(program, quick=False)
    run.more(3)
    intention = run.agent.intentions[1]
    run.agent.suspension.suspend(intention)
    assert run.more(3, "a") == []
    run.agent.suspension.resume(intention)
    assert run.more(30) == ["bad"]


def test_resume_is_about_what_was_suspended_only() -> None:
    run = Run("!g. !s. +!g <- drive; after. +!s <- .wait(100); .resume(g).", quick=False)
    assert run.more(10) == ["drive"]
    assert run.more(3, "drive") == ["after"]


@pytest.mark.parametrize(
    ("body", "reason"),
    [
        ("drive(uc)", "action(drive(uc))"),
        (".wait(9000)", "wait(9000)[time(9000)]"),
        ('.wait("+b")', 'wait("+b")'),
        (".send(bob,askOne,x,Y)", "ask"),
        (".suspend", "suspended"),
    ],
)
def test_why_a_goal_does_not_go_on_can_be_asked(body: str, reason: str) -> None:
    run = Run(f"!g. !s. +!g <- {body}. +!s <- .wait(500); for (.suspended(g,R)) {{ .print(R) }}; end.", quick=False)
    assert run.more(15)[-2:] == [reason, "end"]


def test_a_goal_that_goes_on_is_not_suspended() -> None:
    assert said("!g. +!g : .suspended(g,_) <- no. +!g <- yes.") == ["yes"]


# ---- dropping ------------------------------------------------------------------------------------------------------


def test_dropping_an_inner_goal_drops_who_wants_it() -> None:
    run = Run("!g. !s. +!g <- !h; c. -!g <- rescue. +!h <- drive. +!s <- .wait(300); .drop_intention(h).", quick=False)
    assert run.more(10) == ["drive"]
    assert (run.cancelled, run.failures, run.agent.idle) == (["drive"], [], True)


def test_a_plan_can_drop_its_own_intention() -> None:
    run = Run("!g. +!g <- !h; c. +!h <- a; .drop_intention; b.")
    assert run.more(10) == ["a"]
    assert run.agent.idle


def test_drop_intention_leaves_events_and_drop_event_leaves_intentions() -> None:
    program = "!s. @[atomic] +!s <- !!g; {}; end. +!g <- a."
    assert said(program.format(".drop_intention(g)")) == ["end", "a"]
    assert said(program.format(".drop_event(g)")) == ["end"]
    assert said("!g. !s. +!g <- a; .wait(300); b. +!s <- .drop_event(g).") == ["a", "b"]


def test_drop_desire_drops_both() -> None:
    program = (
        "!go(1). !s. +!go(X) <- .wait(500); go(X). @[atomic] +!s <- !!go(2); !!stay; .drop_desire(go(_)). +!stay <- a."
    )
    assert said(program) == ["a"]


def test_dropping_what_was_suspended_leaves_nothing() -> None:
    run = Run("!g. !s. +!g <- drive. +!s <- .wait(100); .suspend(g); .wait(300); .drop_intention(g).", quick=False)
    run.more(20)
    assert run.cancelled == ["drive"]
    assert not run.agent.intentions
    assert not run.agent.suspended_events


def test_dropping_one_branch_drops_the_intention() -> None:
    run = Run("!g. !s. +!g <- !h |&| drive; c. +!h <- walk. +!s <- .wait(500); .drop_intention(h); s.", quick=False)
    assert run.more(20) == ["drive", "walk", "s"]
    assert sorted(run.cancelled) == ["drive", "walk"]
    assert not run.more(3, "s")
    assert run.agent.idle


def test_drop_all_intentions_keeps_the_branches_of_the_one_that_says_so() -> None:
    run = Run("!g. !o. +!g <- (.wait(300); .drop_all_intentions) |&| drive; c. +!o <- other.", quick=False)
    run.more(10)
    assert run.cancelled == ["other"]
    assert run.more(5, "drive") == ["c"]


def test_a_time_that_was_dropped_wakes_no_intention() -> None:
    """The old wait is over after one second; the new one must not be cut short by it."""
    program = "!g. !s. +!g <- !h; .wait(3000); b. +!h <- .wait(1000). +!s <- .wait(500); .succeed_goal(h)."
    run = Run(program)
    assert run.more(30) == []
    assert run.more(10) == ["b"]


def test_future_intentions_are_those_that_have_the_goal_before_them() -> None:
    program = """!a. !b. !c. !s.
        +!a <- .wait(900); !go(uc); a. +!b <- .wait(900); if (x) { !go(library) }; b. +!c <- !go(uc); .wait(900); c.
        +!go(P). +!s <- .wait(200); .drop_future_intention(go(library))."""
    assert sorted(said(program)) == ["a", "c"]
    assert said(program.replace("drop_future_intention(go(library))", "drop_future_intention(go(_))")) == ["c"]


def test_a_loop_comes_round_again_to_its_goal() -> None:
    program = """n(0). !g. !s. +!g <- while (n(X) & X < 5) { !go; -+n(X+1); .wait(200) }; end. +!go <- a.
        +!s <- .wait(200); .drop_future_intention(go)."""
    assert said(program) == ["a"]


# ---- asking --------------------------------------------------------------------------------------------------------


def test_a_goal_is_desired_from_the_start_and_intended_once_a_plan_is_chosen() -> None:
    program = """!s. @[atomic] +!s <- !!go(1); !say; !!t.
        +!go(X) <- .wait(900). +!t <- .wait(100); !say.
        +!say <- .findall(X, .desire(go(X)), D); .findall(X, .intend(go(X)), I); said(D,I)."""
    assert said(program) == ["said([1],[])", "said([1],[1])"]


def test_a_suspended_goal_is_still_desired() -> None:
    assert said("!s. @[atomic] +!s <- !!g; .suspend(g); .desire(g); yes. +!g.") == ["yes"]


def test_the_intention_of_a_goal_can_be_asked_for_and_says_where_its_plans_are() -> None:
    program = """!g(7). +!g(X) <- !h.
        +!h <- .intend(g(Y), intention(Id, [im(L,_,_,_)|Rest])); _[code_line(N),code_src(F)] = L; L =.. [Plan,_,_];
            said(Y, Id, Plan, N, F)."""
    assert said(program) == ['said(7,1,p__2,2,"<text>")']


def test_the_context_of_a_plan_knows_the_intention_that_asks_for_it() -> None:
    program = """!g. !other. +!other <- .wait(9000). +!g <- !h.
        +!h : .intention(I,_,[im(_,{+!Who},_,_)|_],current) & Who =.. [_,Name,_,_] <- said(I,Name)."""
    assert said(program) == ["said(1,g)"]


def test_an_agent_knows_its_intentions_and_their_states() -> None:
    program = """!a. !b. !c. !s. +!a <- .wait(9000). +!b <- .suspend. +!c <- drive. +!s <- .wait(1000);
        .findall(St, .intention(_,St), L); said(L); .intention(I,_,_,current); .intention(I,How); said(How)."""
    run = Run(program, quick=False)
    assert run.more(15) == ["drive", "said([waiting,suspended,waiting,running])"]
    assert run.more(3, "said([waiting,suspended,waiting,running])") == ["said(running)"]


def test_the_current_intention_has_its_plans_the_running_one_first() -> None:
    program = """!g. @outer +!g <- !h; c. @inner +!h <- .current_intention(intention(Id, Stack));
        .findall(L, .member(im(P,_,_,_), Stack) & P =.. [L,_,_], Ls); said(Id, Ls)."""
    assert said(program)[0] == "said(1,[inner,outer])"


# ---- succeeding and failing ----------------------------------------------------------------------------------------


def test_an_inner_goal_that_succeeds_lets_who_wants_it_go_on() -> None:
    run = Run(
        "!g. !s. +!g <- !h; c. +!h <- !i; no. +!i <- drive; no. +!s <- .wait(300); .succeed_goal(h).", quick=False
    )
    assert run.more(10) == ["drive", "c"]
    assert run.cancelled == ["drive"]


def test_an_outer_goal_that_succeeds_is_over() -> None:
    run = Run("!g. !s. +!g <- !h; c. +!h <- drive; no. +!s <- .wait(300); .done(g); s.", quick=False)
    assert run.more(10) == ["drive", "s"]
    assert (run.cancelled, run.failures) == (["drive"], [])


def test_a_goal_can_succeed_before_a_plan_is_chosen() -> None:
    assert said("!s. @[atomic] +!s <- !!g; .succeed_goal(g); end. +!g <- no.") == ["end"]
    assert said("!g. !s. +!g <- !h(1); c. +!h(X) <- no. +!s <- .succeed_goal(h(_)).") == ["c"]


def test_a_plan_can_end_its_own_goals() -> None:
    assert said("!g. +!g <- !h; c. +!h <- !i; no. +!i <- .succeed_goal(h); no.") == ["c"]
    assert said("!g. +!g <- !h; c. +!h <- !i; no. +!i <- .fail_goal(h); no. -!h <- rescue.") == ["rescue", "c"]


def test_an_inner_goal_that_fails_is_rescued_by_its_own_plan() -> None:
    program = """!g. !s. +!g <- !h; c. +!h <- !i; no. +!i <- drive; no. -!i <- wrong.
        -!h[error(E), why(W)] <- .print(E, W). +!s <- .wait(300); .fail_goal(h, why(late))."""
    run = Run(program, quick=False)
    assert run.more(10) == ["drive", "goal_failedlate", "c"]
    assert run.cancelled == ["drive"]


def test_a_goal_that_fails_without_a_plan_of_its_own_fails_who_wants_it() -> None:
    run = Run("!g. !s. +!g <- !h; c. -!g <- rescue. +!h <- .wait(9000). +!s <- .wait(300); .fail_goal(h).")
    assert run.more(10) == ["rescue"]


def test_a_goal_that_is_only_an_event_can_fail() -> None:
    assert said("!s. @[atomic] +!s <- !!g; .fail_goal(g); end. +!g <- no. -!g[error(E)] <- said(E).") == [
        "end",
        "said(goal_failed)",
    ]


def test_succeeding_and_failing_resume_what_was_suspended() -> None:
    program = "!g. !s. +!g <- !h; c. +!h <- .wait(200); a. -!h <- rescue. +!s <- .suspend(h); .wait(500); {}(h)."
    assert said(program.format(".succeed_goal")) == ["c"]
    assert said(program.format(".fail_goal")) == ["rescue", "c"]


def test_succeeding_the_goal_around_branches_ends_all_of_them_once() -> None:
    run = Run("!g. !s. +!g <- !h; c. +!h <- drive |&| (walk; no). +!s <- .wait(500); .succeed_goal(h).", quick=False)
    assert run.more(10) == ["drive", "walk", "c"]
    assert sorted(run.cancelled) == ["drive", "walk"]


def test_a_goal_that_two_intentions_pursue_ends_for_both() -> None:
    program = """!a. !b. !s. +!a <- !h(1); a. +!b <- !h(2); b. +!h(X) <- .wait(9000).
        +!s <- .wait(500); .succeed_goal(h(_))."""
    assert said(program) == ["a", "b"]
