"""python -m bdi run"""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from bdi.__main__ import app

COURIER = """!go.
+!go : line(center) <- drive(forward); !go.
+!go : line(lost) <- done.
+!go <- .print("no line"); !go.
-!go[error(E)] <- stop(E); done.
"""


@pytest.fixture
def courier(tmp_path: Path) -> Path:
    path = tmp_path / "courier.asl"
    path.write_text(COURIER)
    return path


def run(*arguments: object) -> Result:
    return CliRunner().invoke(app, ["run", *map(str, arguments)])


def test_every_action_is_printed_with_its_cycle(courier: Path, tmp_path: Path) -> None:
    percepts = tmp_path / "percepts.txt"
    percepts.write_text("line(center) battery(ok)\n\nline(center)\nline(lost)\nline(lost)\n")
    result = run(courier, "--percepts", percepts)
    assert result.stdout.splitlines() == ["1 drive(forward)", "3 drive(forward)", "5 done"]
    assert result.exit_code == 0


def test_a_percept_file_may_be_json_with_messages(tmp_path: Path) -> None:
    (tmp_path / "a.asl").write_text("+!g(X) : b <- act(X); done.")
    (tmp_path / "a.jsonl").write_text(
        '{"percepts": ["b"]}\n{"percepts": null, "messages": [["achieve", "g( 1 )"]]}\n{"percepts": null}\n'
    )
    result = run(tmp_path / "a.asl", "--percepts", tmp_path / "a.jsonl")
    assert result.stdout.splitlines() == ["2 act(1)", "3 done"]


def test_without_a_file_nothing_is_perceived_and_cycles_are_limited(courier: Path) -> None:
    result = run(courier, "--cycles", 4)
    assert result.stdout == ""
    assert "says: no line" in result.stderr


def test_an_action_can_be_made_to_fail(courier: Path, tmp_path: Path) -> None:
    (tmp_path / "p.txt").write_text("line(center)\n" * 3)
    result = run(courier, "--percepts", tmp_path / "p.txt", "--fail", "drive")
    assert result.stdout.splitlines() == ["1 drive(forward)", "3 stop(action_failed)", "4 done"]


def test_what_one_may_wonder_about_is_said_at_the_end(tmp_path: Path) -> None:
    (tmp_path / "a.asl").write_text("!g. +!g <- drive.")
    assert "--fail drvie: no action of this name was started" in run(tmp_path / "a.asl", "--fail", "drvie").stderr
    assert "--fail" not in run(tmp_path / "a.asl", "--fail", "drive").stderr
    (tmp_path / "a.asl").write_text("b. +!g <- a.")
    assert "nothing was done: a program begins by itself with a goal" in run(tmp_path / "a.asl").stderr
    (tmp_path / "a.asl").write_text("!g. +!g <- !h.")
    assert "why a goal failed: `python -m bdi step`" in run(tmp_path / "a.asl").stderr
    (tmp_path / "a.asl").write_text("!g. +!g <- a.")
    assert run(tmp_path / "a.asl").stderr == ""


def test_json_gives_one_object_a_line(courier: Path, tmp_path: Path) -> None:
    (tmp_path / "p.txt").write_text("line(lost)\n")
    result = run(courier, "--percepts", tmp_path / "p.txt", "--json")
    assert [json.loads(line) for line in result.stdout.splitlines()] == [{"cycle": 1, "actions": ["done"]}]


def test_it_ends_when_nothing_is_left_to_do(tmp_path: Path) -> None:
    (tmp_path / "a.asl").write_text('!g. +!g <- .wait(300); a; .wait("+never").')
    assert run(tmp_path / "a.asl").stdout.splitlines() == ["4 a"]


@pytest.mark.parametrize(
    ("program", "percepts", "problem"),
    [
        ("+!g <- a", "", "a.asl:1:9: the text ends too early"),
        ("+!g <- .nope.", "", "there is no internal action .nope"),
        ("!g.", "p(1) q((\n", "p.txt:1:9: "),
        ("!g.", '{"percepts": 3}', "p.txt:1:1: percepts must be a list"),
        ("!g.", '{"messages": [["achieve"]]}', "a message is a pair"),
        ("!g.", '{"messages": [["shout", "g"]]}', "no agent understands the performative 'shout'"),
        ("!g.", "{", "p.txt:1:2: this line is no JSON"),
        ("!g.", '{"percepts": [p]}', "p.txt:1:15: this line is no JSON: Expecting value"),
        ("!g.", "p(1), q(2)", "p.txt:1:5: percepts are separated by spaces, without ','"),
        ("!g.", "\np(1).", "p.txt:2:5: percepts are separated by spaces, without '.'"),
        ("!g.", "\np f(1", "p.txt:2:6: the text ends while the '(' of line 2, column 4 is open"),
        ("!g.", '{"agents": {"bob": {"percepts": ["p"]}}}', "there is no agent 'bob'; there are a"),
    ],
)
def test_bad_input_is_a_sentence_and_exit_code_2(tmp_path: Path, program: str, percepts: str, problem: str) -> None:
    (tmp_path / "a.asl").write_text(program)
    (tmp_path / "p.txt").write_text(percepts)
    result = run(tmp_path / "a.asl", "--percepts", tmp_path / "p.txt")
    assert (result.exit_code, result.stdout) == (2, "")
    assert problem in result.stderr
    assert "Traceback" not in result.stderr


