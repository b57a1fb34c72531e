"""python -m bdi test"""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from bdi.__main__ import app

COURIER = """!go.
+!go : line(center) <- drive(forward); +driven(1); !go.
+!go : line(lost) <- .print("no line"); done.
"""
PERCEPTS = "line(center)\n" * 3 + "line(lost)\n" * 4


@pytest.fixture
def courier(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    Path("courier.asl").write_text(COURIER)
    Path("walk.txt").write_text(PERCEPTS)
    return Path("courier.asl")


def run_test(*arguments: object) -> Result:
    return CliRunner().invoke(app, ["test", *map(str, arguments)])


def expecting(text: str, *more: object) -> Result:
    Path("walk.exp").write_text(text)
    return run_test("courier.asl", "--percepts", "walk.txt", "--expect", "walk.exp", *more)


@pytest.mark.parametrize(
    "text",
    [
        "1 drive(forward)\n5 done\n",
        "# a comment\n// another\n\n 1   drive( forward )\n5 done",
        "drive(forward)\ndone\n",
        "1 drive(_)\n5 done\n",
        "1 courier drive(forward)\n5 done\n",
        "1 drive(forward)\n1 believes line(center)\n1 not driven(_)\n3 believes driven(X) & X < 2\n5 done\n",
        "drive(forward)\ndone\nbelieves driven(1)\nnot line(center)\n",
        "1 drive(forward)\n4 says no line\n5 done\n",
    ],
)
@pytest.mark.usefixtures("courier")
def test_what_comes_as_expected_is_ok(text: str) -> None:
    result = expecting(text)
    assert result.exit_code == 0, result.output
    assert result.stdout.startswith("ok ")


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("1 drive(back)\n5 done\n", ["-    1 drive(back)", "+    1 drive(forward)", "     5 done"]),
        ("1 drive(forward)\n4 done\n", ["-    4 done  (came 1 cycle later, in 5)", "+    5 done"]),
        ("1 drive(forward)\n3 turn(left)\n5 done\n", ["-    3 turn(left)", "     5 done"]),
        ("5 done\n", ["+    1 drive(forward)"]),
        ("done\ndrive(forward)\n", ["- done", "+    5 done"]),
        ("1 drive(forward)\n1 believes driven(1)\n5 done\n", ["?    1 believes driven(1)  (is not believed)"]),
        ("1 drive(forward)\n5 done\n90 not driven(1)\n", ["?   90 not driven(1)  (the run ended after 5 cycles)"]),
        ("1 drive(forward)\n5 done\n6 says good bye\n", ["-    6 says good bye", "+    4 says no line"]),
    ],
)
@pytest.mark.usefixtures("courier")
def test_what_comes_otherwise_is_shown_as_a_difference(text: str, shown: list[str]) -> None:
    result = expecting(text)
    assert result.exit_code == 1
    lines = [line.strip() for line in result.stdout.splitlines()]
    assert lines[0].startswith("DIFFERS")
    assert [each for each in shown if each.strip() not in lines] == [], result.stdout


@pytest.mark.usefixtures("courier")
def test_a_new_expectation_is_written_and_then_met() -> None:
    first = run_test("courier.asl", "--percepts", "walk.txt", "--expect", "new.exp", "--update")
    assert first.exit_code == 0
    assert Path("new.exp").read_text() == "1 drive(forward)\n5 done\n"
    assert run_test("courier.asl", "--percepts", "walk.txt", "--expect", "new.exp").exit_code == 0


@pytest.mark.usefixtures("courier")
def test_an_update_keeps_comments_beliefs_and_the_form() -> None:
    assert expecting("# my walk\nturn(left)\nbelieves driven(1)\n", "--update").exit_code == 0
    assert Path("walk.exp").read_text() == "# my walk\ndrive(forward)\ndone\nbelieves driven(1)\n"


def test_the_closing_comment_is_a_test_and_can_be_updated(tmp_path: Path) -> None:
    good, bad = tmp_path / "good.asl", tmp_path / "bad.asl"
    good.write_text(
        "+!g(X) <- act(X).\n-!g(X)[error(E)] <- sorry(E).\n\n/* messages\nachieve g(1)\n3 achieve g(2)\n\n"
        "fails act\nprints\n1 act(1)\n3 sorry(action_failed)\n4 act(2)\n6 sorry(action_failed)\n*/\n"
    )
    bad.write_text("+p <- a.\n/* percepts\nq\np\n\nprints\n1 a\n*/\n")
    result = run_test(good, bad)
    assert result.exit_code == 1
    assert "1 of 2 programs differ" in result.stdout
    assert "came 1 cycle later, in 2" in result.stdout
    assert run_test(bad, "--update").exit_code == 0
    assert bad.read_text() == "+p <- a.\n/* percepts\nq\np\n\nprints\n2 a\n*/\n"
    assert "2 programs ok" in run_test(good, bad).stdout


def test_several_programs_with_one_expectation_are_one_system(tmp_path: Path) -> None:
    (tmp_path / "asker.asl").write_text("!g. +!g <- .send(teller, askOne, price(_), price(P)); buy(P).")
    (tmp_path / "teller.asl").write_text("price(42). +price(0) <- never.")
    (tmp_path / "e").write_text("asker buy(42)\nteller believes price(42)\nasker not price(_)\n")
    programs = [tmp_path / "asker.asl", tmp_path / "teller.asl"]
    result = run_test(*programs, "--expect", tmp_path / "e")
    assert result.exit_code == 0, result.output
    (tmp_path / "e").write_text("teller buy(42)\n")
    wrong = run_test(*programs, "--expect", tmp_path / "e")
    assert wrong.exit_code == 1
    assert "+ asker buy(42)" in wrong.stdout or "asker buy(42)" in wrong.stdout


@pytest.mark.usefixtures("courier")
def test_json_lists_the_differences() -> None:
    result = expecting("1 drive(back)\n5 done\n", "--json")
    assert result.exit_code == 1
    (program,) = json.loads(result.stdout)["programs"]
    assert program["as_expected"] is False
    assert [(each["what"], each["cycle"], each["text"]) for each in program["differences"]] == [
        ("missing", 1, "drive(back)"),
        ("unexpected", 1, "drive(forward)"),
    ]


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("1 drive(forward\n", "walk.exp:1:"),
        ("1 drive(forward)\ndone\n", "walk.exp:2:1: this line has no cycle, others do"),
        ("1 believes (\n", "walk.exp:1:"),
    ],
)
@pytest.mark.usefixtures("courier")
def test_a_wrong_expectation_is_named_with_its_line(text: str, problem: str) -> None:
    result = expecting(text)
    assert (result.exit_code, result.stdout) == (2, "")
    assert problem in result.stderr


@pytest.mark.usefixtures("courier")
def test_a_program_that_expects_nothing_says_how_to() -> None:
    result = run_test("courier.asl")
    assert result.exit_code == 2
    assert "--expect FILE" in result.stderr
