"""The settings file as text: complete with every key and its default, or changed in place without losing a comment."""

import os
import tempfile
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import Any, get_args

import tomlkit
from annotated_types import Ge, Gt, Le, Lt
from pydantic.fields import FieldInfo
from tomlkit.exceptions import TOMLKitError

from robot.core.config import ConfigError, Section, Settings, load_settings
from robot.core.durable_file import replace

HEADER = """\
# Every setting of a robot with its default: what is commented out has no default.
# python -m robot settings --check FILE says whether a file is right.
"""
_BOUNDS = ((Ge, "ge", "from {}"), (Gt, "gt", "above {}"), (Le, "le", "to {}"), (Lt, "lt", "below {}"))


@dataclass(frozen=True)
class SettingRow:
    """One setting as the manual and the complete file show it. `default` is TOML, None where there is none."""

    key: str
    default: str | None
    range: str
    about: str


def rows(section: type[Section] = Settings, prefix: str = "") -> Iterator[SettingRow]:
    """Every setting in the order of the file."""
    for name, field in section.model_fields.items():
        inner = _section(field)
        if inner:
            yield from rows(inner, f"{prefix}{name}.")
        else:
            yield SettingRow(prefix + name, _toml(field.default), _range(field), field.description or "")


def _section(field: FieldInfo) -> type[Section] | None:
    kind = field.annotation
    return kind if isinstance(kind, type) and issubclass(kind, Section) else None


def _toml(value: object) -> str | None:
    if value is None:
        return None
    text = str(value) if isinstance(value, Path | StrEnum) else value
    return tomlkit.item(text).as_string()


def _range(field: FieldInfo) -> str:
    limits = [*field.metadata, *(limit for part in get_args(field.annotation) for limit in _metadata(part))]
    said = [
        sentence.format(f"{getattr(limit, name):g}")
        for kind, name, sentence in _BOUNDS
        for limit in limits
        if isinstance(limit, kind)
    ]
    return " ".join(said)


def _metadata(annotation: object) -> Iterable[object]:
    return getattr(annotation, "__metadata__", ())


def complete_toml() -> str:
    """Every key with its meaning, range and default, in a form that `load_settings` takes as it is."""
    lines, section = [HEADER], ""
    for row in rows():
        *path, name = row.key.split(".")
        if (here := ".".join(path)) != section:
            section = here
            lines.append(f"[{section}]")
        lines.append(f"# {row.about}{f' ({row.range})' if row.range else ''}")
        lines.append(f"{name} = {row.default}" if row.default is not None else f"# {name} =")
        lines.append("")
    return "\n".join(lines)


def changed(text: str, values: Mapping[str, Any]) -> str:
    """The text of a settings file with these dotted keys set; everything else, comments too, stays as it was."""
    document = tomlkit.parse(text)
    for dotted, value in values.items():
        *sections, key = dotted.split(".")
        table: Any = document
        for section in sections:
            table = table.setdefault(section, tomlkit.table())
        table[key] = value
    return tomlkit.dumps(document)


def write_settings(path: Path, values: Mapping[str, Any]) -> None:
    """Set these keys in the file, or begin one. All of it is checked first; a power cut leaves the old or the new file.

    Raises ConfigError: the result would not be accepted, or the file cannot be written.
    """
    try:
        text = changed(path.read_text("utf-8") if path.exists() else "", values)
        temporary = _write_beside(path, text)
    except TOMLKitError as error:
        raise ConfigError(str(path), "file", f"is not TOML: {error}") from None
    except OSError as error:
        way_out = "Run the command as the owner of the file (sudo)."
        raise ConfigError(str(path), "file", f"cannot be written: {error.strerror}", way_out) from None
    try:
        load_settings(temporary, {})
    except ConfigError as error:
        temporary.unlink()
        raise ConfigError(str(path), error.key, error.message, error.way_out) from None
    replace(temporary, path)


def _write_beside(path: Path, text: str) -> Path:
    """On the disk before it gets its name, with the mode and, if we may, the owner of the file that it will replace."""
    handle, name = tempfile.mkstemp(prefix=f".{path.name}.", dir=path.parent)
    with os.fdopen(handle, "w", encoding="utf-8") as file:
        file.write(text)
        file.flush()
        if path.exists():
            old = path.stat()
            os.fchmod(file.fileno(), old.st_mode & 0o7777)
            if os.geteuid() == 0:
                os.fchown(file.fileno(), old.st_uid, old.st_gid)
        else:
            os.fchmod(file.fileno(), 0o644)
        os.fsync(file.fileno())
    return Path(name)
