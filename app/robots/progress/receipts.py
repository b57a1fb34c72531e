"""Receipts of robots: this robot wrote it, and this code opened. Else custody does not move.

What it goes by is another matter (`app.robots.progress.evidence`): what nothing proves is written down as claimed."""

import base64
import binascii
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from typing import Final

from cryptography.exceptions import InvalidSignature
from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PublicKey
from sqlmodel.ext.asyncio.session import AsyncSession

from app.models import Evidence, Handover, MissionRow, Order, RefusedReceipt, RobotCommand, RobotRow
from app.orders.custody.codes import HandoverCode, Holder, codes_of, delegates_of
from app.orders.custody.unproven import CLAIMED
from app.robots.alarms import raise_alarm
from app.robots.link.clocks import put_right
from app.robots.progress.evidence import UNPROVED, evidence_of, is_too_fast
from app.robots.progress.reports import Report
from protocol.parts import Purpose
from protocol.to_server import HandoverReceipt

REFUSED: Final = "receipt_refused"
REVOKED: Final = "revoked_code_used"

OPENED_BY: Final[Mapping[Purpose, frozenset[Purpose]]] = {
    Purpose.LOAD: frozenset({Purpose.LOAD}),
    Purpose.RECEIVE: frozenset({Purpose.RECEIVE}),
    # Mail that is brought back is given to its recipient too, and for the code that it was loaded with.
    Purpose.RETURN: frozenset(Purpose),
}
PROBLEMS: Final[Mapping[str, str]] = {
    "unsigned": "it is not signed, although this robot has a key",
    "bad_signature": "its signature is not this robot's",
    "unknown_code": "its code is none of this order's",
    "no_code": "it names no code",
    "unknown_command": "this robot was not asked for it",
    "used_command": "it goes by a request that the robot has answered before",
}


def counts_for_nothing(purpose: str, order_id: str, problem: str) -> str:
    """Return the sentence for dispatchers; `problem` is one of PROBLEMS."""
    return f"a receipt ({purpose}) for order {order_id} counts for nothing: {PROBLEMS[problem]}"


def claimed(purpose: str, order_id: str, post: str, problem: str) -> str:
    """Return the sentence for dispatchers; `problem` is one of UNPROVED."""
    return f"the robot says that mail of order {order_id} changed hands ({purpose}) at {post}: {UNPROVED[problem]}"


class _Refused(Exception):
    """`problem` is one of PROBLEMS."""

    def __init__(self, problem: str) -> None:
        super().__init__(problem)
        self.problem = problem


