"""Several agents in one process: who has its turn when, what reaches whom, who comes and goes."""

from pathlib import Path

import pytest
from typer.testing import CliRunner

from bdi import (
    Agent,
    DuplicateAgent,
    Finished,
    Message,
    MultiAgentSystem,
    NotALiteral,
    Outcome,
    Program,
    Stimuli,
    UnknownAgent,
    load_program,
    parse_program,
)
from bdi.__main__ import app

CONTRACT_NET = Path(__file__).parents[3] / "examples" / "agents" / "contract_net"


def agent(name: str, text: str) -> Agent:
    return Agent(parse_program(text, source=f"{name}.asl"), name=name, random_seed=1)


def system_of(programs: dict[str, str], library: dict[str, str] | None = None, **more: object) -> MultiAgentSystem:
    """Agents by name and text; `library` has the programs that can be created."""

    def load(source: str) -> Program:
        if library is None or source not in library:
            raise FileNotFoundError(f"no file {source}")
        return parse_program(library[source], source=source)

    return MultiAgentSystem([agent(*each) for each in programs.items()], load=load, **more)  # type: ignore[arg-type]


def run(system: MultiAgentSystem, rounds: int = 60) -> list[tuple[int, str, str]]:
    """(round, agent, action) for every action; each succeeds at once."""
    done: list[tuple[int, str, str]] = []
    finished: dict[str, list[Finished]] = {}
    for number in range(1, rounds + 1):
        stimuli = {name: Stimuli((), (), finished.get(name, [])) for name in system.agents}
        outcomes = system.round(stimuli, now=number / 10)
        finished = {}
        for name, outcome in outcomes.items():
            done += [(number, name, str(action)) for action in outcome.actions]
            finished[name] = [Finished(action.id) for action in outcome.actions]
        if system.stopped or (system.idle and not any(finished.values())):
            break
    return done


def acts(system: MultiAgentSystem, rounds: int = 60) -> list[tuple[str, str]]:
    return [(name, action) for _, name, action in run(system, rounds)]


# ---- turns and messages --------------------------------------------------------------------------------------------


def test_what_is_sent_in_a_round_is_read_in_the_next_whichever_agent_comes_first() -> None:
    hears = "+hello(N)[source(S)] <- heard(N,S)."
    programs = {
        "b": f"{hears} !g. +!g <- .send(a, tell, hello(1)).",
        "a": f"{hears} !g. +!g <- .send(b, tell, hello(2)).",
    }
    assert run(system_of(programs)) == [(2, "b", "heard(2,a)"), (2, "a", "heard(1,b)")]


def test_messages_arrive_in_the_order_in_which_they_were_sent() -> None:
    sender = "!g. +!g <- .send(c, tell, n(1)); .send(c, tell, n(2))."
    programs = {"a": sender, "b": sender.replace("n(", "m("), "c": "+n(X) <- n(X). +m(X) <- m(X)."}
    assert [action for _, action in acts(system_of(programs))] == ["n(1)", "m(1)", "n(2)", "m(2)"]


def test_equal_systems_have_equal_runs() -> None:
    programs = {
        "a": "!g. +!g <- .random(X); .send([b,c], achieve, draw(X)); .broadcast(tell, p(X)); act(X).",
        "b": "+!draw(X) <- .random(Y); draw(X,Y). +p(X)[source(S)] <- p(X,S).",
        "c": "+!draw(X) <- .random(Y); draw(X,Y). +p(X)[source(S)] <- p(X,S).",
    }
    runs = [run(system_of(programs)) for _ in range(3)]
    assert len(runs[0]) == 5
    assert runs[0] == runs[1] == runs[2]


def test_a_token_goes_round_a_ring_of_fifty_agents() -> None:
    ring = {
        f"a{n}": f"+!token(0) <- end. +!token(N) <- .send(a{(n + 1) % 50}, achieve, token(N-1))." for n in range(50)
    }
    system = system_of(ring)
    system.round({"a0": Stimuli(messages=[Message("user", "achieve", "token(100)")])})
    assert run(system, 200) == [(100, "a0", "end")]
    assert system.idle


