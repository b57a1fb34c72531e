"""Questions between agents: how they are answered, and what who asked them does meanwhile; and know-how."""

import pytest

from bdi import Agent, Message, Outcome, parse_program


def agent_of(text: str, name: str = "r1") -> Agent:
    return Agent(parse_program(text), name=name, random_seed=1)


def told(agent: Agent, performative: str, content: str, sender: str = "bob", **more: str) -> Outcome:
    return agent.cycle(None, [Message(sender, performative, content, **more)])


def actions(agent: Agent, cycles: int = 8, start_s: float = 0.0) -> list[str]:
    """Return the outputs of the next cycles, a second apart; no action ever ends."""
    return [str(each) for n in range(cycles) for each in agent.cycle(now=start_s + n).actions]


def replies(agent: Agent, performative: str, content: str, cycles: int = 8) -> list[tuple[str, str]]:
    """Performative and content of all that it answers to bob's question q1."""
    sent = [*told(agent, performative, content, id="q1").messages]
    sent += [message for _ in range(cycles) for message in agent.cycle().messages]
    assert all((each.receiver, each.reply_to) == ("bob", "q1") for each in sent)
    return [(each.performative, str(each.content)) for each in sent]


def asker(ask: str, then: str = "know(A)") -> tuple[Agent, Message]:
    """An agent that has just asked, and its question."""
    agent = agent_of(f"!g. +!g <- {ask}; {then}. -!g[error(E)] <- sorry(E).")
    return agent, agent.cycle().messages[0]


# ---- answering -----------------------------------------------------------------------------------------------------


def test_a_question_that_no_belief_answers_is_answered_by_a_plan() -> None:
    agent = agent_of("factor(3). +?double(X,Y) : factor(F) <- Y = X*2*F.")
    assert replies(agent, "askOne", "double(5,Y)") == [("tell", "double(5,30)")]


@pytest.mark.parametrize("plan", ["+?p(X) <- .fail.", "+?p(X) : never <- X = 1.", "-?p(X) <- .fail. +?p(X) <- .fail."])
def test_a_plan_that_finds_nothing_answers_with_no(plan: str) -> None:
    agent = agent_of(plan)
    assert [kind for kind, _ in replies(agent, "askOne", "p(X)")] == ["untell"]
    assert [kind for kind, _ in replies(agent, "askOne", "p(X)")] == ["untell"]
    assert not agent.intentions


def test_a_belief_answers_before_a_plan() -> None:
    assert replies(agent_of("p(1). +?p(X) <- X = 2."), "askOne", "p(X)") == [("tell", "p(1)")]


def test_all_answers_come_as_one_list() -> None:
    agent = agent_of("p(1). p(2). q(X) :- p(X) & X > 1. +?r(X) <- X = 3.")
    assert replies(agent, "askAll", "q(X)") == [("tell", "[q(2)]")]
    assert replies(agent, "askAll", "p(X)") == [("tell", "[p(1),p(2)]")]
    assert replies(agent, "askAll", "r(X)") == [("tell", "[]")]


def test_an_answer_says_from_whom_it_is_known_unless_by_the_agent_itself() -> None:
    agent = agent_of("p(1)[source(ann)]. p(2). p(3)[k(1),source(ann)].")
    assert replies(agent, "askAll", "p(X)") == [("tell", "[p(1)[source(ann)],p(2),p(3)[k(1),source(ann)]]")]
    assert replies(agent, "askOne", "p(2)") == [("tell", "p(2)")]
    assert replies(agent, "askOne", "p(1)") == [("tell", "p(1)[source(ann)]")]


def test_know_how_is_asked_for_without_annotations() -> None:
    agent = agent_of("@a +!go(X)[source(S)] <- a. +!G <- b.")
    assert replies(agent, "askHow", "{+!go(_)}") == [("tellHow", "[{@a +!go(X)[source(S)] <- a},{+!G <- b}]")]


def test_know_how_is_told_as_plans() -> None:
    agent = agent_of("@a +!go(X) : X > 1 <- a. @b +!go(home) <- b. @c +!stay <- c.")
    assert replies(agent, "askHow", "+!go(5)") == [("tellHow", "[{@a +!go(X) : (X>1) <- a}]")]


# ---- asking --------------------------------------------------------------------------------------------------------


def test_the_answer_to_a_question_that_no_agent_waits_for_is_believed() -> None:
    agent = agent_of("!g. +!g <- .send(bob, askOne, at(X)); on. +at(X)[source(S)] <- at(X,S).")
    question = agent.cycle().messages[0]
    assert actions(agent, 1) == ["on"]
    assert [str(each) for each in told(agent, "tell", "at(uc)", reply_to=question.id).actions] == ["at(uc,bob)"]


def test_an_answer_carries_who_gave_it() -> None:
    agent, question = asker(".send(bob, askOne, at(X), A)")
    assert [str(each) for each in told(agent, "tell", "at(uc)", reply_to=question.id).actions] == [
        "know(at(uc)[source(bob)])"
    ]


def test_no_for_an_answer_is_false() -> None:
    agent, question = asker(".send(bob, askOne, at(X), A)")
    assert [str(each) for each in told(agent, "untell", "at(X)", reply_to=question.id).actions] == ["know(false)"]


def test_a_list_of_answers_can_be_waited_for() -> None:
    agent, question = asker(".send(bob, askAll, at(X), A)")
    answer = told(agent, "tell", "[at(uc),at(library)]", reply_to=question.id)
    assert [str(each) for each in answer.actions] == ["know([at(uc)[source(bob)],at(library)[source(bob)]])"]


