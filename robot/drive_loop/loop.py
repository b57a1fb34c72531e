"""The fifty-times-a-second loop: base → line and odometry → the skill's speeds → reflexes → base.

It owns base and line sensor. Everything else talks to it through queues that never make it wait: the mind starts and
cancels skills, the camera loop reports what it read, and both read the latest `view`.
"""

from collections import deque
from collections.abc import Callable, Container, Iterable

from robot import reflexes
from robot.drive_loop.black_box import BlackBox
from robot.drive_loop.jobs import Jobs
from robot.drive_loop.sensing import Sensing
from robot.drive_loop.wheels import Wheels
from robot.drivers.create2.wheel_speeds import DEADLINE_S
from robot.drivers.interfaces import (
    STOP,
    Base,
    BodyShape,
    CameraReport,
    HostReport,
    LineSensor,
    PositionSource,
    WheelSpeeds,
)
from robot.skills.interfaces import Failed, JobEnd, Skill, View

PERIOD_S = 0.02
LATE_PERIODS = 3
GAP_S = DEADLINE_S
"""The loop was away for longer than a speed is valid: the driver has stopped the wheels, and what a skill wants now
rests on a leap of the encoders."""
STAND_AFTER_GAP_S = 0.3
DUMP_AFTER_S = 1.0
"""The black box is written so long after a stop, so that it holds how the robot came to stand."""