def test_a_broadcast_reaches_everybody_but_its_sender() -> None:
    hears = "+news(X)[source(S)] <- heard(X,S)."
    programs = {"a": f"{hears} !g. +!g <- .broadcast(tell, news(1)).", "b": hears, "c": hears}
    assert acts(system_of(programs)) == [("b", "heard(1,a)"), ("c", "heard(1,a)")]


def test_agents_share_no_variables_and_no_collections() -> None:
    programs = {
        "a": """!g. +!g <- .queue.create(Q); .queue.add(Q,1); .send(b, achieve, take(X,Q)); .wait(1000);
                    .length(Q,N); mine(N); if (.ground(X)) { bound } else { free }.""",
        "b": "+!take(X,Q) <- X = 7; .queue.add(Q,2); .queue.add(Q,3); .length(Q,N); theirs(N).",
    }
    assert acts(system_of(programs)) == [("b", "theirs(3)"), ("a", "mine(1)"), ("a", "free")]


def test_an_unknown_receiver_is_a_failure_that_names_it() -> None:
    system = system_of({"a": "!g. +!g <- .send(nobody, tell, p). -!g[error(E),receiver(R)] <- sorry(E,R)."})
    assert acts(system) == [("a", "sorry(unknown_receiver,nobody)")]


def test_a_performative_of_ones_own_is_legal_where_the_receiver_understands_it() -> None:
    programs = {
        "a": """!g. +!g <- .send(b, propose, price(3)); .send(c, propose, price(3)).
                -!g[error(E)] <- sorry(E). +agreed(P) <- agreed(P).""",
        "b": "+!kqml_received(S, propose, price(P), M) : P < 5 <- .send(S, tell, agreed(P), M).",
        "c": "",
    }
    assert acts(system_of(programs)) == [("a", "sorry(unknown_performative)"), ("a", "agreed(3)")]


def test_a_question_to_an_agent_that_finds_the_answer_by_a_plan() -> None:
    programs = {
        "a": "!g. +!g <- .send(b, askOne, way(uc,W), way(_,W), 5000); go(W).",
        "b": "+?way(To,W) <- .send(c, askOne, road(To,R), road(_,R)); W = by(R).",
        "c": "road(uc,street).",
    }
    assert acts(system_of(programs)) == [("a", "go(by(street))")]


def test_messages_for_the_outside_are_handed_back() -> None:
    system = system_of({"a": "!g. +!g <- .send(user, tell, p); .send(b, tell, q).", "b": ""}, outside=["user"])
    outcomes = [system.round(now=n / 10) for n in range(3)]
    sent = [message for outcome in outcomes for message in outcome["a"].messages]
    assert [(each.receiver, str(each.content)) for each in sent] == [("user", "p")]
    assert system.agents["b"].believes("q[source(a)]")


def test_an_agent_can_answer_the_sender_of_a_message() -> None:
    system = system_of({"a": "+!g[source(S)] <- .send(S, tell, done)."})
    outcome = system.round({"a": Stimuli(messages=[Message("phone", "achieve", "g")])})["a"]
    assert [(each.receiver, str(each.content)) for each in outcome.messages] == [("phone", "done")]


def test_a_stimulus_that_is_wrong_is_refused_before_anybody_has_a_turn() -> None:
    system = system_of({"a": "!g. +!g <- act.", "b": ""})
    for wrong, error in [
        ({"c": Stimuli()}, UnknownAgent),
        ({"b": Stimuli(messages=[Message("user", "achieve", 5)])}, NotALiteral),
        ({"b": Stimuli(percepts=[5])}, NotALiteral),
    ]:
        with pytest.raises(error):
            system.round(wrong)
    assert [agent.cycles for agent in system.agents.values()] == [0, 0]
    assert acts(system) == [("a", "act")]


