"""Internal actions written in Python: kinds, answers, failures, and whose they are."""

import io
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from bdi import Agent, Atom, Finished, InternalActions, Literal, Term, UnknownInternalAction, atom, parse_program, show
from bdi.builtin.user_actions import ANY, ATOM, LIST, NUMBER, OUT, STRING, optional, rest
from bdi.model.intentions import StepFailed
from bdi.model.mind import Mind
from bdi.tools.recording.recorder import Recorder
from bdi.tools.recording.replaying import read_recording

library = InternalActions()
POSTS = {"library": (0.0, 120.0), "canteen": (50.0, 0.0)}


@library.action("courier.distance")
def distance(mind: Mind, a: float, b: float) -> float:
    return abs(a - b)


@library.action("courier.post")
def post(mind: Mind) -> Iterator[tuple[str, float, float]]:
    for name, (x, y) in POSTS.items():
        yield name, x, y


@library.action("courier.known")
def known(mind: Mind, name: str) -> bool:
    return name in POSTS


@library.action("courier.place")
def place(mind: Mind, name: str) -> list[float] | None:
    return list(POSTS[name]) if name in POSTS else None


@library.action("courier.kinds")
def kinds(mind: Mind, word: Atom, literal: Literal, numbers: list[float], flag: bool, whole: int, term: Term) -> str:
    return " ".join(type(value).__name__ for value in (word, literal, numbers, flag, whole, term))


@library.action("courier.note")
def note(mind: Mind, text: str, times: int = 1, *more: Any) -> None:
    for _ in range(times):
        mind.say(" ".join([text, *map(str, more)]))


@library.action("courier.oops")
def oops(mind: Mind) -> None:
    raise RuntimeError("the wheel came off")


@library.action("courier.refuses")
def refuses(mind: Mind) -> None:
    raise StepFailed("too_far", "that is too far", (atom("tired"),))


@library.action("courier.breaks_off")
def breaks_off(mind: Mind) -> Iterator[int]:
    yield 1
    raise RuntimeError("no more")


@library.action("courier.strange")
def strange(mind: Mind) -> object:
    return object()


@library.function("courier.cost")
def cost(mind: Mind, km: float) -> float:
    return 0.5 * km


@library.function("courier.limit")
def limit(mind: Mind) -> float:
    return 30


@library.function("courier.broken")
def broken(mind: Mind, km: float) -> float:
    raise RuntimeError("no tariff")


@library.action("courier.explicit", NUMBER, OUT, STRING, OUT)
def explicit(mind: Any, number: Any, text: Any) -> Any:
    return number + 1, text.upper()


def answers(call: str) -> list[str]:
    found = Agent(parse_program("at(3)."), internal_actions=library).ask(call)
    return [" ".join(f"{name}={show(value)}" for name, value in each.items()) or "yes" for each in found]


def run(text: str, own: InternalActions | None = library) -> list[str]:
    agent = Agent(parse_program(text), internal_actions=own)
    seen: list[str] = []
    finished: list[Finished] = []
    for _ in range(20):
        outcome = agent.cycle(None, [], finished)
        seen += [*map(str, outcome.actions), *outcome.printed]
        finished = [Finished(action.id) for action in outcome.actions]
    return seen


@pytest.mark.parametrize(
    ("call", "expected"),
    [
        ("courier.distance(3,10,D)", ["D=7"]),
        ("courier.distance(3,10,7)", ["yes"]),
        ("courier.distance(3,10,8)", []),
        ("courier.post(P,X,Y) & Y > 0", ['P="library" X=0 Y=120']),
        ("courier.post(P,_,_)", ['P="library"', 'P="canteen"']),
        ('courier.known("canteen")', ["yes"]),
        ('not courier.known("attic")', ["yes"]),
        ('courier.place("library",L)', ["L=[0,120]"]),
        ('courier.place("attic",L)', []),
        ('courier.kinds(a,p(1)[x],[1,2],true,3,"t",S)', ['S="Atom Structure list bool int str"']),
        ("X = 2 * courier.cost(courier.limit)", ["X=30"]),
        ("at(X) & courier.cost(X) < 2", ["X=3"]),
        ('courier.explicit(1,N,"up",T)', ['N=2 T="UP"']),
    ],
    ids=str,
)
def test_it_answers(call: str, expected: list[str]) -> None:
    assert answers(call) == expected


def test_in_a_plan_it_is_a_step_a_condition_and_a_value() -> None:
    program = """!g. +!g : courier.known("library") <- courier.distance(1,5,D); drive(D);
        for (courier.post(P,_,_)) { visit(P) }; pay(courier.cost(D)); courier.note("done")."""
    assert run(program) == ["drive(4)", 'visit("library")', 'visit("canteen")', "pay(2)", "done"]


def test_arguments_with_a_default_and_any_number_more() -> None:
    assert run('!g. +!g <- courier.note("a"); courier.note("b",2,x,[1]).') == ["a", "b x [1]", "b x [1]"]


