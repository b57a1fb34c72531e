"""python -m bdi test"""

import json
from collections.abc import Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer
from rich.markup import escape

from bdi.tools.console import DIFFERENT, aside, complain, complaints, output
from bdi.tools.options import AsJson, Compatible, Cycles, Fail, Outside, Percepts, Programs, Seed
from bdi.tools.percept_file import read_percepts
from bdi.tools.simulation import Setting, setting_of
from bdi.tools.trials.differences import Difference
from bdi.tools.trials.expectations import Expectation, Line, expectation_of, read_expectation
from bdi.tools.trials.runs import Result, Trial, long_enough, run_trial
from bdi.tools.trials.scripts import Script, script_in

STYLES = {" ": "dim", "-": "red", "+": "green", "?": "yellow"}
AROUND = 2  # lines as expected that are shown before and after a difference
NO_EXPECTATION = """{path} says nowhere what is expected. Give --expect FILE (and --update to write it), or end the \
program with a comment:

    /* prints
    3 drive(post1)
    */"""


def test(
    programs: Programs,
    *,
    percepts: Percepts = None,
    expect: Annotated[Path | None, typer.Option(help="What is expected: lines of CYCLE ACTION.")] = None,
    update: Annotated[bool, typer.Option("--update", help="Write what happens as what is expected.")] = False,
    cycles: Cycles = None,
    fail: Fail = None,
    seed: Seed = 0,
    outside: Outside = None,
    compatible: Compatible = False,
    as_json: AsJson = False,
) -> None:
    """Run programs and compare what they do with what is expected.

    With --expect the programs run together, as one test. Without, each
    program is a test of its own, with its closing comment as the script.

    [bold]What can be expected[/bold]

    \b
      3 drive(post1)          this action in cycle 3; _ stands for anything
      5 believes at(post1)    this is believed after cycle 5
      5 not at(_)             this is not
      7 says hello            what .print says
      # words                 a comment

    Lines without numbers say only in which order.

    [bold]The closing comment of a program[/bold]: each part may be left out but the last

    \b
      /* percepts                one line a cycle, as in a percept file
      at(post1)
      messages                  CYCLE PERFORMATIVE CONTENT
      2 achieve go(post4)
      fails drive               actions of this name fail
      prints                    what is expected
      2 drive(post4)
      */

    [bold]Examples[/bold]

    \b
      python -m bdi test mail.asl --percepts walk.txt --expect walk.exp --update
      python -m bdi test mail.asl --percepts walk.txt --expect walk.exp
      python -m bdi test examples/agents/*.asl

    Exit status: 0 as expected, 1 something differs, 2 not usable.
    """
    with complaints():
        stimuli = read_percepts(percepts) if percepts else ()
        given = setting_of((), stimuli, fail=fail, cycles=cycles, seed=seed, compatible=compatible, outside=outside)
        results = []
        for trial in _trials(programs, given, expect, update):
            longest = cycles or long_enough(trial.expectation, trial.setting.stimuli)
            result = run_trial(replace(trial, setting=replace(trial.setting, cycles=longest)))
            results.append(_updated(result, expect) if update and not result.as_expected else result)
    if as_json:
        typer.echo(json.dumps({"programs": [result.data() for result in results]}, indent=2))
    else:
        _show(results)
    if not all(result.as_expected for result in results):
        raise typer.Exit(DIFFERENT)


def _trials(programs: list[Path], given: Setting, expect: Path | None, update: bool) -> Iterable[Trial]:
    if expect is not None:
        missing = update and not expect.exists()
        expectation = Expectation((), True) if missing else read_expectation(expect)
        yield Trial(replace(given, programs=tuple(programs)), expectation)
        return
    for path in programs:
        script = _script(path)
        setting = replace(
            given,
            programs=(path,),
            stimuli=given.stimuli or script.stimuli,
            failing=given.failing | frozenset(script.failing),
        )
        yield Trial(setting, script.expectation)


def _script(path: Path) -> Script:
    script = script_in(path.read_text(encoding="utf-8"), str(path))
    if script is None:
        raise complain(NO_EXPECTATION.format(path=path))
    return script


# ---- writing what is expected --------------------------------------------------------------------------------------


def _updated(result: Result, expect: Path | None) -> Result:
    """Beliefs and comments stay as they are written, but for beliefs that turned out wrong."""
    by_cycle = result.trial.expectation.by_cycle
    happened = [str(line if by_cycle else replace(line, cycle=None)) for line in result.lines]
    if expect is not None:
        _write_file(expect, result.trial.expectation, happened)
        where = expect
    else:
        where = result.trial.setting.programs[0]
        _write_comment(where, happened)
    aside(f"{where}: written, {_count(len(happened), 'line')}")
    return replace(result, differences=tuple(Difference(" ", line) for line in result.lines))


def _write_file(path: Path, before: Expectation, happened: Sequence[str]) -> None:
    beliefs = [str(line) for line in before.beliefs]
    comments = [line for line in path.read_text("utf-8").splitlines() if _says_nothing(line)] if path.exists() else []
    path.write_text("\n".join([*comments, *happened, *beliefs]) + "\n", encoding="utf-8")


def _says_nothing(line: str) -> bool:
    return bool(line.strip()) and not expectation_of([line], "").lines


def _write_comment(path: Path, happened: Sequence[str]) -> None:
    text = path.read_text(encoding="utf-8")
    script = _script(path)
    lines = text.split("\n")
    start = script.first_line - 1
    lines[start : start + script.lines] = [*happened, *map(str, script.expectation.beliefs)]
    path.write_text("\n".join(lines), encoding="utf-8")


# ---- showing -------------------------------------------------------------------------------------------------------


def _show(results: Sequence[Result]) -> None:
    console = output()
    width = max(len(result.trial.name) for result in results)
    for result in results:
        mark = "[green]ok     [/green]" if result.as_expected else "[bold red]DIFFERS[/bold red]"
        happened = f"{_count(len(result.lines), 'line')}, {_count(result.cycles, 'cycle')}"
        console.print(f"{mark} {escape(result.trial.name.ljust(width))}  [dim]{happened}[/dim]")
        if not result.as_expected:
            for line in _diff(result.differences):
                console.print(line)
    different = sum(not result.as_expected for result in results)
    if len(results) > 1:
        console.print(f"{different} of {len(results)} programs differ" if different else f"{len(results)} programs ok")
    if different:
        console.print("[dim]- expected, + happened, ? belief; --update takes what happens as expected[/dim]")


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}{'' if number == 1 else 's'}"


def _diff(differences: Sequence[Difference]) -> Iterable[str]:
    """The differing lines with a few around them."""
    near = {
        place + offset
        for place, each in enumerate(differences)
        if each.mark != " "
        for offset in range(-AROUND, AROUND + 1)
    }
    gap = False
    for place, each in enumerate(differences):
        if place not in near:
            gap = True
            continue
        if gap:
            yield "      [dim]⋮[/dim]"
        gap = False
        style = STYLES[each.mark]
        yield f"    [{style}]{each.mark} {escape(_aligned(each.line))}[/{style}]{_note(each)}"


def _note(difference: Difference) -> str:
    return f"  [dim]({escape(difference.note)})[/dim]" if difference.note else ""


def _aligned(line: Line) -> str:
    number = "" if line.cycle is None else f"{line.cycle:>4} "
    return number + str(replace(line, cycle=None))
