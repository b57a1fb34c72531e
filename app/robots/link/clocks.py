"""Robots' clocks: order never depends on them, but what people read does, so their times are put right for display."""

from datetime import datetime, timedelta
from typing import Final

from sqlmodel.ext.asyncio.session import AsyncSession

from app.models import RobotRow
from app.robots.alarms import clear_alarms, raise_alarm

NOISE_S: Final = 30.0
"""So little may be the delay of a hello, on a scaled clock above all: left as it is, so that times stay in order."""
TOLERANCE_S: Final = 300.0


def put_right(at: datetime, off_s: float) -> datetime:
    """A robot's time as the service's clock would have said it; `off_s` is how far the robot's clock is ahead."""
    return at - timedelta(seconds=off_s) if abs(off_s) > NOISE_S else at


def by_its_clock(at: datetime, off_s: float) -> datetime:
    """The other way round: what the robot's clock says at a time of the service's."""
    return at + timedelta(seconds=off_s) if abs(off_s) > NOISE_S else at


def has_been_set(known_s: float, seen_s: float) -> bool:
    """Tell if a clock that was `known_s` ahead must have been set since, if a message says that it is `seen_s` ahead.

    A message takes its time but never comes before it was sent: it may well make a clock look slower than it is. No
    connection lives long enough to make it look slower by the tolerance.
    """
    return seen_s > known_s + NOISE_S or seen_s < known_s - TOLERANCE_S


async def compare(session: AsyncSession, robot: RobotRow, at: datetime, now: datetime) -> None:
    """Note how far the robot's clock is ahead, which said `at` just now; far off, it is an alarm."""
    robot.clock_off_s = (at - now).total_seconds()
    if abs(robot.clock_off_s) > TOLERANCE_S:
        sentence = f"the robot's clock is off by {robot.clock_off_s:+.0f} s"
        await raise_alarm(session, robot.name, "clock_off", sentence, now=now)
    else:
        await clear_alarms(session, robot.name, "clock_off", now)


async def compare_again(session: AsyncSession, robot: RobotRow, at: datetime, now: datetime) -> None:
    """With each message: a robot that starts without network often has its clock set after its hello."""
    if has_been_set(robot.clock_off_s, (at - now).total_seconds()):
        await clear_alarms(session, robot.name, "clock_off", now)
        await compare(session, robot, at, now)
