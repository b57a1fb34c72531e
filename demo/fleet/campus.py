"""The campus of a demonstration: its map, where robots are at home, and whose office is where."""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import Final

from app.core.errors import StartError
from maps import CampusMap, CampusMapError, find_map
from maps.campus_map import map_path

NAMES: Final = (
    *("ada", "ben", "chloe", "dora", "emil", "fay", "gus", "hana", "ivo", "jule", "kim", "lena", "max"),
    *("nora", "otto", "pia", "quinn", "rosa", "sam", "tess", "uma", "vito", "wanda", "xenia", "yves", "zoe"),
)


@dataclass(frozen=True)
class Campus:
    """`homes`: every robot's own bay, or dock where the map has no bays. `offices`: people, and the post next to each
    one's office."""

    file: Path
    map: CampusMap
    homes: Mapping[str, str]
    offices: Mapping[str, str]


def campus_of(name_or_path: str, robots: int | None = None) -> Campus:
    """So many robots on this map, those with a dock first; None: as many as it has docks. Raises StartError."""
    try:
        campus = find_map(name_or_path)
    except CampusMapError as error:
        raise StartError(f"The map cannot be used. {error}") from error
    places = campus.track.home_bays or campus.docks()
    docks = sum(place.dock is not None for place in places)
    offices = _offices(campus)
    if not docks or len(offices) < 2:
        raise StartError(f"The map {campus.name} needs a dock, and two posts where a robot can stop.")
    if robots is not None and robots > len(places):
        raise StartError(
            f"The map {campus.name} has homes for {len(places)} robots ({', '.join(place.name for place in places)}); "
            f"{robots} were asked for. Ask for fewer, or name a map with more homes: --map."
        )
    homes = {f"r{number}": place.name for number, place in enumerate(islice(places, robots or docks), start=1)}
    return Campus(map_path(name_or_path), campus, homes, offices)


def _offices(campus: CampusMap) -> dict[str, str]:
    """One person at every post where a robot can stop."""
    posts = [post.name for post in campus.posts.values() if post.bays]
    return {_name(number): post for number, post in enumerate(posts)}


def _name(number: int) -> str:
    again, which = divmod(number, len(NAMES))
    return f"{NAMES[which]}{again + 1 if again else ''}"
