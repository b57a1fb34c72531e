"""python -m bdi step: driven by commands from a pipe, from a file and from a real terminal."""

import json
import os
import pty
import select
import sys
import time
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from bdi import AgentSpeakSyntaxError
from bdi.__main__ import app
from bdi.tools.stepping.breakpoints import breakpoint_of

ROOT = Path(__file__).parents[3]
MAIL = """!deliver(post4). line(lost).
@direct +!deliver(P) : line(center) & open(P) <- drive(P).
@other +!deliver(post5) <- drive(post5).
@search +!deliver(P) : line(L) <- +tried(P); drive(L); !deliver(P).
@seen[breakpoint] +marker(M) <- note(M).
"""


@pytest.fixture(autouse=True)
def mail(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "80")
    path = Path("mail.asl")
    path.write_text(MAIL)
    return path


def step(commands: str, *arguments: object) -> Result:
    return CliRunner().invoke(app, ["step", "mail.asl", *map(str, arguments)], input=commands)


def shown(commands: str, *arguments: object) -> list[str]:
    result = step(commands, *arguments)
    assert result.exit_code == 0, result.output
    return [line.rstrip() for line in result.stdout.splitlines()]


def test_a_cycle_shows_event_plans_with_reasons_step_beliefs_and_intentions() -> None:
    assert shown("n\n")[1:] == [
        "cycle 1 " + "─" * 72,
        "event    +!deliver(post4)",
        "plans    ✗ direct 2 line(center) does not hold (believed: line(lost))",
        "         ✗ other  3 argument 1 is post4, not post5",
        "         ✓ search 4 P=post4, L=lost",
        "step     +tried(P)                                       mail.asl:4, intention 1",
        "beliefs  + tried(post4)[source(self)]",
        "doing    1  +!deliver(post4)          search  has posted +tried(post4)",
    ]


def test_nothing_is_wider_than_the_terminal() -> None:
    lines = shown("n\n" * 12 + "i\np\nw deliver(_)\nh\n")
    assert max(map(len, lines)) <= 80
    assert sum(line.startswith("cycle ") for line in lines) == 12


def test_actions_removed_beliefs_and_messages_are_shown() -> None:
    Path("p.txt").write_text("far\nnear\n")
    Path("mail.asl").write_text('+near <- .send(user, tell, here); .print("hello"); ring.')
    lines = shown("n 4\n", "--percepts", "p.txt")
    assert "beliefs  + near[source(percept)]" in lines
    assert "         - far[source(percept)]" in lines
    assert "sends    tell here to user" in lines
    assert "says     hello" in lines
    assert "action   ring" in lines


def test_it_goes_on_to_a_breakpoint_and_says_which() -> None:
    lines = shown("b drive(lost)\nc\n")
    assert "… 1 cycle" in lines
    assert lines[-1] == "stopped: action drive(lost) starts"


@pytest.mark.parametrize(
    ("breakpoint", "why"),
    [
        ("+!deliver/1", "stopped: event +!deliver(post4)"),
        ("+!deliver", "stopped: event +!deliver(post4)"),
        ("+!deliver(post4)", "stopped: event +!deliver(post4)"),
        ("@search", "stopped: plan search is chosen"),
        ("search", "stopped: plan search is chosen"),
        ("+tried(_)", "stopped: +tried(post4)[source(self)]"),
        ("drive", "stopped: action drive(lost) starts"),
    ],
)
def test_a_breakpoint_is_an_event_a_plan_a_belief_or_an_action(breakpoint: str, why: str) -> None:
    assert shown(f"b {breakpoint}\nc\n")[-1] == why


@pytest.mark.parametrize(
    "breakpoint", ["+!deliver/2", "+!deliver(post9)", "-tried", "@direct", "drive(center)", "-!deliver"]
)
def test_a_breakpoint_that_is_about_something_else_does_not_stop(breakpoint: str) -> None:
    assert shown(f"b {breakpoint}\nc\n", "--cycles", 9)[-1] == "the run is over after 9 cycles"


def test_a_plan_can_be_a_breakpoint_by_its_annotation() -> None:
    Path("p.txt").write_text("\n\nmarker(m4)\n\n")
    lines = shown("c\n", "--percepts", "p.txt", "--cycles", 20)
    assert lines[-1] == "stopped: plan seen is a breakpoint"


def test_breakpoints_are_listed_and_deleted() -> None:
    lines = shown("b\nb drive\nb +!deliver\nb\nd drive\nb\nd\nb\n")
    assert lines.count("  drive") == 1
    assert lines.count("  +!deliver") == 2
    assert lines[-1] == "no breakpoints; b +!goto/2 makes one"


def test_a_filter_shows_only_cycles_about_it() -> None:
    lines = shown("f +!deliver\nn 2\nf\nn\n")
    cycles = [line.split()[1] for line in lines if line.startswith("cycle ")]
    assert cycles[0] == "1"
    assert int(cycles[1]) > 2
    assert int(cycles[2]) == int(cycles[1]) + 1


def test_going_back_gives_the_same_cycle_again() -> None:
    lines = shown("n 5\nback 2\nn 2\n")
    places = [number for number, line in enumerate(lines) if line.startswith("cycle ")]
    pictures = [lines[start + 1 : end] for start, end in zip(places, [*places[1:], len(lines)], strict=True)]
    numbers = [lines[start].split()[1] for start in places]
    assert numbers == ["1", "2", "3", "4", "5", "3", "4", "5"]

    def plain(lines: list[str]) -> list[str]:
        return [line for line in lines if not line.startswith("> ")]

    assert [plain(each) for each in pictures[2:5]] == [plain(each) for each in pictures[5:8]]
    assert shown("n\nback\n")[-1] == "before the first cycle"


