"""Hand-overs by people. A tap is a request: it reaches the robot as a command, and its receipt decides."""

import hmac
from dataclasses import dataclass
from datetime import timedelta
from typing import Final, Literal

from sqlmodel.ext.asyncio.session import AsyncSession

from app.core.server_key import ServerKey
from app.handover import errors
from app.handover.people import WAITS, check_waits, code_for, codes_by_digits
from app.handover.schemas import HandoverAsked
from app.models import DigitLock, Order, Person, RobotRow
from app.orders.custody.codes import CONFIRM_LIFETIME_S, HandoverCode, delegates_of
from app.orders.errors import NoCodeForYou
from app.orders.ledger import unknown
from app.orders.service import Actor
from app.orders.transitions import By
from app.orders.views.views import CONFIRM_REQUESTED, role_in
from app.robots.alarms import clear_alarms, raise_alarm
from app.robots.commands import ask, new_command_id, unanswered
from app.robots.link.clocks import by_its_clock
from app.robots.service import Fleet
from protocol.parts import Purpose
from protocol.to_robot import Confirm

How = Literal["tap", "digits"]
TRIES: Final = 5
LOCKED: Final = "digits_locked"
SHOW_IT: Final = "Show it the QR code."


@dataclass(frozen=True)
class HandOvers:
    """Codes, taps and digits of the orders of one campus."""

    fleet: Fleet

    @property
    def key(self) -> ServerKey:
        return self.fleet.orders.key

    async def my_code(self, session: AsyncSession, person: Person, order_id: str) -> HandoverCode:
        """The code that it is this person's turn to show. Raises UnknownOrder, NoCodeForYou."""
        _, code = await self._turn(session, person, order_id)
        if code is None:
            raise NoCodeForYou("It is not your turn to show a code for this order.")
        return code

    async def _turn(self, session: AsyncSession, person: Person, order_id: str) -> tuple[Order, HandoverCode | None]:
        """Return the order and the code that it is this person's turn to show, if any. Raises UnknownOrder."""
        order = await self.fleet.orders.ledger.order(session, order_id)
        code = code_for(order, person, await delegates_of(session, [order]))
        if code is None and role_in(order, person) is None:
            raise unknown(order_id)
        return order, code

    async def is_locked(self, session: AsyncSession, order_id: str) -> bool:
        """Return whether the digits of this order are locked until a dispatcher releases them."""
        lock = await session.get(DigitLock, order_id)
        return lock is not None and lock.locked_at is not None

    async def tap(self, session: AsyncSession, person: Person, order_id: str) -> HandoverAsked:
        """The person says that they stand at the robot. Raises UnknownOrder, NotYourTurn and what `_confirm` raises."""
        order, code = await self._turn(session, person, order_id)
        if code is None:
            raise errors.NotYourTurn("It is not your turn to hand over this order.")
        return await self._confirm(session, order, person, code, "tap")

    async def type_digits(
        self, session: AsyncSession, person: Person, order_id: str, digits: str
    ) -> HandoverAsked | errors.WrongDigits | errors.DigitsLocked:
        """Check digits typed by a person who sees the order. Raises UnknownOrder and what `_confirm` raises.

        Wrong digits and the lock are returned, not raised: the try must be committed.
        """
        order = await self.fleet.orders.ledger.order(session, order_id)
        delegates = await delegates_of(session, [order])
        if role_in(order, person) is None and code_for(order, person, delegates) is None:
            raise unknown(order_id)
        check_waits(order)
        lock = await session.get(DigitLock, order_id, with_for_update=True) or DigitLock(order_id=order_id)
        if lock.locked_at is not None:
            return errors.DigitsLocked(f"The digits are locked until a dispatcher releases them. {SHOW_IT}")
        # Compared with each to the end: the time that it takes tells nothing.
        known = codes_by_digits(order, delegates)
        fitting = [code for code in known if hmac.compare_digest(code.digits(self.key), digits)]
        if not fitting:
            return await self._wrong(session, order, person, lock)
        return await self._confirm(session, order, person, fitting[0], "digits")

    async def _wrong(
        self, session: AsyncSession, order: Order, person: Person, lock: DigitLock
    ) -> errors.WrongDigits | errors.DigitsLocked:
        lock.wrong_tries += 1
        session.add(lock)
        if lock.wrong_tries < TRIES:
            return errors.WrongDigits(f"These are not the digits. {TRIES - lock.wrong_tries} tries are left.")
        lock.locked_at = self.fleet.clock.utc()
        await self.fleet.orders.ledger.note(session, order.id, LOCKED, actor_of(order, person))
        if order.robot is not None:
            sentence = f"{TRIES} wrong digits for order {order.id}: they are locked until a dispatcher releases them"
            await raise_alarm(session, order.robot, LOCKED, sentence, now=lock.locked_at)
        return errors.DigitsLocked(f"These are not the digits, for the fifth time: they are locked. {SHOW_IT}")

    async def release_digits(self, session: AsyncSession, dispatcher: Person, order_id: str) -> Order:
        """A dispatcher lets digits be typed again. Raises UnknownOrder."""
        order, _ = await self.fleet.orders.ledger.visible_order(session, dispatcher, order_id)
        lock = await session.get(DigitLock, order_id, with_for_update=True)
        if lock is not None and lock.wrong_tries:
            lock.wrong_tries, lock.locked_at = 0, None
            actor = Actor(By.DISPATCHER, person_id=dispatcher.id)
            await self.fleet.orders.ledger.note(session, order_id, "digits_released", actor)
            if order.robot is not None:
                await clear_alarms(session, order.robot, LOCKED, self.fleet.clock.utc())
        return order

    async def _confirm(
        self, session: AsyncSession, order: Order, person: Person, code: HandoverCode, how: How
    ) -> HandoverAsked:
        """Ask the robot to hand over; once, until it answers or the request is too old.

        Raises RobotNotThere, CodesExpired, RobotOffline, RobotTakesNoTaps.
        """
        purpose, now = check_waits(order), self.fleet.clock.utc()
        if order.codes_expire_at <= now:
            raise errors.CodesExpired("The codes of this order are too old. Ask a dispatcher.")
        robot = await self._robot(session, order)
        lifetime = timedelta(seconds=CONFIRM_LIFETIME_S)
        earlier = await unanswered(session, robot=robot.name, kind="confirm", order_id=order.id)
        asked = next((one for one in earlier if one.asked_at + lifetime > now), None)
        if asked is None:
            request = Confirm(
                command_id=new_command_id("confirm"),
                order_id=order.id,
                purpose=purpose,
                how=how,
                by=code.sha256(self.key),
                # It is the robot that judges whether this came too late.
                expires_at=by_its_clock(now + lifetime, robot.clock_off_s),
            )
            asked = await ask(session, self.fleet, robot, request, person.id)
            await self.fleet.orders.ledger.note(session, order.id, CONFIRM_REQUESTED, actor_of(order, person, how))
        return HandoverAsked(
            order_id=order.id,
            purpose=purpose.value,
            how=how,
            at=asked.asked_at,
            expires_at=asked.asked_at + lifetime,
        )

    async def _robot(self, session: AsyncSession, order: Order) -> RobotRow:
        robot = await session.get(RobotRow, order.robot, with_for_update=True) if order.robot else None
        if robot is None or not robot.online:
            raise errors.RobotOffline(f"The robot has no network just now, so a tap cannot reach it. {SHOW_IT}")
        if not robot.takes_confirm:
            raise errors.RobotTakesNoTaps(f"This robot takes no taps. {SHOW_IT}")
        return robot


def actor_of(order: Order, person: Person, reason: str | None = None) -> Actor:
    """Return the actor of an event: a delegate acts for the person who named them."""
    role = role_in(order, person)
    by = By(role) if role else (By.RECIPIENT if WAITS.get(order.state) is Purpose.RECEIVE else By.SENDER)
    return Actor(by, person_id=person.id, reason=reason)
