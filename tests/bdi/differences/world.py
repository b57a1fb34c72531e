"""The world comes in by arguments and goes out by the answer."""

from bdi import Agent, parse_program
from tests.bdi.differences import happenings, shows


@shows("percept-order")
def percept_order() -> None:
    assert happenings("+at(P) <- seen(P).", [{"at(c)", "at(a)", "at(b)"}]) == ["1 seen(a)", "2 seen(b)", "3 seen(c)"]


@shows("clock")
def clock() -> None:
    agent = Agent(parse_program("!g. +!g <- .wait(5000); rise."))
    assert not agent.cycle(now=100.0).actions
    assert not agent.cycle(now=104.9).actions
    answers = [str(action) for now in (105.1, 105.2) for action in agent.cycle(now=now).actions]
    assert answers == ["rise"]


@shows("random")
def chance() -> None:
    program = "!g. +!g <- .random(X); .shuffle([1,2,3,4,5],L); show(X,L)."
    assert happenings(program) == happenings(program)
    assert "show" in happenings(program)[0]


@shows("print")
def printing() -> None:
    assert happenings('!g. +!g <- .print("at ", post(1)).') == ["1 says at post(1)"]


@shows("verbose")
def verbose() -> None:
    assert happenings("!g. +!g <- .verbose(2); p.") == ["2 p"]


@shows("given-up")
def given_up() -> None:
    assert happenings("!g. +!g : never <- p.") == ["1 given up +!g no_applicable"]


@shows("cancelled")
def cancelled() -> None:
    seen = happenings("!g. +!g <- long. +stop <- .drop_all_intentions; p.", [None, None, {"stop"}])
    assert seen == ["1 long", "3 cancels 1", "4 p"]