def test_two_agents_of_one_name_are_refused() -> None:
    with pytest.raises(DuplicateAgent):
        MultiAgentSystem([agent("a", ""), agent("a", "")])


def test_a_system_is_idle_when_no_agent_has_anything_to_do_and_no_message_is_under_way() -> None:
    system = system_of({"b": "+p <- act.", "a": "!g. +!g <- .send(b, tell, p)."})
    states = []
    for _ in range(3):
        finished = {name: Stimuli(finished=[Finished(1)]) for name in ("b",) if len(states) == 2}
        system.round(finished)
        states.append(system.idle)
    assert states == [False, False, True]  # under way, an action that is not over, nothing


# ---- coming and going ----------------------------------------------------------------------------------------------


def test_an_agent_that_is_created_runs_from_the_next_round_on() -> None:
    library = {"worker.asl": "!work. +!work <- work. +job(J)[source(S)] <- job(J,S)."}
    system = system_of({"boss": '!g. +!g <- .create_agent(bob, "worker.asl"); .send(bob, tell, job(1)).'}, library)
    assert run(system) == [(2, "bob", "work"), (3, "bob", "job(1,boss)")]


def test_an_agent_can_begin_without_a_program_and_be_told_how() -> None:
    text = (
        """!g. +!g <- .create_agent(bob); .send(bob, tellHow, {+!work(X) <- work(X)}); .send(bob, achieve, work(1))."""
    )
    assert acts(system_of({"boss": text})) == [("bob", "work(1)")]


def test_a_name_that_is_taken_gets_a_number() -> None:
    text = """!g. +!g <- .create_agent(bob, "w.asl"); .create_agent(bob, "w.asl", [], N); .create_agent(X, "w.asl");
                 .all_names(L); names(N,X,L)."""
    assert acts(system_of({"boss": text}, {"w.asl": ""})) == [("boss", "names(bob_2,w,[boss,bob,bob_2,w])")]


def test_a_created_agent_can_be_given_beliefs_and_goals() -> None:
    text = '!g. +!g <- .create_agent(bob, "w.asl", [beliefs([price(3)]), goals("sell(apple), sell(pear)")]).'
    library = {"w.asl": "+!sell(What) : price(P) <- sell(What,P)."}
    assert acts(system_of({"boss": text}, library)) == [("bob", "sell(apple,3)"), ("bob", "sell(pear,3)")]


@pytest.mark.parametrize(
    ("action", "error"),
    [
        ('.create_agent(bob, "missing.asl")', "program_not_loaded"),
        ('.create_agent(bob, "broken.asl")', "program_not_loaded"),
        ('.create_agent(bob, "w.asl", [agentClass("x.Y")])', "wrong_arguments"),
        ('.create_agent(bob, "w.asl", [beliefs([5])])', "wrong_arguments"),
        ('.create_agent(bob, "w.asl", [goals("go(")])', "wrong_arguments"),
        ('.save_agent("a.asl")', "no_saver"),
        ('.save_agent("a.asl", [5])', "wrong_arguments"),
    ],
)
def test_what_cannot_be_made_is_a_failure_by_name(action: str, error: str) -> None:
    system = system_of(
        {"a": f"!g. +!g <- {action}. -!g[error(E)] <- sorry(E)."}, {"w.asl": "", "broken.asl": "+!g <- ("}
    )
    assert acts(system) == [("a", f"sorry({error})")]
    assert list(system.agents) == ["a"]


@pytest.mark.parametrize("action", [".all_names(L)", ".kill_agent(b)", '.df_register("s")', ".stopMAS"])
def test_an_agent_that_lives_alone_has_no_others(action: str) -> None:
    alone = agent("a", f"!g. +!g <- {action}. -!g[error(E)] <- sorry(E).")
    assert [str(action) for _ in range(4) for action in alone.cycle().actions] == ["sorry(alone)"]


