"""python -m bdi check"""

import json
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.markup import escape

from bdi.language.errors import AgentSpeakError
from bdi.reasoning.agent import Agent
from bdi.tools.checks import Finding, Severity, findings_of
from bdi.tools.console import DIFFERENT, complaints, load, output
from bdi.tools.options import AsJson, Compatible, Programs

STYLES = {Severity.ERROR: "bold red", Severity.WARNING: "yellow", Severity.HINT: "cyan"}


def check(
    programs: Programs,
    *,
    percepts_declared: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME", help="What the body perceives: name or name/arity; may be repeated, or a,b,c."),
    ] = None,
    strict: Annotated[bool, typer.Option("--strict", help="Warnings count as errors.")] = False,
    hints: Annotated[bool, typer.Option("--hints/--no-hints", help="Show what may be meant so.")] = True,
    compatible: Compatible = False,
    as_json: AsJson = False,
) -> None:
    """Find what is wrong with programs without running them.

    [bold]What is found[/bold]

    \b
      goal-without-plan       !g, and no plan +!g that could take it
      no-default-plan         all plans for a goal ask for something
      open-failure            all plans -!g do: other failures end it all
      shadowed-plan           a plan after one that always comes first
      uncalled-plan           a plan for a goal that nothing posts
      look-alike              goTo and go_to
      forgotten-mark          go(X) where there are plans for !go(X)
      unknown-belief          asked for, and nothing brings it about
      variable-without-value  an action with a variable that is new
      lone-variable           stands once: a typing mistake, or _
      endless-rule            a rule that asks itself first
      same-label, unreached-step

    [bold]error[/bold]: fails whenever it is reached; [bold]warning[/bold]: most likely a mistake;
    [bold]hint[/bold]: worth a look. Beliefs that nothing brings about may be percepts:
    say which there are, and the others are named.

    [bold]Examples[/bold]

    \b
      python -m bdi check mail.asl
      python -m bdi check mail.asl --percepts-declared line,battery,at/1
      python -m bdi check examples/agents/*.asl --strict --no-hints --json

    Exit status: 0 no errors, 1 errors (with --strict also warnings), 2 not
    readable.
    """
    declared = None if percepts_declared is None else [n for text in percepts_declared for n in text.split(",")]
    with complaints():
        found = [(path, _found(path, declared, compatible)) for path in programs]
    worst = Severity.WARNING if strict else Severity.ERROR
    failed = any(finding.severity <= worst for _, findings in found for finding in findings)
    if not hints:
        found = [(path, [each for each in all_ if each.severity is not Severity.HINT]) for path, all_ in found]
    if as_json:
        data = [{"program": str(path), "findings": [each.data() for each in findings]} for path, findings in found]
        typer.echo(json.dumps({"programs": data}, indent=2))
    else:
        _show(output(), [finding for _, findings in found for finding in findings], len(programs))
    if failed:
        raise typer.Exit(DIFFERENT)


def _found(path: Path, declared: list[str] | None, compatible: bool) -> list[Finding]:
    program = load(path, compatible)
    found = findings_of(program, declared)
    try:
        Agent(program)
    except AgentSpeakError as error:
        advice = "docs/reference/agentspeak.md lists what there is"
        found.insert(0, Finding("refused", Severity.ERROR, error.place, error.problem, advice))
    return found


def _show(console: Console, findings: list[Finding], programs: int) -> None:
    for finding in findings:
        style = STYLES[finding.severity]
        console.print(
            f"{escape(str(finding.place))} [{style}]{finding.severity}[/{style}] {escape(finding.problem)} "
            f"[dim]\\[{finding.code}][/dim]"
        )
        picture = finding.place.picture()
        if picture:
            line, caret = picture.strip("\n").split("\n")
            console.print(f"[dim]{escape(line)}[/dim]\n[{style}]{caret}[/{style}]")
        console.print(f"    {escape(finding.advice)}\n")
    counts = [(sum(each.severity is severity for each in findings), str(severity)) for severity in Severity]
    counted = ", ".join(f"{count} {name}{'' if count == 1 else 's'}" for count, name in counts if count)
    where = f"{programs} programs: " if programs > 1 else ""
    console.print(where + (counted or "nothing found"))
