"""The saved state of a simulated world: the robot stands where its daemon died, and its base counts on from there.

A real base rolls on for a while.
"""

import json
import os
from pathlib import Path
from typing import Any

from robot.core.errors import RobotError
from robot.simulated import Pose, SimulatedRobot

SAVE_EVERY_S = 0.5
"""How often the charge of one that stands still is written down."""
SAVED_BYTES = 512


class WorldNotKept(RobotError):
    """The file of the simulated world cannot be read or written."""

    def __init__(self, path: Path, problem: object) -> None:
        super().__init__(
            f"{path}: the simulated robot cannot keep its place there: {problem}. Delete it or free some room."
        )


class SavedWorld:
    """Moves the simulated robot along, and keeps its pose and charge in a file from which the next start goes on."""

    def __init__(self, robot: SimulatedRobot, path: Path) -> None:
        """Raises WorldNotKept, as `step_until` does."""
        self._robot, self._path = robot, path
        self._saved_s, self._kept = robot.now, robot.pose
        self.restored = False
        try:
            self._file = os.open(path, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600)
            text = os.pread(self._file, SAVED_BYTES, 0)
            if text:
                self._restore(json.loads(text))
        except (OSError, ValueError, KeyError, TypeError) as error:
            raise WorldNotKept(path, error) from None

    def _restore(self, saved: dict[str, Any]) -> None:
        self.restore_place(Pose(saved["x_m"], saved["y_m"], saved["heading_rad"]))
        self._robot.sag(saved["battery_ratio"])
        base = self._robot.body.base
        base.left.counts, base.right.counts = map(float, saved["counts"])

    def restore_place(self, pose: Pose) -> None:
        """Go on from here; no person has carried the robot."""
        self._robot.body.place(pose.x_m, pose.y_m, pose.heading_rad)
        self.restored = True

    def step_until(self, now: float) -> None:
        """See daemon.World.

        A robot that has moved is written down before it is reported: one that had ended a turn and was killed
        came back in the middle of it, sure that it had turned.
        """
        self._robot.step_until(now)
        if self._robot.pose != self._kept or now - self._saved_s >= SAVE_EVERY_S:
            self._saved_s = now
            self.save()

    def save(self) -> None:
        """One small write into the open file: a kill comes before or after it, never in the middle."""
        pose, state, base = self._robot.pose, self._robot.state(), self._robot.body.base
        self._kept = pose
        saved = {
            "x_m": pose.x_m,
            "y_m": pose.y_m,
            "heading_rad": pose.heading_rad,
            "battery_ratio": self._robot.battery.ratio,
            "counts": [base.left.encoder, base.right.encoder],
            # Not read again; for a person who looks at how it ended.
            "mode": state["mode"],
            "wheels_mm_s": [round(speed) for speed in state["wheels_mm_s"]],
        }
        try:
            os.pwrite(self._file, json.dumps(saved).ljust(SAVED_BYTES).encode(), 0)
        except OSError as error:
            raise WorldNotKept(self._path, error.strerror) from None

    def close(self) -> None:
        os.close(self._file)
