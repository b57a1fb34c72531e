"""One run in stepped time with everything that section 6.4 of the paper looks at written down."""

import time
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory
from typing import Any

from bdi import Agent
from bdi.debug.trace import Deliberated, TraceEntry
from bdi.language.syntax import Plan, Trigger
from bdi.language.terms import Literal
from benchmarks.paper.contenders import SIMULATED_LINE_HZ, Contender
from benchmarks.paper.stages import Stage, Stages
from protocol.clock import SteppedClock
from robot.ops.assembly import Parts
from robot.ops.runners import LockstepRunner

LIMIT_S = 1800.0
"""A run that has not delivered by then is lost: the way is 12 m, a charge takes a good minute."""
GIVEN_UP_S = 10.0
"""A program that has had nothing to do for so long has given up. (Ours is quiet while it charges.)"""
LOW_RATIO = 0.2
LOW_AFTER_S = (5.0, 20.0)
SPIRAL = "drive(spiral)"
SHOWN_WITH_ARGUMENT = ("drive", "turn", "station")


@dataclass
class Log:
    """Times are of the simulated clock, but for `cycle_ms`, what a reasoning cycle computed on this machine.

    Plans and actions are counted while the robot is not in a dock: waiting there is no delivery.
    """

    seed: int
    delivered: bool = False
    reason: str | None = None
    time_s: float = 0.0
    docked_s: float = 0.0
    driving_s: float = 0.0
    looking_s: float = 0.0
    """Time spent looking for the line: pulses of drive(spiral), or the skill find_line."""
    driven_m: float = 0.0
    posts: tuple[str, ...] = ()
    cycle_ms: list[float] = field(default_factory=list)
    plans: Counter[str] = field(default_factory=Counter)
    actions: Counter[str] = field(default_factory=Counter)
    stages: list[Stage] = field(default_factory=list)


class TimedAgent:
    """The agent; the time that each of its cycles computes goes into `cycle_ms`, its actions into `acted`."""

    def __init__(self, agent: Agent, cycle_ms: list[float], clock: Callable[[], float] = time.thread_time) -> None:
        """`clock` is in seconds: the thread's own, which stands while others have their turn, unless told otherwise."""
        self._agent, self._cycle_ms, self._clock = agent, cycle_ms, clock
        self.acted: list[str] = []

    def cycle(self, *arguments: Any) -> Any:
        began_s = self._clock()
        outcome = self._agent.cycle(*arguments)
        self._cycle_ms.append((self._clock() - began_s) * 1e3)
        self.acted += [action_name(action.term) for action in outcome.actions]
        return outcome

    def __getattr__(self, name: str) -> Any:
        return getattr(self._agent, name)


def logged(contender: Contender, seed: int, limit_s: float = LIMIT_S) -> Log:
    clock = SteppedClock()
    with TemporaryDirectory(prefix="paper-") as folder:
        rate = {"rates.line_hz": SIMULATED_LINE_HZ}
        parts = contender.assembled(Path(folder), clock, seed, in_memory=True, **rate)
        runner = LockstepRunner(parts.daemon.loops(), clock)
        logger = _Logger(contender, parts, seed, runner, limit_s)
        parts.daemon.watchers = (*parts.daemon.watchers, logger.look)
        runner.run()
        parts.daemon.close(runner.now_s)
    return logger.log


class _Logger:
    def __init__(self, contender: Contender, parts: Parts, seed: int, runner: LockstepRunner, limit_s: float) -> None:
        assert parts.robot is not None
        self.log, self._limit_s = Log(seed), limit_s
        self._contender, self._parts, self._robot, self._runner = contender, parts, parts.robot, runner
        self._agent = TimedAgent(parts.mind.agent, self.log.cycle_ms)
        parts.mind.agent.listen(self._heard)
        parts.mind.agent = self._agent  # type: ignore[assignment]  # it does whatever the agent does
        self._tick_s = 1 / parts.daemon.rates.mind_hz
        self._low_after_s = Random(f"{seed}/low").uniform(*LOW_AFTER_S)
        self._collected_s: float | None = None
        self._busy_s = 0.0
        self._was_low = False
        self._stages = Stages(contender, parts, self.log.stages)

    def _heard(self, entry: TraceEntry) -> None:
        if isinstance(entry, Deliberated) and entry.plan and not self._robot.docked:
            self.log.plans[plan_name(entry.plan.plan)] += 1

    def look(self, now: float) -> None:
        """After each tick of the mind."""
        log, view = self.log, self._parts.mind.hands.view
        docked, acted = self._robot.docked, self._take_acted()
        log.docked_s += docked * self._tick_s
        log.driving_s += (not view.sent.still) * self._tick_s
        log.looking_s += (view.searching or SPIRAL in acted) * self._tick_s
        if not docked:
            log.actions.update(acted)
        if not self._parts.mind.is_quiet:
            self._busy_s = now
        self._let_battery_sag(now)
        self._stages.look(now, self._was_low)
        if self._contender.has_delivered(self._parts):
            self._end(now, None)
        elif self._contender.program and now - self._busy_s >= GIVEN_UP_S:
            self._end(now, f"given up: {self._parts.mind.failures[-1:]}")
        elif now >= self._limit_s:
            self._end(now, f"not delivered in {self._limit_s:g} s")

    def _take_acted(self) -> list[str]:
        acted, self._agent.acted = self._agent.acted, []
        return acted

    def _let_battery_sag(self, now: float) -> None:
        if self._collected_s is None and self._contender.has_collected(self._parts):
            self._collected_s = now
        if self._collected_s is not None and not self._was_low and now >= self._collected_s + self._low_after_s:
            self._was_low = True
            self._robot.sag(LOW_RATIO)

    def _end(self, now: float, reason: str | None) -> None:
        log = self.log
        log.delivered, log.reason, log.time_s = reason is None, reason, now
        log.posts, log.driven_m = tuple(self._parts.navigator.visited), self._robot.driven_mm / 1000
        self._runner.stop()


def plan_name(plan: Plan) -> str:
    """The goal or belief that a plan is for; what stands without a context or counts a watchdog is said."""
    head = plan.head.functor if isinstance(plan.head, Literal) else str(plan.head)
    name = f"{plan.trigger.value}{head}"
    if plan.trigger is Trigger.GOAL_ADDED and "WATCHDOG" in str(plan.context):
        return f"{name} (watchdog)"
    return name if plan.context is not None or plan.trigger is not Trigger.GOAL_ADDED else f"{name} (no context)"


def action_name(term: Any) -> str:
    return str(term) if term.functor in SHOWN_WITH_ARGUMENT else str(term.functor)
