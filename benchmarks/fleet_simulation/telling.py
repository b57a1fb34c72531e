"""What a simulated robot tells of itself: its state now, and who it is on a new connection."""

from dataclasses import dataclass

from benchmarks.fleet_simulation.body import Body
from protocol.envelope import YOUNGER
from protocol.parts import Activity, Battery
from protocol.to_server import Hello, Snapshot
from robot.mission.mission import MissionManager


@dataclass
class Telling:
    """`home`: of its settings, until the service gives it one."""

    home: str
    map_version: str
    body: Body
    missions: MissionManager
    activity: Activity = Activity.IDLE

    def snapshot(self) -> Snapshot:
        held = self.missions.held
        return Snapshot(
            position=held.position,
            activity=self.activity,
            battery=self._battery(),
            cargo=held.cargo,
            mission=held.mission_held,
        )

    def hello(self) -> Hello:
        held = self.missions.held
        return Hello(
            position=held.position,
            cargo=held.cargo,
            mission=held.mission_held,
            battery=self._battery(),
            software="simulated",
            map_version=self.map_version,
            understands=YOUNGER,
            home=held.home or self.home,
        )

    def _battery(self) -> Battery:
        return Battery(ratio=self.body.ratio, charging=self.body.charging, docked=self.body.docked)
