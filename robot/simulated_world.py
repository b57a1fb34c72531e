"""What a simulated world remembers: a real robot stays where it is when its computer dies, so this one must too."""

import json
from pathlib import Path

from .simulated import Pose, SimulatedRobot

SAVE_EVERY_S = 0.5
LAYOUT = 1


class SavedWorld:
    """Moves the simulated robot along, and keeps its pose and charge in a file from which the next start goes on."""

    def __init__(self, robot: SimulatedRobot, path: Path) -> None:
        self._robot, self._path = robot, path
        self._saved_s = robot.now
        self.restored = False
        if path.exists():
            self._restore(path)

    def _restore(self, path: Path) -> None:
        saved = json.loads(path.read_text())
        if saved["layout"] != LAYOUT:
            return
        self._robot.place(Pose(saved["x_m"], saved["y_m"], saved["heading_rad"]))
        self._robot.sag(saved["battery_ratio"])
        self.restored = True

    def step_until(self, now: float) -> None:
        """See daemon.World."""
        self._robot.step_until(now)
        if now - self._saved_s >= SAVE_EVERY_S:
            self._saved_s = now
            self.save()

    def save(self) -> None:
        """Whole or not at all: a kill in the middle leaves the older file."""
        pose = self._robot.pose
        saved = {
            "layout": LAYOUT,
            "x_m": pose.x_m,
            "y_m": pose.y_m,
            "heading_rad": pose.heading_rad,
            "battery_ratio": self._robot.battery.ratio,
        }
        new = self._path.with_suffix(".new")
        new.write_text(json.dumps(saved))
        new.replace(self._path)
