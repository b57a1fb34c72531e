"""The reference pages that follow from the code. Each is one function, in the table at the end."""

import inspect
from collections.abc import Callable, Mapping
from html import unescape
from pathlib import Path
from typing import Any, Final

import typer
from pydantic import BaseModel
from pydantic.fields import FieldInfo
from typer.cli import get_docs_for_click

# What the pages are made of: the only names of ours that a renamed module changes.
import app.__main__ as service
import bdi.__main__ as agentspeak
import demo.__main__ as demo
import maps.__main__ as maps
import robot.__main__ as robot
from app.core.settings import Settings as ServiceSettings
from bdi.builtin import STANDARD
from bdi.builtin.table import Definition
from docs.site.api_page import api
from docs.site.robot_pages import percepts_and_actions, robot_settings, scenario_keys, simulated_faults
from docs.site.staging import CHECKOUT
from protocol.__main__ import messages_as_markdown

COMMANDS: Final[Mapping[str, typer.Typer]] = {
    "app": service.app,
    "robot": robot.cli,
    "demo": demo.app,
    "bdi": agentspeak.app,
    "maps": maps.cli,
}


def pages() -> dict[str, str]:
    """The text of each generated page, by its file name."""
    return {name: make() for name, make in PAGES.items()}


def settings() -> str:
    """Return every setting of the service and of a robot, with its default."""
    text = "# Settings\n\nThis page is generated from the code. Secrets can be files: see the how-to guides.\n\n"
    text += "## The service\n\nEnvironment variables.\n\n| variable | default | meaning |\n|---|---|---|\n"
    for name, field in ServiceSettings.model_fields.items():
        text += _row(f"CAMPUS_MAIL_{name.upper()}", field)
    return text + robot_settings()


def _row(name: str, field: FieldInfo) -> str:
    value = field.get_default(call_default_factory=True)
    shown = "" if value is None or value == () else _as_text(value)
    default = f"`{shown}`" if shown else ""
    return f"| `{name}` | {default} | {_cell(field.description or '')} |\n"


def _as_text(value: Any) -> str:
    if isinstance(value, Path) and value.is_relative_to(CHECKOUT):
        return str(value.relative_to(CHECKOUT))
    if isinstance(value, tuple):
        return ", ".join(_as_text(one) for one in value)
    if isinstance(value, BaseModel):
        return " ".join(f"{key}={one}" for key, one in value)
    return str(getattr(value, "value", value))


def _cell(text: str) -> str:
    return " ".join(text.split()).replace("|", "\\|").replace("<", "&lt;")


def messages() -> str:
    """Return every message between service and robot, with its examples."""
    return "# Protocol messages\n\nThis page is generated from the code.\n\n" + messages_as_markdown()


def internal_actions() -> str:
    """Return every internal action and function of AgentSpeak as it runs here."""
    text = "# Internal actions and functions\n\nThis page is generated from the code.\n\n"
    for title, table in (("Internal actions", STANDARD.actions), ("Functions", STANDARD.functions)):
        text += f"## {title}\n\n| name | arguments | meaning |\n|---|---|---|\n"
        text += "".join(_defined(table[name]) for name in sorted(table)) + "\n"
    return text


def _defined(definition: Definition) -> str:
    arguments = ", ".join(
        f"{kind.name}{' …' if kind.rest else ' (optional)' if kind.optional else ''}" for kind in definition.takes
    )
    return f"| `{definition.name}` | {arguments} | {_cell(inspect.getdoc(definition.call) or '')} |\n"


def commands() -> str:
    """Return the help of every command, by the names that people type."""
    text = "# Commands\n\nThis page is generated from the commands' own help. Run them with `.venv/bin/python`.\n\n"
    for package, cli in COMMANDS.items():
        name = f"python -m {package}"
        command = typer.main.get_command(cli)
        context = typer.Context(command, info_name=name)
        text += _deeper(unescape(get_docs_for_click(obj=command, ctx=context, name=name))) + "\n"
    return text


def _deeper(text: str) -> str:
    """The same text one level of headings deeper, outside code blocks."""
    lines, code = [], False
    for line in text.splitlines():
        code ^= line.startswith("```")
        lines.append(
            f"#{line}" if line.startswith("#") and not code else line.replace("<", "&lt;") if not code else line
        )
    return "\n".join(lines)


PAGES: Final[Mapping[str, Callable[[], str]]] = {
    "api-operations.md": api,
    "settings.md": settings,
    "messages.md": messages,
    "internal-actions.md": internal_actions,
    "commands.md": commands,
    "percepts-and-actions.md": percepts_and_actions,
    "scenario-keys.md": scenario_keys,
    "simulated-faults.md": simulated_faults,
}
