"""Meta events: what plans hear of the states of goals, in which order, with which reasons."""

from bdi import Agent, Finished, Message, parse_program


def heard(program: str, cycles: int = 40, finish: bool = True, fail: str = "") -> list[str]:
    """Return what plans such as `^!g[state(S)] <- .print(S)` print; actions succeed at once, or never."""
    agent = Agent(parse_program(program))
    said: list[str] = []
    finished: list[Finished] = []
    for cycle in range(1, cycles + 1):
        outcome = agent.cycle(None, (), finished, cycle / 10)
        said += outcome.printed
        ended = [action for action in outcome.actions if finish]
        finished = [Finished(action.id, "jammed" if action.term.functor == fail else None) for action in ended]
    return said


PRINT = " ^!g[state(S)] <- .print(S)."
WITH_REASON = ' ^!g[state(S)[reason(R)]] <- .print(S, " ", R). ^!g[state(S)] <- .print(S).'


def test_a_goal_is_pending_executing_achieved_and_finished() -> None:
    assert heard("!g. +!g <- X = 1." + PRINT) == ["pending", "executing", "achieved", "finished"]


def test_how_a_goal_ended_is_the_reason_of_finished() -> None:
    assert heard("!g. +!g." + WITH_REASON)[-1] == "finished achieved"
    assert heard("!g. +!g <- .fail." + WITH_REASON)[-1] == "finished unachieved"
    assert heard("!g. +!g <- .drop_intention." + WITH_REASON)[-1] == "finished dropped"


def test_a_goal_waits_for_its_action_and_goes_on() -> None:
    said = heard("!g. +!g <- drive(uc)." + WITH_REASON)
    assert said == ["pending", "executing", "waiting action(drive(uc))", "achieved", "finished achieved"]


def test_all_goals_of_an_intention_wait_together() -> None:
    program = """!a. +!a <- !b. +!b <- .wait(300).
        ^!a[state(S)] <- .print(a, S). ^!b[state(S)] <- .print(b, S)."""
    assert heard(program) == [
        *["apending", "aexecuting", "bpending", "bexecuting", "bwaiting", "awaiting", "bexecuting", "aexecuting"],
        *["bachieved", "bfinished", "aachieved", "afinished"],
    ]


def test_the_reason_of_a_wait_says_how_long() -> None:
    assert "waiting wait(300)[time(300)]" in heard("!g. +!g <- .wait(300)." + WITH_REASON)
    assert 'waiting wait("+b")' in heard('!g. +!g <- .wait("+b").' + WITH_REASON)


def test_suspend_and_resume_are_heard() -> None:
    program = "!g. !s. +!g <- .wait(400); a. +!s <- .wait(100); .suspend(g); .wait(900); .resume(g)."
    assert heard(program + PRINT) == [
        *["pending", "executing", "waiting", "suspended", "executing", "resumed"],
        *["waiting", "achieved", "finished"],
    ]


def test_a_goal_that_is_only_an_event_can_be_suspended() -> None:
    program = "!s. @[atomic] +!s <- !!g; .suspend(g); !!later. +!later <- .wait(500); .resume(g). +!g <- a."
    assert heard(program + PRINT)[:4] == ["pending", "suspended", "resumed", "executing"]


def test_a_failed_goal_is_heard_with_its_error() -> None:
    said = heard("!g. +!g <- ?nothing. -!g <- rescue." + WITH_REASON)
    assert said[:3] == ["pending", "executing", "failed test_goal_failed"]
    assert said[-1] == "finished unachieved"
    assert said.count("finished unachieved") == 1


def test_a_goal_without_plan_fails() -> None:
    assert heard("!g." + WITH_REASON) == ["pending", "failed no_relevant", "finished unachieved"]
    assert heard("!g. +!g : no." + WITH_REASON) == ["pending", "failed no_applicable", "finished unachieved"]


def test_goals_above_the_one_with_a_plan_for_its_failure_are_finished() -> None:
    program = """!a. +!a <- !g; after. +!g <- fail_action. -!a <- rescue."""
    said = heard(program + WITH_REASON, fail="fail_action")
    assert said[-2:] == ["failed action_failed", "finished unachieved"]


def test_dropped_goals_are_heard() -> None:
    for way in (".drop_intention(g)", ".drop_desire(g)", ".drop_all_intentions", ".drop_all_desires"):
        said = heard(f"!g. !s. +!g <- .wait(9000). +!s <- .wait(300); {way}." + WITH_REASON)
        assert said[-2:] == ["dropped", "finished dropped"], way


