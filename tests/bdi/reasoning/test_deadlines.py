"""Goals with a hard or a soft deadline, by the clock that the agent is given (0.1 s a cycle)."""

import gc

import pytest

from bdi import Agent, Finished, Message, parse_program


class Run:
    """Cycles of 0.1 s; an action ends when the test says so."""

    def __init__(self, program: str) -> None:
        self.agent = Agent(parse_program(program))
        self.cycles = 0
        self.said: list[str] = []
        self.cancelled: list[int] = []
        self.failures: list[str] = []
        self.ids: dict[str, int] = {}

    def until(self, seconds: float, *finished: str, percepts: set[str] | None = None) -> "Run":
        news = [Finished(self.ids[name]) for name in finished]
        while self.cycles < round(seconds * 10):
            self.cycles += 1
            outcome = self.agent.cycle(percepts, (), news, self.cycles / 10)
            news = []
            self.said += outcome.printed
            self.said += map(str, outcome.actions)
            self.ids |= {str(action): action.id for action in outcome.actions}
            self.cancelled += outcome.cancelled
            self.failures += [failure.error for failure in outcome.failures]
        return self

    def nothing_is_left(self) -> bool:
        gc.collect()
        agent = self.agent
        left = (agent.intentions, agent.events, agent.suspended_events, agent.running, agent.timers, agent.waiters)
        return agent.idle and not agent.deadlines and not any(left)


def test_a_goal_that_takes_too_long_fails_and_its_plan_for_failure_runs() -> None:
    run = Run(
        """!deliver.
        +!deliver <- !travel[hard_deadline(1000)]; hand_over.
        +!travel <- drive.
        -!travel[error(E), error_msg(M)] <- .print(E, ": ", M); walk."""
    )
    assert run.until(1.0).said == ["drive"]
    run.until(1.5)
    assert run.said == ["drive", "deadline_reached: +!travel was not reached in 1000 ms", "walk"]
    assert run.cancelled == [run.ids["drive"]]
    assert run.until(3, "walk").said[-1] == "hand_over"
    assert run.until(4, "hand_over").nothing_is_left()


def test_a_goal_that_is_reached_in_time_has_no_deadline_any_more() -> None:
    run = Run("!g. +!g <- !h[hard_deadline(1000)]; .wait(5000); end. +!h <- .wait(500).")
    run.until(1)
    gc.collect()
    assert not run.agent.deadlines
    assert run.until(8).said == ["end"]
    assert not run.failures


def test_a_goal_that_failed_before_has_no_deadline_any_more() -> None:
    run = Run("!g. +!g <- !h[hard_deadline(1000)]; end. +!h <- .fail. -!h <- .wait(3000); rescued.")
    assert run.until(5).said == ["rescued"]
    assert run.until(6, "rescued").said == ["rescued", "end"]
    assert run.until(7, "end").nothing_is_left()


def test_without_a_plan_for_its_failure_the_caller_fails() -> None:
    run = Run("!g. +!g <- !h[hard_deadline(1000)]; end. +!h <- !i. +!i <- .wait(9000). -!g[error(E)] <- .print(E).")
    assert run.until(2).said == ["deadline_reached"]
    assert run.nothing_is_left()


def test_a_deadline_reaches_sub_goals_and_leaves_outer_goals_their_time() -> None:
    run = Run(
        """!g. +!g <- !h[hard_deadline(2000)]; end. +!h <- !i[hard_deadline(500)]; late. +!i <- drive.
        -!i <- .print(i). -!h <- .print(h)."""
    )
    run.until(1)
    assert run.said == ["drive", "i", "late"]
    assert run.until(3).said == ["drive", "i", "late", "h", "end"]
    assert run.cancelled == [run.ids["drive"], run.ids["late"]]


def test_the_outer_goal_takes_the_inner_one_with_it() -> None:
    run = Run(
        "!g. +!g <- !h[hard_deadline(1000)]; end. +!h <- !i[hard_deadline(1000)]. +!i <- drive. -!h <- .print(h)."
    )
    assert run.until(3).said == ["drive", "h", "end"]
    assert len(run.cancelled) == 1


def test_a_goal_apart_has_its_deadline_too() -> None:
    run = Run("!g. +!g <- !!h[hard_deadline(1000)]; end. +!h <- drive.")
    run.until(2)
    assert (run.said, run.failures, run.cancelled) == (["end", "drive"], ["deadline_reached"], [run.ids["drive"]])


def test_an_initial_goal_and_one_that_is_told_can_have_deadlines() -> None:
    run = Run("!h[hard_deadline(500)]. +!h <- .wait(2000). -!h[source(S), error(E)] <- .print(S, E).")
    run.until(1)
    run.agent.cycle(None, [Message("bob", "achieve", "h[hard_deadline(500)]")], (), 1.05)
    assert run.until(2).said == ["selfdeadline_reached", "bobdeadline_reached"]


