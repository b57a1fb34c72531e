"""How far it is from post to post by corridor, worked out once: the map does not change while the service runs."""

import math

from maps.campus_map import CampusMap
from maps.errors import NoRoute
from maps.routes import Route, shortest_route


class Ways:
    """The shortest routes of one campus, and their lengths in metres."""

    def __init__(self, campus: CampusMap) -> None:
        self.campus = campus
        self._known: dict[tuple[str, str], float] = {}
        self._routes: dict[tuple[str, str], Route] = {}

    def route(self, from_post: str, to_post: str) -> Route:
        """As `shortest_route`. Raises UnknownPost and NoRoute."""
        if (from_post, to_post) not in self._routes:
            self._routes[from_post, to_post] = shortest_route(self.campus, from_post, to_post)
        return self._routes[from_post, to_post]

    def length_m(self, from_post: str | None, to_post: str) -> float:
        """Infinite where nothing is known: from nowhere, to a post of another map, or where no corridors join them."""
        if from_post is None or from_post not in self.campus.posts or to_post not in self.campus.posts:
            return math.inf
        if (from_post, to_post) not in self._known:
            self._known[from_post, to_post] = self._look_up(from_post, to_post)
        return self._known[from_post, to_post]

    def _look_up(self, from_post: str, to_post: str) -> float:
        try:
            return self.route(from_post, to_post).length_m
        except NoRoute:
            return math.inf
