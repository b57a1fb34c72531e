"""Several agents, and messages."""

from bdi import Agent, Message, MultiAgentSystem, Stimuli, parse_program
from tests.bdi.differences import actions_of, happenings, shows, together


@shows("round")
def round_of_agents() -> None:
    seen = together(ann="!g. +!g <- .send(ben, tell, p); a.", ben="!h. +!h <- b. +p <- heard.")
    assert seen == ["1 ben b", "2 ann a", "2 ben heard"]


@shows("late-answer")
def late_answer() -> None:
    ann = "!g. +!g <- .send(ben, askOne, p(_), A, 100); got(A). +p(X) <- believed(X)."
    ben = "p(1). +!kqml_received(S,askOne,C,I) <- .wait(500); .send(S,tell,p(1),I)."
    assert actions_of(together(ann=ann, ben=ben)) == ["ann got(timeout)"]


@shows("several-asked")
def several_asked() -> None:
    ann = "!g. +!g <- .send([ben,cara], askOne, p(_), p(X)); got(X). +p(X) <- believed(X)."
    assert actions_of(together(ann=ann, ben="p(1).", cara="p(2).")) == ["ann got(1)"]


@shows("killed-receiver")
def killed_receiver() -> None:
    ann = "!g. +!g <- .send(ben, askOne, p(_), A); got(A). -!g[error(E)] <- why(E)."
    assert actions_of(together(ann=ann, ben="!h. +!h <- .kill_agent(ben).")) == ["ann why(ask_failed)"]


@shows("unknown-receiver")
def unknown_receiver() -> None:
    ann = "!g. +!g <- .send(nobody, tell, p). -!g[error(E),receiver(R)] <- why(E,R)."
    assert actions_of(together(ann=ann)) == ["ann why(unknown_receiver,nobody)"]


@shows("free-content")
def free_content() -> None:
    assert happenings("!g. +!g <- .send(ben, tell, X). -!g[error(E)] <- why(E).") == ["2 why(wrong_arguments)"]


@shows("kqml-plans")
def kqml_plans() -> None:
    """Obey a message in the cycle that reads it: no plan of the library is in between."""
    agent = Agent(parse_program("p(1)."))
    agent.cycle(None, [Message("ann", "untell", "q"), Message("ann", "askAll", "p(X)", id="q1")])
    [answer] = agent.cycle().messages
    assert (answer.performative, str(answer.content)) == ("tell", "[p(1)]")


@shows("save-agent")
def save_agent() -> None:
    assert happenings('!g. +!g <- .save_agent("a.asl"). -!g[error(E)] <- why(E).') == ["2 why(alone)"]
    ann = '!g. +!g <- .save_agent("a.asl"). -!g[error(E)] <- why(E).'
    assert actions_of(together(ann=ann)) == ["ann why(no_saver)"]


@shows("create-agent-options")
def create_agent_options() -> None:
    ann = '!g. +!g <- .create_agent(ben, "b.asl", [agentClass(x)]). -!g[error(E)] <- why(E).'
    assert actions_of(together(ann=ann)) == ["ann why(wrong_arguments)"]


@shows("clone")
def clone() -> None:
    program = "b(1). !g. +seen(X) <- .clone(twin). "
    ann = Agent(parse_program(program), name="ann")
    system = MultiAgentSystem([ann])
    system.round({"ann": Stimuli(percepts={"seen(2)"})}, 0.1)
    system.round({}, 0.2)
    assert system.agents["twin"].believes("b(1) & not seen(_)")


@shows("df-subscribe")
def df_subscribe() -> None:
    ann = '!g. +!g <- .df_subscribe("carry"). +provider(A,_)[source(df)] <- there(A). -provider(A,_) <- gone(A).'
    ben = '!h. +!h <- .df_register("carry"); .wait(500); .kill_agent(ben).'
    assert actions_of(together(ann=ann, ben=ben)) == ["ann there(ben)", "ann gone(ben)"]