class DriveLoop:
    """See `skills.interfaces.Body` for what other threads may call; `tick` belongs to one thread alone."""

    def __init__(
        self,
        base: Base,
        line_sensor: LineSensor,
        shape: BodyShape | None = None,
        now: float = 0.0,
        faults_before: Container[str] = (),
        period_s: float = PERIOD_S,
        black_box: BlackBox | None = None,
        sources: Iterable[PositionSource] = (),
    ) -> None:
        """`faults_before`: what was wrong when the daemon last ran; an emergency stop outlives a restart."""
        self._sensing = Sensing(base, line_sensor, shape or BodyShape(), now, sources)
        self._wheels = Wheels(base, now)
        self._black_box = black_box or BlackBox()
        take_wheels = lambda at_s: self._wheels.take(self._sensing.state, at_s)  # noqa: E731
        self._jobs = Jobs(self._wheels.request, take_wheels, self._black_box.note)
        self._inbox: deque[Callable[[float], None]] = deque()
        self._heartbeat_s = now
        self._offline_since_s: float | None = None
        self._host = HostReport()
        self._stop_asked = self._rearm = False
        self._reflexes = reflexes.ReflexState.woken(faults_before, now)
        self._faults: frozenset[str] = frozenset()
        self._stopping: frozenset[str] = frozenset()
        self._sent = STOP
        self._bumps = 0
        self._late_s = LATE_PERIODS * period_s
        self._ticked_s: float | None = None
        self._stand_until_s = now
        self.late_ticks, self.worst_gap_s = 0, 0.0
        self.view = View(at_s=now)

    # For every thread

    def start(self, skill: Skill, now: float) -> int:
        """See `Body.start`."""
        number = self._jobs.next_number()
        self._inbox.append(lambda tick_s: self._begin(number, skill, tick_s))
        return number

    def cancel(self, job: int) -> None:
        """See `Body.cancel`."""
        self._inbox.append(lambda tick_s: self._jobs.end(job, Failed("cancelled"), tick_s))

    def finished(self) -> tuple[JobEnd, ...]:
        """See `Body.finished`."""
        return self._jobs.finished()

    def heartbeat(self, now: float) -> None:
        """See `Body.heartbeat`."""
        self._heartbeat_s = now

    def emergency_stop(self) -> None:
        """See `Body.emergency_stop`."""
        self._inbox.append(lambda _: self._take_stop())

    def rearm(self) -> None:
        """See `Body.rearm`."""
        self._inbox.append(lambda _: self._take_rearm())

    def link(self, online: bool) -> None:
        """See `Body.link`."""
        self._inbox.append(lambda tick_s: self._take_link(online, tick_s))

    def report(self, report: CameraReport, now: float) -> None:
        """Take in the camera loop's reading of one frame."""
        self._inbox.append(lambda _: self._sensing.take_report(report, now))

    def report_host(self, report: HostReport) -> None:
        """Hand in a reading of the computer's own state."""
        self._inbox.append(lambda _: self._take_host(report))

    def sample_line(self) -> None:
        """One more look at the diodes between two ticks, for the majority vote; called from the thread of `tick`."""
        self._sensing.sample_line()

    @property
    def impossible_reads(self) -> int:
        """Patterns of the diodes so far that no tape makes, for the technician who looks after the sensor."""
        return self._sensing.lasting.impossible_reads

    # The loop

    def tick(self, now: float) -> None:
        """One fiftieth of a second."""
        self._note_lateness(now)
        self._sensing.sense(self._sent, now)
        while self._inbox:
            self._inbox.popleft()(now)
        before, self.view = self.view, self._look(now)
        view = self.view
        self._note_line(view, before)
        # A bump's reflex holds the wheels as a stop does, but leaves them to the firmware.
        held = bool(self._stopping) or "bump" in self._faults or now < self._stand_until_s
        wanted = self._jobs.step(view, held, now)
        if wanted is not None and (now < self._stand_until_s or view.base is None):
            wanted = STOP
        if self._jobs.motion is None:
            self._wheels.rest(self._sensing.state, bool(self._stopping), now)
        else:
            self._wheels.not_at_rest(now)
        decision = reflexes.decide(self._reflexes, self._senses(now), wanted or STOP, now)
        self._reflexes, self._stop_asked, self._rearm = decision.state, False, False
        if decision.faults is not self._faults:
            self._note_faults(decision, now)
        self._sent = self._drive(wanted, decision.allowed, now)
        self._wheels.sound(self._sensing.state, now)
        self._black_box.write_what_is_due(now)

    def _note_line(self, view: View, before: View) -> None:
        if view.reading != before.reading:
            self._black_box.note("line", view.at_s, view.reading.pattern)

    def _note_lateness(self, now: float) -> None:
        gap_s = now - self._ticked_s if self._ticked_s is not None else 0.0
        self._ticked_s = now
        if gap_s <= self._late_s:
            return
        self.late_ticks += 1
        self.worst_gap_s = max(self.worst_gap_s, gap_s)
        self._black_box.note("late", now, gap_s)
        if gap_s > max(GAP_S, self._late_s):
            self._stand_until_s = now + STAND_AFTER_GAP_S

    def _look(self, now: float) -> View:
        sensing, motion = self._sensing, self._jobs.motion
        return View(
            at_s=now,
            base=sensing.state,
            reading=sensing.reading,
            line=sensing.word.word,
            odometry=sensing.odometry,
            post=sensing.post,
            post_odometry=sensing.post_odometry,
            code=sensing.code,
            fixes=tuple(sensing.fixes.values()),
            camera_age_s=sensing.camera_age_s(now),
            sent=self._sent,
            motion=motion.skill.name if motion else None,
            searching=motion.searching if motion else False,
            faults=self._faults,
            find_line_episodes=self._jobs.episodes,
            bumps=self._bumps,
            something_ahead_s=sensing.something_ahead_s,
        )

    def _senses(self, now: float) -> reflexes.Senses:
        sensing, lasting = self._sensing, self._sensing.lasting
        senses = reflexes.Senses(
            base=sensing.state,
            base_age_s=sensing.base_age_s(now),
            mind_age_s=now - self._heartbeat_s,
            camera_age_s=self.view.camera_age_s,
            camera_frozen_s=sensing.camera_frozen_s,
            stop_asked=self._stop_asked,
            rearm=self._rearm or sensing.spot_went_down,
            own_wheels=self._wheels.own,
            host=self._host,
            offline_s=0.0 if self._offline_since_s is None else now - self._offline_since_s,
            standing=lasting.standing,
            slipping_s=lasting.slipping_s,
            constant_mm=lasting.constant_mm,
            impossible_mm=lasting.impossible_mm,
            sees_line=any(sensing.reading),
            diodes_broken=sensing.diodes_broken,
        )
        if senses.rearm:
            lasting.start_again()
        return senses

    def _note_faults(self, decision: reflexes.Decision, now: float) -> None:
        new = decision.faults - self._faults
        if decision.faults != self._faults:
            self._black_box.note("faults", now, tuple(sorted(decision.faults)))
        self._faults, self._stopping = decision.faults, decision.stopping
        if "bump" in new:
            self._bumps += 1
            self._wheels.beep(now)
        for name in new & reflexes.STOPPING:
            self._black_box.write_at(now + DUMP_AFTER_S, name)

    def _drive(self, wanted: WheelSpeeds | None, allowed: WheelSpeeds, now: float) -> WheelSpeeds:
        """None: the firmware drives, unless a fault takes the wheels from it."""
        motion = self._jobs.motion
        if wanted is None and self._stopping and motion:
            self._jobs.end(motion.number, Failed(min(self._stopping)), now)
        elif wanted is None:
            return STOP
        self._jobs.refused(self._refusing(wanted, allowed), now)
        if self._stopping and (self._stopping & reflexes.LATCHED or not self._in_dock):
            # A mind that is silent in the dock is no reason to end the charge; a hand on Clean is: it begins to clean.
            self._wheels.take(self._sensing.state, now)
        return self._wheels.drive(allowed, now)

    @property
    def _in_dock(self) -> bool:
        return self._sensing.state is not None and self._sensing.state.docked

    def _refusing(self, wanted: WheelSpeeds | None, allowed: WheelSpeeds) -> str | None:
        if self._faults and wanted != allowed and not self._stopping and "bump" not in self._faults:
            return next((name for name in reflexes.REFUSING if name in self._faults), None)
        return None

    def _begin(self, number: int, skill: Skill, now: float) -> None:
        self._jobs.begin(number, skill, self._look(now), now)

    def _take_stop(self) -> None:
        self._stop_asked = True

    def _take_rearm(self) -> None:
        """A stop holds against a re-arm in the same tick: the sender of the re-arm did not see it."""
        self._rearm = True

    def _take_host(self, report: HostReport) -> None:
        self._host = report

    def _take_link(self, online: bool, now: float) -> None:
        if online:
            self._offline_since_s = None
        elif self._offline_since_s is None:
            self._offline_since_s = now