def test_an_answer_of_another_form_is_a_failure() -> None:
    agent, question = asker(".send(bob, askOne, at(X), at(uc))")
    outcome = told(agent, "tell", "at(library)", reply_to=question.id)
    assert [str(each) for each in outcome.actions] == ["sorry(ask_failed)"]


def test_an_answer_that_is_late_is_a_timeout() -> None:
    agent, _ = asker(".send(bob, askOne, at(X), A, 3000)")
    assert [(n, str(each)) for n in range(1, 6) for each in agent.cycle(now=float(n)).actions] == [(3, "know(timeout)")]


def test_a_timeout_that_was_not_expected_is_a_failure() -> None:
    agent, _ = asker(".send(bob, askOne, at(X), at(Y), 3000)")
    assert actions(agent) == ["sorry(ask_failed)"]


def test_an_answer_after_the_timeout_does_nothing() -> None:
    agent, question = asker(".send(bob, askOne, at(X), A, 1000)", then="know(A); more")
    assert actions(agent, 3) == ["know(timeout)"]
    assert told(agent, "tell", "at(uc)", reply_to=question.id).actions == ()
    assert not agent.believes("at(_)")


def test_an_intention_that_is_dropped_waits_for_no_answer() -> None:
    agent = agent_of("!g. +!g <- .send(bob, askOne, at(X), A); know(A). +stop <- .drop_intention(g).")
    question = agent.cycle().messages[0]
    agent.cycle({"stop"})
    assert told(agent, "tell", "at(uc)", reply_to=question.id).actions == ()
    assert (agent.idle, agent.intentions) == (True, {})


def test_of_several_that_are_asked_the_first_answer_counts() -> None:
    agent = agent_of("!g. +!g <- .send([bob,ann], askOne, at(X), A); know(A); more; again.")
    bob, ann = agent.cycle().messages
    assert {bob.receiver, ann.receiver} == {"bob", "ann"}
    first = told(agent, "tell", "at(uc)", sender="ann", reply_to=ann.id)
    assert [str(each) for each in first.actions] == ["know(at(uc)[source(ann)])"]
    assert told(agent, "tell", "at(library)", reply_to=bob.id).actions == ()


# ---- know-how ------------------------------------------------------------------------------------------------------


def test_know_how_that_was_asked_for_is_learnt() -> None:
    """Both have plans without a name."""
    asks = agent_of("!g. +!g <- .send(bob, askHow, {+!go(_)}); .wait({+ready}); !go(uc).", name="ann")
    knows = agent_of("+!stay <- stay. +!go(X) <- drive(X).", name="bob")
    question = asks.cycle().messages[0]
    answer = knows.cycle(messages=[question]).messages[0]
    asks.cycle(messages=[answer])
    asks.cycle({"ready"})
    assert actions(asks) == ["drive(uc)"]


def test_know_how_can_be_waited_for() -> None:
    agent, question = asker(".send(bob, askHow, {+!go(_)}, A)")
    answer = told(agent, "tellHow", '["+!go(X) <- drive(X)."]', reply_to=question.id)
    assert [str(each) for each in answer.actions] == ['know(["+!go(X) <- drive(X)."])']
    assert len(agent.library.plans) == 2, "what is waited for is no new plan"


def test_plans_are_told_as_values_with_what_their_variables_stand_for() -> None:
    teacher = agent_of("!g. +!g <- X = uc; .send(bob, tellHow, { @way +!go <- drive(X) }).", name="ann")
    pupil = agent_of("", name="bob")
    for _ in range(3):
        for message in teacher.cycle().messages:
            pupil.cycle(messages=[message])
    assert [str(each) for each in told(pupil, "achieve", "go").actions] == ["drive(uc)"]


def test_a_plan_of_a_name_that_is_taken_is_reported() -> None:
    agent = agent_of("@own +!a <- own.")
    outcome = told(agent, "tellHow", "@own +!a <- other.")
    assert [each.goal for each in outcome.failures] == ["tellHow of bob"]
    assert [str(each) for each in told(agent, "achieve", "a").actions] == ["own"]


def test_plans_told_in_a_list_carry_their_source() -> None:
    agent = agent_of("!g. +!g <- .wait({+ready}); !a; !b.")
    told(agent, "tellHow", '["@pa +!a <- a; ready.", "@pb +!b <- b."]')
    assert [str(each.plan.label) for each in agent.library.plans][1:] == ["pa[source(bob)]", "pb[source(bob)]"]


def test_no_agent_takes_away_a_plan_that_it_did_not_tell() -> None:
    agent = agent_of("@own +!a <- own.")
    told(agent, "tellHow", "@hers +!b <- b.", sender="ann")
    for label in ("own", "hers"):
        told(agent, "untellHow", label, sender="bob")
    assert [each.label for each in agent.library.plans] == ["own", "hers"]


def test_a_plan_is_untold_by_name_or_as_it_is_written() -> None:
    agent = agent_of("@own +!a <- own.")
    told(agent, "tellHow", "@new +!a <- new.")
    told(agent, "tellHow", "+!b(X) : X > 1 <- b(X).")
    assert len(agent.library.plans) == 3
    told(agent, "untellHow", "+!b(X) : X>1 <- b(X).")
    told(agent, "untellHow", "new")
    assert [each.label for each in agent.library.plans] == ["own"]
