"""What a simulated world remembers: a real robot stays where it is when its computer dies, so this one must too."""

import json
import os
from pathlib import Path
from typing import Any

from .simulated import Pose, SimulatedRobot

SAVE_EVERY_S = 0.5
SAVED_BYTES = 512


class SavedWorld:
    """Moves the simulated robot along, and keeps its pose and charge in a file from which the next start goes on."""

    def __init__(self, robot: SimulatedRobot, path: Path) -> None:
        self._robot = robot
        self._saved_s = robot.now
        self._file = os.open(path, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600)
        text = os.pread(self._file, SAVED_BYTES, 0)
        self.restored = bool(text)
        if text:
            self._restore(json.loads(text))

    def _restore(self, saved: dict[str, Any]) -> None:
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
        """One small write into the open file: a kill comes before or after it, never in the middle."""
        pose, state = self._robot.pose, self._robot.state()
        saved = {
            "x_m": pose.x_m,
            "y_m": pose.y_m,
            "heading_rad": pose.heading_rad,
            "battery_ratio": self._robot.battery.ratio,
            # Not read again; for whoever looks at how it ended.
            "mode": state["mode"],
            "wheels_mm_s": [round(speed) for speed in state["wheels_mm_s"]],
        }
        os.pwrite(self._file, json.dumps(saved).ljust(SAVED_BYTES).encode(), 0)

    def close(self) -> None:
        os.close(self._file)
