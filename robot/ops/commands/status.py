"""`status`: what a running robot does, and why."""

import json
from typing import Any

import typer

from robot.core.json_socket import NoAnswer, ask
from robot.ops.commands.asking import OTHER_FOLDER, UNFINISHED, ConfigOption, DataOption, JsonOption, settings_of
from robot.ops.control import SOCKET_NAME


def status(config: ConfigOption = None, data: DataOption = None, as_json: JsonOption = False) -> None:
    """What the running robot does and why; battery, faults, mail aboard, link, base, punctuality of its loops.

    Exit status 1: no daemon answers, or it stands for a fault.
    """
    try:
        told = ask(settings_of(config, data).data / SOCKET_NAME, {"do": "status"})
    except NoAnswer as error:
        typer.echo(f"{error} {OTHER_FOLDER}", err=True)
        raise typer.Exit(UNFINISHED) from None
    print(json.dumps(told) if as_json else "\n".join(lines(told)))
    if told.get("faults"):
        raise typer.Exit(UNFINISHED)


def lines(told: dict[str, Any]) -> list[str]:
    """For a person."""
    battery, base, link = told["battery"], told["base"], told["link"]
    known = battery["ratio"] is not None
    charge = f"{battery['ratio']:.0%} ({battery['word']}), {battery['voltage_mv']} mV" if known else "not known"
    rows = [
        ("robot", f"{told['robot']}, {told['software']}, up {told['up_s']:.0f} s"),
        ("doing", f"{told['activity']}: {told['why'] or '–'}"),
        ("last post", _position(told["position"])),
        ("mission", _mission(told["mission"])),
        ("mail aboard", ", ".join(told["cargo"]) or "none"),
        ("battery", charge + (", charging" if battery["charging"] else "")),
        ("base", f"{base['mode']}, {'on the dock' if base['docked'] else 'off the dock'}, {_cable(base)}"),
        ("link", f"{link['state']} ({link['server']}){_because(link['problem'])}" if link else "none: it works alone"),
        *(("FAULT", f"{name}: {about}") for name, about in told["faults"].items()),
    ]
    table = [f"{'loop':16} {'ticks':>9} {'late p50':>10} {'p99':>9} {'worst':>9}"]
    table += [_loop(name, loop) for name, loop in told["loops"].items()]
    return [*(f"{name:12} {text}" for name, text in rows), "", *table]


def _position(position: dict[str, Any]) -> str:
    if position["post"] is None:
        return "not known"
    return f"{position['post']}, heading for {position['towards']}" if position["towards"] else position["post"]


def _mission(mission: dict[str, Any] | None) -> str:
    return f"{mission['id']}, next stop {mission['next_stop'] + 1}" if mission else "none"


def _cable(base: dict[str, Any]) -> str:
    age = f"last heard {base['age_s']:.2f} s ago" if base["age_s"] is not None else "never heard"
    return f"{age}, {base.get('reconnections', 0)} reconnections{_because(base.get('problem'))}"


def _because(problem: str | None) -> str:
    return f": {problem}" if problem else ""


def _loop(name: str, loop: dict[str, float]) -> str:
    late = (f"{loop[key]:.1f} ms" for key in ("late_p50_ms", "late_p99_ms", "late_worst_ms"))
    p50, p99, worst = late
    return f"{name:16} {loop['ticks']:>9} {p50:>10} {p99:>9} {worst:>9}"
