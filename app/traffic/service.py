"""Answers the claims of robots by the schedule: at once, or when the corridor is free. Woken after commits.

What robots say is written down by the intake; here it is looked at, and what follows is written in one transaction. If
that fails the schedule is made anew from the database, so that it never knows of a grant that was not given.
"""

import asyncio
from collections.abc import Awaitable, Callable, Mapping, Sequence
from dataclasses import replace
from datetime import datetime, timedelta
from random import Random
from typing import Final

import structlog
from sqlmodel.ext.asyncio.session import AsyncSession

from app.core.polling import PollingLoop
from app.models import ClaimRow, GrantRow, RobotRow
from app.robots.alarms import VANISHED, clear_alarms, raise_alarm
from app.robots.corridors.occupied import tell_of_traffic
from app.robots.service import Fleet, known_robot
from app.traffic.bay_schedule import BayTrafficSchedule
from app.traffic.robot_locations import left_at, read_traffic, where_they_left
from app.traffic.schedule import Elsewhere, HasToWait, MayEnter, TrafficSchedule, Verdict
from app.traffic.snapshot import RobotLocation, TrafficSnapshot
from maps import corridor_name
from protocol.parts import Leg
from protocol.to_robot import Deny, Detour, Grant

DETOUR: Final = "detour"
POLL_AGAIN_S: Final = 5.0
"""Real seconds. Where robots follow each other, time alone lets the next one in."""
REST_S: Final = 0.03
"""Real seconds: what is said in one moment is looked at once."""
NEWS_S: Final = 15.0
"""People are told again when a robot is expected to wait so much longer or shorter."""

log = structlog.get_logger(__name__)

ChargesFirst = Callable[[AsyncSession, RobotRow, ClaimRow, Sequence[Leg]], Awaitable[bool]]
"""Whether a robot goes to a dock instead of into these corridors: its claim is answered by that."""


async def _never(_session: AsyncSession, _robot: RobotRow, _claim: ClaimRow, _legs: Sequence[Leg]) -> bool:
    return False


