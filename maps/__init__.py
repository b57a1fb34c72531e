"""Where things are: campus maps as data (TOML), their one reader, routes on them, and their check."""

from maps.bays import Bay, Dock, Marker
from maps.campus_map import (
    CampusMap,
    Corridor,
    Post,
    builtin_map,
    corridor_name,
    find_map,
    read_map,
)
from maps.errors import CampusMapError, MapError, NoRoute, UnknownCorridor, UnknownPost
from maps.geometry import Point
from maps.routes import Route, shortest_route

__all__ = [
    "Bay",
    "CampusMap",
    "CampusMapError",
    "Corridor",
    "Dock",
    "MapError",
    "Marker",
    "NoRoute",
    "Point",
    "Post",
    "Route",
    "UnknownCorridor",
    "UnknownPost",
    "builtin_map",
    "corridor_name",
    "find_map",
    "read_map",
    "shortest_route",
]
