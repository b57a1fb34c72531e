"""The agent as its body sees it: actions, cancellations, failures, messages, waiting."""

from collections.abc import Iterable
from typing import Any

import pytest

from bdi import (
    Agent,
    AgentSpeakSyntaxError,
    Finished,
    Message,
    NotALiteral,
    Outcome,
    UnknownActionId,
    UnknownPerformative,
    parse_program,
    parse_term,
)


def agent_of(text: str, **options: object) -> Agent:
    return Agent(parse_program(text), **options)  # type: ignore[arg-type]


def run(agent: Agent, cycles: int = 30, fail: str = "") -> list[str]:
    """The actions, each of which succeeds at once, except one of this name."""
    seen: list[str] = []
    finished: list[Finished] = []
    for cycle in range(cycles):
        outcome = agent.cycle(None, [], finished, cycle * 0.1)
        seen += map(str, outcome.actions)
        finished = [
            Finished(action.id, "jammed", "the wheel is jammed") if action.term.functor == fail else Finished(action.id)
            for action in outcome.actions
        ]
    return seen


def idle_cycles(agent: Agent, cycles: int) -> Iterable[Outcome]:
    return [agent.cycle() for _ in range(cycles)]


# ---- actions -------------------------------------------------------------------------------------------------------


def test_an_intention_waits_for_its_action_while_others_go_on() -> None:
    agent = agent_of("!slow. !quick. +!slow <- drive; arrived. +!quick <- a; b.")
    first = agent.cycle().actions[0]
    assert str(first) == "drive"
    later = [agent.cycle(finished=[]) for _ in range(5)]
    assert [str(action) for outcome in later for action in outcome.actions] == ["a"]
    assert [str(action) for action in agent.cycle(finished=[Finished(first.id)]).actions] == ["arrived"]


def test_a_failed_action_reaches_the_plan_with_its_reason() -> None:
    agent = agent_of(
        """!deliver.
        +!deliver <- !travel; hand_over.
        +!travel <- drive(forward).
        -!travel[error(E), reason(R), error_msg(M)] <- report(E, R, M)."""
    )
    assert run(agent, fail="drive") == [
        "drive(forward)",
        'report(action_failed,jammed,"the wheel is jammed")',
        "hand_over",
    ]


def test_the_reason_itself_is_an_annotation_too() -> None:
    agent = agent_of("!g. +!g <- drive. -!g[jammed] <- free_wheel. -!g <- other.")
    assert run(agent, fail="drive") == ["drive", "free_wheel"]


def test_a_sentence_as_reason_is_no_syntax_error() -> None:
    agent = agent_of("!g. +!g <- drive. -!g[error_msg(M)] <- say(M).")
    drive = agent.cycle().actions[0]
    outcomes = [agent.cycle(finished=[Finished(drive.id, "it is dark, sorry")]), agent.cycle()]
    assert [str(action) for outcome in outcomes for action in outcome.actions] == ['say("it is dark, sorry")']


def test_dropping_an_intention_cancels_its_action() -> None:
    agent = agent_of("!go. +!go <- drive. +bumped <- .drop_desire(go); stop.")
    drive = agent.cycle().actions[0]
    outcome = agent.cycle({"bumped"})
    assert outcome.cancelled == (drive.id,)
    assert str(agent.cycle().actions[0]) == "stop"
    assert agent.cycle(finished=[Finished(drive.id)]).actions == ()


def test_drop_all_intentions_keeps_the_one_that_says_so() -> None:
    agent = agent_of("!go. +!go <- drive. +battery(low) <- .drop_all_intentions; !charge. +!charge <- dock.")
    drive = agent.cycle().actions[0]
    outcomes = [agent.cycle({"battery(low)"}), agent.cycle(), agent.cycle()]
    assert [id for outcome in outcomes for id in outcome.cancelled] == [drive.id]
    assert [str(action) for outcome in outcomes for action in outcome.actions] == ["dock"]


def test_a_goal_that_no_plan_rescues_is_reported() -> None:
    agent = agent_of("!g. +!g <- drive; more.")
    drive = agent.cycle().actions[0]
    failure = agent.cycle(finished=[Finished(drive.id, "jammed")]).failures[0]
    assert (failure.goal, failure.error) == ("+!g", "action_failed")
    assert agent.idle