def test_questions_about_beliefs_goals_and_intentions() -> None:
    lines = shown("n 4\np line(X)\np nothing\np tried(post4)\nw deliver(_)\ni\np 3 +\nzz\n")
    assert "X=lost" in lines
    assert "no" in lines
    assert "yes" in lines
    assert "deliver(post4) is being worked on by plan search." in lines
    assert any(line.startswith("Plan search was chosen for +!deliver(post4)") for line in lines)
    assert "zz is no command; h shows them" in lines


def test_a_goal_or_breakpoint_that_nothing_is_about_is_noticed() -> None:
    lines = shown("n\nw delivr(_)\nb drvie\nb drive\nb @seen\nb +!deliver/1\n")
    assert "Pursued are: deliver(post4)." in lines
    assert [line for line in lines if line.startswith("no plan")] == ["no plan has the name drvie in it"]


def test_events_whose_turn_comes_later_are_shown() -> None:
    Path("mail.asl").write_text("!a. !b. +!a <- act. +!b <- act.")
    lines = shown("n\nn\ni\n")
    assert lines[lines.index("event    +!a") + 5] == "waiting  +!b"
    assert "event    +!b" in lines


def test_commands_may_come_from_a_file_and_quit_ends(tmp_path: Path) -> None:
    (tmp_path / "commands").write_text("n\nq\nn\n")
    lines = shown("", "--commands", tmp_path / "commands")
    assert sum(line.startswith("cycle ") for line in lines) == 1


def test_json_gives_a_cycle_a_line() -> None:
    result = step("n 3\n", "--json")
    cycles = [json.loads(line) for line in result.stdout.splitlines()]
    assert [each["cycle"] for each in cycles] == [1, 2, 3]
    deliberated = next(entry for entry in cycles[0]["entries"] if entry["kind"] == "deliberated")
    assert [each["verdict"] for each in deliberated["options"]] == ["context", "head", "chosen"]
    assert cycles[0]["added"] == ["tried(post4)[source(self)]"]
    assert cycles[0]["intentions"][0]["plans"][0]["plan"] == "search"


def test_json_answers_every_command_in_json() -> None:
    lines = [json.loads(line) for line in step("n\np line(X)\np\ni\nfrob\n", "--json").stdout.splitlines()]
    assert lines[1:3] == [
        {"answers": [{"X": "lost"}]},
        {"beliefs": ["line(lost)[source(self)]", "tried(post4)[source(self)]"]},
    ]
    assert [stack["plans"][0]["plan"] for stack in lines[3]["intentions"]] == ["search"]
    assert lines[4] == {"message": "frob is no command; h shows them"}


def test_the_help_tells_how_a_program_names_a_breakpoint() -> None:
    assert "A plan @label[breakpoint] is a breakpoint" in CliRunner().invoke(app, ["step", "--help"]).stdout


def test_several_agents_are_told_apart() -> None:
    Path("bob.asl").write_text("+hello[source(A)] <- greet(A).")
    Path("mail.asl").write_text("!g. +!g <- .send(bob, tell, hello); a.")
    result = CliRunner().invoke(app, ["step", "mail.asl", "bob.asl"], input="n 3\na bob\np hello[source(X)]\na eve\n")
    lines = [line.rstrip() for line in result.stdout.splitlines()]
    assert any(line.startswith("cycle 2  bob ─") for line in lines)
    assert "action   greet(mail)" in lines
    assert "X=mail" in lines
    assert lines[-1] == "there is no agent eve; there are mail, bob"


def test_a_recording_is_stepped_through() -> None:
    assert CliRunner().invoke(app, ["run", "mail.asl", "--cycles", "6", "--save-trace", "run.jsonl"]).exit_code == 0
    Path("mail.asl").unlink()
    result = CliRunner().invoke(app, ["step", "--recording", "run.jsonl"], input="c\nback 5\n")
    assert "the run is over after 6 cycles" in result.stdout
    assert "✓ search" in result.stdout


def test_without_a_program_it_says_what_to_give() -> None:
    result = CliRunner().invoke(app, ["step"])
    assert result.exit_code == 2
    assert "--recording FILE" in result.stderr


@pytest.mark.parametrize("text", ["", "+!", "!g", "drive(", "a b", "=x"])
def test_what_is_no_breakpoint_is_refused_with_examples(text: str) -> None:
    with pytest.raises(AgentSpeakSyntaxError):
        breakpoint_of(text)


@pytest.mark.skipif(sys.platform == "win32", reason="there are no pseudo-terminals")
def test_in_a_terminal_it_prompts_and_colours() -> None:
    child, terminal = pty.fork()
    if child == 0:
        os.environ.update(TERM="xterm-256color", PYTHONPATH=str(ROOT), NO_COLOR="")
        os.execv(sys.executable, [sys.executable, "-m", "bdi", "step", "mail.asl"])  # noqa: S606
    text = ""
    for command, awaited in (("", ">"), ("\n", "doing"), ("p line(X)\n", "X=lost"), ("q\n", "")):
        os.write(terminal, command.encode())
        text += read_until(terminal, awaited)
    assert os.waitpid(child, 0)[1] == 0
    assert "\x1b[32m✓\x1b[0m" in text
    assert "\x1b[31m✗\x1b[0m" in text


def read_until(terminal: int, awaited: str) -> str:
    """Read until this text is there, or 20 seconds have passed."""
    text, end = "", time.monotonic() + 20
    while time.monotonic() < end and not (awaited and awaited in text):
        if select.select([terminal], [], [], 0.1)[0]:
            try:
                text += os.read(terminal, 65536).decode(errors="replace")
            except OSError:
                break
        elif not awaited:
            break
    return text