def test_a_dropped_event_is_heard() -> None:
    assert heard("!s. @[atomic] +!s <- !!g; .drop_event(g). +!g." + PRINT) == ["pending", "dropped", "finished"]


def test_succeed_goal_is_an_achievement() -> None:
    said = heard("!g. !s. +!g <- .wait(9000). +!s <- .wait(300); .succeed_goal(g)." + PRINT)
    assert said == ["pending", "executing", "waiting", "achieved", "finished"]


def test_fail_goal_is_a_failure() -> None:
    said = heard("!g. !s. +!g <- .wait(9000). +!s <- .wait(300); .fail_goal(g)." + PRINT)
    assert said == ["pending", "executing", "waiting", "failed", "finished"]


def test_test_goals_have_states_too() -> None:
    said = heard("!a. +!a <- ?where(X). +?where(uc) <- .wait(100). ^?where(X)[state(S)] <- .print(S).")
    assert said == ["pending", "executing", "waiting", "executing", "achieved", "finished"]


def test_arguments_and_annotations_of_the_goal_are_in_the_event() -> None:
    program = "!g(1,uc)[urgent]. +!g(X,P). ^!g(X,P)[urgent, source(S), state(achieved)] <- .print(X, P, S)."
    assert heard(program) == ["1ucself"]


def test_a_goal_that_is_told_is_heard() -> None:
    agent = Agent(parse_program("+!g <- a. ^!g[source(S), state(pending)] <- .print(S)."))
    printed = agent.cycle(None, [Message("bob", "achieve", "g")]).printed
    printed += tuple(line for _ in range(4) for line in agent.cycle().printed)
    assert printed == ("bob",)


def test_a_plan_with_a_variable_hears_of_every_goal_but_its_own() -> None:
    program = "!a. +!a <- !b. +!b. +!note <- .print(noted). ^!G <- !note."
    assert heard(program, cycles=100) == ["noted"] * 8  # four states of each goal


def test_meta_plans_can_be_added_later() -> None:
    program = '!a. +!a <- !!g; .wait(200); .add_plan("^!g[state(S)] <- .print(S)."); !!g. +!g.'
    assert heard(program) == ["pending", "executing", "achieved", "finished"]


def test_a_rescue_mission_suspends_moving_without_knowing_of_it() -> None:
    """Goals do not know each other; how they go together is said by meta plans."""
    agent = Agent(
        parse_program(
            """!move.
            +!move <- step; !move.
            +battery(low) <- !charge.
            +!charge <- plug; .wait({-battery(low)}); unplug.
            ^!charge[state(executing)] <- .suspend(move).
            ^!charge[state(finished)] <- .resume(move)."""
        )
    )
    seen: list[str] = []
    finished: list[Finished] = []
    for cycle in range(40):
        percepts = {"battery(low)"} if 4 <= cycle < 20 else set()
        outcome = agent.cycle(percepts, (), finished, cycle / 10)
        seen += [f"{cycle} {action}" for action in outcome.actions]
        finished = [Finished(action.id) for action in outcome.actions]
    plugged = next(int(each.split()[0]) for each in seen if each.endswith(" plug"))
    unplugged = next(int(each.split()[0]) for each in seen if each.endswith("unplug"))
    steps = [int(each.split()[0]) for each in seen if each.endswith("step")]
    assert steps[0] == 0
    assert [step for step in steps if plugged + 3 < step < unplugged] == []
    assert steps[-1] > unplugged


def test_branches_tell_once_that_a_goal_is_over() -> None:
    program = "!g. +!g <- (a; b) |&| c." + PRINT
    said = heard(program, cycles=60)
    assert said[-2:] == ["achieved", "finished"]
    assert said.count("finished") == 1
    dropped = heard("!g. !s. +!g <- a |&| b. +!s <- .wait(500); .drop_intention(g)." + PRINT, finish=False)
    assert (dropped[-2:], dropped.count("dropped")) == (["dropped", "finished"], 1)


def test_what_becomes_of_goals_is_answered_before_other_events() -> None:
    program = "!g. !other. +!g <- !h. +!h. +!other <- .print(other). ^!h[state(pending)] <- .print(h)."
    assert heard(program) == ["h", "other"]
    program = "!g. +!g <- !!h; !!other. +!h. +!other <- .print(other). ^!h[state(executing)] <- .print(h)."
    assert heard(program) == ["h", "other"]
