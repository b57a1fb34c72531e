"""The map of a scenario: a built-in one or a file, in its own size or another."""

from pathlib import Path

from maps import CampusMap
from maps.campus_map import build_map, find_map, map_path
from maps.map_file import load_map_file
from maps.scaling import fitting_factor, scaled
from robot.scenarios.errors import ScenarioError
from robot.scenarios.scenario import MapChoice


def campus_of(choice: MapChoice, source: Path | None = None) -> CampusMap:
    """Raises maps.MapError, ScenarioError. A file is looked for beside the scenario."""
    if choice.scale is not None and choice.corridors_m is not None:
        raise ScenarioError(str(source or "scenario"), "map", "both scale and corridors_m are given", "Keep one.")
    path = map_path(choice.name)
    if source is not None and not path.is_absolute() and (source.parent / path).exists():
        path = source.parent / path
    campus = find_map(path)  # which also checks that the file makes a map
    if choice.scale is None and choice.corridors_m is None:
        return campus
    file = load_map_file(path)
    factor = choice.scale if choice.corridors_m is None else fitting_factor(file, *choice.corridors_m)
    return build_map(scaled(file, factor or 1.0))
