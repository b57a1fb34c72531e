"""A campus as large as one likes: posts at which three corridors of equal length meet, with bays in between."""

from dataclasses import dataclass
from math import sqrt
from pathlib import Path

from maps import CampusMap, read_map
from maps.map_file import BayRow, CorridorRow, MapFile, PostRow, toml_of

APART_M = 30.0


@dataclass(frozen=True, slots=True)
class Honeycomb:
    """`wide` × `high` posts, each with `bays` for passing, one or two; `homes`, with a dock each, as evenly as can be
    over them."""

    wide: int
    high: int
    homes: int
    bays: int = 1

    @property
    def name(self) -> str:
        return f"honeycomb_{self.wide}x{self.high}"

    def write(self, folder: Path) -> Path:
        """Write the map file; returns where."""
        path = folder / f"{self.name}.toml"
        path.write_text(toml_of(self.file()))
        return path

    def read(self, folder: Path) -> CampusMap:
        return read_map(self.write(folder))

    def file(self) -> MapFile:
        places = [(x, y) for y in range(self.high) for x in range(self.wide)]
        along = [((x, y), (x + 1, y)) for x, y in places if x + 1 < self.wide and _leads_right(x, y)]
        across = [((x, y), (x, y + 1)) for x, y in places if y + 1 < self.high]
        posts = tuple(self._post(number, x, y) for number, (x, y) in enumerate(places))
        corridors = tuple(CorridorRow(ends=(_name(*a), _name(*b))) for a, b in (*along, *across))
        return MapFile(name=self.name, title="A honeycomb", post=posts, corridor=corridors)

    def _post(self, number: int, x: int, y: int) -> PostRow:
        aside, first_deg = (0.25, 60.0) if _leads_right(x, y) else (-0.25, 0.0)
        bays = [BayRow(bearing_deg=first_deg + 240 * at) for at in range(self.bays)]
        if self._has_home(number):
            bays.append(BayRow(bearing_deg=first_deg + 120, home=True, dock=True))
        x_m, y_m = APART_M * (1.5 * x + aside), APART_M * sqrt(3) / 2 * y
        return PostRow(name=_name(x, y), x_m=round(x_m, 2), y_m=round(y_m, 2), bay=tuple(bays))

    def _has_home(self, number: int) -> bool:
        posts = self.wide * self.high
        return number * self.homes // posts < (number + 1) * self.homes // posts


def _name(x: int, y: int) -> str:
    return f"p{x}_{y}"


def _leads_right(x: int, y: int) -> bool:
    return (x + y) % 2 == 0
