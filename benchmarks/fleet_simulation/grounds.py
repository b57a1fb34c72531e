"""The campus for a run: a built-in map, with as many docks and bays as are asked for."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from maps import CampusMap, read_map
from maps.campus_map import builtin_path
from maps.map_file import BayRow, PostRow, load_map_file, toml_of


@dataclass(frozen=True, slots=True)
class Ground:
    """`docks`: so many in homes, the map's own first; `bays`: at most so many for passing at each post; 0: as the map
    says. Docks to share stay."""

    name: str = "carleton"
    docks: int = 0
    bays: int = 0

    def write(self, folder: Path) -> Path:
        """Write the map file; returns where."""
        file = load_map_file(builtin_path(self.name))
        posts = list(self._with_docks(post if not self.bays else _with_bays(post, self.bays) for post in file.post))
        path = folder / f"{self.name}.toml"
        path.write_text(toml_of(file.model_copy(update={"post": tuple(posts)})))
        return path

    def read(self, folder: Path) -> CampusMap:
        return read_map(self.write(folder))

    def _with_docks(self, posts: Iterable[PostRow]) -> Iterator[PostRow]:
        rows = list(posts)
        lacking = self.docks - sum(bay.home and bay.dock for post in rows for bay in post.bay)
        for post in rows:
            bays = list(post.bay)
            for number, bay in enumerate(bays):
                if lacking > 0 and bay.home and not bay.dock:
                    bays[number], lacking = bay.model_copy(update={"dock": True}), lacking - 1
            yield post.model_copy(update={"bay": tuple(bays)})


def _with_bays(post: PostRow, most: int) -> PostRow:
    passing = [bay for bay in post.bay if not (bay.home or bay.dock)]
    return post.model_copy(update={"bay": tuple(bay for bay in post.bay if not _is_one_of(bay, passing[most:]))})


def _is_one_of(bay: BayRow, bays: Iterable[BayRow]) -> bool:
    return any(bay is one for one in bays)
