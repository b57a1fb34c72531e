"""The reference pages that follow from the robot's code: settings, percepts and actions, scenarios, faults."""

from collections.abc import Iterable
from dataclasses import fields
from typing import Final

from robot.agent.actions.table import ACTIONS, PAPER_ACTIONS, Action
from robot.agent.perception.percepts import PERCEPTS
from robot.core.settings_file import rows
from robot.scenarios.loading import keys
from robot.simulated.faults import SWITCHES, Faults

POSITIONS: Final = {"bool": "true, false", "int": "whole number", "float": "number"}


def robot_settings() -> str:
    """Return every setting of a robot, with its default and its range."""
    text = "\n## A robot\n\nKeys of its settings file (TOML). `python -m robot settings` prints a complete file.\n\n"
    text += "| key | default | meaning |\n|---|---|---|\n"
    for row in rows():
        default = "" if row.default is None else "`" + row.default.strip('"') + "`"
        text += f"| `{row.key}` | {default} | {row.about}{f' ({row.range})' if row.range else ''} |\n"
    return text


def percepts_and_actions() -> str:
    """Return what an agent program can perceive and do."""
    text = "# Percepts and actions of the robot\n\nThis page is generated from the code.\n\n## Percepts\n\n"
    text += "| percept | meaning | mode |\n|---|---|---|\n"
    text += "".join(_row(f"`{one.name}`", one.about, "both" if one.drained else "latest") for one in PERCEPTS)
    text += "\n## Actions\n\n" + _actions(ACTIONS)
    return text + "\n## The paper's actions\n\nFor its program and others like it.\n\n" + _actions(PAPER_ACTIONS)


def _actions(actions: Iterable[Action]) -> str:
    text = "| action | meaning |\n|---|---|\n"
    for one in actions:
        form = f"{one.name}({', '.join(map(str, one.takes))})" if one.takes else one.name
        text += _row(f"`{form}`", one.about)
    return text


def scenario_keys() -> str:
    """Return every key of a scenario file."""
    text = "# Keys of a scenario file\n\nThis page is generated from the code. Times are seconds since the start, "
    text += "lengths metres in the map's frame. With `after_post`, `at_s` counts from when the robot first stands "
    text += "at that post.\n"
    part = None
    for key, about in keys().items():
        if key.rpartition(".")[0] != part:
            part = key.rpartition(".")[0]
            text += f"\n## {f'`{part}`' if part else 'The file itself'}\n\n| key | meaning |\n|---|---|\n"
        text += _row(f"`{key}`", about)
    return text


def simulated_faults() -> str:
    """Return every fault that the simulated world can be given."""
    text = "# Faults of the simulated world\n\nThis page is generated from the code. Shares and chances are 0 to 1.\n\n"
    text += "| switch | value | what it does |\n|---|---|---|\n"
    kinds = {field.name: POSITIONS[getattr(field.type, "__name__", str(field.type))] for field in fields(Faults)}
    return text + "".join(_row(f"`{name}`", kinds[name], about) for name, about in SWITCHES.items())


def _row(*cells: str) -> str:
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |\n"
