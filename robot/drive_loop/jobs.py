"""Skills under way: begun, stepped, ended. Every job ends once; a mistake in a skill ends the skill alone."""

import math
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from itertools import count

import structlog

from robot.drivers.interfaces import STOP, WheelSpeeds
from robot.skills.interfaces import BaseRequest, Done, Failed, JobEnd, Outcome, Running, Skill, View

log = structlog.get_logger("robot.drive")

REFUSED_S = 3.0
"""A motion that may not go where it wants for so long fails with the name of what refuses."""
Request = Callable[[BaseRequest, float], None]
Note = Callable[[str, float, object], None]


@dataclass
class Job:
    """A skill under way."""

    number: int
    skill: Skill
    until_s: float
    wheels: WheelSpeeds | None = STOP
    searching: bool = False
    refused_since_s: float | None = None


class Jobs:
    """`request` carries out what skills ask of the base, `take_wheels` ends what the firmware was asked to do, `note`
    is told of each beginning and end."""

    def __init__(self, request: Request, take_wheels: Callable[[float], None], note: Note) -> None:
        self._request, self._take_wheels, self._note = request, take_wheels, note
        self._finished: deque[JobEnd] = deque()
        self._numbers = count(1)
        self._jobs: dict[int, Job] = {}
        self.motion: Job | None = None
        self._pulse, self._pulse_until_s = STOP, -math.inf
        self.episodes = 0
        """Times that the line was lost and looked for."""

    def next_number(self) -> int:
        return next(self._numbers)

    def finished(self) -> tuple[JobEnd, ...]:
        """Those that ended since the last call; from any thread."""
        ends = []
        while self._finished:
            ends.append(self._finished.popleft())
        return tuple(ends)

    def begin(self, number: int, skill: Skill, view: View, now: float) -> None:
        job = Job(number, skill, now + skill.limit_s)
        if skill.moves and self.motion is not None:
            self._finish(JobEnd(number, skill.name, Failed("busy"), now))
            return
        self._note("job", now, f"{number} {skill.name} begins")
        self._jobs[number] = job
        if skill.moves:
            self.motion = job
        try:
            skill.start(view, now)
        except Exception:
            self.end(number, _broken(skill), now)

    def end(self, number: int, outcome: Outcome, now: float) -> None:
        job = self._jobs.pop(number, None)
        if job is None:
            return
        if job is self.motion:
            self.motion = None
            self._pulse_until_s = -math.inf
            if job.wheels is None and not isinstance(outcome, Done):
                self._take_wheels(now)
        for request in outcome.requests:
            self._request(request, now)
        self._finish(JobEnd(number, job.skill.name, outcome, now))

    def _finish(self, end: JobEnd) -> None:
        self._finished.append(end)
        word = end.outcome.reason if isinstance(end.outcome, Failed) else "done"
        self._note("job", end.at_s, f"{end.job} {end.skill} {word}")

    def step(self, view: View, held: bool, now: float) -> WheelSpeeds | None:
        """The speeds that are wanted; None: the firmware drives.

        A motion of ours waits while a reflex holds the wheels: what it sees then is not its own doing.
        """
        for job in tuple(self._jobs.values()):
            if now > job.until_s:
                self.end(job.number, Failed(job.skill.on_timeout), now)
            elif job is not self.motion or job.wheels is None or not held:
                self._step(job, view, now)
            else:
                # What it wanted before is old when the reflex lets go: it would twitch before it has looked again.
                job.wheels = STOP
        if self.motion is not None:
            return self.motion.wheels
        return self._pulse if now < self._pulse_until_s else STOP

    def _step(self, job: Job, view: View, now: float) -> None:
        try:
            step = job.skill.step(view, now)
            _refuse_nonsense(step)
        except Exception:
            step = _broken(job.skill)
        if not isinstance(step, Running):
            self.end(job.number, step, now)
            if isinstance(step, Done) and step.pulse is not None:
                self._pulse, self._pulse_until_s = step.pulse, now + step.pulse_s
            return
        for request in step.requests:
            self._request(request, now)
        job.wheels = step.wheels
        self.episodes += step.searching and not job.searching
        job.searching = step.searching

    def refused(self, by: str | None, now: float) -> None:
        """The motion may not go where it wants, because of this fault; None: it may."""
        job = self.motion
        if job is None or by is None:
            if job is not None:
                job.refused_since_s = None
        elif job.refused_since_s is None:
            job.refused_since_s = now
        elif now - job.refused_since_s >= REFUSED_S:
            self.end(job.number, Failed(by), now)


def _refuse_nonsense(step: Outcome | Running) -> None:
    """A speed that is no number must not get as far as the base."""
    wheels = step.wheels if isinstance(step, Running) else None
    if wheels is not None and not (math.isfinite(wheels.left_mm_s) and math.isfinite(wheels.right_mm_s)):
        raise ValueError(f"wheels at {wheels}")


def _broken(skill: Skill) -> Failed:
    log.exception("skill_broken", skill=skill.name)
    return Failed("broken")
