"""Settings of a fleet demonstration."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from demo.fleet.campus import Campus
from demo.settings import Demonstration
from maps.campus_map import read_map
from maps.map_file import load_map_file, toml_of
from maps.scaling import scaled
from robot.simulated import WorldFile

WATCHED_SPEED, ONCE_SPEED = 8.0, 30.0
"""Simulated seconds per second at most; the robots' processes lower it to what they keep up with."""
SCALE = 0.1
"""The tunnels are assumed to be 60 to 165 m long: twenty minutes in one of them are too long to watch."""
ONCE_LIMIT_S, FOR_EACH_ROBOT_S = 60.0, 30.0
"""Real time: orders that are not delivered by then have failed."""
RESTART_AFTER_S = 600.0
# Assumed: a charger twelve times as strong as a Create 2's, or an afternoon would be spent in docks.
ROBOT_CONFIG = """\
home = "{home}"

[battery]
simulated_charger_ma = 15000
"""


@dataclass(frozen=True)
class FleetDemo(Demonstration):
    """One with several robots in one simulated world. Its doors lie in the folder `door`."""

    campus: Campus
    minutes: float | None = None
    scale: float = SCALE
    seed: int = 1
    restart_after_s: float = RESTART_AFTER_S
    """By the demonstration's clock."""
    ghosts: bool = False
    """Bodies pass through each other; how often they would have touched is counted, and ends nothing."""

    @property
    def homes(self) -> Mapping[str, str]:
        """The robots that take part, and where each is at home."""
        return self.campus.homes

    @property
    def once_limit_s(self) -> float:
        return ONCE_LIMIT_S + FOR_EACH_ROBOT_S * len(self.homes)

    @property
    def map(self) -> str:
        return str(self.folder / f"{self.campus.map.name}.toml")

    @property
    def more(self) -> dict[str, Any]:
        # People of a demonstration come at once, or not at all; who looks on does not wait long for an alarm either.
        return {"wait_limit_s": 90.0, "assumed_handover_s": 30.0, "vanished_after_s": 120.0}

    @property
    def interval_s(self) -> float:
        """Between two orders, on an average: longer where the ways are."""
        return 30.0 + 600.0 * self.scale

    def lay_out(self) -> None:
        """The folders and files that service and robots find their way by. Raises MapError."""
        self.door.mkdir(mode=0o700, exist_ok=True)
        Path(self.map).write_text(toml_of(scaled(load_map_file(self.campus.file), self.scale)), encoding="utf-8")
        read_map(self.map)
        WorldFile.create(self.world_file, self.ghosts).close()
        for robot, home in self.homes.items():
            self._config_of(robot).write_text(ROBOT_CONFIG.format(home=home))

    def robot_command(self, robot: str) -> list[str]:
        more = {
            "--config": str(self._config_of(robot)),
            "--start": self._start_of(self.homes[robot]),
            "--world": str(self.world_file),
        }
        return self.command_of(robot, self.folder / robot, self.door / robot, more)

    def _start_of(self, home: str) -> str:
        """In the dock, or in the bay of a home that has none."""
        return f"dock:{home}" if self.campus.map.track.post(home).dock else home

    @property
    def world_file(self) -> Path:
        """Where the simulated world keeps the true places of all robots."""
        return self.folder / "world"

    def _config_of(self, robot: str) -> Path:
        return self.folder / f"{robot}.toml"
