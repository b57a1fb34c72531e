"""Distances from post to post by corridor, worked out once: the map does not change while the service runs."""

import math

from maps.campus_map import CampusMap
from maps.errors import NoRoute
from maps.routes import Route, lengths_from, shortest_route


class Ways:
    """The shortest routes of one campus, and their lengths in metres."""

    def __init__(self, campus: CampusMap) -> None:
        self.campus = campus
        self._known: dict[tuple[str, str], Route | None] = {}
        self._lengths_m: dict[str, dict[str, float]] = {}

    def route(self, from_post: str, to_post: str) -> Route:
        """As `shortest_route`. Raises UnknownPost and NoRoute."""
        # Asked anew where there is none: the map says why.
        return self._look_up(from_post, to_post) or shortest_route(self.campus, from_post, to_post)

    def length_m(self, from_post: str | None, to_post: str) -> float:
        """Infinite where nothing is known: from nowhere, to a post of another map, or where no corridors join them."""
        if from_post is None or from_post not in self.campus.posts or to_post not in self.campus.posts:
            return math.inf
        if from_post not in self._lengths_m:
            self._lengths_m[from_post] = lengths_from(self.campus, from_post)
        return self._lengths_m[from_post].get(to_post, math.inf)

    def _look_up(self, from_post: str, to_post: str) -> Route | None:
        if (from_post, to_post) not in self._known:
            try:
                self._known[from_post, to_post] = shortest_route(self.campus, from_post, to_post)
            except NoRoute:
                self._known[from_post, to_post] = None
        return self._known[from_post, to_post]
