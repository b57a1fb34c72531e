"""A world that several processes share, each with one robot of its own: see `world_file`.

Each process alone decides where its own body is. After every step it writes that down and reads where the others are.
"""

from dataclasses import dataclass
from pathlib import Path

from maps import CampusMap
from robot.simulated.obstacles import BUMPER_RADIUS_M
from robot.simulated.start import Pose
from robot.simulated.true_poses import TruePose
from robot.simulated.world import Resident, World
from robot.simulated.world_file import WorldFile


@dataclass
class OtherRobot:
    """A robot of another process, as an `obstacles.Obstacle` where it was last seen."""

    x_m: float
    y_m: float
    number: int

    def nearest(self, x_m: float, y_m: float) -> tuple[float, float, float]:
        return self.x_m, self.y_m, BUMPER_RADIUS_M


class SharedWorld(World):
    """The world in `path`, with room for one robot, `name`, of this process. Raises WorldFileUnusable, BodyTaken."""

    def __init__(self, campus: CampusMap, path: Path, name: str, seed: int = 0) -> None:
        super().__init__(campus, seed=seed)
        self._file = WorldFile(path)
        try:
            self._row = self._file.take(name)
        except BaseException:
            self._file.close()
            raise
        self._others: dict[int, OtherRobot] = {}
        left = self._file.read(self._row)
        self._handled_before = left.handled if left else 0
        self.left: Pose | None = Pose(left.x_m, left.y_m, left.heading_rad) if left else None
        """Where an earlier process has left this robot."""

    def moved(self, robot: Resident) -> None:
        pose = robot.true_pose
        handled = self._handled_before + pose.handled
        self._file.write(self._row, TruePose(pose.time_s, pose.x_m, pose.y_m, pose.heading_rad, handled))
        if not self._file.ghosts:
            self._look_at_others()

    def _look_at_others(self) -> None:
        for row in self._file.rows():
            if row == self._row:
                continue
            other, number = self._others.get(row), self._file.number(row)
            if number == (other.number if other else 0):
                continue
            pose = self._file.read(row)
            if pose is None:
                continue
            if other is None:
                other = self._others[row] = OtherRobot(pose.x_m, pose.y_m, number)
                self.robots.append(other)
            other.x_m, other.y_m, other.number = pose.x_m, pose.y_m, number

    def close(self) -> None:
        """The robot stays where it is, for all others."""
        self._file.close()
