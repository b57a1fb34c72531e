"""`doctor`: what is wrong with this robot, and the way out."""

import json
import tempfile
from collections.abc import Iterator
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from typing import Annotated, Any

import typer

from robot.core.config import ConfigError, Settings, load_settings
from robot.core.json_socket import NoAnswer, ask
from robot.ops.commands.asking import UNFINISHED, ConfigOption, JsonOption, refuse, settings_path, simulated_bench
from robot.ops.control import SOCKET_NAME
from robot.ops.doctor.findings import Finding, Grade, Subjects
from robot.ops.doctor.table import examine
from robot.ops.equipment import Equipment, living_equipment, real_equipment

PUSH_S = 20.0


def doctor(
    config: ConfigOption = None,
    simulated: Annotated[bool, typer.Option("--simulated", help="A simulated robot at its first post.")] = False,
    push: Annotated[bool, typer.Option("--push", help="Push it over the tape: does each diode see it?")] = False,
    root: Annotated[Path, typer.Option(help="Where /proc, /sys, /boot and /etc are.", hidden=True)] = Path("/"),
    as_json: JsonOption = False,
) -> None:
    """Check computer, cable, base, line sensor, camera and service, and name what is wrong with the way out.

    The wheels do not turn. While the daemon runs, it is asked about the base, and pins and camera are left to it.

    Exit status 1: something keeps this robot from driving.
    """
    with tempfile.TemporaryDirectory(prefix="campus-mail-doctor-") as folder:
        try:
            asked = {"data": Path(folder)} if simulated else {}
            settings = load_settings(settings_path(config), asked)
        except ConfigError as problem:
            refuse(str(problem))
        with _equipment(settings, simulated) as equipment:
            if equipment.robot:
                settings = settings.model_copy(update={"serial_port": equipment.robot.port_path})
            daemon = None if simulated else _daemon(settings)
            patient = Subjects(
                settings, settings_path(config), equipment, root, daemon, PUSH_S if push else 0.0, tell=_tell
            )
            found = list(_told(patient, as_json))
    if as_json:
        print(json.dumps({"ok": _fit(found), "checks": [_row(name, finding) for name, finding in found]}))
    raise typer.Exit(0 if _fit(found) else UNFINISHED)


def _fit(found: list[tuple[str, Finding]]) -> bool:
    return all(finding.grade is not Grade.FAIL for _, finding in found)


def _told(patient: Subjects, as_json: bool) -> Iterator[tuple[str, Finding]]:
    for name, finding in examine(patient):
        if not as_json:
            print(f"{finding.grade:5} {name:9} {finding.said}", flush=True)
            if finding.way_out:
                print(f"{'':16}→ {finding.way_out}", flush=True)
        yield name, finding


def _row(name: str, finding: Finding) -> dict[str, str]:
    return {"check": name, "grade": finding.grade.lower(), "said": finding.said, "way_out": finding.way_out}


def _tell(sentence: str) -> None:
    typer.echo(sentence, err=True)


def _daemon(settings: Settings) -> dict[str, Any] | None:
    try:
        return ask(settings.data / SOCKET_NAME, {"do": "status"})
    except NoAnswer:
        return None


def _equipment(settings: Settings, simulated: bool) -> AbstractContextManager[Equipment]:
    return simulated_bench(living_equipment(settings)) if simulated else nullcontext(real_equipment(settings))
