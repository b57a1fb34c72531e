"""Runs on file, and the same runs again: python -m bdi run --save-trace, replay, and Recorder."""

import io
import json
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner, Result

from bdi import Agent, BdiError, Finished, Message, load_program, parse_program, parse_term
from bdi.__main__ import app
from bdi.tools.recording.recorder import RecordedTooLate, Recorder
from bdi.tools.recording.replaying import NotARecording, read_recording

ROOT = Path(__file__).parents[3]
GAMBLER = """!go. { include("more.asl") }
+!go : .random(X) & X > 0.4 <- .print(X); .random(Y); bet(Y); !go.
+!go <- .wait(250); !lose; !go.
+told(X)[source(W)] <- .send(W, tell, heard(X)).
"""


def invoke(*arguments: object) -> Result:
    return CliRunner().invoke(app, [*map(str, arguments)])


@pytest.fixture
def recording(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A run of 40 cycles with chance, time, messages, failures and an included file."""
    monkeypatch.chdir(tmp_path)
    Path("gambler.asl").write_text(GAMBLER)
    Path("more.asl").write_text("+!lose <- .fail(bad_luck).\n-!lose <- cry.\n+line(2) <- !vain.\n")
    lines = ["line(1) line(2)"] * 10 + ['{"percepts": null, "messages": [["tell", "told(7)", "bob"]]}', "line(2)", ""]
    Path("in.txt").write_text("\n".join(lines) + "\n")
    result = invoke(
        "run", "gambler.asl", "--percepts", "in.txt", "--cycles", 40, "--seed", 5, "--save-trace", "run.jsonl"
    )
    assert result.exit_code == 0, result.output
    assert "bet(" in result.stdout
    return Path("run.jsonl")


def lines_of(path: Path) -> list[dict[str, Any]]:
    return [json.loads(line) for line in path.read_text().splitlines()]


def test_a_recording_needs_no_other_file_and_comes_out_the_same(recording: Path) -> None:
    Path("gambler.asl").unlink()
    Path("more.asl").unlink()
    result = invoke("replay", recording)
    assert result.exit_code == 0, result.output
    assert result.stdout == "same     gambler (gambler.asl)  40 cycles\n"


def test_the_recording_holds_what_came_in_and_what_came_out(recording: Path) -> None:
    head, first, *lines = lines_of(recording)
    assert (head["agent"], head["program"], sorted(head["sources"])) == (
        "gambler",
        "gambler.asl",
        ["gambler.asl", "more.asl"],
    )
    assert first["percepts"] == ["line(1)", "line(2)"]
    assert "percepts" not in lines[0]
    told = next(line for line in lines if "messages" in line)
    assert told["messages"][0]["content"] == "told(7)"
    assert any(line.get("failures") for line in lines)
    assert lines[-1] == {"agent": "gambler", "end": 40}


@pytest.mark.parametrize("what", ["actions", "printed", "messages_out", "failures", "events", "intentions"])
def test_the_first_difference_is_named(recording: Path, what: str) -> None:
    head, *cycles, end = lines_of(recording)
    cycle = next(line for line in cycles if line.get(what))
    cycle[what] = cycle[what] + 1 if isinstance(cycle[what], int) else [*cycle[what], cycle[what][0]]
    recording.write_text("".join(json.dumps(line) + "\n" for line in [head, *cycles, end]))
    result = invoke("replay", recording)
    assert result.exit_code == 1
    assert f"in cycle {cycle['cycle']}: {what}" in result.stdout
    data = json.loads(invoke("replay", recording, "--json").stdout)["runs"][0]["difference"]
    assert (data["cycle"], data["what"], data["recorded"]) == (cycle["cycle"], what, cycle[what])
    assert data["replayed"] != data["recorded"]


def test_a_recording_that_breaks_off_is_replayed_as_far_as_it_goes(recording: Path) -> None:
    text = recording.read_text()
    recording.write_text(text[: text.index('"cycle": 20') + 15])
    result = invoke("replay", recording)
    assert result.exit_code == 0
    assert "19 cycles" in result.stdout
    assert "breaks off in line 21; replayed as far as it goes" in result.stderr
    recording.write_text("\n".join(text.splitlines()[:11]) + "\n")
    result = invoke("replay", recording)
    assert "10 cycles" in result.stdout
    assert "the end of gambler is missing" in result.stderr


def test_a_changed_program_is_replayed_as_it_was_and_can_be_tried_on_the_same_inputs(recording: Path) -> None:
    Path("more.asl").write_text("+!lose <- laugh.\n+line(2) <- !vain.\n")
    same = invoke("replay", recording)
    assert same.exit_code == 0
    assert "gambler.asl has changed since; replayed as it was" in same.stderr
    changed = invoke("replay", recording, "--program", "gambler.asl")
    assert changed.exit_code == 1
    assert "laugh" in changed.stdout


@pytest.mark.parametrize(
    "text", ["", "hello\n", "{}\n", '{"recording": 99, "agent": "a"}\n', "[1]\n", '{"cycle": 1}\n']
)
def test_what_is_no_recording_is_refused(tmp_path: Path, text: str) -> None:
    (tmp_path / "x.jsonl").write_text(text)
    result = invoke("replay", tmp_path / "x.jsonl")
    assert (result.exit_code, result.stdout) == (2, "")
    assert "x.jsonl" in result.stderr
    assert "Traceback" not in result.stderr


def test_a_recording_that_breaks_off_at_once_says_so(recording: Path) -> None:
    recording.write_text(recording.read_text()[:200])
    assert "mail.jsonl:1: this is no line of a recording: it is no JSON, or breaks off" in invoke(
        "replay", recording
    ).stderr.replace(str(recording), "mail.jsonl")


def test_a_program_that_was_changed_within_the_recording_is_refused(recording: Path) -> None:
    recording.write_text(recording.read_text().replace("bad_luck", "good_luck", 1))
    with pytest.raises(NotARecording, match="its program was changed"):
        read_recording(recording)


def test_agents_that_write_to_each_other_are_recorded_in_one_file(tmp_path: Path) -> None:
    (tmp_path / "a.asl").write_text("!go. +!go <- .send(b, askOne, price(_), price(P)); buy(P); done.")
    (tmp_path / "b.asl").write_text("price(42). +?price(0) <- never.")
    path = tmp_path / "run.jsonl"
    assert "buy(42)" in invoke("run", tmp_path / "a.asl", tmp_path / "b.asl", "--save-trace", path).stdout
    result = invoke("replay", path, "--show")
    assert result.exit_code == 0, result.output
    assert "a buy(42)" in result.stdout
    assert result.stdout.count("same ") == 2


def replayed(folder: Path, **programs: str) -> Result:
    """The recording of agents that run together, replayed each for itself."""
    for name, text in programs.items():
        (folder / f"{name}.asl").write_text(text)
    paths = [folder / f"{name}.asl" for name in programs]
    invoke("run", *paths, "--save-trace", folder / "run.jsonl", "--cycles", "40")
    return invoke("replay", folder / "run.jsonl", "--show")


def test_what_an_agent_learns_of_those_around_it_is_recorded(tmp_path: Path) -> None:
    a = """!go. +!go <- .all_names(L); names(L); .wait(300); .df_search(paint,F); found(F); .kill_agent(b);
           .all_names(M); names(M); .send(c,tell,x); .send(nobody,tell,x).
           -!go[error(E),receiver(R)] <- failed(E,R); !strange. +!strange <- .send(c,mumble,x). -!strange <- sorry."""
    result = replayed(tmp_path, a=a, b="!d. +!d <- .df_register(paint).", c="+x <- got.")
    assert result.exit_code == 0, result.output
    acts = [line.partition(" a ")[2] for line in result.stdout.splitlines() if line[0].isdigit() and " a " in line]
    assert acts == ["names([a,b,c])", "found([b])", "names([a,c])", "failed(unknown_receiver,nobody)", "sorry"]


def test_agents_that_are_created_while_others_run_are_recorded_with_what_they_are_given(tmp_path: Path) -> None:
    (tmp_path / "new.asl").write_text("+!start(X) : b(Y)[source(S)] <- act(X,Y).")
    program = '!go. +!go <- .create_agent(n, "new.asl", [beliefs([b(1),b(2)]), goals([start(7)])], R); made(R).'
    result = replayed(tmp_path, a=program)
    assert result.exit_code == 0, result.output
    assert "n act(7,1)" in result.stdout
    assert result.stdout.count("same ") == 2


def test_the_run_of_a_clone_is_refused_by_name(tmp_path: Path) -> None:
    result = replayed(tmp_path, a="b(1). !go. +!go <- .clone(twin).")
    assert result.exit_code == 2
    assert "the run of twin cannot be replayed: a recording does not hold what a clone has" in result.stderr


def recorded(text: str, **options: Any) -> tuple[Recorder, io.StringIO]:
    program, file = parse_program(text, source="text.asl"), io.StringIO()
    return Recorder(Agent(program, **options), file, program, texts={"text.asl": text}, entries=True), file


def test_any_agent_can_be_recorded_whatever_it_is_given(tmp_path: Path) -> None:
    """Percepts and contents as terms or text, reasons of failures, unknown seeds, entries of the trace."""
    recorder, file = recorded(
        "+!g(X) <- .random(R); act(X, R). -!g(X)[reason(Y)] <- sorry(X, Y). +p(X) : X > 1 <- seen(X).",
        actions=["act", "sorry", "seen"],
    )
    recorder.cycle([parse_term('p(2,"x y")'), parse_term("p(2)")], [Message("u", "achieve", parse_term("g([1,a])"))])
    recorder.cycle(["p( 3 )"], [Message("u", "achieve", 'g("text")')], now=0.2)
    with pytest.raises(BdiError):
        recorder.cycle(["p(("])
    for _ in range(3):
        recorder.cycle(now=0.2)
    recorder.cycle(None, [], [Finished(1, parse_term("bumped(left)"), "hit"), Finished(2)], 0.3)
    for now in range(4, 12):
        recorder.cycle(None, now=now / 10)
    recorder.close()
    path = tmp_path / "run.jsonl"
    path.write_text(file.getvalue())
    recording = read_recording(path)
    assert recording.cut_off == ""
    assert len(recording.runs[0].lines) == 14
    assert any("trace" in line for line in recording.runs[0].lines)
    assert recording.runs[0].replay() is None


def test_recording_changes_nothing() -> None:
    text = "!g. +!g <- .random(X); act(X); !g."
    agent, (recorder, _) = Agent(parse_program(text), random_seed=1), recorded(text, random_seed=1)
    for number in range(20):
        finished = [Finished(number)] if number and number % 3 == 0 else []
        known = [news for news in finished if news.id <= agent.last_action]
        assert [str(a) for a in agent.cycle((), [], known).actions] == [
            str(a) for a in recorder.cycle((), [], known).actions
        ]


def test_an_agent_that_has_already_run_cannot_be_recorded() -> None:
    program = parse_program("!g.")
    agent = Agent(program)
    agent.cycle()
    with pytest.raises(RecordedTooLate):
        Recorder(agent, io.StringIO(), program, texts={})


def test_the_program_of_the_robot_is_recorded_with_all_its_files(tmp_path: Path) -> None:
    source = ROOT / "robot" / "agent" / "main.asl"
    program = load_program(source)
    file = io.StringIO()
    recorder = Recorder(Agent(program, name="r1"), file, program)
    for number in range(30):
        recorder.cycle(["at(post1)", "battery(low)"] if number < 15 else ["docked"], now=number / 10)
    recorder.close()
    path = tmp_path / "r1.jsonl"
    path.write_text(file.getvalue())
    (run,) = read_recording(path).runs
    assert len(run.head["sources"]) == 5
    assert run.replay() is None
