"""The campus for a run: a built-in map, with as many bays and docks as are asked for."""

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from maps import CampusMap, read_map
from maps.campus_map import builtin_path

POST: Final = "[[post]]\n"
PLACE: Final = re.compile(r"^x_m = (\S+)\ny_m = (\S+)$", re.MULTILINE)
DOCK_BESIDE_M: Final = 0.6


@dataclass(frozen=True, slots=True)
class Ground:
    """`bays` at each post, 0: as the map says. `docks`: so many, the map's own first, then at its other posts."""

    name: str = "carleton"
    bays: int = 0
    docks: int = 0

    def write(self, folder: Path) -> Path:
        """Write the map file; returns where."""
        head, *posts = builtin_path(self.name).read_text().split(POST)
        lacking = self.docks - sum("\ndock = " in post for post in posts)
        for number, post in enumerate(posts):
            if lacking > 0 and "\ndock = " not in post:
                posts[number], lacking = _with_dock(post), lacking - 1
        if self.bays:
            posts = [PLACE.sub(lambda found: f"{found[0]}\nbays = {self.bays}", post, count=1) for post in posts]
        path = folder / f"{self.name}.toml"
        path.write_text(POST.join([head, *posts]))
        return path

    def read(self, folder: Path) -> CampusMap:
        return read_map(self.write(folder))


def _with_dock(post: str) -> str:
    """Assumed, as the map's own are: in the direction of none of the tunnels' lines."""

    def dock(found: re.Match[str]) -> str:
        x_m, y_m = float(found[1]), float(found[2])
        there = f"{{ x_m = {x_m + DOCK_BESIDE_M}, y_m = {y_m + DOCK_BESIDE_M}, heading_deg = 45.0 }}"
        return f"{found[0]}\ndock = {there}"

    return PLACE.sub(dock, post, count=1)