def test_a_killed_agent_has_no_more_turns_and_its_actions_are_cancelled() -> None:
    programs = {"bob": "!g. +!g <- drive.", "boss": "!g. +!g <- .wait(200); .kill_agent(bob); .all_names(L); left(L)."}
    system = system_of(programs)
    outcomes: list[dict[str, Outcome]] = [system.round(now=n / 10) for n in range(6)]
    started = outcomes[0]["bob"].actions[0]
    assert [each["bob"].cancelled for each in outcomes[:3]] == [(), (), (started.id,)]
    assert not any("bob" in each for each in outcomes[3:])
    assert [str(action) for each in outcomes for action in each["boss"].actions] == ["left([boss])"]


def test_an_agent_can_end_its_own_life() -> None:
    system = system_of({"a": "!g. +!g <- act; .my_name(N); .kill_agent(N); never."})
    assert acts(system) == [("a", "act")]
    assert list(system.agents) == []


def test_killing_an_unknown_agent_fails() -> None:
    assert acts(system_of({"a": "!g. +!g <- .kill_agent(b). -!g <- none."})) == [("a", "none")]


def test_what_was_on_its_way_to_a_killed_agent_is_not_lost_in_silence() -> None:
    system = system_of({"a": "!g. +!g <- .send(b, tell, p).", "b": ""})
    system.round()
    system.kill("b")
    system.round()
    assert [str(message.content) for message in system.undelivered] == ["p"]


def test_an_agent_that_waits_for_the_answer_of_a_killed_agent_fails_at_once() -> None:
    programs = {
        "bob": "+?secret(X) <- .wait(100000).",
        "ann": "!g. +!g <- .send(bob, askOne, secret(X), A); never. -!g[error(E)] <- sorry(E).",
        "boss": "!g. +!g <- .wait(1000); .kill_agent(bob).",
    }
    assert acts(system_of(programs)) == [("ann", "sorry(ask_failed)")]


def test_of_several_that_were_asked_the_others_still_answer() -> None:
    programs = {
        "bob": "+?secret(X) <- .wait(100000).",
        "eve": "+?secret(X) <- .wait(2000); X = 7.",
        "ann": "!g. +!g <- .send([bob,eve], askOne, secret(X), A); know(A).",
        "boss": "!g. +!g <- .wait(1000); .kill_agent(bob).",
    }
    assert acts(system_of(programs)) == [("ann", "know(secret(7)[source(eve)])")]


def test_a_clone_believes_and_can_do_the_same_but_wants_nothing() -> None:
    text = """price(3). way(P,near) :- price(P). way(P,far) :- price(P). way(9,no).
              dear(P) :- price(X) & X > P. +?ways(L) <- .findall(W, way(_,W), L).
              +!sell <- .my_name(N); ?price(P); ?ways(L); if (dear(2)) { sell(N,P,L) }.
              !start. +!start <- -+price(4); .clone(eve); .send(eve, achieve, sell). +price(P) <- new(P)."""
    system = system_of({"bob": text})
    assert acts(system) == [("bob", "new(3)"), ("bob", "new(4)"), ("eve", "sell(eve,4,[near,far,no])")]


def test_the_system_stops_when_an_agent_says_so() -> None:
    system = system_of({"a": "!g. +!g <- act; !g.", "boss": "!g. +!g <- .wait(300); .stopMAS(500, 3)."})
    last = run(system)[-1][0]
    assert 8 <= last <= 10
    assert (system.stopped, system.exit_code) == (True, 3)


def test_a_saved_agent_is_a_program_that_does_the_same() -> None:
    saved: dict[str, str] = {}
    text = """price(3)[source(shop)]. dear(P) :- price(X) & X > P. best(1). best(2). best(N) :- N = 3. !g.
              @sell +!sell(What) : dear(2) & seen(N) <- .findall(B, best(B), L); sell(What,N,L).
              +!g <- +seen(1); .save_agent("bob.asl", [sell(pear)])."""
    run(MultiAgentSystem([agent("bob", text)], save=saved.__setitem__))
    assert "seen(1)." in saved["bob.asl"].splitlines()
    assert acts(system_of({"new": saved["bob.asl"]})) == [("new", "sell(pear,1,[1,2,3])")]


