"""Effects of messages, performative by performative, and of an agent's own plans for messages."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bdi import Agent, BdiError, Finished, Message, Outcome, UnknownPerformative, parse_program, parse_term
from bdi.reasoning.performatives import PERFORMATIVES


def agent_of(text: str, name: str = "r1") -> Agent:
    return Agent(parse_program(text), name=name, random_seed=1)


def told(agent: Agent, performative: str, content: str, sender: str = "bob", **more: str) -> Outcome:
    return agent.cycle(None, [Message(sender, performative, content, **more)])


def actions(agent: Agent, cycles: int = 8, start_s: float = 0.0) -> list[str]:
    """Return the outputs of the next cycles, a second apart; no action ever ends."""
    return [str(each) for n in range(cycles) for each in agent.cycle(now=start_s + n).actions]


# ---- tell, achieve, signal -----------------------------------------------------------------------------------------


def test_hearsay_keeps_who_said_it_to_whom() -> None:
    agent = agent_of("")
    told(agent, "tell", "open(uc)[source(ann)]")
    assert agent.believes("open(uc)[source(bob)[source(ann)]]")
    assert not agent.believes("open(uc)[source(ann)]")
    told(agent, "untell", "open(uc)[source(ann)]")
    assert not agent.believes("open(uc)")


def test_a_list_is_told_one_by_one() -> None:
    agent = agent_of("+p(X)[source(S)] <- heard(X,S).")
    told(agent, "tell", "[p(1),p(2)]")
    assert agent.ask("p(X)[source(bob)]") == [{"X": 2}, {"X": 1}]


def test_no_agent_takes_back_what_another_said() -> None:
    agent = agent_of("")
    told(agent, "tell", "p(1)", sender="ann")
    told(agent, "untell", "p(1)", sender="bob")
    assert agent.believes("p(1)[source(ann)]")


def test_a_signal_is_an_event_and_no_belief() -> None:
    agent = agent_of("+ping(X)[source(S)] <- pong(X,S).")
    assert [str(each) for each in told(agent, "signal", "ping(1)").actions] == ["pong(1,bob)"]
    assert not agent.believes("ping(_)")


def test_a_goal_is_taken_back_by_any_sender_also_when_its_plan_pursues_it_again() -> None:
    agent = agent_of("+!go(P) <- drive(P); !go(P).")
    drive = told(agent, "achieve", "go(uc)", sender="ann").actions[0]
    agent.cycle(None, (), [Finished(drive.id)])
    again = agent.cycle().actions[0]
    assert told(agent, "unachieve", "go(library)", sender="ann").cancelled == ()
    assert told(agent, "unachieve", "go(_)", sender="bob").cancelled == (again.id,)


def test_a_list_of_goals_is_achieved_one_by_one() -> None:
    agent = agent_of("+!go(P)[source(S)] <- drive(P,S).")
    told(agent, "achieve", "[go(uc),go(library)]", sender="ann")
    started = [str(each) for _ in range(3) for each in agent.cycle().actions]
    assert started == ["drive(library,ann)"]  # the first one had its turn with the message


def test_a_message_to_itself_comes_back_in_the_next_cycle() -> None:
    agent = agent_of(
        "!g. +!g <- .send(r1, achieve, h); .send(self, tell, p). +!h[source(S)] <- h(S). +p[source(S)] <- p(S)."
    )
    outcomes = [agent.cycle() for _ in range(6)]
    assert [str(each) for outcome in outcomes for each in outcome.actions] == ["h(self)", "p(self)"]
    assert not any(outcome.messages for outcome in outcomes)


def test_an_agent_can_ask_itself() -> None:
    assert actions(agent_of("at(uc). !g. +!g <- .send(r1, askOne, at(X), at(Y)); go(Y).")) == ["go(uc)"]


# ---- wrong messages ------------------------------------------------------------------------------------------------

WRONG_SENDS = {
    ".send(bob, achive, g)": "unknown_performative",
    "P = tell(1); .send(bob, P, g)": "wrong_arguments",
    ".send(bob, tell, X)": "wrong_arguments",
    ".send(bob, achieve, 5)": "wrong_arguments",
    ".send(bob, tellHow, 5)": "wrong_arguments",
    ".send(X, tell, p)": "wrong_arguments",
    ".send(p(1), tell, p)": "wrong_arguments",
    "T = soon; .send(bob, askOne, p(X), A, T)": "wrong_arguments",
    ".send(r1, achieve, 5)": "wrong_arguments",
    ".send(self, tell, 5, q1)": "wrong_arguments",
    ".kqml.default(bob, achieve, 5, q1)": "wrong_arguments",
    ".kqml.default(bob, achive, g, q1)": "wrong_arguments",
    ".send(bob, tell, p, A)": "wrong_arguments",
    ".broadcast(shout, p)": "unknown_performative",
    ".broadcast(tell, X)": "wrong_arguments",
}


@pytest.mark.parametrize("step", WRONG_SENDS)
def test_a_wrong_message_fails_at_its_sender_by_name(step: str) -> None:
    agent = agent_of(f"!g. +!g <- {step}; never. -!g[error(E)] <- sorry(E).")
    outcomes = [agent.cycle() for _ in range(5)]
    assert [str(each) for outcome in outcomes for each in outcome.actions] == [f"sorry({WRONG_SENDS[step]})"]
    assert not any(outcome.messages for outcome in outcomes)


# ---- plans for messages --------------------------------------------------------------------------------------------


def test_a_plan_for_messages_goes_before_what_is_usual() -> None:
    agent = agent_of("+!kqml_received(S, tell, C, M) : not friend(S) <- ignore(S,C). friend(ann).")
    assert [str(each) for each in told(agent, "tell", "p(1)").actions] == ["ignore(bob,p(1))"]
    told(agent, "tell", "p(1)", sender="ann")
    assert agent.ask("p(X)[source(S)]") == [{"X": 1, "S": parse_term("ann")}]


def test_messages_that_no_plan_is_about_go_the_usual_way() -> None:
    agent = agent_of("+!kqml_received(S, tell, secret(C), M) <- ignore. +!go <- go.")
    told(agent, "tell", "p(1)")
    assert agent.believes("p(1)[source(bob)]")
    assert [str(each) for each in told(agent, "achieve", "go").actions] == ["go"]


def test_a_performative_of_ones_own_is_legal_where_a_plan_understands_it() -> None:
    agent = agent_of("+!kqml_received(S, propose, price(P), M) <- .send(S, accept, P, M).")
    (answer,) = told(agent, "propose", "price(3)", id="m7").messages
    assert (answer.receiver, answer.performative, str(answer.content), answer.reply_to) == ("bob", "accept", "3", "m7")
    with pytest.raises(UnknownPerformative):
        told(agent, "refuse", "price(3)")


def test_a_plan_for_messages_can_do_what_is_usual_besides() -> None:
    agent = agent_of("+!kqml_received(S,P,C,M) <- log(P); .kqml.default(S,P,C,M).  p(1).")
    action = told(agent, "askOne", "p(X)", id="q1").actions[0]
    sent = [each for n in range(4) for each in agent.cycle(finished=[Finished(action.id)] if n == 0 else ()).messages]
    assert [(each.performative, str(each.content), each.reply_to) for each in sent] == [("tell", "p(1)", "q1")]


def test_a_goal_variable_is_no_plan_for_messages() -> None:
    agent = agent_of("+!G <- any(G). +?q(X) <- X = 2.")
    told(agent, "tell", "p(1)")
    assert agent.believes("p(1)")
    sent = [*told(agent, "askOne", "q(X)").messages, *(each for _ in range(4) for each in agent.cycle().messages)]
    assert [str(each.content) for each in sent] == ["q(2)"]


def test_know_how_comes_as_text_to_an_agent_with_plans_for_messages_too() -> None:
    agent = agent_of(
        "+!kqml_received(S, tell, C, _) <- heard(C). +!kqml_received(S, tellHow, P, _) : S == eve <- no(P)."
    )
    told(agent, "tellHow", "+!g <- a.")
    for _ in range(3):
        agent.cycle()
    assert [str(each) for each in told(agent, "achieve", "g").actions] == ["a"]
    assert [str(each) for each in told(agent, "tellHow", "+!g <- b.", sender="eve").actions] == ['no("+!g <- b.")']


# ---- social acceptance ---------------------------------------------------------------------------------------------


def test_who_may_tell_and_want_what_is_decided_by_a_function() -> None:
    agent = agent_of("+!go <- go. !g. +!g <- .send(eve, askOne, p(X), A); know(A).")
    agent.accepts = lambda message: message.sender == "ann" or message.performative == "tell"
    question = agent.cycle().messages[0]
    assert told(agent, "achieve", "go", sender="bob").actions == ()
    assert [str(each) for each in told(agent, "achieve", "go", sender="ann").actions] == ["go"]
    told(agent, "tell", "q", sender="bob")
    assert agent.believes("q[source(bob)]")
    answer = told(agent, "untell", "p(X)", sender="eve", reply_to=question.id)
    assert [str(each) for each in answer.actions] == ["know(false)"]


# ---- any input -----------------------------------------------------------------------------------------------------

OWN_PLANS = """
r(X) :- .nth(9,[a],X).
+!kqml_received(S,P,q(X),M) : X > 1 <- .kqml.default(S,P,q(X),M).
+!kqml_received(S,shout,X,M) <- .send(S,tell,X,M); .kqml.default(S,shout,X,M).
+!kqml_received(ann,P,X,M) <- .send(ann,P,X,M); .kqml.default(ann,P,X,M).
!g. +!g <- .send(bob, askOne, at(X), at(_)). +p(X) : X > 1 <- a(X). +!g(X) <- b(X/0). +?p(X) <- X = 1/0.
"""
CONTENTS = st.sampled_from(
    ["p(1/0)", "q(2)", "q(X)", "r(X)", "p(X)[source(Y)]", "~p", "+!g(X)", "+!X", "+!p <- a.", "g", "[p,5]", "5", "X",
     "{+!g <- a}", '["+!g <- a."]', "{+!_}", '"p"', "p(", "", "[p|T]", ".print(1)", "p & q", "s::p(1)"]
)  # fmt: skip


@settings(max_examples=300, deadline=None)
@given(
    st.sampled_from([*PERFORMATIVES, "shout", "sorry"]),
    CONTENTS,
    st.sampled_from(["", "ag-1?", "x"]),
    st.sampled_from(["bob", "ann", "self", "ag"]),
)
@pytest.mark.slow
def test_a_message_is_refused_at_the_door_or_read_whatever_it_says(
    performative: str, content: str, reply_to: str, sender: str
) -> None:
    agent = agent_of(OWN_PLANS, name="ag")
    agent.cycle()
    try:
        agent.cycle(messages=[Message(sender, performative, content, id="q", reply_to=reply_to)])
    except BdiError:
        assert agent.cycles == 1, "refused in the middle of a cycle, not at the door"
    for cycle in range(8):
        agent.cycle(now=float(cycle))
    assert agent.cycles in (9, 10)
