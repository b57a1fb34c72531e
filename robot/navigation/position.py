"""Where the robot is, in words of the map: seen at posts, never tracked in between.

    position = Position()                                  # nothing is known
    position = Position.placed(campus, "post1", "post2")   # somebody put it there and said so
    position = position.after(campus, view)                # every look of the mind: markers seen, way driven, turns

`current` is the last post that the axle has reached, `previous` the one before. The way the robot looks comes from the
map at every post; turns on the spot since then are added, bends of the line are not, so that it stays what it was at
the post.
"""

from dataclasses import dataclass, replace

from maps import CampusMap
from maps.geometry import wrapped

from ..drivers.interfaces import Odometry, Sighting
from .approach import arrival_heading_rad, post_ahead_mm
from .directions import Way, next_post, sector, turn_towards_rad

REACHED_MM = 30.0
"""So near counts as at the post; a robot that stops there is within a few millimetres."""
LEFT_MM = 100.0
"""So far beyond it the robot has left the post."""


@dataclass(frozen=True, slots=True)
class Position:
    """What is known about where the robot is. Distances are odometry's `ahead_mm`."""

    current: str | None = None
    previous: str | None = None
    facing_rad: float | None = None
    """The way it looked, in the map's frame, when `spot_turn_rad` was read."""
    spot_turn_rad: float = 0.0
    approaching: str | None = None
    """The post whose marker has been seen but that the axle has not reached."""
    post_at_mm: float | None = None
    """Odometry's reading at which the axle is (or was) on `approaching`, else on `current`."""
    seen_at_s: float | None = None
    """When the last marker was seen."""
    has_left: bool = False
    """The robot is on the way from `current`."""

    @classmethod
    def placed(
        cls,
        campus: CampusMap,
        post: str,
        towards: str | None,
        odometry: Odometry | None = None,
        now: float | None = None,
    ) -> "Position":
        """Somebody put the robot at `post`, looking along the corridor to `towards`. Raises UnknownPost."""
        campus.post(post)
        facing = campus.corridor(post, towards).heading_leaving(post) if towards else None
        start = odometry or Odometry()
        return cls(post, None, facing, start.spot_turn_rad, None, start.ahead_mm, now)

    def facing_now_rad(self, odometry: Odometry) -> float | None:
        """The way the robot looks now (at posts and on straight corridors), None while it cannot be known."""
        if self.facing_rad is None:
            return None
        return wrapped(self.facing_rad + odometry.spot_turn_rad - self.spot_turn_rad)

    def after(
        self,
        campus: CampusMap,
        odometry: Odometry,
        post: Sighting | None,
        post_odometry: Odometry,
        docked: bool = False,
    ) -> "Position":
        """After one look at the body's view."""
        position = self
        if post is not None and post.text in campus.posts and post.at_s != self.seen_at_s:
            position = position._sighted(campus, post, post_odometry, docked)
        return position._moved(campus, odometry)

    def _sighted(self, campus: CampusMap, post: Sighting, odometry: Odometry, docked: bool) -> "Position":
        dock = campus.post(post.text).dock
        if docked and dock:
            # In the dock the robot is at the post for every purpose of the map, and looks where the dock says.
            previous = self.previous if self.current == post.text else self.current
            return Position(
                post.text, previous, dock.heading_rad, odometry.spot_turn_rad, None, odometry.ahead_mm, post.at_s
            )
        heading = arrival_heading_rad(campus, self.current, post.text)
        ahead_mm = post_ahead_mm(campus, post, heading if heading is not None else self.facing_now_rad(odometry))
        if ahead_mm is None:
            return self
        at_mm = odometry.ahead_mm + ahead_mm
        if post.text == self.current and not self.has_left:
            return self._still_before(post, at_mm, odometry)
        return replace(self, approaching=post.text, post_at_mm=at_mm, seen_at_s=post.at_s)

    def _still_before(self, post: Sighting, at_mm: float, odometry: Odometry) -> "Position":
        """Standing at a post, its marker tells how exactly. Who has stopped well short of it is still on the way."""
        if abs(at_mm - odometry.ahead_mm) <= LEFT_MM:
            return replace(self, post_at_mm=at_mm, seen_at_s=post.at_s)
        if at_mm < odometry.ahead_mm or self.previous is None:
            return self
        return replace(
            self,
            current=self.previous,
            previous=None,
            approaching=post.text,
            post_at_mm=at_mm,
            seen_at_s=post.at_s,
            has_left=True,
        )

    def _moved(self, campus: CampusMap, odometry: Odometry) -> "Position":
        if self.post_at_mm is None:
            return self
        to_go_mm = self.post_at_mm - odometry.ahead_mm
        if self.approaching is not None:
            return self._reached(campus, self.approaching, odometry) if to_go_mm <= REACHED_MM else self
        has_left = abs(to_go_mm) > LEFT_MM
        return self if has_left == self.has_left else replace(self, has_left=has_left)

    def _reached(self, campus: CampusMap, post: str, odometry: Odometry) -> "Position":
        came_back = post == self.current
        heading = None if came_back else arrival_heading_rad(campus, self.current, post)
        if heading is None:
            heading = self.facing_now_rad(odometry)
        previous = self.previous if came_back else self.current
        return Position(post, previous, heading, odometry.spot_turn_rad, None, self.post_at_mm, self.seen_at_s)

    def stands_at(self, campus: CampusMap, post: str, odometry: Odometry) -> "Position":
        """The body has stopped at this post, whatever the sightings from here say about the last few centimetres."""
        if self.at == post and self.approaching is None:
            return self
        return replace(self, post_at_mm=odometry.ahead_mm)._reached(campus, post, odometry)

    @property
    def at(self) -> str | None:
        """The post where the robot stands; None on the way."""
        return None if self.has_left else self.current

    @property
    def sighted(self) -> tuple[str, float] | None:
        """The post ahead whose marker has been seen, and odometry's reading there."""
        return None if self.approaching is None or self.post_at_mm is None else (self.approaching, self.post_at_mm)

    # Which way

    def turn_rad(self, campus: CampusMap, neighbour: str, odometry: Odometry) -> float | None:
        """How far to turn to leave `current` for `neighbour`; None while the way the robot looks is not known."""
        facing = self.facing_now_rad(odometry)
        return (
            None
            if facing is None or self.current is None
            else turn_towards_rad(campus, facing, self.current, neighbour)
        )

    def way_to(
        self, campus: CampusMap, destination: str, odometry: Odometry, avoid: frozenset[str] = frozenset()
    ) -> Way | None:
        """The word for the way to a destination; None while no post has been seen. Raises UnknownPost, NoRoute.

        As long as the way it looks is not known the word is `forward`: the next post will tell.
        """
        campus.post(destination)
        if self.current is None:
            return None
        towards = next_post(campus, self.current, destination, avoid)
        if towards is None:
            return Way.ARRIVED
        turn = self.turn_rad(campus, towards, odometry)
        return Way.FORWARD if turn is None else sector(turn)
