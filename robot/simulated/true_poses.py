"""True poses of robots: what the judge reads, and what robots never see."""

import csv
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import IO

LOG_EVERY_S = 0.2
COLUMNS = ("time_s", "robot", "x_m", "y_m", "heading_rad", "handled")


@dataclass(frozen=True)
class TruePose:
    """The middle of the axle at `time_s`, in metres and radians of the map.

    `handled`: how often a person has carried or pushed the robot so far.
    """

    time_s: float
    x_m: float
    y_m: float
    heading_rad: float
    handled: int = 0


class PoseLog:
    """A CSV file with the way of every robot: a row for each one that has moved, five times a simulated second."""

    def __init__(self, path: Path) -> None:
        self._file: IO[str] = path.open("w", buffering=1, newline="", encoding="utf-8")
        self._rows = csv.writer(self._file)
        self._rows.writerow(COLUMNS)
        self._written: dict[str, TruePose] = {}

    def note(self, poses: Mapping[str, TruePose]) -> None:
        for name, pose in poses.items():
            last = self._written.get(name)
            if last is None or (pose.time_s - last.time_s >= LOG_EVERY_S and _place(pose) != _place(last)):
                self._written[name] = pose
                place = (f"{pose.x_m:.4f}", f"{pose.y_m:.4f}", f"{pose.heading_rad:.4f}")
                self._rows.writerow((f"{pose.time_s:.3f}", name, *place, pose.handled))

    def close(self) -> None:
        self._file.close()


def _place(pose: TruePose) -> tuple[float, float, float, int]:
    return pose.x_m, pose.y_m, pose.heading_rad, pose.handled