def test_a_saved_agent_keeps_its_local_namespaces_to_itself() -> None:
    saved: dict[str, str] = {}
    text = """{namespace(priv,local)} priv_1::price(1). priv::price(7). priv::dear(X) :- priv::price(X) & X > 5.
              room(9). {begin namespace(shop,local)} own(2). +!tell <- !default::sell(this_ns). {end}
              !g. +!g <- .save_agent("bob.asl", [priv::start]).
              +!priv::start : priv::dear(X) & priv_1::price(Y) <- ?room(R); +priv::seen(X); act(X,Y,R).
              +priv::seen(X) <- .findall(P, priv::price(P), L); seen(X,L); !shop::tell.
              +!sell(N) <- .findall(P, N::own(P), L); sold(L)."""
    run(MultiAgentSystem([agent("bob", text)], save=saved.__setitem__))
    declared = [line for line in saved["bob.asl"].splitlines() if "local" in line]
    assert declared == ["{ namespace(priv_1_,local) }"], "priv_1 is taken, and shop was handed out as a value"
    again: dict[str, str] = {}
    for text in (saved["bob.asl"], saved["bob.asl"] + '!h. +!h <- .save_agent("x.asl", [priv_1_::start]).'):
        system = MultiAgentSystem([agent("new", text)], save=again.__setitem__)
        assert acts(system) == [("new", "seen(7,[7])"), ("new", "sold([2])"), ("new", "act(7,1,9)")]
    parse_program(again["x.asl"])


# ---- the directory of services -------------------------------------------------------------------------------------


def test_services_are_found_in_the_order_in_which_they_were_offered() -> None:
    programs = {
        "a": '!g. +!g <- .df_register("paint", "oil").',
        "b": "!g. +!g <- .df_register(paint).",
        "c": """!g. +!g <- .wait(500); .df_search("paint", L); .df_search("paint", "oil", O); .df_search(cook, N);
                found(L,O,N).""",
    }
    assert acts(system_of(programs)) == [("c", "found([a,b],[a],[])")]


def test_a_subscriber_is_told_of_those_that_are_there_and_of_those_that_come_and_go() -> None:
    programs = {
        "early": "!g. +!g <- .df_register(paint).",
        "late": "!g. +!g <- .wait(1000); .df_register(paint); .wait(1000); .df_deregister(paint).",
        "dying": "!g. +!g <- .wait(1500); .df_register(paint); .wait(1000); .my_name(N); .kill_agent(N).",
        "c": """!g. +!g <- .wait(300); .df_subscribe(paint).
                +provider(A,S)[source(df)] <- come(A,S). -provider(A,S)[source(df)] <- gone(A,S).""",
    }
    assert [action for _, action in acts(system_of(programs))] == [
        'come(early,"paint")',
        'come(late,"paint")',
        'come(dying,"paint")',
        'gone(late,"paint")',
        'gone(dying,"paint")',
    ]


def test_the_contract_net_of_the_examples_ends_with_the_cheapest_bidder() -> None:
    """The program's own expectation is about the order; here is who does what."""
    system = MultiAgentSystem(
        [Agent(load_program(CONTRACT_NET / "manager.asl"), name="manager")],
        load=lambda name: load_program(CONTRACT_NET / name),
    )
    assert acts(system) == [
        ("manager", "award(ben,4)"),
        ("ben", "carry(letter)"),
        ("anna", "forget(letter)"),
        ("manager", "pay(ben,letter)"),
    ]


def test_the_contract_net_of_the_examples_passes_its_own_test() -> None:
    result = CliRunner().invoke(app, ["test", str(CONTRACT_NET / "manager.asl")])
    assert result.exit_code == 0, result.output
