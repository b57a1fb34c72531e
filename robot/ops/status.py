"""A running robot in one object: what `status` shows. Read from the newest view and snapshot; nothing is waited for."""

from dataclasses import dataclass
from typing import Any

from protocol.clock import Clock
from robot.agent.mind import Mind
from robot.drivers.create2.create2 import Create2
from robot.drivers.port_thread import PortThread
from robot.link.link import Link
from robot.ops.daemon import SOFTWARE, Daemon
from robot.ops.runners import Lag, Runner
from robot.reflexes import TOLD


@dataclass(frozen=True)
class StatusBoard:
    """Everything that `tell` looks at."""

    name: str
    daemon: Daemon
    mind: Mind
    runner: Runner
    clock: Clock
    began_s: float
    link: Link | None = None
    server: str | None = None

    def tell(self) -> dict[str, Any]:
        """Ready for JSON. Any thread may ask."""
        return {
            "robot": self.name,
            "software": SOFTWARE,
            "up_s": round(self.clock.now() - self.began_s, 1),
            **self._doing(),
            "battery": self._battery(),
            "faults": {name: TOLD.get(name, "") for name in sorted(self.mind.hands.body.view.faults)},
            "base": self._base(),
            "link": self._link(),
            "drive": self._drive(),
            "loops": {name: _punctuality(lag) for name, lag in self.runner.lags.items()},
        }

    def _doing(self) -> dict[str, Any]:
        snapshot, why = self.mind.snapshot(), self.mind.why
        return {
            "activity": str(snapshot.activity),
            "why": why.sentence if why else None,
            "position": snapshot.position.model_dump(mode="json"),
            "mission": snapshot.mission.model_dump(mode="json") if snapshot.mission else None,
            "cargo": list(snapshot.cargo),
        }

    def _battery(self) -> dict[str, Any]:
        view, sense = self.mind.hands.body.view, self.mind.battery
        state = view.base
        return {
            "ratio": round(sense.ratio, 3) if sense.ratio is not None else None,
            "word": str(sense.word),
            "charging": bool(view.heard_base and view.heard_base.charging),
            "voltage_mv": state.voltage_mv if state else None,
        }

    def _base(self) -> dict[str, Any]:
        base, view = self.daemon.base, self.mind.hands.body.view
        state = view.base
        told: dict[str, Any] = {
            "mode": state.mode.name.lower() if state else None,
            "docked": bool(view.heard_base and view.heard_base.docked),
            "age_s": round(view.at_s - state.at_s, 3) if state else None,
            "wheels_mm_s": list(view.sent),
        }
        if isinstance(base, Create2 | PortThread):
            health = base.health
            told |= {"frames": health.frames, "starts": health.starts, "reconnections": health.reconnections}
            told |= {"damaged": health.corrupt, "problem": health.problem, "down": health.down}
        return told

    def _drive(self) -> dict[str, Any]:
        drive = self.daemon.drive
        return {
            "late_ticks": drive.late_ticks,
            "worst_gap_ms": round(1000 * drive.worst_gap_s, 1),
            "impossible_reads": drive.impossible_reads,
        }

    def _link(self) -> dict[str, Any] | None:
        if self.link is None:
            return None
        return {"server": self.server, "state": str(self.link.state), "problem": self.link.problem}

    def signs(self) -> dict[str, object]:
        """Return the signs that the watchdog checks: a frame of the base heard, the drive loop and the mind gone on."""
        view = self.mind.hands.body.view
        return {
            "serial": view.base.at_s if view.base else None,
            "control": view.at_s,
            "mind": self.runner.lags["mind"].ticks or None,
        }

    def sentence(self) -> str:
        """One line for `systemctl status`."""
        why, ratio = self.mind.why, self.mind.battery.ratio
        doing = why.sentence if why else str(self.mind.activity())
        return f"{doing} Battery {ratio:.0%}." if ratio is not None else doing


def _punctuality(lag: Lag) -> dict[str, float]:
    return {
        "ticks": lag.ticks,
        "late_p50_ms": round(1000 * lag.share_s(0.5), 2),
        "late_p99_ms": round(1000 * lag.share_s(0.99), 2),
        "late_worst_ms": round(1000 * lag.worst_s, 2),
    }