@pytest.mark.parametrize(
    ("call", "failure"),
    [
        ("courier.oops", 'ia_failed,"courier.oops: RuntimeError: the wheel came off"'),
        ("courier.refuses", 'too_far,"that is too far"'),
        ("courier.strange(X)", 'ia_failed,"courier.strange: TypeError'),
        (".findall(X,courier.breaks_off(X),L)", 'ia_failed,"courier.breaks_off: RuntimeError: no more"'),
        ("Y = courier.broken(2)", 'ia_failed,"courier.broken: RuntimeError: no tariff"'),
        ("Z = foo; courier.distance(Z,1,D)", 'wrong_arguments,"argument 1 of courier.distance is a number, not foo"'),
        ("courier.distance(Z,1,D)", 'wrong_arguments,"argument 1 of courier.distance is a number, not Z"'),
        ("courier.distance(1,2,9)", 'ia_failed,"courier.distance(1,2,9)'),
    ],
    ids=str,
)
def test_what_goes_wrong_in_python_fails_the_step_and_never_the_cycle(call: str, failure: str) -> None:
    program = f"!g. +!g <- {call}. -!g[error(E),error_msg(M)] <- say(E,M)."
    assert run(program)[0].startswith(f"say({failure}")


def test_an_exception_in_a_condition_makes_it_false() -> None:
    assert run("!g. +!g : courier.oops <- a. +!g <- b.") == ["b"]


@pytest.mark.parametrize(
    ("program", "message"),
    [
        ("+!g <- courier.distanse(1,2,D).", "1:8: there is no internal action courier.distanse; did you mean courier."),
        (
            "+!g <- other.distance(1,2,D).",
            "1:8: there is no internal action other.distance; did you mean courier.distance?",
        ),
        ("+!g : courier.distance(1,2) <- a.", "1:1: courier.distance takes 3 arguments, not 2"),
        ("+!g <- courier.distance(1,two,D).", "1:8: argument 2 of courier.distance is a number, not two"),
        ("+!g <- X = courier.cost(a).", "1:8: argument 1 of courier.cost is a number, not a"),
        ('+!g <- courier.note("a",b).', "1:8: argument 2 of courier.note is a whole number, not b"),
    ],
    ids=str,
)
def test_a_wrong_call_is_refused_when_the_agent_is_made(program: str, message: str) -> None:
    with pytest.raises(UnknownInternalAction) as caught:
        Agent(parse_program(program), internal_actions=library)
    assert message in str(caught.value)


def test_each_agent_has_only_its_own() -> None:
    other = InternalActions()
    other.action("courier.distance", NUMBER, NUMBER, OUT)(lambda mind, a, b: math.hypot(a, b))
    program = "!g. +!g <- courier.distance(3,4,D); say(D)."
    assert (run(program), run(program, other)) == (["say(1)"], ["say(5)"])
    with pytest.raises(UnknownInternalAction):
        run(program, None)


def test_a_package_can_be_shared_by_several_agents_and_knows_who_calls() -> None:
    own = InternalActions()
    own.action("who.am_i", OUT)(lambda mind: atom(mind.name))
    for name in ("r1", "r2"):
        agent = Agent(parse_program("!g. +!g <- who.am_i(N); say(N)."), name=name, internal_actions=own)
        said = [str(action) for _ in range(4) for action in agent.cycle().actions]
        assert said == [f"say({name})"]


def test_a_recorded_run_is_replayed_with_them(tmp_path: Path) -> None:
    text = "!g. +!g <- courier.distance(3,4,D); say(D)."
    program = parse_program(text, source="courier.asl")
    file = io.StringIO()
    recorder = Recorder(Agent(program, internal_actions=library), file, program, texts={"courier.asl": text})
    said = [str(action) for _ in range(4) for action in recorder.cycle().actions]
    recorder.close()
    (tmp_path / "run.jsonl").write_text(file.getvalue())
    (recorded,) = read_recording(tmp_path / "run.jsonl").runs
    recorded.internal_actions = library
    assert said == ["say(1)"]
    assert recorded.replay() is None


@pytest.mark.parametrize("name", ["distance", ".distance", "Courier.distance", "courier.", "a b.c", "math.abs"])
def test_a_name_that_cannot_be_called_is_refused(name: str) -> None:
    with pytest.raises(ValueError, match=r"no name for an internal action|already"):
        InternalActions().action(name, ANY)(lambda mind, value: True)


def test_a_name_twice_is_refused() -> None:
    own = InternalActions()
    own.action("a.b", ATOM)(lambda mind, value: True)
    with pytest.raises(ValueError, match=r"there is a\.b already"):
        own.function("a.b", LIST)(lambda mind, value: 1)


def test_what_may_be_left_out_cannot_stand_before_an_answer() -> None:
    def far(mind: Mind, a: float, b: float = 0.0) -> float:
        return a - b

    with pytest.raises(ValueError, match="register it twice"):
        InternalActions().action("a.far")(far)
    own = InternalActions()
    own.action("a.far", NUMBER, OUT)(far)
    own.action("a.all", optional(NUMBER), rest(ANY))(lambda mind, *values: len(values) < 3)
    assert run("!g. +!g : a.all & a.all(1,x) & not a.all(1,x,y) <- a.far(3,D); say(D).", own) == ["say(3)"]