class TrafficService:
    """Runs in the background of the service."""

    def __init__(self, fleet: Fleet, charges_first: ChargesFirst = _never) -> None:
        self._fleet = fleet
        self.polling = PollingLoop(POLL_AGAIN_S, REST_S)
        self._schedule: TrafficSchedule | None = None
        self._seen: TrafficSnapshot | None = None
        self.on_poll: list[Callable[[], None]] = []
        """Called after each look that has found something new, which is in the schedule then."""
        self._charges_first = charges_first
        self._rng = Random(0)
        self.in_turn = asyncio.Lock()
        """The schedule is worked on beside the event loop, by one at a time."""

    @property
    def schedule(self) -> TrafficSchedule | None:
        """As it was after the last look; None before the first, and after anything went wrong."""
        return self._schedule

    def wake(self, _changed: str = "") -> None:
        self.polling.wake()

    def stop(self) -> None:
        """End `run` after what it is doing."""
        self.polling.stop()

    async def run(self) -> None:
        """Until stopped or cancelled."""
        async for _ in self.polling.until_stopped():
            try:
                await self.poll()
            except BaseException:
                self._schedule = None
                raise

    async def poll(self) -> None:
        """Take over what has changed, and answer who can be answered."""
        schedule = self._schedule or self._new_schedule()
        before, said = schedule.vanished, [True]
        async with self.in_turn:  # held from the look on: what others have planned since would not be in it
            now, now_s = self._fleet.clock.utc(), self._fleet.clock.now()
            snapshot, left = await self._look(schedule)
            schedule.vanished = self._vanished(snapshot, now)
            understood = {name: self._fleet.connections.understands(name, DETOUR) for name in snapshot.robots}
            verdicts = await asyncio.to_thread(schedule.follow_and_answer, snapshot, left, understood, now_s)
        if verdicts or before != schedule.vanished:
            async with self._fleet.database.transaction() as session:
                await self._tell_of_vanished(session, snapshot, before, schedule.vanished, now)
                names = sorted(verdict.robot for verdict in verdicts)  # locked in one order, as all others do
                rows = {name: await known_robot(session, name, to_change=True) for name in names}
                said = [
                    await self._say(session, rows[verdict.robot], snapshot.robots[verdict.robot], verdict, now)
                    for verdict in verdicts
                ]
        # What was decided on a claim that is another by now was not said: the schedule must not believe it was.
        self._schedule = schedule if all(said) else None
        is_news = before != schedule.vanished or any(not isinstance(verdict, HasToWait) for verdict in verdicts)
        before_it, self._seen = self._seen, _without_times(snapshot)
        if is_news or self._seen != before_it or self._schedule is None:
            for call in self.on_poll:
                call()

    async def _look(self, schedule: TrafficSchedule) -> tuple[TrafficSnapshot, Mapping[int, str]]:
        async with self._fleet.database.reading() as session:
            snapshot = await read_traffic(session, self._fleet.campus)
            if self._schedule is None:
                snapshot = await where_they_left(session, snapshot)
            held = [hold.grant_id for one in schedule.known.values() for hold in one.holds]
            return snapshot, await left_at(session, held)

    def _new_schedule(self) -> TrafficSchedule:
        campus = self._fleet.campus
        kind = TrafficSchedule if campus.track is campus else BayTrafficSchedule
        estimates = self._fleet.orders.ledger.estimates
        return kind(campus, self._fleet.settings, estimates=estimates, rng=self._rng)

    def _vanished(self, snapshot: TrafficSnapshot, now: datetime) -> frozenset[str]:
        """Silent for long, and not at home: without network robots are for minutes, with a flat battery for good."""
        since = now - timedelta(seconds=self._fleet.settings.vanished_after_s)
        return frozenset(
            name
            for name, one in snapshot.robots.items()
            if not one.online and (one.holds or not one.at_home) and (one.heard_at is None or one.heard_at < since)
        )

    async def _tell_of_vanished(
        self,
        session: AsyncSession,
        snapshot: TrafficSnapshot,
        before: frozenset[str],
        now_gone: frozenset[str],
        now: datetime,
    ) -> None:
        for name in sorted(now_gone - before):
            one = snapshot.robots[name]
            hold = one.holds[0] if one.holds else None
            where = f"between {hold.from_post} and {hold.to_post}" if hold else f"at {one.post}"
            others = "no robot is let in there" if hold else "others go round it"
            reason = f"nothing has been heard of the robot since it was {where}: {others} until it is found"
            await raise_alarm(session, name, VANISHED, reason, now=now, post=one.post)
        for name in sorted(before - now_gone):
            await clear_alarms(session, name, VANISHED, now)

    # What is said to robots.

    async def _say(
        self, session: AsyncSession, robot: RobotRow, one: RobotLocation, verdict: Verdict, now: datetime
    ) -> bool:
        """False if the robot has asked anew meanwhile, or is sent elsewhere: the next look has that."""
        assert one.request is not None  # noqa: S101  # there are verdicts on wishes alone
        claim = await session.get(ClaimRow, (one.robot, one.request.claim_id), with_for_update=True)
        if claim is None or claim.granted is not None:
            return False
        match verdict:
            case HasToWait():
                self._let_wait(session, robot, verdict, now)
            case MayEnter():
                legs = tuple(Leg(from_post=a, to_post=b) for a, b in verdict.legs)
                if await self._charges_first(session, robot, claim, legs):
                    return False
                await self._grant(session, robot, claim, verdict, now)
            case Elsewhere():
                await self._deny(session, robot, claim, verdict)
        return True

    async def _grant(
        self, session: AsyncSession, robot: RobotRow, claim: ClaimRow, verdict: MayEnter, now: datetime
    ) -> None:
        claim.granted = True
        legs = tuple(Leg(from_post=a, to_post=b) for a, b in verdict.legs)
        session.add_all(_grant_row(claim, leg, now) for leg in legs)
        if verdict.aside:
            message: Grant | Detour = Detour(claim_id=claim.claim_id, legs=legs, reason="Others have to pass.")
        else:
            message = Grant(claim_id=claim.claim_id, legs=legs)
        await self._fleet.tell(session, robot, message)
        self._fleet.learning.let_in(robot.name, legs, now)
        self._note_wait(session, robot, None)
        await session.flush()
        await tell_of_traffic(session, self._fleet.feed, robot.name)
        log.info("corridor_granted", robot=robot.name, legs=verdict.legs, aside=verdict.aside)

    async def _deny(self, session: AsyncSession, robot: RobotRow, claim: ClaimRow, verdict: Elsewhere) -> None:
        a, b = verdict.leg
        claim.granted, claim.reason = False, "others have to pass"
        await self._fleet.tell(
            session,
            robot,
            Deny(claim_id=claim.claim_id, avoid=(Leg(from_post=a, to_post=b),), reason="Others have to pass."),
        )

    def _let_wait(self, session: AsyncSession, robot: RobotRow, verdict: HasToWait, now: datetime) -> None:
        until = None if verdict.for_s is None else now + timedelta(seconds=verdict.for_s)
        before = robot.waits_for or {}
        waits: dict[str, object] = {
            "from_post": verdict.leg[0],
            "to_post": verdict.leg[1],
            "robots": list(verdict.robots),
            "closed": verdict.closed,
        }
        told = before.get("until")
        same = {key: before.get(key) for key in waits} == waits
        if same and _is_about(told and datetime.fromisoformat(told), until):
            return
        self._note_wait(session, robot, {**waits, "until": until and until.isoformat()})

    def _note_wait(self, session: AsyncSession, robot: RobotRow, waits: dict[str, object] | None) -> None:
        if robot.waits_for != waits:
            robot.waits_for = waits
            self._fleet.announce(session, robot)


def _without_times(snapshot: TrafficSnapshot) -> TrafficSnapshot:
    """That a robot was heard is no news of the traffic."""
    return replace(snapshot, robots={name: replace(one, heard_at=None) for name, one in snapshot.robots.items()})


def _is_about(told: datetime | None, until: datetime | None) -> bool:
    if told is None or until is None:
        return told is until
    return abs((told - until).total_seconds()) < NEWS_S


def _grant_row(claim: ClaimRow, leg: Leg, now: datetime) -> GrantRow:
    return GrantRow(
        robot=claim.robot,
        claim_id=claim.claim_id,
        corridor=corridor_name(leg.from_post, leg.to_post),
        from_post=leg.from_post,
        to_post=leg.to_post,
        granted_at=now,
    )
