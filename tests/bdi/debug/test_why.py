"""agent.why(goal): every reason for which a goal is not reached, in words and as data."""

import json

import pytest

from bdi import Agent, Finished, Message, parse_program
from bdi.debug.explain import WORDS


def agent_of(text: str, cycles: int = 0, **options: object) -> Agent:
    agent = Agent(parse_program(text), **options)  # type: ignore[arg-type]
    for number in range(cycles):
        agent.cycle(now=number * 0.1)
    return agent


def test_a_goal_waits_for_a_moment_and_it_is_said_how_long_yet() -> None:
    agent = agent_of("!g. @slow +!g <- .wait(2000); a.")
    agent.cycle(now=10.0)
    agent.cycle(now=10.5)
    why = agent.why("g")
    assert why.sentence == "g waits 1.5 s more in plan slow."
    assert (why.kind, why.left_s) == ("moment", 1.5)


def test_a_goal_waits_for_an_event_with_and_without_an_end() -> None:
    agent = agent_of('!g. @p +!g <- .wait("+open(_)", 3000).')
    agent.cycle(now=1.0)
    agent.cycle(now=2.0)
    assert agent.why("g").sentence == "g waits for +open(_) in plan p, 2.0 s more at most."
    assert agent_of('!g. @p +!g <- .wait("+open").', 2).why("g").sentence == "g waits for +open in plan p."


def test_a_goal_waits_for_an_answer_and_it_is_said_whose() -> None:
    agent = agent_of("!g. @p +!g <- .send(bob, askOne, price(X), A, 5000); buy(A).", 1)
    why = agent.why("g")
    assert why.waits_for == "the answer of bob"
    assert why.sentence == "g waits for the answer of bob in plan p, 5.0 s more at most."


def test_a_suspended_goal_names_the_plan_that_suspended_it() -> None:
    agent = agent_of("!g. !h. @work +!g <- a; b. @boss +!h <- .suspend(g); c.", 5)
    why = agent.why("g")
    assert why.state == "is suspended"
    assert why.sentence == "g is suspended in plan work, by plan boss."


def test_a_goal_waits_for_its_turn_behind_an_atomic_plan() -> None:
    agent = agent_of("!g. @slow +!g <- x; y. @first[atomic] +alarm <- a; b.", 1)
    agent.cycle(("alarm",))
    agent.cycle(("alarm",), [], [Finished(1)])
    why = agent.why("g")
    assert why.kind == "turn"
    assert why.sentence == ("g waits for its turn in plan slow: plan first of intention 2 is atomic and goes first.")
    blocked = agent_of("@first[atomic] +alarm <- a; b. +!g <- c.")
    blocked.cycle(("alarm",))
    blocked.cycle(("alarm",), [Message("user", "achieve", "g")])
    why = blocked.why("g")
    assert why.kind == "pending behind"
    assert why.sentence == (
        "g waits for its turn: no plan has been chosen yet, plan first of intention 1 is atomic and goes first."
    )


def test_a_goal_that_was_posted_waits_for_a_plan() -> None:
    assert agent_of("!a. !b. +!a <- x. +!b <- y.", 1).why("b").sentence == (
        "b waits for its turn: no plan has been chosen yet."
    )
    waiting = agent_of("!a. @p +!a <- !sub. +!sub <- x.", 1)
    assert waiting.why("a").sentence == "a waits until a plan is chosen for +!sub in plan p."


def test_a_goal_that_was_given_up_says_why() -> None:
    agent = agent_of("!deliver(post4). +!deliver(P) <- drive(P).", 1)
    agent.cycle(None, [], [Finished(1, "bumped", "hit a wall")])
    why = agent.why("deliver(_)")
    assert why.sentence == "deliver(post4) was given up: action_failed, hit a wall."
    assert why.kind == "given up"
    assert agent.why("deliver(post5)").kind == "unknown"


def test_what_was_given_up_is_forgotten_in_time() -> None:
    agent = agent_of("+!try(N) <- .fail.")
    for number in range(200):
        agent.cycle(None, [Message("user", "achieve", f"try({number})")])
        agent.cycle()
    assert agent.why("try(199)").kind == "given up"
    assert agent.why("try(1)").kind == "unknown"
    assert len(agent.given_up) == 50


def test_while_a_debugger_listens_it_is_said_why_this_plan() -> None:
    program = "!go. at(library). @a +!go : at(uc) <- x. @b +!go : at(P) <- drive(P). @c +!go <- y."
    silent = agent_of(program, 1)
    assert silent.why("go").chosen is None
    heard = agent_of(program)
    heard.listen(lambda entry: None, explain=True)
    heard.cycle()
    assert heard.why("go").chosen == (
        "plan b was chosen for +!go, since of the earlier ones a did not apply "
        "(at(uc) does not hold (believed: at(library)))"
    )


def test_another_table_of_words_says_it_in_another_language() -> None:
    agent = agent_of("!deliver(post4). @p +!deliver(P) <- drive(P).", 1)
    german = {**WORDS, "action": "{goal} wartet auf {what}"}
    assert agent.why("deliver(_)").in_words(german) == "deliver(post4) wartet auf drive(post4)."


@pytest.mark.parametrize("program", ["!g. +!g <- a.", "!g. +!g <- .wait(100).", "", "!g."])
def test_the_data_can_be_written_as_json(program: str) -> None:
    data = agent_of(program, 2).why("g").data()
    assert json.loads(json.dumps(data))["sentence"] == data["sentence"]