@dataclass(frozen=True)
class _Judge:
    """One receipt of one robot, and what it is held against. `mission`: that of its stop."""

    report: Report
    robot: RobotRow
    order: Order
    mission: MissionRow
    receipt: HandoverReceipt

    @property
    def _session(self) -> AsyncSession:
        return self.report.session

    async def handover(self) -> Handover:
        """The link of the chain of custody that the receipt proves or claims. Raises _Refused."""
        receipt = self.receipt
        _check_signature(self.robot, receipt)
        command = await self._command()
        code = await self._code()
        evidence, problem = await self._evidence(code, command)
        if evidence is Evidence.CLAIMED:
            reason = claimed(receipt.purpose, self.order.id, receipt.post, problem or "")
            await self._ring(CLAIMED, reason)
        else:
            await self._tell_if_revoked(code)
        return Handover(
            order_id=receipt.order_id,
            stop_id=receipt.stop_id,
            purpose=receipt.purpose,
            robot=self.robot.name,
            post=receipt.post,
            code_sha256=receipt.code_sha256,
            robot_at=put_right(receipt.happened_at, self.robot.clock_off_s),
            at=self.report.now,
            how=receipt.how,
            holder=code.holder if code else None,
            person_id=None if evidence is Evidence.CLAIMED else _person(self.order, code, command),
            delegate_id=code.delegate.id if code and code.delegate else None,
            command_id=receipt.command_id,
            signature=receipt.signature if self.robot.public_key else None,
            evidence=evidence,
            problem=problem,
        )

    async def _evidence(self, code: HandoverCode | None, command: RobotCommand | None) -> tuple[Evidence, str | None]:
        report, receipt = self.report, self.receipt
        told = await self._session.get(MissionRow, receipt.mission_id) if receipt.mission_id else None
        missions = (self.mission, told)
        evidence, problem = evidence_of(report.orders.key, self.robot, receipt, missions, code, command)
        ways, clock = report.orders.ledger.ways, report.orders.ledger.clock
        if problem is None and await is_too_fast(self._session, ways, clock, self.robot, receipt, report.now):
            return Evidence.CLAIMED, "too_fast"
        return evidence, problem

    async def _command(self) -> RobotCommand | None:
        """Return the command of the person who asked for it in the app: once, and not if the robot has said no to
        it."""
        receipt = self.receipt
        if receipt.how not in ("tap", "digits"):
            return None
        command = await self._session.get(RobotCommand, receipt.command_id or "")
        asked = command and (command.robot, command.order_id, command.how, command.code_sha256)
        if command is None or asked != (self.robot.name, receipt.order_id, receipt.how, receipt.code_sha256):
            raise _Refused("unknown_command")
        if command.answered_at is not None:
            raise _Refused("used_command")
        command.answered_at, command.accepted = self.report.now, True
        return command

    async def _code(self) -> HandoverCode | None:
        """Return the code that opened; None for the Spot button, which loads only."""
        receipt = self.receipt
        if receipt.code_sha256 is None:
            if receipt.purpose is not Purpose.LOAD:
                raise _Refused("no_code")
            return None
        delegates = await delegates_of(self._session, [self.order])
        for code in codes_of(self.order, delegates, with_revoked=True):
            is_for_this = code.purpose in OPENED_BY[receipt.purpose]
            if is_for_this and code.sha256(self.report.orders.key) == receipt.code_sha256:
                return code
        raise _Refused("unknown_code")

    async def _tell_if_revoked(self, code: HandoverCode | None) -> None:
        """It was taken back, but this robot had not heard of it yet: the mail is gone all the same."""
        if code is not None and code.delegate is not None and code.delegate.revoked_at is not None:
            sentence = f"order {self.order.id} was handed over to {code.delegate.name}, whose code had been revoked"
            await self._ring(REVOKED, sentence)

    async def _ring(self, name: str, sentence: str) -> None:
        report = self.report
        await raise_alarm(report.session, self.robot.name, name, sentence, now=report.now, post=self.receipt.post)


async def judged(report: Report, order: Order, mission: MissionRow, receipt: HandoverReceipt) -> Handover | None:
    """The link of the chain that a receipt proves or claims; None if it counts for nothing: then it is written down
    and an alarm."""
    row = await report.session.get_one(RobotRow, report.robot)
    try:
        return await _Judge(report, row, order, mission, receipt).handover()
    except _Refused as refused:
        report.session.add(_refused(report.robot, receipt, report.now, refused.problem))
        reason = counts_for_nothing(receipt.purpose, order.id, refused.problem)
        await raise_alarm(report.session, report.robot, REFUSED, reason, now=report.now, post=receipt.post)
        return None


def _check_signature(robot: RobotRow, receipt: HandoverReceipt) -> None:
    if robot.public_key is None:
        return  # enrolled without a key; whatever it signs cannot be told from anything else
    if receipt.signature is None:
        raise _Refused("unsigned")
    try:
        key = Ed25519PublicKey.from_public_bytes(base64.b64decode(robot.public_key, validate=True))
        key.verify(base64.b64decode(receipt.signature, validate=True), receipt.signed_by(robot.name))
    except (InvalidSignature, ValueError, binascii.Error):
        raise _Refused("bad_signature") from None


def _person(order: Order, code: HandoverCode | None, command: RobotCommand | None) -> str | None:
    if code is None or code.holder is Holder.DELEGATE:
        return None
    if code.holder is Holder.MAILROOM:
        return command.asked_by_id if command else None
    return order.sender_id if code.holder is Holder.SENDER else order.recipient_id


def _refused(robot: str, receipt: HandoverReceipt, now: datetime, problem: str) -> RefusedReceipt:
    return RefusedReceipt(
        robot=robot,
        order_id=receipt.order_id,
        stop_id=receipt.stop_id,
        purpose=receipt.purpose,
        post=receipt.post,
        code_sha256=receipt.code_sha256,
        how=receipt.how,
        command_id=receipt.command_id,
        signature=receipt.signature,
        robot_at=receipt.happened_at,
        at=now,
        problem=problem,
    )
