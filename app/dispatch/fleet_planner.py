"""Assignment by the schedule: decided at once for all robots, then improved.

look → decide → write → tell the schedule
look → decide → improve, in a process of its own → write, if it still holds → tell the schedule
"""

import asyncio
from contextlib import suppress
from datetime import timedelta
from random import Random
from typing import Final

import structlog

from app.dispatch.assignment_problem import ProblemOfWork
from app.dispatch.charge_limits import Charges
from app.dispatch.given_out import Changes, changes_of, give_out
from app.dispatch.open_work import OpenWork, read_open_work
from app.dispatch.planner_process import PlannerProcess
from app.dispatch.why_orders_wait import NOT_PLANNED_FOR, answers
from app.dispatch.why_recorded import explain
from app.robots.service import Fleet
from app.traffic.schedule import TrafficSchedule
from app.traffic.service import TrafficService
from fleet.assignment.adopting import adopt
from fleet.assignment.comes_next import Likely, foresee
from fleet.assignment.cost import SLACK_S
from fleet.assignment.deciding import Decision
from fleet.eta.arrivals import FreeRobot

IMPROVE_EVERY_S: Final = 30.0
"""Real seconds. Also when nothing was given: robots have moved since."""
PLANNING_BUDGET_S: Final = 0.25
"""Real seconds: so long a better plan is searched for at a time, in the planner's process."""
REST_S: Final = 1.0
"""Real seconds, after each improvement: there is other work for this machine."""

log = structlog.get_logger(__name__)


class FleetPlanner:
    """`left`: so many orders found no robot at the last look; `own`: orders that are being given here.

    It assigns when dispatch asks it to, and runs in the background of the service to find better plans."""

    def __init__(self, fleet: Fleet, desk: TrafficService, process: PlannerProcess | None = None) -> None:
        self._fleet, self._desk = fleet, desk
        self._scenes = ProblemOfWork(
            fleet.settings, Charges(fleet.orders.ledger.ways, fleet.settings, fleet.spending.rates)
        )
        self._process = process or PlannerProcess()
        self._rng = Random(0)
        self._planned: frozenset[str] = frozenset()
        self._something_new = asyncio.Event()
        self._stopped = asyncio.Event()
        self.left = 0
        self.own: set[str] = set()

    # At once.

    async def assign(self) -> bool:
        """Give waiting orders to robots; whether to look again at once, since what was decided on has changed."""
        work, schedule = await self._look(), self._desk.schedule
        waiting = [order.id for order in work.waiting]
        decision = await self._decide(work, schedule) if schedule is not None and work.connected else None
        changes = changes_of(work, decision) if decision is not None else None
        if decision is not None and changes and not await self._carry_out(schedule, decision, changes):
            return True
        left = [order for order in waiting if changes is None or order not in changes.given]
        likely = await self._foresee(work, decision if left else None)
        if left:
            has_news = _has_not_seen(schedule, work)
            told = await asyncio.to_thread(answers, work, decision, left, likely)
            await explain(self._fleet, [one for one in told if not (has_news and one.why == NOT_PLANNED_FOR)])
        if changes:
            self._something_new.set()
        self.left = len(left)
        return False

    async def _look(self) -> OpenWork:
        async with self._fleet.database.reading() as session:
            return await read_open_work(session, self._fleet.clock.utc())

    async def _decide(self, work: OpenWork, schedule: TrafficSchedule) -> Decision | None:
        clock = self._fleet.clock
        async with self._desk.in_turn:
            problem = await asyncio.to_thread(self._scenes.of, work, schedule.controller, clock.utc(), clock.now())
        return await self._process.decided(problem, self._rng)

    async def _foresee(self, work: OpenWork, decision: Decision | None) -> Likely:
        """What is likely after a decision that leaves orders waiting: by it the next ones are told a time, too."""
        found = Likely({}, {}) if decision is None else await asyncio.to_thread(foresee, decision, work.able)
        now = self._fleet.clock.utc()
        self._fleet.orders.ledger.estimates.free = [
            FreeRobot(now + timedelta(seconds=in_s), post) for in_s, post in found.free.values()
        ]
        return found

    async def _carry_out(self, schedule: TrafficSchedule | None, decision: Decision, changes: Changes) -> bool:
        """False if it does not hold any more."""
        try:
            async with self._fleet.database.transaction() as session:
                if not await give_out(session, self._fleet, changes, self.own):
                    return False
        finally:
            self.own.clear()
        # Else the schedule finds a way of its own to what robots have now before them, as after a restart.
        if schedule is not None and not changes.taken:
            await self._adopt(schedule, decision)
        return True

    async def _adopt(self, schedule: TrafficSchedule, decision: Decision) -> bool:
        """False if it cannot be carried out any more."""
        async with self._desk.in_turn:
            if schedule is not self._desk.schedule:
                return False
            now_s = self._fleet.clock.now()
            return await asyncio.to_thread(adopt, schedule.controller, decision, schedule.known, now_s)

    # And better.

    def notice(self) -> None:
        """A robot that cannot be planned for any more: what it has not loaded is for others."""
        schedule = self._desk.schedule
        planned = frozenset(schedule.controller.can_be_planned()) if schedule else self._planned
        if planned != self._planned:
            self._planned = planned
            self._something_new.set()

    def stop(self) -> None:
        """End `run` after what it is doing."""
        self._stopped.set()
        self._something_new.set()
        self._process.cut_off()

    async def run(self) -> None:
        """Until stopped or cancelled."""
        try:
            while not self._stopped.is_set():
                with suppress(TimeoutError):
                    async with asyncio.timeout(IMPROVE_EVERY_S):
                        await self._something_new.wait()
                self._something_new.clear()
                if not self._stopped.is_set():
                    await self.improve()
                    with suppress(TimeoutError):
                        async with asyncio.timeout(REST_S):
                            await self._stopped.wait()
        finally:
            await self._process.end()

    async def improve(self) -> bool:
        """Look for a better plan within the budget; whether one was found, and could still be carried out."""
        schedule = self._desk.schedule
        if schedule is None:
            return False
        work = await self._look()
        decision = await self._decide(work, schedule)
        if decision is None:
            return False
        better = await self._improved(decision)
        if self._stopped.is_set():
            return False
        changes = changes_of(work, better)
        if not changes:
            return await self._goes_by_now(schedule, decision, better)
        is_written = await self._carry_out(schedule, better, changes)
        log.info("improved", is_written=is_written, taken=len(changes.taken), saves_s=decision.cost_s - better.cost_s)
        return is_written

    async def _goes_by_now(self, schedule: TrafficSchedule, decision: Decision, better: Decision) -> bool:
        """Every order stays with its robot, and only the timetable is another: nothing of that is written down."""
        is_adopted = better.cost_s < decision.cost_s - SLACK_S and await self._adopt(schedule, better)
        if is_adopted:
            self._desk.wake()
            log.info("timetable_improved", saves_s=decision.cost_s - better.cost_s)
        return is_adopted

    async def _improved(self, decision: Decision) -> Decision:
        """The same, if there is nothing to choose from."""
        if len(decision.routes) < 2 or len(decision.robot_of()) < 2:
            return decision
        return await self._process.improved(decision, PLANNING_BUDGET_S) or decision


def _has_not_seen(schedule: TrafficSchedule | None, work: OpenWork) -> bool:
    """Tell if a robot has come that the schedule knows from its next poll on, which wakes dispatch: that none can be
    planned for is not so before."""
    return schedule is not None and any(
        robot.is_there for name, robot in work.robots.items() if name not in schedule.known
    )