def test_a_goal_without_plan_is_reported() -> None:
    assert [each.error for each in agent_of("!g(1).").cycle().failures] == ["no_relevant"]


def test_a_goal_whose_contexts_do_not_hold_is_reported() -> None:
    assert [each.error for each in agent_of("!g(1). +!g(X) : X > 1 <- a.").cycle().failures] == ["no_applicable"]


def test_news_of_an_action_that_was_never_started_is_an_error() -> None:
    with pytest.raises(UnknownActionId):
        agent_of("!g.").cycle(finished=[Finished(7)])


def test_a_variable_gets_its_value_when_the_goal_is_reached_and_not_before() -> None:
    agent = agent_of(
        """!g. +!g <- !find(X); use(X).
        +!find(X) <- X = wrong; fail_action.
        -!find(X) <- X = right."""
    )
    assert run(agent, fail="fail_action") == ["fail_action", "use(right)"]


# ---- percepts ------------------------------------------------------------------------------------------------------


def test_a_percept_raises_an_event_only_when_it_is_new() -> None:
    agent = agent_of("+at(P) <- seen(P). -at(P) <- lost(P).")
    seen = [[str(each) for each in agent.cycle(percepts).actions] for percepts in (["at(a)"], ["at(a)"], None, [])]
    assert seen == [["seen(a)"], [], [], ["lost(a)"]]


def test_the_same_percept_in_another_notation_is_not_new() -> None:
    agent = agent_of("+at(P,N) <- seen(P). -at(P,N) <- lost(P).")
    inputs = [{"at(a,1)"}, {"at( a, 1 )"}, {parse_term("at(a,1)")}, {"at(a,1.0)"}]
    assert [[str(each) for each in agent.cycle(percepts).actions] for percepts in inputs] == [["seen(a)"], [], [], []]


def test_what_is_perceived_is_not_forgotten_by_a_plan() -> None:
    agent = agent_of("!g. +!g : battery(low) <- -battery(low); ?battery(low); still.")
    assert [str(a) for _ in range(5) for a in agent.cycle({"battery(low)"}).actions] == ["still"]


# ---- messages ------------------------------------------------------------------------------------------------------


def told(agent: Agent, performative: str, content: str, **more: str) -> Outcome:
    return agent.cycle(None, [Message("bob", performative, content, **more)])


def test_tell_and_untell_change_beliefs_with_their_source() -> None:
    agent = agent_of("+post(P)[source(S)] <- heard(P,S).")
    assert str(told(agent, "tell", "post(library)").actions[0]) == "heard(library,bob)"
    assert agent.believes("post(library)[source(bob)]")
    told(agent, "untell", "post(library)")
    assert not agent.believes("post(_)")


def test_achieve_is_a_goal_and_unachieve_drops_it() -> None:
    agent = agent_of("+!go(P)[source(S)] <- drive(P,S); !go(P).")
    drive = told(agent, "achieve", "go(uc)").actions[0]
    assert str(drive) == "drive(uc,bob)"
    assert told(agent, "unachieve", "go(uc)").cancelled == (drive.id,)


def test_a_question_is_answered_from_the_beliefs() -> None:
    agent = agent_of("at(uc). at(library).", name="r1")
    one = told(agent, "askOne", "at(X)", id="q1").messages[0]
    assert (one.sender, one.receiver, one.reply_to, str(one.content)) == ("r1", "bob", "q1", "at(uc)")
    assert str(told(agent, "askAll", "at(X)").messages[0].content) == "[at(uc),at(library)]"
    assert told(agent, "askOne", "lost(X)").messages[0].performative == "untell"


def test_a_plan_can_wait_for_an_answer() -> None:
    agent = agent_of("!g. +!g <- .send(bob, askOne, at(X), at(Y)); go(Y).")
    question = agent.cycle().messages[0]
    assert agent.cycle().actions == ()
    outcome = told(agent, "tell", "at(mine)", reply_to=question.id)
    assert [str(each) for each in outcome.actions] == ["go(mine)"]


def test_a_question_about_how_is_answered_with_plans() -> None:
    answer = told(agent_of("@here +!g(X) : X > 1 <- a."), "askHow", "+!g(_)", id="q").messages[0]
    assert str(answer.content) == "[{@here +!g(X) : (X>1) <- a}]"


