"""The permission to enter a corridor, by one simple and safe rule.

A claim is granted as a whole when none of the posts it touches, nor any on the shortest way from its end to the robot's
own dock, is reserved by another robot; all of these posts are then reserved for this one until it stands in a dock
with no corridor left. So every robot that is out has a free way home, no corridor ever holds two, and no two robots
wait for each other. It costs throughput: the fleet's schedule (another part of the project) does better.
"""

from collections.abc import Iterable
from dataclasses import dataclass, field

from maps import CampusMap, NoRoute, corridor_name, shortest_route
from protocol.parts import Leg


@dataclass
class Claimed:
    """A claim that waits for its way to be free."""

    robot: str
    claim_id: str
    legs: tuple[Leg, ...]


@dataclass
class Interlocking:
    """`homes`: robot → post of its dock."""

    campus: CampusMap
    homes: dict[str, str | None]
    held: dict[str, list[Leg]] = field(default_factory=dict)
    """Granted and not reported clear."""
    reserved: dict[str, set[str]] = field(default_factory=dict)
    """Posts, by robot."""
    waiting: list[Claimed] = field(default_factory=list)

    def claim(self, claim: Claimed) -> None:
        """A robot has only one claim at a time: a newer one takes the place of the older."""
        self.waiting = [one for one in self.waiting if one.robot != claim.robot]
        self.waiting.append(claim)

    def clear(self, robot: str, leg: Leg) -> None:
        self.held[robot] = [one for one in self.held.get(robot, []) if one != leg]

    def in_dock(self, robot: str) -> None:
        """It stands out of everybody's way, and keeps only what it has been granted since."""
        if not self.held.get(robot):
            self.reserved.pop(robot, None)

    def grants(self) -> list[Claimed]:
        """The waiting claims that can be granted now, oldest first; they are held from now on."""
        granted = []
        for claim in tuple(self.waiting):
            posts = self._posts(claim)
            if posts & self._others(claim.robot):
                continue
            self.waiting.remove(claim)
            self.reserved.setdefault(claim.robot, set()).update(posts)
            held = self.held.setdefault(claim.robot, [])
            held += [leg for leg in claim.legs if leg not in held]
            granted.append(claim)
        return granted

    def may_be_in(self, robot: str, corridor: str) -> bool:
        """Return whether the robot has been granted this corridor, in whichever direction."""
        return any(corridor_name(leg.from_post, leg.to_post) == corridor for leg in self.held.get(robot, ()))

    def _posts(self, claim: Claimed) -> set[str]:
        touched = {post for leg in claim.legs for post in (leg.from_post, leg.to_post)}
        home = self.homes.get(claim.robot)
        if home is None or not claim.legs:
            return touched
        try:
            return touched | set(shortest_route(self.campus, claim.legs[-1].to_post, home).posts)
        except NoRoute:
            return touched

    def _others(self, robot: str) -> set[str]:
        return _union(posts for name, posts in self.reserved.items() if name != robot)


def _union(sets: Iterable[set[str]]) -> set[str]:
    return {post for posts in sets for post in posts}
