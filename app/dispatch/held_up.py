"""Robots that cannot take any order until a person has done something, and what is said of that."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final

from sqlmodel.ext.asyncio.session import AsyncSession

from app.dispatch.open_work import HeldUp, RobotNow, read_held_up
from app.robots.service import Fleet

NONE_CONNECTED: Final = "No robot is connected at the moment."
SENTENCES: Final = {
    HeldUp.STUCK_MAIL: "No robot is free: the mailroom has to see to stuck mail first.",
    HeldUp.STOPPED: "Every robot that could fetch it has stopped and needs help.",
    HeldUp.PAUSED: "The robots that may fetch it take no orders at the moment.",
}


def why_held_up(robots: Iterable[RobotNow]) -> str | None:
    """The first reason that holds of a connected robot, if each of them has one; None if one could come."""
    return _first_of({robot.held_up for robot in robots if robot.is_there})


def _first_of(reasons: set[HeldUp | None]) -> str | None:
    if not reasons or None in reasons:
        return None
    return next(sentence for reason, sentence in SENTENCES.items() if reason in reasons)


@dataclass(frozen=True)
class NoRobotComes:
    """Asked by the estimates, before anything is ordered."""

    fleet: Fleet

    async def why(self, session: AsyncSession) -> str | None:
        """The reason for which no robot would come for an order of this moment; None if one would."""
        reasons = await read_held_up(session)
        return _first_of(reasons) if reasons else NONE_CONNECTED