def test_plans_can_be_told_and_untold() -> None:
    agent = agent_of("")
    told(agent, "tellHow", "@new +!g <- a.")
    assert [str(each) for each in told(agent, "achieve", "g").actions] == ["a"]
    told(agent, "untellHow", "new")
    assert [each.error for each in told(agent, "achieve", "g").failures] == ["no_relevant"]


def test_an_unknown_performative_is_an_error() -> None:
    with pytest.raises(UnknownPerformative):
        told(agent_of(""), "shout", "a")


def test_a_plan_told_while_an_event_waits_for_its_turn_reacts_to_it() -> None:
    agent = agent_of('!a. +!a <- .add_plan("+b(X) <- heard(X).").')
    agent.cycle({"b(1)"})
    assert [str(action) for _ in range(3) for action in agent.cycle().actions] == ["heard(1)"]


def test_events_without_a_plan_do_not_pile_up_behind_an_atomic_plan() -> None:
    agent = agent_of("!g. @g[atomic] +!g <- drive.")
    for at in range(50):
        agent.cycle({f"at({at})"})
    assert len(agent.events) <= 1


# ---- the door ------------------------------------------------------------------------------------------------------

WRONG: dict[str, tuple[type[Exception], dict[str, Any]]] = {
    "a percept that is no AgentSpeak": (AgentSpeakSyntaxError, {"percepts": ["at(a)", "fine", "at("]}),
    "a percept in another notation beside one that is none": (AgentSpeakSyntaxError, {"percepts": ["at( b )", ")"]}),
    "a percept that is a number": (NotALiteral, {"percepts": [7]}),
    "a comparison as percept": (AgentSpeakSyntaxError, {"percepts": ["X > 1"]}),
    "an unknown performative": (UnknownPerformative, {"messages": [Message("bob", "shout", "b(1)")]}),
    "a message that is no AgentSpeak": (AgentSpeakSyntaxError, {"messages": [Message("bob", "tell", "b(")]}),
    "a message about a number": (NotALiteral, {"messages": [Message("bob", "achieve", 5)]}),
    "a question about no event": (AgentSpeakSyntaxError, {"messages": [Message("bob", "askHow", "g")]}),
    "a plan that is none": (AgentSpeakSyntaxError, {"messages": [Message("bob", "tellHow", "+!g <- (")]}),
    "an answer that is no AgentSpeak": (AgentSpeakSyntaxError, {"messages": [Message("b", "tell", "(", reply_to="1")]}),
    "an action that was never started": (UnknownActionId, {"finished": [Finished(1), Finished(99)]}),
}


@pytest.mark.parametrize("wrong", WRONG)
def test_what_is_wrong_is_refused_by_name_and_the_agent_is_as_before(wrong: str) -> None:
    error, given = WRONG[wrong]
    program = "+at(P) <- seen(P). -at(P) <- lost(P). +b(X) <- told(X). !g. +!g <- drive; arrived. +c <- c."
    agents = [agent_of(program), agent_of(program)]
    for agent in agents:
        agent.cycle({"at(a)"}, now=1.0)
        agent.cycle(now=2.0)
    good: dict[str, Any] = {"percepts": ["c"], "messages": [Message("bob", "tell", "b(1)")], "finished": [Finished(1)]}
    with pytest.raises(error):
        agents[0].cycle(**{**good, **given}, now=3.0)
    assert snapshot(agents[0]) == snapshot(agents[1])
    later = [[outcomes_of(agent, cycle) for cycle in range(8)] for agent in agents]
    assert later[0] == later[1]


def snapshot(agent: Agent) -> list[Any]:
    intentions = [(str(each), each.state) for each in agent.intentions.values()]
    return [
        agent.now,
        agent.cycles,
        list(map(str, agent.beliefs)),
        list(map(str, agent.events)),
        intentions,
        agent.idle,
    ]


def outcomes_of(agent: Agent, cycle: int) -> list[str]:
    return [str(action) for action in agent.cycle({"at(a)"} if cycle < 4 else set(), now=4.0 + cycle).actions]


def test_a_question_that_cannot_be_worked_out_is_answered_with_no() -> None:
    agent = agent_of("p(X) :- .nth(5,[a],X).")
    assert told(agent, "askOne", "p(X)", id="q").messages[0].performative == "untell"


