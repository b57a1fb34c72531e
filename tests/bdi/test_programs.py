"""Programs as text: what is refused, and how it is said. Nothing but named errors comes out of bad text."""

from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from bdi import (
    Agent,
    AgentSpeakError,
    AgentSpeakSyntaxError,
    BdiError,
    IncludeCircle,
    IncludeNotFound,
    Message,
    UnknownAction,
    UnknownDirective,
    UnknownInternalAction,
    load_program,
    parse_plan,
    parse_program,
    parse_term,
)
from bdi.builtin import ACTIONS, FUNCTIONS
from bdi.performatives import PERFORMATIVES

MAIL = """// the heart of a courier
dockStation(post0).
par(X,Y) :- edge(X,Y) & not (closed(Y) | X == Y).
!start[urgent].
+!deliver(FROM,TO) : not charging & battery(B) & B >= 20.5
  <- +mission(FROM,TO); !collect(FROM); -+at(TO); .send(bob, tell, done("ok")); -mission(FROM,_).
@low[atomic] +battery(low)[source(S)] : dockStation(D) <- .drop_all_intentions; !charge(D).
+!charge(D) <- if (at(D)) { dock } else { !go(D); dock }; while (not battery(full)) { .wait(100) };
  for (.member(X,[1,2|[3]])) { count(X*2+1) }.
-!deliver(_,_)[error(E)] : E \\== x <- .print("failed: ", E); B = {p(1); !q}; B; (a; b) ||| c.
"""


def test_a_syntax_error_shows_file_line_column_and_a_caret() -> None:
    with pytest.raises(AgentSpeakSyntaxError) as caught:
        parse_program("!g.\n+!g <- go(1;\n   stop.\n", source="robot.asl")
    error = caught.value
    assert (error.source, error.line, error.column) == ("robot.asl", 2, 12)
    assert str(error).splitlines() == [
        "robot.asl:2:12: unexpected ';'; expected ')', ',' or '|'",
        "    +!g <- go(1;",
        "               ^",
    ]


def test_a_text_that_ends_too_early_says_so() -> None:
    with pytest.raises(AgentSpeakSyntaxError, match="the text ends too early"):
        parse_program("+!g <- a")


def test_two_signs_that_mean_nothing_are_refused_in_place() -> None:
    with pytest.raises(AgentSpeakSyntaxError, match=r"<text>:1:8: .* is no step of a plan"):
        parse_program("+!g <- +-b.")


def test_a_missing_include_names_its_place(tmp_path: Path) -> None:
    program = tmp_path / "robot.asl"
    program.write_text('b.\n{ include("safety.asl") }\n')
    with pytest.raises(IncludeNotFound) as caught:
        load_program(program)
    assert (caught.value.line, caught.value.source) == (2, str(program))


def test_includes_are_relative_to_the_file_that_includes(tmp_path: Path) -> None:
    (tmp_path / "parts").mkdir()
    (tmp_path / "robot.asl").write_text('{ include("parts/safety.asl") }\n!g.\n')
    (tmp_path / "parts" / "safety.asl").write_text('{ include("words.asl") }\n')
    (tmp_path / "parts" / "words.asl").write_text("+!g <- a.\n")
    program = load_program(tmp_path / "robot.asl")
    assert [str(action) for action in Agent(program).cycle().actions] == ["a"]
    assert program.plans[0].place.source == str(tmp_path / "parts" / "words.asl")


def test_a_file_that_includes_itself_is_refused(tmp_path: Path) -> None:
    (tmp_path / "a.asl").write_text('{ include("b.asl") }')
    (tmp_path / "b.asl").write_text('{ include("a.asl") }')
    with pytest.raises(IncludeCircle):
        load_program(tmp_path / "a.asl")


def test_an_unknown_directive_is_refused() -> None:
    with pytest.raises(UnknownDirective, match="includ"):
        parse_program('{ includ("a.asl") }')


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("+!g <- .prnt(1).", r"1:8: there is no internal action \.prnt"),
        ("+!g : .member(1) <- a.", r"1:1: \.member takes 2 arguments, not 1"),
        ("p :- .nonsense.", r"there is no internal action \.nonsense"),
    ],
)
def test_an_unknown_internal_action_is_refused_when_the_agent_is_made(text: str, problem: str) -> None:
    with pytest.raises(UnknownInternalAction, match=problem):
        Agent(parse_program(text))


def test_an_action_that_the_body_lacks_is_refused_when_the_agent_is_made() -> None:
    with pytest.raises(UnknownAction, match=r"<text>:1:19: the body has no action dance/1; expected drive/1 or stop"):
        Agent(parse_program("+!g <- drive(on); dance(1)."), actions=["drive/1", "stop"])


def test_an_unknown_action_in_a_variable_is_a_failure_that_plans_see() -> None:
    program = "!g. +!g <- X = dance(1); X. -!g[error(E)] <- stop(E)."
    agent = Agent(parse_program(program), actions=["stop"])
    actions = [str(action) for _ in range(4) for action in agent.cycle().actions]
    assert actions == ["stop(unknown_action)"]


