"""The shape of a map file, before anybody has asked whether it makes sense.

A file is TOML. Lengths are metres, x to the east and y to the north; headings are degrees counter-clockwise from
east. An unknown key is an error: a mistyped `lenght_m` must not become a default.
"""

import re
import tomllib
from pathlib import Path
from typing import Annotated, Literal

import tomlkit
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from maps.errors import MapError

Metres = Annotated[float, Field(allow_inf_nan=False)]
Degrees = Annotated[float, Field(ge=-360, le=360)]
LAST_TAG = 586
"""Of the 587 in the family 36h11."""
Side = Literal["1", "2", "3", "4"]


class Row(BaseModel):
    """One table of the file."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class PoseRow(Row):
    x_m: Metres
    y_m: Metres
    heading_deg: Degrees


class BayRow(Row):
    """A spur of tape off the post, from its middle to where the axle of a robot stands."""

    bearing_deg: Degrees
    length_m: Annotated[float, Field(gt=0, allow_inf_nan=False)] = 1.0
    # Kept for the robot whose home it is.
    home: bool = False
    # Beyond the end of the tape, straight on.
    dock: bool = False
    # Left out: the post's name and `_bay`, with the bay's place in this file, counted from 1.
    name: str | None = None
    # Left out: counted down from the last tag, so that a post more leaves the sheets of bays as they are.
    tag: int | None = Field(default=None, ge=0, le=LAST_TAG)


class PostRow(Row):
    name: str
    title: str = ""
    x_m: Metres
    y_m: Metres
    # Where robots stand, clear of the line.
    bay: tuple[BayRow, ...] = ()
    # Of maps from before bays had places on the floor: how many robots can stand there (left out: one), the places
    # where a robot can rest clear of line and bays, the dock among them (left out: one where there is a dock), the
    # dock's pose. A post has either these or `bay`.
    bays: int | None = Field(default=None, ge=0)
    homes: int | None = Field(default=None, ge=0)
    mailroom: bool = False
    # False: a robot that stands here is not heard of until it is back where there is network.
    network: bool = True
    # The number of the AprilTag on its sheets; left out: the post's place in this file, counted from 0.
    tag: int | None = Field(default=None, ge=0, le=LAST_TAG)
    dock: PoseRow | None = None
    # Left out: the standard places, one beside every approach and one beside the dock.
    markers: tuple[PoseRow, ...] | None = None
    # Which neighbour lies on which side, 1 to 4 clockwise in the post's own frame. A survey may know this before
    # anybody has measured anything; the map check compares it with the corridors and with the geometry.
    sides: dict[Side, str] | None = None

    def bay_names(self) -> list[str]:
        return [bay.name or f"{self.name}_bay{number}" for number, bay in enumerate(self.bay, start=1)]


class CorridorRow(Row):
    ends: tuple[str, str]
    length_m: Annotated[float, Field(gt=0, allow_inf_nan=False)] | None = None
    assumed: bool = False
    network: bool = True
    via: tuple[tuple[Metres, Metres], ...] = ()
    bend_radius_m: float = Field(default=1.0, ge=0)
    # Robots may follow each other in here, so many seconds apart. Left out: one robot at a time.
    following_s: Annotated[float, Field(gt=0, allow_inf_nan=False)] | None = None

    @property
    def name(self) -> str:
        return "-".join(sorted(self.ends))


class MapFile(Row):
    name: str
    title: str
    note: str = ""
    post: tuple[PostRow, ...] = Field(min_length=1)
    corridor: tuple[CorridorRow, ...] = ()

    def tags(self) -> dict[str, int | None]:
        """The number of the AprilTag of each post and bay by name; None where the family has no more."""
        bays = [pair for row in self.post for pair in zip(row.bay_names(), row.bay, strict=True)]
        posts = {row.name: _tag(row.tag, place) for place, row in enumerate(self.post)}
        return posts | {name: _tag(bay.tag, LAST_TAG - place) for place, (name, bay) in enumerate(bays)}


def _tag(own: int | None, place: int) -> int | None:
    return own if own is not None else place if 0 <= place <= LAST_TAG else None


def load_map_file(path: Path) -> MapFile:
    """Read the file's shape. Raises MapError with the line and column (broken TOML) or with the table and key."""
    text = _read(path)
    try:
        return MapFile.model_validate(tomllib.loads(text))
    except tomllib.TOMLDecodeError as error:
        raise _broken_toml(path, text, str(error)) from error
    except ValidationError as error:
        raise _broken_shape(path, error) from error


def toml_of(file: MapFile) -> str:
    """The text of a file from which the same would be read; comments are not kept."""
    return tomlkit.dumps(file.model_dump(mode="json", exclude_none=True))


def _read(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8")
    except OSError as error:
        raise MapError(str(path), "file", error.strerror or "cannot be read", "Check the path.") from error
    except UnicodeDecodeError as error:
        raise MapError(str(path), f"byte {error.start}", "this is not UTF-8 text", "Save it as UTF-8.") from error


def _broken_toml(path: Path, text: str, complaint: str) -> MapError:
    """tomllib says where only inside its sentence: 'Expected … (at line 3, column 5)' or '(at end of document)'."""
    message, _, where = complaint.partition(" (at ")
    lines = text.splitlines() or [""]
    line, column = map(int, re.findall(r"\d+", where) or (len(lines), len(lines[-1]) + 1))
    return MapError(str(path), f"line {line}, column {column}", message, "The file must be valid TOML.")


def _broken_shape(path: Path, error: ValidationError) -> MapError:
    first, others = error.errors()[0], error.error_count() - 1
    place = ".".join(str(part + 1) if isinstance(part, int) else part for part in first["loc"]) or "file"
    more = f" (and {others} more like this)" if others else ""
    return MapError(str(path), place, first["msg"] + more, "docs/reference/maps.md describes the format.")
