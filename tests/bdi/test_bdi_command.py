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
        ("!g.", "{", "this line is no JSON"),
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
