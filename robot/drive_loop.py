"""The fifty-times-a-second loop: base → line and odometry → the skill's speeds → reflexes → base.

It owns base and line sensor. Everything else talks to it through queues that never make it wait: the mind starts and
cancels skills, the camera loop reports what it read, and both read the latest `view`.
"""

import math
from collections import deque
from collections.abc import Callable, Container
from dataclasses import dataclass
from itertools import count

import structlog

from . import reflexes
from .drivers.interfaces import (
    STOP,
    Base,
    BaseState,
    BodyShape,
    CameraReport,
    LineSensor,
    Mode,
    Odometry,
    Sighting,
    WheelSpeeds,
)
from .drivers.odometry import advanced
from .navigation.line_symbol import LineWord
from .skills.interfaces import (
    BaseRequest,
    Done,
    Failed,
    JobEnd,
    Outcome,
    Play,
    Running,
    SeekDock,
    SetMode,
    ShowLights,
    Skill,
    View,
)
from .skills.tunes import BUMPED

log = structlog.get_logger("robot.drive")

STOPPING = frozenset(fault.name for fault in reflexes.FAULTS if fault.response is reflexes.Response.STOP)
PAUSING = STOPPING | {"bump"}
OFF_DOCK_S = 2.0
"""Contacts bounce: only after so long without power is the robot off its dock."""


@dataclass
class Job:
    """A skill under way."""

    number: int
    skill: Skill
    until_s: float
    wheels: WheelSpeeds | None = STOP
    searching: bool = False


