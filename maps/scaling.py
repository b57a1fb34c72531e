"""The same campus in another size: to try in minutes what takes a robot hours.

Only the places of posts and the tape between them are scaled. Robots, markers and docks keep their size, so docks and
markers keep their distance from their post.
"""

from math import sqrt

from maps.campus_map import build_map
from maps.errors import MapError
from maps.map_file import CorridorRow, MapFile, PoseRow, PostRow

SCALED_NOTE = "Scaled by {factor:.4g}. "


def scaled(file: MapFile, factor: float) -> MapFile:
    """The map file with every corridor `factor` times as long. Bends keep their radius where there is room for it."""
    if not factor > 0:
        raise MapError(file.name, "scale", f"{factor:g} is no size", "Give a factor above 0.")
    return file.model_copy(
        update={
            "note": SCALED_NOTE.format(factor=factor) + file.note,
            "post": tuple(_post(row, factor) for row in file.post),
            "corridor": tuple(_corridor(row, factor) for row in file.corridor),
        }
    )


def fitting_factor(file: MapFile, shortest_m: float, longest_m: float) -> float:
    """A factor with which no corridor is shorter or longer than wanted. Raises MapError if there is none."""
    lengths_m = [corridor.length_m for corridor in build_map(file).corridors]
    if not lengths_m:
        raise MapError(file.name, "scale", "it has no corridors", "Nothing needs to be scaled.")
    least, most = shortest_m / min(lengths_m), longest_m / max(lengths_m)
    if least > most:
        have, want = f"{min(lengths_m):g} to {max(lengths_m):g} m", f"{shortest_m:g} to {longest_m:g} m"
        said = f"its corridors of {have} cannot become {want}"
        raise MapError(file.name, "scale", said, "Allow longer or shorter ones.")
    return sqrt(least * most)


def _post(row: PostRow, factor: float) -> PostRow:
    dx_m, dy_m = row.x_m * (factor - 1), row.y_m * (factor - 1)
    return row.model_copy(
        update={
            "x_m": row.x_m * factor,
            "y_m": row.y_m * factor,
            "dock": row.dock and _moved(row.dock, dx_m, dy_m),
            "markers": row.markers and tuple(_moved(marker, dx_m, dy_m) for marker in row.markers),
        }
    )


def _moved(pose: PoseRow, dx_m: float, dy_m: float) -> PoseRow:
    return pose.model_copy(update={"x_m": pose.x_m + dx_m, "y_m": pose.y_m + dy_m})


def _corridor(row: CorridorRow, factor: float) -> CorridorRow:
    return row.model_copy(
        update={
            "length_m": row.length_m and row.length_m * factor,
            "via": tuple((x_m * factor, y_m * factor) for x_m, y_m in row.via),
        }
    )