def test_what_is_printed_is_what_was_written() -> None:
    for text in ("p(X)[a,source(bob)]", "~q([1,2|T])", "'Hello world'", "f(-3)", "ns::p(1)"):
        assert str(parse_term(text)) == text.replace("-3", "(-3)")


def test_a_printed_plan_reads_back_as_the_same_plan() -> None:
    for plan in parse_program(MAIL).plans:
        assert str(parse_plan(str(plan))) == str(plan)


@pytest.mark.parametrize("text", ["(" * 5000, "[" * 5000, "p(" * 300 + "1" + ")" * 300, "+!g <- " + "-" * 3000 + "b."])
def test_deep_nesting_is_refused(text: str) -> None:
    with pytest.raises(AgentSpeakError):
        parse_program(text)


def test_a_long_program_is_read() -> None:
    program = parse_program("+!g <- " + "a; " * 3000 + "b." + " fact(1)." * 2000)
    assert len(program.plans[0].body.steps) == 3001


def mangled(text: str) -> st.SearchStrategy[str]:
    """The program with a few pieces cut out, doubled or replaced."""
    places = st.integers(0, len(text))
    pieces = st.sampled_from(
        [*"()[]{}.,;:+-!?@~|&<>=*/\"'_ \n", "", "<-", ":-", "not", "if", "|||", "X", "1e9", "é", "\0"]
    )

    def apply(edits: list[tuple[int, int, str]]) -> str:
        result = text
        for start, length, piece in edits:
            result = result[:start] + piece + result[start + length :]
        return result

    return st.lists(st.tuples(places, st.integers(0, 12), pieces), min_size=1, max_size=4).map(apply)


@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(mangled(MAIL))
def test_mangled_programs_raise_only_errors_of_the_language(text: str) -> None:
    try:
        agent = Agent(parse_program(text))
    except AgentSpeakError as error:
        assert error.line >= 1
        return
    for cycle in range(20):
        agent.cycle({"battery(low)", "edge(a,b)"} if cycle % 2 else set(), now=cycle * 0.1)


VALUES = st.sampled_from(
    [
        *["X", "_", "Q", "1", "-2", "0.5", "1/0", "math.abs(-1)", '"text"', '"+b(X)"', '"+(("'],
        *["a", "g", "g(X)", "~b", "[]", "[1,2,3]", "[a|T]", '[b(1),"s",2]', "{p(1)}", "b(X) & X > 0"],
    ]
)
PLACES = st.sampled_from(
    [
        "!g. +!g <- .queue.create(Q); CALL; ok(X). -!g <- rescued.",
        "!g. +!g : CALL <- ok(X). +!g <- no.",
        "!g. +!g <- Z = CALL; ok(Z). -!g <- rescued.",
        "r(X) :- CALL. !g. +!g : r(X) <- ok. +!g <- for (CALL) { .print(X) }.",
    ]
)


@settings(max_examples=300, deadline=None)
@given(st.sampled_from([*ACTIONS, *FUNCTIONS]), st.lists(VALUES, max_size=4), PLACES)
def test_internal_actions_with_any_arguments_fail_by_name_if_at_all(name: str, values: list[str], place: str) -> None:
    call = f"{name}({','.join(values)})" if values else name
    try:
        agent = Agent(parse_program("b(1). b(2). " + place.replace("CALL", call)))
    except AgentSpeakError:
        return
    for cycle in range(8):
        agent.cycle([], now=float(cycle))


@settings(max_examples=150, deadline=None)
@given(st.text(alphabet="pX1 ()[]|,.~-+*/&!?{}\"'_:=<>@\n", max_size=30))
def test_any_text_is_a_term_or_a_syntax_error(text: str) -> None:
    try:
        parse_term(text)
    except AgentSpeakSyntaxError as error:
        assert error.line >= 1


CONTENTS = st.one_of(
    st.sampled_from(
        ["p(1/0)", "r(X)", "r(1/0)", "p(X)[source(Y)]", "~p", "+!g(X)", "+!X", "@l +b <- .nth(9,[a],X); a.", "g"]
    ),
    st.builds("{}({})".format, st.sampled_from(["p", "r", "g", "b"]), VALUES),
    st.text(alphabet="pX1 ()[]|,.~-+*/&!?{}\"'_:=<>@", max_size=12),
)


@settings(max_examples=300, deadline=None)
@given(
    st.sampled_from([*PERFORMATIVES, "shout"]), CONTENTS, st.sampled_from(["", "ag-1"]), st.lists(CONTENTS, max_size=2)
)
def test_a_wrong_message_or_percept_is_refused_by_name_and_never_troubles_a_cycle(
    performative: str, content: str, reply_to: str, percepts: list[str]
) -> None:
    program = (
        "r(X) :- .nth(9,[a],X). !g. +!g <- .send(bob, askOne, at(X), at(_)). +p(X) : X > 1 <- a(X). +!g(X) <- b(X/0)."
    )
    agent = Agent(parse_program(program), name="ag")
    agent.cycle()
    try:
        agent.cycle(percepts, [Message("bob", performative, content, id="q", reply_to=reply_to)])
    except BdiError:
        assert agent.cycles == 1, "refused in the middle of a cycle, not at the door"
    for cycle in range(6):
        agent.cycle(now=float(cycle))
