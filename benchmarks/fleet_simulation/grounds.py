"""The campus for a run: a built-in map, with as many docks as are asked for."""

from dataclasses import dataclass
from pathlib import Path
from typing import Final

from maps import CampusMap, read_map
from maps.campus_map import builtin_path

BAY: Final = "[[post.bay]]\n"
HOME, DOCK = "home = true\n", "dock = true\n"


@dataclass(frozen=True, slots=True)
class Ground:
    """`docks`: so many in homes, the map's own first; 0: as the map says. Docks to share stay."""

    name: str = "carleton"
    docks: int = 0

    def write(self, folder: Path) -> Path:
        """Write the map file; returns where."""
        head, *bays = builtin_path(self.name).read_text().split(BAY)
        lacking = self.docks - sum(DOCK in bay and HOME in bay for bay in bays)
        for number, bay in enumerate(bays):
            if lacking > 0 and HOME in bay and DOCK not in bay:
                bays[number], lacking = bay.replace(HOME, DOCK + HOME, 1), lacking - 1
        path = folder / f"{self.name}.toml"
        path.write_text(BAY.join([head, *bays]))
        return path

    def read(self, folder: Path) -> CampusMap:
        return read_map(self.write(folder))
