"""A robot of a scenario from the outside: what a person beside it sees and hears."""

from dataclasses import dataclass, field
from typing import Final

from maps import CampusMap
from robot.ops.assembly import Parts
from robot.scenarios.actors.stepped_link import SteppedLink
from robot.scenarios.places import AT_POST_M, post_at
from robot.scenarios.scenario import RobotRow
from robot.simulated import Pose, SimulatedRobot
from robot.skills.tunes import TUNES

AT_DOCK_M: Final = 1.0
_NAMES: Final = {tuple(number for number, _ in notes): name for name, notes in TUNES.items()}


@dataclass
class Actor:
    """`look` once in a tick; the rest is what was seen."""

    row: RobotRow
    parts: Parts
    body: SimulatedRobot
    link: SteppedLink
    posts: list[tuple[float, str]] = field(default_factory=list)
    """When it was first seen at which post, in order; the truth, not its own idea."""
    post: str | None = None
    rolls: bool = False
    """Its wheels turn."""
    _since_s: float | None = None
    """Since when they turn, or stand; None before the first look."""
    heard: list[str] = field(default_factory=list)
    """Tunes since the last look."""
    carried: bool = False
    """A person has put it somewhere, and it has not come to a post since: it cannot know which corridor it is in."""
    _put_down: bool = False
    _songs: int = 0

    @property
    def name(self) -> str:
        return self.row.name

    def look(self, track: CampusMap, now: float) -> None:
        pose = self.body.pose
        # In its dock it is at the dock's post for everybody who has a letter for it.
        place = post_at(track, pose.x_m, pose.y_m, AT_DOCK_M if self.body.docked else AT_POST_M)
        if place and (not self.posts or self.posts[-1][1] != place):
            self.posts.append((now, place))
        post = self.post = place and (None if track.bays_of(place) else track.address_of(place))
        # Put down on a post it has the marker behind it: only the one that it comes to, or a dock, tells it anything.
        self._put_down = self._put_down and post is not None and not self.body.docked
        self.carried = self.carried and (post is None or self._put_down)
        self._look_at_wheels(now)
        self._listen()

    def carry(self, pose: Pose) -> None:
        """A person puts it there."""
        self.body.place(pose)
        self.carried = self._put_down = True

    def _look_at_wheels(self, now: float) -> None:
        if self.body.body.base.moving != self.rolls or self._since_s is None:
            self.rolls, self._since_s = self.body.body.base.moving, now

    def _listen(self) -> None:
        self._songs, tunes = self.body.tunes_since(self._songs)
        self.heard = [_NAMES.get(tune, "?") for tune in tunes]

    def stands_s(self, now: float) -> float:
        """Return how long its wheels have been still."""
        return 0.0 if self.rolls or self._since_s is None else now - self._since_s

    def rolls_s(self, now: float) -> float:
        """Return how long its wheels have turned without a stand."""
        return now - self._since_s if self.rolls and self._since_s is not None else 0.0
