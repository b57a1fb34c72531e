"""Codes for enrolling: made by a maintainer, good once and for minutes, known here by their hash alone."""

import hmac
import secrets
from dataclasses import dataclass
from datetime import timedelta
from typing import Final

from sqlmodel import col, select
from sqlmodel.ext.asyncio.session import AsyncSession

from app.core.server_key import ServerKey
from app.core.settings import Settings
from app.models import EnrolmentCode, RobotRow
from app.robots.enrolment.errors import NoEnrolmentCode, NoHomeForRobot, WrongEnrolmentCode
from app.robots.homes import no_room
from app.robots.service import check_name, enrol, new_token
from maps import CampusMap
from protocol.clock import Clock

LETTERS: Final = "23456789ABCDEFGHJKMNPQRSTUVWXYZ"
"""None that is taken for another when it is read out or typed."""
GROUPS, GROUP_LENGTH = 2, 4
CODE_LIFETIME_S: Final = 900.0


@dataclass(frozen=True)
class EnrolmentService:
    """Makes codes and admits the robot that comes with one."""

    settings: Settings
    campus: CampusMap
    key: ServerKey
    clock: Clock

    async def make_code(
        self, session: AsyncSession, name: str, made_by_id: str | None = None
    ) -> tuple[EnrolmentCode, str]:
        """A new code for a robot of this name, known already or not; older ones are worthless. Raises RobotNameInvalid
        and NoHomeForRobot.

        A robot that is known keeps its token until it comes with the code.
        """
        check_name(name)
        await self._check_room(session, name)
        now = self.clock.utc()
        code = "-".join("".join(secrets.choice(LETTERS) for _ in range(GROUP_LENGTH)) for _ in range(GROUPS))
        row = EnrolmentCode(
            robot=name,
            code_hash=self._hash(name, code),
            made_by_id=made_by_id,
            created_at=now,
            expires_at=now + timedelta(seconds=CODE_LIFETIME_S),
        )
        session.add(row)
        await session.flush()
        return row, code

    async def use_code(
        self, session: AsyncSession, name: str, code: str
    ) -> WrongEnrolmentCode | NoEnrolmentCode | None:
        """Use up the code, or one of its tries. Errors are returned, not raised: the try must be committed."""
        newest = select(EnrolmentCode).where(EnrolmentCode.robot == name).order_by(col(EnrolmentCode.id).desc())
        row = (await session.exec(newest.limit(1).with_for_update())).first()
        now = self.clock.utc()
        if row is None or row.used_at or row.expires_at <= now or row.tries_left <= 0:
            return NoEnrolmentCode("There is no code for this robot that is still good. Have a new one made.")
        if not hmac.compare_digest(row.code_hash, self._hash(name, code)):
            row.tries_left -= 1
            return WrongEnrolmentCode(f"That is not the code. {row.tries_left} tries are left.")
        row.used_at = now
        return None

    async def admit(self, session: AsyncSession, name: str, public_key: str) -> str:
        """The robot's token, which is told once; those that it had before are worthless, and so is its old key."""
        await self._check_room(session, name)
        known = await session.get(RobotRow, name)
        token = await (new_token if known else enrol)(session, self.clock, name)
        robot = await session.get_one(RobotRow, name)
        robot.public_key = public_key
        return token

    async def _check_room(self, session: AsyncSession, name: str) -> None:
        if refusal := await no_room(session, self.campus, name):
            raise NoHomeForRobot(refusal)

    def _hash(self, name: str, code: str) -> str:
        # Keyed: so few letters are found by trying them all.
        plain = code.upper().replace("-", "").replace(" ", "")
        return self.key.derive("enrolment", name, plain).hex()