def test_a_file_that_is_not_there_is_named(tmp_path: Path) -> None:
    result = run(tmp_path / "none.asl")
    assert result.exit_code == 2
    assert "none.asl: No such file" in result.stderr


def test_a_file_of_another_kind_is_asked_about(tmp_path: Path) -> None:
    (tmp_path / "a.mas2j").write_text("MAS a { agents: bob; }")
    result = run(tmp_path / "a.mas2j")
    assert result.exit_code == 2
    assert "a.mas2j is no .asl file: is it an agent program?" in result.stderr


def test_several_programs_are_agents_that_write_to_each_other(tmp_path: Path) -> None:
    (tmp_path / "buyer.asl").write_text("!go. +!go <- .send(seller, askOne, price(_), price(P)); buy(P).")
    (tmp_path / "seller.asl").write_text("price(42). +seen(X) <- wave(X).")
    (tmp_path / "p.txt").write_text('\n{"agents": {"seller": {"percepts": ["seen(you)"]}}}\n')
    programs = tmp_path / "buyer.asl", tmp_path / "seller.asl"
    result = run(*programs, "--percepts", tmp_path / "p.txt")
    assert set(result.stdout.splitlines()) == {"2 seller wave(you)", "3 buyer buy(42)"}
    assert "buyer to seller: askOne price" in result.stderr
    lines = [json.loads(line) for line in run(*programs, "--json").stdout.splitlines()]
    assert {"cycle": 3, "agent": "buyer", "actions": ["buy(42)"]} in lines


def test_two_programs_of_one_name_are_two_agents(tmp_path: Path) -> None:
    (tmp_path / "a.asl").write_text("!g. +!g <- .my_name(N); i_am(N).")
    stdout = run(tmp_path / "a.asl", tmp_path / "a.asl").stdout
    assert set(stdout.splitlines()) == {"2 a i_am(a)", "2 a_2 i_am(a_2)"}


def test_an_agent_outside_can_be_written_to_if_named(tmp_path: Path) -> None:
    (tmp_path / "a.asl").write_text("!g. +!g <- .send(server, tell, here); a. -!g <- b.")
    assert run(tmp_path / "a.asl").stdout.splitlines() == ["2 b"]
    result = run(tmp_path / "a.asl", "--outside", "server")
    assert result.stdout.splitlines() == ["2 a"]
    assert "1 to server: tell here" in result.stderr


def test_the_trace_shows_choices_and_steps_also_as_json(courier: Path, tmp_path: Path) -> None:
    (tmp_path / "p.txt").write_text("line(lost)\n")
    result = run(courier, "--percepts", tmp_path / "p.txt", "--trace")
    assert result.stdout == "1 done\n"
    assert "    1 +!go: plan p__2 (line 3), of 3 relevant" in result.stderr.splitlines()
    lines = [json.loads(line) for line in run(courier, "--cycles", 1, "--trace", "--json").stdout.splitlines()]
    assert {line["trace"]["kind"] for line in lines if "trace" in line} == {"deliberated", "stepped"}


def test_older_notation_is_taken_with_warnings_if_one_says_so(tmp_path: Path) -> None:
    path = tmp_path / "old.asl"
    path.write_text("p. q. !g. +!g : p and q <- act.")
    assert run(path).exit_code == 2
    result = run(path, "--compatible")
    assert result.stdout.splitlines() == ["1 act"]
    assert f"warning: {path}:1:19: 'and' is written '&'" in result.stderr


@pytest.mark.parametrize("command", ["run", "test", "step", "check", "replay"])
def test_every_command_explains_itself_with_examples(command: str) -> None:
    result = CliRunner().invoke(app, [command, "--help"])
    assert result.exit_code == 0
    assert f"python -m bdi {command}" in result.stdout
    assert "Examples" in result.stdout


@pytest.mark.parametrize("command", ["run", "test", "step", "check", "replay"])
def test_every_command_names_a_file_that_is_not_there(command: str) -> None:
    result = CliRunner().invoke(app, [command, "none.asl"], input="n\n")
    assert (result.exit_code, result.stdout) == (2, "")
    assert "none.asl" in result.stderr
    assert "Traceback" not in result.stderr
