"""The robot's idea of where it is, kept up with what the body sees, and written down for after a power cut."""

import math
from dataclasses import replace

from maps import CampusMap, NoRoute
from protocol.parts import Leg, Position
from robot import pilot
from robot.drivers.interfaces import Odometry
from robot.duties import Duties
from robot.pilot import Pose
from robot.skills.interfaces import View


class Navigator:
    """Pose and destination. Told by actions what they are about to do, and by the body what it sees."""

    def __init__(self, campus: CampusMap, home: str | None, duties: Duties) -> None:
        self.campus, self.home = campus, home
        self.destination: str | None = None
        self.sighted: str | None = None
        """The post whose marker was in a frame since the last look."""
        self.passed: list[str] = []
        """Every post seen, in order; the same one twice only after another."""
        self._duties = duties
        self._odometry = Odometry()
        self._docked = False
        self.pose = remembered(campus, duties.held.position)

    def look(self, view: View) -> None:
        """Take in what the body sees now."""
        self._odometry = view.odometry
        self._look_at_dock(view)
        self.sighted = None
        if view.post and view.post.at_s > self.pose.seen_at_s and view.post.text in self.campus.posts:
            self.sighted = view.post.text
            self._become(pilot.arrived(self.pose, self.campus, view.post, view.odometry))
        else:
            self._become(pilot.rolled(self.pose, self.campus, view.odometry))

    def _look_at_dock(self, view: View) -> None:
        docked = bool(view.base and view.base.docked)
        if docked and not self._docked:
            post = self._dock_post()
            if post:
                self._become(pilot.docked_at(self.pose, self.campus, post, view.odometry))
        self._docked = docked

    def _dock_post(self) -> str | None:
        """The dock at hand: of the last post seen, if it has one."""
        here = self.campus.posts.get(self.pose.post or "")
        return here.name if here and here.dock else self.home

    def _become(self, pose: Pose) -> None:
        before, self.pose = self.pose, pose
        if pose.post and pose.standing and (pose.post != before.post or not before.standing):
            self._note_arrival(pose.post, before)
        elif pose.towards != before.towards:
            self._duties.heading_for(pose.towards)

    def _note_arrival(self, post: str, before: Pose) -> None:
        self._duties.seen(post)
        if before.post and before.post != post:
            self._duties.clear([Leg(from_post=before.post, to_post=post)])
        if self.passed[-1:] != [post]:
            self.passed.append(post)

    def place(self, post: str, towards: str | None) -> None:
        """A person has put the robot down at a post, looking along a corridor (or into the dock)."""
        heading_rad = None
        if towards:
            heading_rad = self.campus.corridor(post, towards).heading_leaving(post)
        self._become(Pose(post, None, True, None, heading_rad, self._odometry.heading_rad, -math.inf, 0.0))

    # What actions ask.

    @property
    def at(self) -> str | None:
        return self.pose.post if self.pose.standing else None

    def way(self) -> str | None:
        """The way to the destination, as the percept `direction` has it."""
        if self.destination is None:
            return None
        return pilot.way_to(self.pose, self.campus, self._odometry, self.destination, self._duties.avoid)

    def legs_to(self, *posts: str) -> tuple[Leg, ...]:
        """The corridors from here to each of these posts in turn. Raises NoRoute."""
        here = self.pose.post
        found: list[Leg] = []
        for post in posts if here else ():
            found += pilot.legs(self.campus, here or post, post, self._duties.avoid)
            here = post
        return tuple(found)

    def next_post(self) -> str | None:
        """The first post on the way to the destination."""
        try:
            way = self.legs_to(self.destination) if self.destination else ()
        except NoRoute:
            return None
        return way[0].to_post if way else None

    def turn_rad(self, way: str) -> float:
        """How far to turn for `way`, left is positive: to the corridor of the destination if that lies there."""
        wanted = self.next_post() if self.way() == way or way == "behind" else None
        if self.way() == "behind" and way in ("left", "right"):
            wanted = self.next_post()  # the paper's program turns left for what lies behind
        return pilot.turn_rad(self.pose, self.campus, self._odometry, way, wanted)

    # What actions tell.

    def leave(self) -> None:
        """The robot is about to follow the line away from its post."""
        self._become(pilot.left(self.pose, self.campus, self._odometry))

    def begin_turn(self) -> None:
        """After a power cut in the middle of a turn, going on along the line is the way to find out."""
        self._duties.heading_for(self.next_post())

    def turned(self, by_rad: float, odometry_before: Odometry) -> None:
        """A turn has ended on the line: what is left of odometry's error is forgotten."""
        heading_rad = self.pose.heading_now(odometry_before)
        if heading_rad is not None:
            self.pose = pilot.looking(self.pose, heading_rad + by_rad, self._odometry)

    def undocked(self) -> None:
        """The robot stands on the line at the dock's post and looks away from the dock."""
        dock = self.campus.post(self.pose.post).dock if self.pose.post else None
        if dock:
            self.pose = pilot.looking(self.pose, dock.heading_rad + math.pi, self._odometry)

    def nearest_dock(self) -> str | None:
        return pilot.nearest_dock(self.campus, self.pose.post, self.home, self._duties.avoid)


def remembered(campus: CampusMap, position: Position) -> Pose:
    """Where the robot was when it was switched off. `towards` was written down before it left or turned."""
    post, previous = position.post, position.previous
    if post is None or post not in campus.posts:
        return Pose()
    pose = Pose(post, previous, standing=position.towards is None, towards=position.towards)
    if previous and previous in {neighbour.name for neighbour, _ in campus.neighbours(post)}:
        pose = replace(pose, heading_rad=campus.corridor(previous, post).heading_arriving(post))
    return pose
