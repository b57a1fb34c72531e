"""The evidence of a receipt: what it carries that its robot could not know without the hand-over.

A stolen robot has everything that robots are told, and its key. What it cannot have is a code that it was not shown,
nor a command that was not given, and it cannot drive faster than its base.
"""

import hmac
import math
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from typing import Final

from sqlmodel import col, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.core.server_key import ServerKey
from app.models import Evidence, Handover, MissionRow, RobotCommand, RobotRow
from app.orders.custody.codes import HandoverCode
from app.robots.link.clocks import put_right
from maps.ways import Ways
from protocol.clock import Clock
from protocol.proofs import ShownCode
from protocol.to_server import HandoverReceipt

FASTEST_M_S: Final = 0.5
"""No wheel of a Create 2 turns faster (Open Interface Specification: Drive takes -500 to 500 mm/s)."""
BESIDE_A_POST_M: Final = 0.5
"""A robot that waits at a post may stand so far before it or behind it."""
SLEWED_S: Final = 1.0
"""A robot's clock is put right by so little without anybody hearing of it."""
TOLD_AT_ONCE_S: Final = 10.0
"""Of the machine's time: what is told so soon after it has happened did not wait for a network."""

UNPROVED: Final[Mapping[str, str]] = {
    "no_proof": "nothing shows that the robot has seen the code",
    "wrong_proof": "what the code would have given is something else",
    "too_fast": "no robot gets there so fast from where it was before",
}


@dataclass(frozen=True)
class Sighting:
    """Where a robot was, when by its own clock (put right), and when it said so, if that is known."""

    post: str
    robot_at: datetime
    at: datetime | None = None


def evidence_of(
    key: ServerKey,
    robot: RobotRow,
    receipt: HandoverReceipt,
    missions: tuple[MissionRow, MissionRow | None],
    code: HandoverCode | None,
    command: RobotCommand | None,
) -> tuple[Evidence, str | None]:
    """Return the evidence of the receipt; if there is none, also why (one of UNPROVED). `missions`: that of its stop
    as it was told to the robot, and the one that the receipt names."""
    if command is not None:
        return Evidence(receipt.how), None
    if code is None:
        return Evidence.BUTTON, None
    if receipt.proof is None:
        must_prove = _must_prove(robot, receipt, missions[0])
        return (Evidence.CLAIMED, "no_proof") if must_prove else (Evidence.DIGEST, None)
    proof = receipt.proved_with(ShownCode.of(code.text(key)).key)
    is_of_this_robot = missions[1] is not None and missions[1].robot == robot.name
    if not hmac.compare_digest(proof, receipt.proof) or not is_of_this_robot:
        return Evidence.CLAIMED, "wrong_proof"
    return Evidence.PROOF, None


def _must_prove(robot: RobotRow, receipt: HandoverReceipt, mission: MissionRow) -> bool:
    """A robot that has proved once must go on, whatever its hello says now. What it was about when it was given newer
    software it may still have told as before."""
    since = robot.proves_since
    happened_at = put_right(receipt.happened_at, robot.clock_off_s)
    return since is not None and (mission.created_at >= since or happened_at >= since)


async def is_too_fast(
    session: AsyncSession, ways: Ways, clock: Clock, robot: RobotRow, receipt: HandoverReceipt, now: datetime
) -> bool:
    """Tell if no robot could have driven here, from where this one was before, in the time that has passed.

    By the robot's own times, and, for what it had told at once, by the service's.
    """
    here = Sighting(receipt.post, put_right(receipt.happened_at, robot.clock_off_s), now)
    told_at_once_s = TOLD_AT_ONCE_S / clock.real_s(1.0)
    return any(is_out_of_reach(ways, one, here, told_at_once_s) for one in await _sightings(session, robot))


def is_out_of_reach(ways: Ways, before: Sighting, here: Sighting, told_at_once_s: float) -> bool:
    """By either clock. What was told late says nothing of when it was by the service's clock."""
    needs_s = (ways.length_m(before.post, here.post) - 2 * BESIDE_A_POST_M) / FASTEST_M_S
    if not math.isfinite(needs_s):
        return False  # nothing is known of the way
    if abs((here.robot_at - before.robot_at).total_seconds()) + SLEWED_S < needs_s:
        return True
    if before.at is None or here.at is None:
        return False
    late_s = (before.at - before.robot_at).total_seconds()
    passed_s = (here.at - before.at).total_seconds()
    return abs(late_s) <= told_at_once_s and passed_s + told_at_once_s < needs_s


async def _sightings(session: AsyncSession, robot: RobotRow) -> list[Sighting]:
    """Where it is proved or believed to have been: at its last hand-over, and where it was seen last."""
    wanted = select(Handover).where(Handover.robot == robot.name)
    wanted = wanted.where(col(Handover.evidence).not_in([Evidence.CLAIMED, Evidence.DISPATCHER]))
    last = (await session.exec(wanted.order_by(col(Handover.id).desc()).limit(1))).first()
    sightings = [] if last is None else [Sighting(last.post, last.robot_at, last.at)]
    if robot.post is not None and robot.seen_at is not None:
        sightings.append(Sighting(robot.post, robot.seen_at))
    return sightings
