"""Programs as text: what is refused, and how it is said. Nothing but named errors comes out of bad text."""

from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from bdi import (
    Action,
    Agent,
    AgentSpeakError,
    AgentSpeakSyntaxError,
    BdiError,
    Finished,
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
from bdi.reasoning.performatives import PERFORMATIVES

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
        "robot.asl:2:12: unexpected ';' while the '(' of line 2, column 10 is open; expected ')', ',' or '|'",
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
    st.sampled_from([*PERFORMATIVES, "shout"]), CONTENTS, st.sampled_from(["", "ag-1?"]), st.lists(CONTENTS, max_size=2)
)
@pytest.mark.slow
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


def test_a_plan_is_taken_apart_and_carried_out_step_by_step() -> None:
    """A program can look into its own plans: label, event, context, body; a body is its first step and the rest."""
    program = """ready. !start.
        @trip[fast] +!trip(P) : ready <- pack; ?ready; drive(P).
        +!start <- .relevant_plans({+!trip(_)}, [Plan]); Plan =.. [L,E,C,B]; E = {+!trip(Where)}; Where = uc;
            L =.. [Name,_,_]; if (C) { named(Name); !all(B) }.
        +!all({}) <- done.
        +!all({First; Rest}) <- First; !all(Rest)."""
    agent = Agent(parse_program(program))
    assert [str(each) for _ in range(30) for each in succeeded(agent)] == ["named(trip)", "pack", "drive(uc)", "done"]


def succeeded(agent: Agent) -> tuple[Action, ...]:
    actions = agent.cycle().actions
    if actions:
        agent.cycle(None, (), [Finished(each.id) for each in actions])
    return actions


PATTERNS = [
    ("{ a; !b(3); ?c } = { First; Rest }; show(First,Rest)", "show({a},{!b(3); ?c})"),
    ("{ a } = { First; Rest }; show(First,Rest)", "show({a},{})"),
    ("{ A1; A2; A3 } = { !g; Own; .print }; Own = x; show(A1,A2,A3)", "show({!g},x,{.print})"),
    ("{ !a(X); b(X) } = { !a(7); R }; show(X,R)", "show(7,{b(7)})"),
    ("{ +!go(P) : free(P) <- drive(P) } = { +!T : C <- B }; T = go(uc); show(C,B)", "show(free(uc),{drive(uc)})"),
    ("W = { @way[fast] +!go <- b }; W = { @L +!go <- B }; show(L,B)", "show(way[fast],{b})"),
    ("{+!go(X)[source(S)]} = {+!go(uc)[source(bob)]}; show(X,S)", "show(uc,bob)"),
    ("{ p(X) :- q(X) & r } = { p(7) :- F }; show(F)", "show((q(7) & r))"),
    ("{+!go(X)} = {+!go(Y)}; X = 1; show(Y)", "show(1)"),
]


@pytest.mark.parametrize(("step", "shown"), PATTERNS, ids=[step for step, _ in PATTERNS])
def test_plans_and_bodies_as_values_are_patterns_too(step: str, shown: str) -> None:
    agent = Agent(parse_program(f"!g. +!g <- {step}."))
    assert [str(each) for _ in range(10) for each in agent.cycle().actions] == [shown]


DIFFERENT = [
    "{} = {A}",
    "{ a; b } = { a }",
    "{ a; b } = { a; !R }",
    "{ !a } = { ?a }",
    "{+!go} = {+?go}",
    "{+!go} = { +!go <- a }",
    "{ @one +!go <- a } = { @two +!go <- a }",
    "{ +!go : b <- a } = { +!go <- a }",
    "{ a } = a(1)",
]


@pytest.mark.parametrize("step", DIFFERENT)
def test_what_differs_in_any_step_does_not_unify(step: str) -> None:
    agent = Agent(parse_program(f"!g. +!g <- {step}; show(wrong). -!g[error(E)] <- show(E)."))
    assert [str(each) for _ in range(10) for each in agent.cycle().actions] == ["show(constraint_failed)"]


def test_annotations_that_are_left_over_go_to_the_tail_on_either_side() -> None:
    text = "!g. +!g <- b(1)[x,y(1),y(2)] = b(B)[y(1)|R]; b(C)[y(1)|S] = b(1)[x,y(1),y(2)]; show(B,R,C,S)."
    agent = Agent(parse_program(text))
    assert [str(each) for _ in range(5) for each in agent.cycle().actions] == ["show(1,[x,y(2)],1,[x,y(2)])"]


def test_a_negated_literal_comes_after_the_others_of_its_name() -> None:
    agent = Agent(parse_program("!g. +!g <- .sort([c,~b(1),b(2),~a,b(1,1),a],L); show(L)."))
    assert [str(each) for _ in range(5) for each in agent.cycle().actions] == ["show([a,~a,b(1,1),b(2),~b(1),c])"]


def test_a_part_is_cut_out_of_a_text_that_comes_first_or_second() -> None:
    text = """!g. +!g <- .substring("warehouse",A,4); .substring("warehouse",B,0,4); .substring(C,"warehouse",4,6);
        .substring("use","warehouse",D); show(A,B,C,D)."""
    agent = Agent(parse_program(text))
    shown = ['show("house","ware","ho",6)']
    assert [str(each) for _ in range(9) for each in agent.cycle().actions] == shown


def test_every_source_of_a_belief_is_an_answer_of_its_own() -> None:
    """Two votes for the same candidate: one belief, two sources."""
    text = """yes[source(ann),source(bob)]. at(uc)[source(gps),k(1),k(2)].
        most(N) :- .count(yes[source(_)],N).
        !g. +!g <- ?most(N); .findall(S,yes[source(S)],L); .findall(S-K,at(_)[source(S),k(K)],M); show(N,L,M);
            .findall(T,at(_)[source(gps)|T],R); .count(yes[source(bob)],B); .count(yes,A); show(R,B,A);
            for (yes[source(W)]) { show(W) }."""
    agent = Agent(parse_program(text))
    shown = [str(each) for _ in range(12) for each in succeeded(agent)]
    assert shown == ["show(2,[ann,bob],[(gps-1),(gps-2)])", "show([[k(1),k(2)]],1,1)", "show(ann)", "show(bob)"]


def test_a_list_with_an_open_end_is_a_list_in_a_rule() -> None:
    text = """new(X,[H|T]) :- not .member(X,[H|T]) & .length([H|T],N) & N < 3.
        !g. +!g : new(c,[a,b]) & not new(a,[a]) <- ok."""
    assert [str(each) for each in succeeded(Agent(parse_program(text)))] == ["ok"]
