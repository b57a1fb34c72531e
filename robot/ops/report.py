"""The terminal report of a run: a line for each thing of note, and a summary at the end."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

from robot.agent.mind import Mind
from robot.link.link import Link, LinkState
from robot.simulated import SimulatedRobot

_QUIET_ACTIONS = ("drive(", "report(", "clear_fault(", "say(", "rest(")


@dataclass
class Reporter:
    """Looks at the mind after each of its ticks and says what is new. `say` gets one line at a time."""

    mind: Mind
    robot: SimulatedRobot | None
    began_s: float
    say: Callable[[str], None]
    now_s: float = 0.0
    _arrivals: int = 0
    _told: set[str] = field(default_factory=set)
    _docked: bool = False
    _lows: int = 0
    _charges: int = 0
    """How often a low battery became full again."""
    _battery: str = ""

    def look(self, now: float) -> None:
        """After a tick of the mind."""
        self.now_s = now
        navigator = self.mind.hands.navigator
        for post in navigator.reached_after(self._arrivals):
            self._line(f"at {post}")
        self._arrivals = navigator.arrivals
        self._look_at_actions()
        self._look_at_battery()

    def note(self, text: str) -> None:
        """Something that went wrong, or that a person should see."""
        self._line(text)

    def _look_at_actions(self) -> None:
        present = {action for action in self.mind.actions.under_way if not action.startswith(_QUIET_ACTIONS)}
        for action in sorted(present - self._told):
            self._line(action)
        self._told = present

    def _look_at_battery(self) -> None:
        base = self.mind.hands.view.base
        docked = bool(base and base.docked)
        if docked != self._docked:
            self._docked = docked
            self._line("docked" if docked else "undocked")
        word = str(self.mind.battery.word)
        if word != self._battery and self.mind.battery.ratio is not None:
            self._charges += word == "full" and self._lows > self._charges
            self._lows += word == "low"
            self._battery = word
            self._line(f"battery {word} ({self.mind.battery.ratio:.0%})")

    def _line(self, text: str) -> None:
        self.say(f"{self.now_s - self.began_s:8.1f} s  {text}")

    def summary(self) -> dict[str, Any]:
        """The run in one object, ready for JSON."""
        view = self.mind.hands.view
        return {
            "posts": list(self.mind.hands.navigator.visited),
            "distance_m": round((self.robot.driven_mm if self.robot else view.odometry.travelled_mm) / 1000, 2),
            "time_s": round(self.now_s - self.began_s, 1),
            "find_line_episodes": view.find_line_episodes,
            "bumps": view.bumps,
            "charges": self._charges,
            "battery": round(self.mind.battery.ratio or 0.0, 3),
            "cycles": self.mind.cycles,
        }


QUIET_S = 2.0
"""An agent that has had nothing to do for so long has finished what it was asked."""


@dataclass
class Ending:
    """Ends a run with goals: when the agent is done with them, when one fails for good, or when the time is up.

    The agent is done when it has nothing left to do, since a goal may be dropped and taken up again on the way (the
    paper's battery plan does so).
    """

    mind: Mind
    goals: Sequence[str]
    until_s: float
    stop: Callable[[], None]
    problem: str | None = None
    """Why the goals were not reached; None if they were, or if there were none."""
    _quiet_since_s: float | None = None

    def __post_init__(self) -> None:
        self.problem = "stopped before it was done" if self.goals else None

    def look(self, now: float) -> None:
        """After a tick of the mind."""
        if not self.goals:
            return
        if self.mind.failures:
            self._end(str(self.mind.failures[0]))
        elif now >= self.until_s:
            self._end(f"not done in time; {self.mind.why.sentence if self.mind.why else 'it never began'}")
        elif not self.mind.is_quiet:
            self._quiet_since_s = None
        elif self._quiet_since_s is None:
            self._quiet_since_s = now
        elif now - self._quiet_since_s >= QUIET_S:
            self._end(None)

    def _end(self, problem: str | None) -> None:
        self.problem = problem
        self.stop()


@dataclass
class Refusal:
    """Ends a run whose server has never let it in: a wrong token. One that was let in before goes on without it."""

    link: Link | None
    stop: Callable[[], None]
    reason: str | None = None
    _was_online: bool = False

    def look(self, _: float) -> None:
        """After a tick of the mind."""
        if self.link is None:
            return
        self._was_online = self._was_online or self.link.online
        if self.link.state is LinkState.REFUSED and not self._was_online:
            self.reason = self.link.problem or "the server refused this robot"
            self.stop()
