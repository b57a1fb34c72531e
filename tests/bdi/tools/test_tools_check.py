"""python -m bdi check: each finding on a program that has it, and none on one that has not."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from bdi import Agent, Finished, parse_program
from bdi.__main__ import app
from bdi.tools.checks import Severity, findings_of

ROOT = Path(__file__).parents[3]
OK = "!go. +!go <- act. "  # a goal with its plan, so that nothing else is found


def codes(text: str, percepts: list[str] | None = None) -> list[str]:
    """Return the findings without hints."""
    found = findings_of(parse_program(text), percepts)
    return [each.code for each in found if each.severity is not Severity.HINT]


@pytest.mark.parametrize(
    ("code", "wrong", "right"),
    [
        ("goal-without-plan", "!go.", "!go. +!go."),
        ("goal-without-plan", "!go(1). +!go(2).", "!go(2). +!go(2)."),
        ("goal-without-plan", OK + "+p <- !go_on.", OK + "+p <- !go."),
        ("goal-without-plan", OK + "+p <- !!go(1,2). +!go(1).", OK + "+p <- !!go(1,2). +!go(_,_)."),
        ("goal-without-plan", OK + "+p <- if (q) { !none }.", OK + "+p <- if (q) { !go }."),
        ("goal-without-plan", "!go. +!go <- !some.", "!go. +!go <- !some. +!G <- act(G)."),
        ("shadowed-plan", OK + "+!go : p <- b.", "!go. +!go : p <- b. +!go <- act."),
        (
            "shadowed-plan",
            OK + "+p(X,Y) <- a(X,Y). +p(1,Z) : q <- b(Z).",
            OK + "+p(1,Z) : q <- b(Z). +p(X,Y) <- a(X,Y).",
        ),
        (
            "shadowed-plan",
            OK + "+p(X) : q(X,Y) <- a(Y). +p(A) : q(A,B) <- b(B).",
            OK + "+p(X) : q(X,Y) <- a(Y). +p(A) : q(B,A) <- b(B).",
        ),
        ("shadowed-plan", OK + "+p(X,Y) <- a(X,Y). +p(Z,Z) <- b.", OK + "+p(Z,Z) <- b. +p(X,Y) <- a(X,Y)."),
        ("shadowed-plan", OK + "+p <- a. +p[source(bob)] <- b.", OK + "+p[source(bob)] <- b. +p <- a."),
        ("no-default-plan", "!go. +!go : p <- a. +!go : q <- b.", "!go. +!go : p <- a. +!go : not p <- b."),
        ("no-default-plan", "!go. +!go : p(X) & X > 2 <- a.", "!go. +!go : p(X) & X > 2 <- a. -!go <- b."),
        ("open-failure", OK + "-!go[reason(late)] <- b.", OK + "-!go[reason(late)] <- b. -!go <- c."),
        ("open-failure", OK + "-!go : p <- b.", OK + "-!go : p <- b. -!go : not p <- c."),
        ("open-failure", "!at(1,2). +!at(_,_). -!at(X,X) <- b.", "!at(1,2). +!at(_,_). -!at(_,Y) <- b(Y)."),
        (
            "open-failure",
            OK + "-!go[error_msg(M), reason(R)] <- b(M,R).",
            OK + "-!go[error_msg(M), reason(R)] <- b(M,R). -!go[error(_), error_msg(M)] <- .fail(error_msg(M)).",
        ),
        (
            "look-alike",
            "!go_to(1). !goTo(1). +!go_to(1). +!goTo(1).",
            "!go_to(1). !come_to(1). +!go_to(1). +!come_to(1).",
        ),
        ("look-alike", OK + "+p : isOpen <- a. +q : is_open <- b.", OK + "+p : isOpen <- a. +q : isOpen <- b."),
        (
            "forgotten-mark",
            "!go. !walk(1). +!go <- walk(1). +!walk(_) <- step.",
            "!go. +!go <- !walk(1). +!walk(_) <- step.",
        ),
        ("forgotten-mark", OK + "+p <- +seen(1). +q <- seen(2).", OK + "+p <- +seen(1). +q <- +seen(2)."),
        ("forgotten-mark", OK + "+p <- dock. +!dock <- !go.", OK + "+p <- !dock. +!dock <- dock."),
        ("variable-without-value", OK + "+p(Post) <- drive(Psot).", OK + "+p(Post) <- drive(Post)."),
        ("variable-without-value", OK + "+p <- +seen(X).", OK + "+p <- ?at(X); +seen(X)."),
        ("lone-variable", OK + "+p(Post) : at(post) & q(POST) <- a.", OK + "+p(Post) : at(Post) <- a."),
        ("endless-rule", OK + "far(X) :- far(Y) & near(X,Y).", OK + "far(a). far(X) :- near(X,Y) & far(Y)."),
        ("endless-rule", OK + "a(X) :- b(X). b(X) :- a(X) & c(X).", OK + "a(X) :- b(X). b(X) :- c(X)."),
        ("same-label", OK + "@x +p <- a. @x +q <- b.", OK + "@x +p <- a. @y +q <- b."),
        ("unreached-step", OK + "+p <- .fail; a.", OK + "+p <- a; .fail."),
        ("unreached-step", OK + "+p <- if (q) { .fail(why); a }; b.", OK + "+p <- if (q) { .fail(why) }; b."),
        (
            "unknown-belief",
            OK + "battery(80). +p : batery(B) & B > 20 <- a(B).",
            OK + "battery(80). +p : battery(B) & B > 20 <- a(B).",
        ),
    ],
)
def test_a_mistake_is_found_and_its_correction_is_not(code: str, wrong: str, right: str) -> None:
    assert code in codes(wrong)
    assert code not in codes(right)


def test_declared_percepts_make_every_other_belief_known_or_not() -> None:
    program = OK + "+line(lost) : battery(B) & B > 20 & at(_) <- a(B)."
    assert codes(program) == []
    assert codes(program, ["line", "battery/1", "at/1"]) == []
    assert codes(program, ["line", "battery/2", "at"]) == ["unknown-belief"]


@pytest.mark.parametrize(
    "program",
    [
        "!go. +!go <- .add_plan({+!later <- a}); !later.",
        "!go. +!go <- +{ +!later <- a }; !later.",
        "!g(a). +!g(G) <- !G. +!a <- b.",
        "!a. +!a <- .send(me, achieve, b). +!b <- c.",
    ],
)
def test_what_may_come_later_is_no_mistake(program: str) -> None:
    assert codes(program) == []


def test_a_sub_plan_may_mean_the_variables_around_it() -> None:
    assert codes("!walk(1). +!walk(Way) <- !step; go(Way). { +!step <- turn(Way). }") == []
    assert codes("!walk(1). +!walk(Way) <- !step; go(Way). { +!step <- turn(Wya). }") == ["variable-without-value"]


def test_the_programs_of_the_project_have_no_mistakes() -> None:
    programs = [*(ROOT / "examples" / "agents").glob("*.asl"), ROOT / "robot" / "agent" / "main.asl"]
    assert len(programs) > 5
    result = check(*programs, "--no-hints")
    assert result.exit_code == 0, result.stdout
    errors = [line for line in result.stdout.splitlines() if " error " in line]
    assert errors == []


def test_in_the_robots_own_program_nothing_is_found_not_even_a_hint() -> None:
    result = check(ROOT / "robot" / "agent" / "main.asl", "--strict")
    assert (result.exit_code, result.stdout) == (0, "nothing found\n")


def test_a_failure_that_no_plan_takes_ends_the_intention_and_check_says_so() -> None:
    """The warning is true: the plan of the goal below is not tried."""
    program = "!trip. +!trip <- !leg. -!trip <- saved. +!leg <- drive. -!leg[reason(blocked)] <- rest."
    agent = Agent(parse_program(program))
    (drive,) = [action for _ in range(5) for action in agent.cycle(None, [], [], 0.0).actions]
    outcomes = [
        agent.cycle(None, [], [Finished(drive.id, "lost")], 1.0),
        *(agent.cycle(None, [], [], 2.0) for _ in "abc"),
    ]
    assert [action for each in outcomes for action in each.actions] == []
    assert [failure for each in outcomes for failure in each.failures]
    assert codes(program) == ["open-failure"]


def test_a_plan_that_says_whose_goal_it_is_needs_no_agent_to_post_it() -> None:
    found = findings_of(parse_program("+!visit(P)[source(user)] <- go(P). +!tour[source(self)] <- go(1)."))
    assert [(each.code, each.place.line, "tour" in each.problem) for each in found] == [("uncalled-plan", 1, True)]


def check(*arguments: object) -> Result:
    return CliRunner().invoke(app, ["check", *map(str, arguments)])


def test_a_finding_names_its_place_and_what_to_do(tmp_path: Path) -> None:
    path = tmp_path / "a.asl"
    path.write_text("!start.\n+!start\n  <- drive(1);\n     !delver(1).\n+!deliver(X) <- drop(X).\n")
    result = check(path)
    assert result.exit_code == 1
    lines = result.stdout.splitlines()
    assert lines[0] == f"{path}:4:7 error there is no plan for !delver/1 [goal-without-plan]"
    assert lines[1:4] == ["         !delver(1).", "          ^", "    did you mean !deliver/1?"]
    assert lines[-1] == "1 error, 1 hint"


def test_the_file_of_an_included_plan_is_named(tmp_path: Path) -> None:
    (tmp_path / "main.asl").write_text('{ include("part.asl") }\n!a. +!a.\n')
    (tmp_path / "part.asl").write_text("\n+p <- !none.\n")
    assert f"{tmp_path / 'part.asl'}:2:8 error" in check(tmp_path / "main.asl").stdout


def test_strict_and_json(tmp_path: Path) -> None:
    path = tmp_path / "a.asl"
    path.write_text("!go. +!go : p <- a.")
    assert check(path).exit_code == 0
    result = check(path, "--strict", "--json")
    assert result.exit_code == 1
    (finding,) = json.loads(result.stdout)["programs"][0]["findings"]
    assert (finding["code"], finding["severity"], finding["line"]) == ("no-default-plan", "warning", 1)


def test_a_program_that_an_agent_refuses_is_an_error_and_one_that_cannot_be_read_is_unusable(tmp_path: Path) -> None:
    path = tmp_path / "a.asl"
    path.write_text("!g. +!g <- .nope(1).")
    result = check(path)
    assert (result.exit_code, "there is no internal action .nope" in result.stdout) == (1, True)
    path.write_text("!g. +!g <-")
    assert check(path).exit_code == 2