def test_time_goes_on_while_a_goal_is_suspended_and_failing_resumes_it() -> None:
    run = Run("!g. !s. +!g <- !h[hard_deadline(1000)]. +!h <- .wait(100); a. -!h <- rescued. +!s <- .suspend(h).")
    assert run.until(2).said == ["rescued"]


def test_a_goal_without_any_turn_yet_fails_as_well() -> None:
    run = Run("!busy. @[atomic] +!busy <- !!h[hard_deadline(500)]; drive. +!h <- never. -!h[error(E)] <- .print(E).")
    run.until(1)
    assert run.until(2, "drive").said == ["drive", "deadline_reached"]


def test_an_atomic_plan_that_is_too_late_lets_the_others_go_on() -> None:
    run = Run("!g[hard_deadline(500)]. !other. @[atomic] +!g <- drive. -!g <- stop. +!other <- other.")
    assert run.until(2).said == ["drive", "other", "stop"]


def test_a_deadline_in_one_branch_ends_that_goal_only() -> None:
    run = Run("!g. +!g <- !h[hard_deadline(500)] |&| b; end. +!h <- drive. -!h <- stop.")
    run.until(0.4)
    run.until(2, "b")
    assert run.said == ["b", "drive", "stop"]
    assert run.until(3, "stop").said[-1] == "end"


def test_a_deadline_of_the_goal_around_branches_ends_them_all() -> None:
    run = Run("!g. +!g <- !h[hard_deadline(500)]; end. +!h <- a |&| b. -!h <- stop.")
    run.until(2)
    assert run.said == ["a", "b", "stop"]
    assert sorted(run.cancelled) == sorted([run.ids["a"], run.ids["b"]])
    assert run.until(3, "stop").said[-1] == "end"


def test_tail_recursion_keeps_the_deadline() -> None:
    run = Run("!g. +!g <- !turn(0)[hard_deadline(1000)]; end. +!turn(N) <- .wait(200); !turn(N+1). -!turn(0) <- stop.")
    assert run.until(3).said == ["stop"]


def test_the_milliseconds_can_be_worked_out() -> None:
    run = Run("limit(300). !g. +!g : limit(L) <- !h[hard_deadline(L*2)]; end. +!h <- .wait(9000). -!h <- stop.")
    assert run.until(0.6).said == []
    assert run.until(1).said == ["stop"]


@pytest.mark.parametrize("limit", ["soon", "[1]", "X"])
def test_a_deadline_that_is_no_number_is_reported_and_the_goal_goes_on(limit: str) -> None:
    run = Run(f"!g. +!g <- !h[hard_deadline({limit})]; end. +!h <- a.")
    run.until(1)
    assert run.failures == ["wrong_arguments"]
    assert run.until(2, "a").said == ["a", "end"]


def test_a_soft_deadline_says_that_a_goal_is_late_and_the_goal_goes_on() -> None:
    run = Run(
        """!g. +!g <- !travel(uc)[soft_deadline(1000)]; end. +!travel(P) <- drive(P).
        ^!travel(P)[state(late)[reason(soft_deadline(MS))]] <- tell_user(P, MS)."""
    )
    assert run.until(2).said == ["drive(uc)", "tell_user(uc,1000)"]
    assert run.until(3, "drive(uc)").said[-1] == "end"
    assert not run.failures


def test_a_soft_deadline_may_end_the_goal_in_a_plan_of_its_own() -> None:
    run = Run(
        """!g. +!g <- !h[soft_deadline(500)]; end. +!h <- drive. -!h[error(E), late] <- .print(E).
        ^!h[state(late)] <- .fail_goal(h, late)."""
    )
    assert run.until(2).said == ["drive", "goal_failed", "end"]
    assert run.cancelled == [run.ids["drive"]]


def test_first_soft_then_hard() -> None:
    run = Run(
        """!g. +!g <- !h[soft_deadline(500), hard_deadline(1000)]; end. +!h <- .wait(9000). -!h <- stop.
        ^!h[state(late)] <- .print(late)."""
    )
    assert run.until(0.9).said == ["late"]
    assert run.until(2).said == ["late", "stop"]


def test_a_soft_deadline_without_a_plan_about_it_does_nothing() -> None:
    run = Run("!g. +!g <- !h[soft_deadline(100)]; end. +!h <- .wait(500).")
    assert run.until(2).said == ["end"]


def test_an_agent_that_only_waits_for_ever_is_not_idle_while_a_deadline_runs() -> None:
    run = Run("!g[hard_deadline(1000)]. +!g <- .wait({+never}).")
    assert not run.until(0.5).agent.idle
    assert run.until(1.5).nothing_is_left()