def test_a_wait_for_what_cannot_be_worked_out_is_a_failure() -> None:
    agent = agent_of("!g. +!g <- .wait(b(I) & .nth(I,[a],X)); never. -!g[error(E)] <- late(E).")
    agent.cycle()
    assert [str(action) for _ in range(4) for action in agent.cycle({"b(5)"}).actions] == ["late(wait_failed)"]


# ---- time ----------------------------------------------------------------------------------------------------------


def test_waiting_ends_by_the_clock_that_is_given() -> None:
    agent = agent_of("!g. +!g <- .wait(2000); a.")
    acted = [now for now in (10.0, 11.0, 11.9, 12.0, 13.0) if agent.cycle(now=now).actions]
    assert acted == [12.0]


def test_waiting_for_an_event_ends_with_it() -> None:
    agent = agent_of('!g. +!g <- .wait("+ready(X)"); a.')
    assert [bool(agent.cycle(percepts).actions) for percepts in ([], [], ["ready(1)"], [])].index(True) == 2


def test_waiting_too_long_for_a_formula_is_a_failure() -> None:
    agent = agent_of("!g. +!g <- .wait(ready, 500); a. -!g[error(E)] <- late(E).")
    acted = [str(each) for now in (0.0, 0.4, 0.6, 0.7) for each in agent.cycle(now=now).actions]
    assert acted == ["late(wait_timeout)"]


# ---- explanations --------------------------------------------------------------------------------------------------


def test_why_names_the_action_that_a_goal_waits_for() -> None:
    agent = agent_of("!deliver(post4). +!deliver(P) <- !travel(P). @by_line +!travel(P) <- drive(P).")
    idle_cycles(agent, 2)
    why = agent.why("deliver(_)")
    assert why.sentence == "deliver(post4) waits for action drive(post4) of plan by_line, needed for travel(post4)."
    assert (why.state, why.plan, why.waits_for) == ("waits for an action", "by_line", "drive(post4)")


def test_why_says_when_a_goal_is_not_pursued() -> None:
    assert "is not pursued" in agent_of("").why("deliver(post4)").sentence


def test_a_listener_hears_of_every_choice() -> None:
    agent = agent_of("!g. @first +!g : no <- a. @second +!g <- b.")
    heard: list[str] = []
    agent.listen(lambda entry: heard.append(str(entry)))
    outcome = agent.cycle()
    assert heard == ["1 +!g: plan second (line 1), of 2 relevant", "1 intention 1: b"]
    assert [str(entry) for entry in outcome.trace] == heard


def test_equal_seeds_give_equal_runs() -> None:
    program = "!g. +!g <- .random(X); a(X); .random([l,r], Y); b(Y)."
    assert run(agent_of(program, random_seed=4)) == run(agent_of(program, random_seed=4))


@pytest.mark.slow
def test_nothing_grows_over_100_000_cycles() -> None:
    agent = agent_of("!g(0). n(0). +!g(N) : N < 10 <- -+n(N); !g(N+1). +!g(N) <- !g(0).")
    for _ in range(100_000):
        agent.cycle()
    assert len(agent.beliefs) == 1
    assert len(agent.intentions) == 1
    assert len(next(iter(agent.intentions.values())).stack) == 1
    assert len(agent.logic.trail) == 0


def test_the_trace_says_why_a_goal_failed() -> None:
    agent = agent_of("!g.\n+!g <- .fail(error(lost)).\n-!g <- b.")
    heard: list[str] = []
    agent.listen(lambda entry: heard.append(str(entry)))
    for _ in range(2):
        agent.cycle()
    assert "2 -!g[error(lost)]: plan p__2 (line 3), of 1 relevant" in heard


def test_text_in_place_of_a_program_or_a_set_of_percepts_is_refused() -> None:
    with pytest.raises(TypeError, match=r"Agent\(parse_program\(text\)\)"):
        Agent("!g. +!g <- a.")  # type: ignore[arg-type]
    agent = Agent(parse_program("+p <- a."))
    with pytest.raises(TypeError, match=r"percepts are a set: \{'p'\}, not 'p'"):
        agent.cycle("p")
    assert [str(action) for action in agent.cycle({"p"}).actions] == ["a"]
