"""A campus on which each of many robots has a home: posts in a grid, joined by corridors, as a map file.

The rows lean, so that the corridors of a post leave at 60° from each other and two bays fit between them.
"""

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Final

from maps import CampusMap, read_map
from maps.map_file import LAST_TAG, BayRow, CorridorRow, MapFile, PostRow, toml_of

CORRIDOR_M: Final = 30.0
LEANS_RAD: Final = math.radians(60)
BAYS: Final = (BayRow(bearing_deg=120.0, home=True, dock=True), BayRow(bearing_deg=300.0))
"""Of each post: the home of one robot, and a bay for those that stop or pass."""
MOST_POSTS: Final = (LAST_TAG + 1) // (1 + len(BAYS))
"""Each post and each bay of a map has a tag of its own."""


def write_campus(folder: Path, posts: int) -> CampusMap:
    """Write the map file of a campus with so many posts, and read it."""
    campus_file(folder).write_text(toml_of(grid(posts)), encoding="utf-8")
    return read_map(campus_file(folder))


def campus_file(folder: Path) -> Path:
    return folder / "campus.toml"


def grid(posts: int) -> MapFile:
    """Return a campus with so many posts, row by row, about as many in each row as there are rows."""
    if not 2 <= posts <= MOST_POSTS:
        raise ValueError(f"There are tags for 2 to {MOST_POSTS} posts with {len(BAYS)} bays each, and not for {posts}.")
    width = math.ceil(math.sqrt(posts))
    return MapFile(
        name="campus",
        title="A campus to measure on",
        note="Made up.",
        post=tuple(_post(number, *divmod(number, width)) for number in range(posts)),
        corridor=tuple(_corridors(posts, width)),
    )


def _post(number: int, row: int, column: int) -> PostRow:
    x_m = CORRIDOR_M * (column + row * math.cos(LEANS_RAD))
    y_m = CORRIDOR_M * row * math.sin(LEANS_RAD)
    return PostRow(name=_name(number), x_m=round(x_m, 3), y_m=round(y_m, 3), mailroom=number == 0, bay=BAYS)


def _corridors(posts: int, width: int) -> Iterator[CorridorRow]:
    for number in range(posts):
        if number % width:
            yield CorridorRow(ends=(_name(number - 1), _name(number)))
        if number >= width:
            yield CorridorRow(ends=(_name(number - width), _name(number)))


def _name(number: int) -> str:
    return f"p{number + 1}"
