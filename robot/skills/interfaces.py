"""A skill: a long action under the agent, stepped by the drive loop, that ends done or failed with a reason.

    body.start(FollowLine(campus, leaving="post1"), now)  -> job id, at once, from any thread
    body.finished()                                       -> [JobEnd(job=1, skill="follow_line", outcome=Done("post2"))]

A second motion while one runs ends at once with Failed("busy"). Every job ends exactly once, a cancelled one with
Failed("cancelled").
"""

import math
from dataclasses import dataclass
from typing import Protocol

from protocol.proofs import ShownCode
from robot.drivers.interfaces import (
    NOTHING_SEEN,
    STOP,
    BaseState,
    Fix,
    LineReading,
    Mode,
    Note,
    Odometry,
    Sighting,
    WheelSpeeds,
)
from robot.localization.line_symbol import LineSymbol

START = Odometry()


@dataclass(frozen=True, slots=True)
class View:
    """Everything the body knows at one moment; what skills decide by and what perception turns into percepts."""

    at_s: float = 0.0
    base: BaseState | None = None
    """Newest frame of the base; None before the first."""
    reading: LineReading = NOTHING_SEEN
    line: LineSymbol = LineSymbol.LOST
    odometry: Odometry = START
    post: Sighting | None = None
    """The newest accepted marker of a post of the map (two equal reads of three)."""
    post_odometry: Odometry = START
    """Where the robot was when the frame with `post` was taken."""
    code: Sighting | None = None
    """The newest hand-over code (`CM1:…`) shown to the camera."""
    fixes: tuple[tuple[Fix, Odometry], ...] = ()
    """The newest of each other position source, and where the robot was by odometry when it came."""
    camera_age_s: float = 0.0
    """Age of the newest frame; above 1 s perception is degraded."""
    sent: WheelSpeeds = STOP
    """The speeds really sent last."""
    motion: str | None = None
    """Name of the skill that has the wheels now."""
    searching: bool = False
    """It has lost the line and looks for it."""
    faults: frozenset[str] = frozenset()
    """Names of the active faults (reflexes.FAULTS)."""
    find_line_episodes: int = 0
    bumps: int = 0
    """Bumps so far."""
    something_ahead_s: float = -math.inf
    """When the light bumpers last saw something ahead."""

    @property
    def heard_base(self) -> BaseState | None:
        """The newest frame of a base that speaks; a silent one is never told to be charging or docked."""
        return None if "base_silent" in self.faults else self.base


@dataclass(frozen=True, slots=True)
class SetMode:
    """Take or give back the wheels (Full only for the undock)."""

    mode: Mode


@dataclass(frozen=True, slots=True)
class SeekDock:
    """Let the firmware drive into the dock."""


@dataclass(frozen=True, slots=True)
class Play:
    """A few notes through the base's speaker."""

    notes: tuple[Note, ...]


@dataclass(frozen=True, slots=True)
class ShowLights:
    """The power light: colour 0 green to 1 red, brightness 0 to 1."""

    colour: float
    brightness: float


BaseRequest = SetMode | SeekDock | Play | ShowLights


@dataclass(frozen=True, slots=True)
class Running:
    """Go on. `wheels` None leaves them to the firmware (docking) or to no one (a skill that does not move)."""

    wheels: WheelSpeeds | None = None
    requests: tuple[BaseRequest, ...] = ()
    searching: bool = False
    """The line is lost and looked for: the loop counts these episodes."""


@dataclass(frozen=True, slots=True)
class Done:
    """Success. `result`: the post that was reached (follow_line). `shown`: the code that opens; None: the button was
    pressed (wait_handover)."""

    result: str | None = None
    requests: tuple[BaseRequest, ...] = ()
    pulse: WheelSpeeds | None = None
    """Speeds to keep for `pulse_s` unless another motion begins (the paper's `drive`)."""
    pulse_s: float = 0.0
    unread: bool = False
    """The post was reached by map and wheels alone: its marker could not be read (follow_line)."""
    shown: ShownCode | None = None


@dataclass(frozen=True, slots=True)
class Failed:
    """No success. `reason` is an atom of the agent language: busy, cancelled, timeout, line_lost, no_dock …"""

    reason: str
    requests: tuple[BaseRequest, ...] = ()


Outcome = Done | Failed
Step = Running | Done | Failed


class Skill(Protocol):
    """A long action. The loop calls `start` once, then `step` fifty times a second until it is not Running."""

    @property
    def name(self) -> str: ...

    @property
    def moves(self) -> bool:
        """Return whether it needs the wheels: only one such skill runs at a time."""
        ...

    @property
    def limit_s(self) -> float:
        """After so long the loop ends it with Failed(on_timeout)."""
        ...

    @property
    def on_timeout(self) -> str: ...

    def start(self, view: View, now: float) -> None: ...

    def step(self, view: View, now: float) -> Step: ...


@dataclass(frozen=True, slots=True)
class JobEnd:
    """The end of a job that `Body.start` gave out."""

    job: int
    skill: str
    outcome: Outcome
    at_s: float


class Body(Protocol):
    """The drive loop's interface for the mind. All of it may be called from any thread and returns at once."""

    def start(self, skill: Skill, now: float) -> int:
        """Begin a skill at the next tick; returns the job's id. Every job ends once, in `finished`."""
        ...

    def cancel(self, job: int) -> None:
        """Stop a job: it ends with Failed("cancelled"). A job that has ended is left alone."""
        ...

    def finished(self) -> tuple[JobEnd, ...]:
        """The jobs that ended since the last call."""
        ...

    def heartbeat(self, now: float) -> None:
        """The mind is alive. Without this for 1 s the reflexes stop the wheels."""
        ...

    def emergency_stop(self) -> None:
        """Latched until `rearm`."""
        ...

    def rearm(self) -> None:
        """A person has looked, and lets a robot go again that was stopped; so does the Spot button on it."""
        ...

    def link(self, online: bool) -> None:
        """Tell whether the service can be reached now. Not called at all by a robot that works alone."""
        ...

    @property
    def view(self) -> View: ...
