"""A campus as large as one likes: posts at which three corridors of equal length meet, with bays in between."""

from dataclasses import dataclass
from math import ceil, sqrt
from pathlib import Path
from typing import Final

from maps import CampusMap, read_map
from maps.map_file import LAST_TAG, BayRow, CorridorRow, MapFile, PostRow, toml_of

APART_M: Final = 30.0
MOST_ROBOTS: Final = (LAST_TAG + 1) // 3
"""Each with a post, a bay for passing and a home of its own: each of these has a tag of its own."""


@dataclass(frozen=True, slots=True)
class Honeycomb:
    """So many posts in rows, about as many rows as there are posts in a row, each with `bays` for passing, one or two;
    `homes`, with a dock each, as evenly as can be over them. What is written has to be read: it raises MapError where
    there are too few tags."""

    posts: int
    homes: int
    bays: int = 1

    @property
    def name(self) -> str:
        return f"honeycomb_{self.posts}"

    @property
    def wide(self) -> int:
        return ceil(sqrt(self.posts))

    def write(self, folder: Path) -> Path:
        """Write the map file; returns where."""
        path = folder / f"{self.name}.toml"
        path.write_text(toml_of(self.file()))
        return path

    def read(self, folder: Path) -> CampusMap:
        return read_map(self.write(folder))

    def file(self) -> MapFile:
        numbers = range(self.posts)
        along = [(one, one + 1) for one in numbers if self._leads_right(one) and (one + 1) % self.wide]
        across = [(one, one + self.wide) for one in numbers]
        corridors = tuple(CorridorRow(ends=(f"p{a}", f"p{b}")) for a, b in (*along, *across) if b < self.posts)
        return MapFile(name=self.name, title="A honeycomb", post=tuple(map(self._post, numbers)), corridor=corridors)

    def _post(self, number: int) -> PostRow:
        y, x = divmod(number, self.wide)
        aside, first_deg = (0.25, 60.0) if self._leads_right(number) else (-0.25, 0.0)
        bays = [BayRow(bearing_deg=first_deg + 240 * at) for at in range(self.bays)]
        if number * self.homes // self.posts < (number + 1) * self.homes // self.posts:
            bays.append(BayRow(bearing_deg=first_deg + 120, home=True, dock=True))
        x_m, y_m = APART_M * (1.5 * x + aside), APART_M * sqrt(3) / 2 * y
        return PostRow(name=f"p{number}", x_m=round(x_m, 2), y_m=round(y_m, 2), mailroom=number == 0, bay=tuple(bays))

    def _leads_right(self, number: int) -> bool:
        return sum(divmod(number, self.wide)) % 2 == 0
