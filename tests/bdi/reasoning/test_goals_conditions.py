"""`+!g <: condition`: the goal counts as reached as soon as the condition holds."""

from bdi import Agent, Finished, parse_program


def agent_of(program: str) -> Agent:
    return Agent(parse_program(program))


def test_an_action_that_goes_on_is_cancelled_and_who_wanted_the_goal_goes_on() -> None:
    agent = agent_of("!deliver. +!deliver <- !travel; hand_over. +!travel <: at(uc) <- drive; no.")
    started = [action for _ in range(3) for action in agent.cycle(set()).actions]
    assert list(map(str, started)) == ["drive"]
    outcome = agent.cycle({"at(uc)"})
    assert outcome.cancelled == (started[0].id,)
    assert [str(action) for action in outcome.actions] == ["hand_over"]


def test_an_action_that_ends_in_the_same_cycle_is_not_cancelled() -> None:
    agent = agent_of("!g. +!g <: at(uc) <- drive; no.")
    drive = agent.cycle(set()).actions[0]
    outcomes = [agent.cycle({"at(uc)"}, (), [Finished(drive.id)]), *(agent.cycle() for _ in range(3))]
    assert [(outcome.cancelled, outcome.actions) for outcome in outcomes] == [((), ())] * 4
    assert agent.idle


def test_a_wait_for_ever_ends() -> None:
    agent = agent_of("!g. +!g <- !h; after. +!h <: enough <- .wait({+never}).")
    assert not any(agent.cycle(set()).actions for _ in range(5))
    assert [str(action) for action in agent.cycle({"enough"}).actions] == ["after"]
    assert not agent.waiters


def test_sub_goals_and_branches_end_with_their_goal() -> None:
    agent = agent_of("!g. +!g <- !h; after. +!h <: enough <- !far |&| sing; no. +!far <- drive; no.")
    started = [action.id for _ in range(6) for action in agent.cycle(set()).actions]
    assert len(started) == 2
    outcome = agent.cycle({"enough"})
    assert sorted(outcome.cancelled) == started
    assert [str(action) for action in (*outcome.actions, *agent.cycle().actions)] == ["after"]


def test_the_condition_of_an_inner_goal_leaves_the_outer_one() -> None:
    agent = agent_of("!g. +!g <: done <- !h; more. +!h <: half <- drive.")
    for _ in range(4):
        agent.cycle(set())
    assert [str(action) for action in agent.cycle({"half"}).actions] == ["more"]
    outcome = agent.cycle({"half", "done"})
    assert len(outcome.cancelled) == 1
    assert agent.idle


def test_the_values_of_the_goal_count_in_its_condition() -> None:
    agent = agent_of("!go(uc). !go(library). +!go(P) <: at(P) <- drive(P).")
    drives = {str(action): action.id for _ in range(4) for action in agent.cycle(set()).actions}
    assert agent.cycle({"at(library)"}).cancelled == (drives["drive(library)"],)


def test_a_condition_that_cannot_be_worked_out_does_not_hold() -> None:
    agent = agent_of("!g. +!g <: .nth(9,[a],_) <- drive; after.")
    drive = agent.cycle().actions[0]
    assert [str(action) for action in agent.cycle(None, (), [Finished(drive.id)]).actions] == ["after"]


def test_a_goal_whose_condition_holds_already_is_reached_at_once() -> None:
    agent = agent_of("enough. !g. +!g <- !h; after. +!h <: enough <- no.")
    assert [str(action) for _ in range(2) for action in agent.cycle().actions] == ["after"]


def test_such_a_goal_can_be_ended_by_others() -> None:
    agent = agent_of("!g. !k. +!g <- !h; after. +!h <: never. +!k <- .wait(300); .succeed_goal(h).")
    assert [str(action) for n in range(9) for action in agent.cycle(None, (), (), n / 10).actions] == ["after"]
    agent = agent_of("!g. !k. +!g <- !h; no. +!h <: never. +!k <- .wait(300); .drop_intention(g); done.")
    assert [str(action) for n in range(9) for action in agent.cycle(None, (), (), n / 10).actions] == ["done"]


def test_others_keep_their_turns_when_a_goal_is_reached() -> None:
    program = "+!a <- !g; a1. +!g <- g1; g2; g3. +!x <- x1; x2; x3; x4; x5. +!s <- s1; s2; .succeed_goal(g); s3."
    agent = agent_of("!x. !a. !s. " + program)
    done: list[Finished] = []
    seen: list[str] = []
    for _ in range(14):
        outcome = agent.cycle(None, (), done)
        done = [Finished(action.id) for action in outcome.actions]
        seen += map(str, outcome.actions)
    assert seen == ["x1", "x2", "s1", "g1", "x3", "s2", "g2", "x4", "a1", "x5", "s3"]


def test_a_goal_is_not_reached_before_its_condition_holds() -> None:
    agent = agent_of("!g. +!g <- !h; after. +!h <: enough <- one.")
    one = next(action for _ in range(3) for action in agent.cycle(set()).actions)
    assert not any(agent.cycle(None, (), [Finished(one.id)]).actions or agent.cycle().actions for _ in range(3))
    assert agent.why("h").sentence == "h waits until enough holds: plan p__2 has nothing left to do."
    assert [str(action) for action in agent.cycle({"enough"}).actions] == ["after"]
    assert not agent.waiters


def test_a_condition_that_never_holds_waits_until_the_plan_is_done_by_its_own_word() -> None:
    agent = agent_of("!g. +!g <- !h; after. +!h <: false <- !part; one; .done; never. +!part <- .done; never.")
    one = next(action for _ in range(6) for action in agent.cycle().actions)
    outcomes = [agent.cycle(None, (), [Finished(one.id)]), *(agent.cycle() for _ in range(4))]
    assert [str(action) for outcome in outcomes for action in outcome.actions] == ["after"]


def test_a_goal_with_a_condition_that_pursues_itself_again_does_not_grow() -> None:
    agent = agent_of("!g(0). +!g(N) <: N > 200 <- !g(N+1).")
    heights = set()
    for _ in range(300):
        agent.cycle()
        heights |= {len(intention.stack) for intention in agent.intentions.values()}
    assert heights == {1}
