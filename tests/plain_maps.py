"""The test track and the tunnels without bays on the floor, for tests in which robots stand on the posts themselves."""

from pathlib import Path
from typing import Final

from maps import CampusMap, read_map

FOLDER: Final = Path(__file__).parent / "plain_maps"
PLAIN_TRACK: Final = FOLDER / "test_track.toml"
PLAIN_TUNNELS: Final = FOLDER / "carleton.toml"


def plain_map(name: str) -> CampusMap:
    return read_map(FOLDER / f"{name}.toml")
