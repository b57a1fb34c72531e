"""A whole robot in a simulated world, run as fast as it goes until something has happened."""

from collections.abc import Callable
from hashlib import sha256
from pathlib import Path
from typing import Any

from protocol.clock import SteppedClock
from protocol.parts import Purpose, Stop, StopAction
from protocol.to_robot import Mission, Verifier, Verifiers
from protocol.to_server import Occupancy
from robot.agent.mind import messages_from_person
from robot.core.config import load_settings
from robot.ops.assembly import Parts, Simulation, assemble
from robot.ops.runners import LockstepRunner

CODES = {Purpose.LOAD: "CM1:" + "a1" * 16, Purpose.RECEIVE: "CM1:" + "b2" * 16}
HOME = "post5_bay1"
"""On the test track: the paper's dock."""
# A strong charger, so that a charge takes a minute and not an hour.
QUICK = {"rates.line_hz": 50.0, "battery.simulated_charger_ma": 60_000.0}
LETTER = Mission(
    id="m1",
    update=1,
    stops=(
        Stop(id="s1", post="post1", action=StopAction.LOAD, order_id="o1", wait_limit_s=120),
        Stop(id="s2", post="post4", action=StopAction.RECEIVE, order_id="o1", wait_limit_s=120),
    ),
)


class SimulatedRun:
    """`until(...)` lets time pass; the robot's parts are there to be looked at."""

    def __init__(self, data: Path, start: str | None = None, **settings: object) -> None:
        self.clock = SteppedClock()
        dotted = {name.replace("__", "."): value for name, value in settings.items()}
        battery = dotted.pop("battery_ratio", None)
        assert battery is None or isinstance(battery, float)
        if "map" not in dotted:
            dotted.setdefault("home", HOME)
            start = start or f"dock:{HOME}"
        self.settings = load_settings(None, {**QUICK, "data": data, **dotted})
        self.parts: Parts = assemble(self.settings, self.clock, Simulation(start, battery, in_memory=True))
        assert self.parts.robot is not None
        self.robot = self.parts.robot
        self.mind, self.missions = self.parts.mind, self.parts.mind.hands.missions
        self.did: list[str] = []
        self.printed: list[str] = []
        self.mind.hands.noted = self.printed.append
        self._runner = LockstepRunner(self.parts.daemon.loops(), self.clock)
        self._wanted: Callable[[], object] = lambda: False
        self._until_s = 0.0
        self.parts.daemon.watchers = (self._watch,)

    def _watch(self, now: float) -> None:
        for action in self.mind.actions.under_way:
            if self.did[-1:] != [action]:
                self.did.append(action)
        if self._wanted() or now >= self._until_s:
            self._runner.stop()

    def until(self, wanted: Callable[[], object], limit_s: float = 400.0) -> None:
        """Let the world go on until this holds; AssertionError if it does not within the limit."""
        self._wanted, self._until_s = wanted, self._runner.now_s + limit_s
        self._runner.run()
        self._runner.restart()
        assert wanted(), f"not within {limit_s:g} s; visited {self.visited}, did {self.did[-8:]}, {self.mind.why}"

    def passes(self, duration_s: float) -> None:
        """Let so much time pass."""
        until_s = self._runner.now_s + duration_s
        self.until(lambda: self._runner.now_s >= until_s - 0.2, duration_s + 1)

    def asks(self, tell: str, achieve: str) -> None:
        self.mind.inbox.extend(messages_from_person([tell] if tell else [], [achieve]))

    def given_a_letter(self) -> None:
        """post1 to post4, with the codes of both people."""
        verifiers = tuple(
            Verifier(
                order_id="o1",
                purpose=purpose,
                sha256=sha256(text.encode()).hexdigest(),
                expires_at=self.clock.utc().replace(year=2030),
            )
            for purpose, text in CODES.items()
        )
        self.missions.memory.keep_verifiers(Verifiers(verifiers=verifiers), self.clock.utc())
        self.missions.give(LETTER)

    def shows(self, purpose: Purpose) -> None:
        self.robot.show_code(CODES[purpose])

    def waits_for(self, action: str) -> bool:
        return any(under_way.startswith(action) for under_way in self.mind.actions.under_way)

    @property
    def visited(self) -> list[str]:
        return self.parts.navigator.visited

    def is_at(self, post: str) -> bool:
        """Return whether this is the last post reached, or it is in a bay of it."""
        campus = self.parts.navigator.campus
        return [campus.address_of(place) for place in self.visited[-1:]] == [post]

    @property
    def is_home(self) -> bool:
        return self.robot.docked and self.mind.is_quiet

    def told(self) -> list[str]:
        """Return what the server would hear: `progress arrived`, `handover load`, `charge low` …"""
        return [_short(kept.message) for kept in self.missions.outbox.pending(limit=1000)]

    @property
    def bays(self) -> list[str]:
        """The bays that it reported to stand in."""
        kept = (one.message for one in self.missions.outbox.pending(limit=1000))
        return [one.post for one in kept if isinstance(one, Occupancy) and one.where == "bay"]

    def kill(self) -> None:
        """As SIGKILL does: nothing is tidied up but what the system does by itself (files and locks are let go)."""
        self.parts.daemon.close_devices()

    def close(self) -> None:
        self.parts.daemon.close(self._runner.now_s)


def _short(message: Any) -> str:
    happened = getattr(message, "happened", None)
    if happened is None:
        return type(message).__name__.lower()
    what = getattr(happened, "step", None) or getattr(happened, "purpose", None) or getattr(happened, "name", "")
    return f"{happened.kind} {what}"