class DriveLoop:
    """See `skills.interfaces.Body` for what other threads may call; `tick` belongs to one thread alone."""

    def __init__(
        self,
        base: Base,
        line_sensor: LineSensor,
        shape: BodyShape | None = None,
        now: float = 0.0,
        faults_before: Container[str] = (),
    ) -> None:
        """`faults_before`: what was wrong when the daemon last ran; an emergency stop outlives a restart."""
        self._base, self._line_sensor, self._shape = base, line_sensor, shape or BodyShape()
        self._inbox: deque[Callable[[float], None]] = deque()
        self._finished: deque[JobEnd] = deque()
        self._numbers = count(1)
        self._jobs: dict[int, Job] = {}
        self._motion: Job | None = None
        self._pulse, self._pulse_until_s = STOP, -math.inf
        self._mode = Mode.PASSIVE
        self._docked_s = now
        self._heartbeat_s = now
        self._stop_asked = self._rearm = False
        self._reflexes = reflexes.ReflexState.woken(faults_before, now)
        self._faults: frozenset[str] = frozenset()
        self._state: BaseState | None = None
        self._odometry = Odometry()
        self._word = LineWord()
        self._post: Sighting | None = None
        self._post_odometry = Odometry()
        self._code: Sighting | None = None
        self._camera_s, self._camera_age_s = now, 0.0
        self._sent = STOP
        self._bumps = 0
        self._episodes = 0
        self.view = View(at_s=now)

    # For every thread

    def start(self, skill: Skill, now: float) -> int:
        """See `Body.start`."""
        number = next(self._numbers)
        self._inbox.append(lambda tick_s: self._begin(number, skill, tick_s))
        return number

    def cancel(self, job: int) -> None:
        """See `Body.cancel`."""
        self._inbox.append(lambda tick_s: self._end(job, Failed("cancelled"), tick_s))

    def finished(self) -> tuple[JobEnd, ...]:
        """See `Body.finished`."""
        ends = []
        while self._finished:
            ends.append(self._finished.popleft())
        return tuple(ends)

    def heartbeat(self, now: float) -> None:
        """See `Body.heartbeat`."""
        self._heartbeat_s = now

    def emergency_stop(self) -> None:
        """See `Body.emergency_stop`."""
        self._inbox.append(lambda _: self._take_stop(True))

    def rearm(self) -> None:
        """See `Body.rearm`."""
        self._inbox.append(lambda _: self._take_stop(False))

    def report(self, report: CameraReport, now: float) -> None:
        """What the camera loop read in one frame."""
        self._inbox.append(lambda _: self._take_report(report, now))

    def sample_line(self) -> None:
        """One more look at the diodes between two ticks, for the majority vote; called from the thread of `tick`."""
        self._line_sensor.sample()

    # The loop

    def tick(self, now: float) -> None:
        """One fiftieth of a second."""
        self._sense(now)
        while self._inbox:
            self._inbox.popleft()(now)
        self.view = view = self._look(now)
        wanted = self._step_jobs(view, now)
        self._choose_mode(now)
        decision = reflexes.decide(self._reflexes, self._senses(now), wanted or STOP, now)
        self._reflexes, self._rearm = decision.state, False
        self._note_faults(decision.faults, now)
        self._sent = self._drive(wanted, decision.allowed, now)

    def _sense(self, now: float) -> None:
        new = self._base.poll(now)
        if new is not None:
            old = self._state or new
            self._odometry = advanced(self._odometry, old, new, self._shape)
            self._state = new
        self._line_sensor.sample()
        reading = self._line_sensor.read()
        self._reading = reading
        self._word = self._word.seen(reading, self._odometry.travelled_mm)

    def _look(self, now: float) -> View:
        return View(
            at_s=now,
            base=self._state,
            reading=self._reading,
            line=self._word.word,
            odometry=self._odometry,
            post=self._post,
            post_odometry=self._post_odometry,
            code=self._code,
            camera_age_s=self._camera_age_s + max(0.0, now - self._camera_s),
            sent=self._sent,
            motion=self._motion.skill.name if self._motion else None,
            searching=self._motion.searching if self._motion else False,
            faults=self._faults,
            find_line_episodes=self._episodes,
            bumps=self._bumps,
        )

    def _senses(self, now: float) -> reflexes.Senses:
        state = self._state
        return reflexes.Senses(
            base=state,
            base_age_s=now - state.at_s if state else math.inf,
            mind_age_s=now - self._heartbeat_s,
            camera_age_s=self.view.camera_age_s,
            stop_asked=self._stop_asked,
            rearm=self._rearm,
            own_wheels=self._mode is not Mode.PASSIVE,
        )

    def _note_faults(self, faults: frozenset[str], now: float) -> None:
        new = faults - self._faults
        self._faults = faults
        if "bump" in new:
            self._bumps += 1
            self._base.play(BUMPED, now)

    def _drive(self, wanted: WheelSpeeds | None, allowed: WheelSpeeds, now: float) -> WheelSpeeds:
        """None: the firmware drives, unless a fault takes the wheels from it."""
        stopped = self._faults & STOPPING
        if wanted is None and stopped and self._motion:
            self._end(self._motion.number, Failed(min(stopped)), now)
        elif wanted is None:
            return STOP
        if stopped:
            self._take_wheels(now)
        if self._mode is Mode.PASSIVE and not allowed.still:
            self._request(SetMode(Mode.SAFE), now)
        return self._base.drive(allowed, now)

    def _take_wheels(self, now: float) -> None:
        """From the firmware, which in Passive docks on, or cleans because somebody pressed Clean."""
        if self._mode is Mode.PASSIVE and self._state is not None:
            self._request(SetMode(Mode.SAFE), now)

    def _choose_mode(self, now: float) -> None:
        """At rest: Passive on the dock, or it would not charge; Safe elsewhere, or a button would start to clean."""
        state = self._state
        if state is None or self._motion is not None or self._faults & STOPPING:
            self._docked_s = now
        elif state.docked:
            self._docked_s = now
            if self._mode is not Mode.PASSIVE:
                self._request(SetMode(Mode.PASSIVE), now)
        elif self._mode is not Mode.SAFE and now - self._docked_s > OFF_DOCK_S:
            self._request(SetMode(Mode.SAFE), now)

    # Jobs

    def _begin(self, number: int, skill: Skill, now: float) -> None:
        job = Job(number, skill, now + skill.limit_s)
        if skill.moves and self._motion is not None:
            self._finished.append(JobEnd(number, skill.name, Failed("busy"), now))
            return
        self._jobs[number] = job
        if skill.moves:
            self._motion = job
        try:
            skill.start(self._look(now), now)
        except Exception:
            self._end(number, _broken(skill), now)

    def _end(self, number: int, outcome: Outcome, now: float) -> None:
        job = self._jobs.pop(number, None)
        if job is None:
            return
        if job is self._motion:
            self._motion = None
            self._pulse_until_s = -math.inf
            if job.wheels is None and not isinstance(outcome, Done):
                self._take_wheels(now)
        for request in outcome.requests:
            self._request(request, now)
        self._finished.append(JobEnd(number, job.skill.name, outcome, now))

    def _step_jobs(self, view: View, now: float) -> WheelSpeeds | None:
        for job in tuple(self._jobs.values()):
            if now > job.until_s:
                self._end(job.number, Failed(job.skill.on_timeout), now)
            elif job is not self._motion or job.wheels is None or not self._faults & PAUSING:
                # A motion waits while a reflex holds the wheels: what it sees then is not its own doing.
                self._step_job(job, view, now)
        if self._motion is not None:
            return self._motion.wheels
        return self._pulse if now < self._pulse_until_s else STOP

    def _step_job(self, job: Job, view: View, now: float) -> None:
        try:
            step = job.skill.step(view, now)
        except Exception:
            step = _broken(job.skill)
        if not isinstance(step, Running):
            self._end(job.number, step, now)
            if isinstance(step, Done) and step.pulse is not None:
                self._pulse, self._pulse_until_s = step.pulse, now + step.pulse_s
            return
        for request in step.requests:
            self._request(request, now)
        job.wheels = step.wheels
        self._episodes += step.searching and not job.searching
        job.searching = step.searching

    def _request(self, request: BaseRequest, now: float) -> None:
        match request:
            case SetMode(mode):
                self._mode = mode
                self._base.set_mode(mode, now)
            case SeekDock():
                self._mode = Mode.PASSIVE
                self._base.seek_dock(now)
            case Play(notes):
                self._base.play(notes, now)
            case ShowLights(colour, brightness):
                self._base.show_lights(colour, brightness, now)

    def _take_stop(self, asked: bool) -> None:
        self._stop_asked, self._rearm = asked, not asked

    def _take_report(self, report: CameraReport, now: float) -> None:
        self._camera_s, self._camera_age_s = now, report.frame_age_s
        for sighting in report.posts:
            self._post, self._post_odometry = sighting, self._odometry
        for sighting in report.codes:
            self._code = sighting


def _broken(skill: Skill) -> Failed:
    """A mistake in a skill ends the skill, never the loop that keeps the wheels."""
    log.exception("skill_broken", skill=skill.name)
    return Failed("broken")
