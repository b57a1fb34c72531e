"""Mail that turns back: because its recipient does not want it now, or its sender or a dispatcher wants it back.

The robot is asked by an update of its mission; until it says that it has turned, the order goes on as before.
"""

from dataclasses import dataclass
from datetime import timedelta
from typing import Final

from sqlmodel.ext.asyncio.session import AsyncSession

from app.models import Order, Person
from app.orders import errors, stops
from app.orders.custody.unproven import robot_with_mail
from app.orders.ledger import Actor, Ledger
from app.orders.transitions import CARRIED, ENDED, TURNED_BACK, By
from app.orders.views.schemas import OrderView
from maps import shortest_route
from protocol.parts import StopAction

RETURN_REQUESTED: Final = "return_requested"


@dataclass(frozen=True)
class Returning:
    """Send mail back that is aboard."""

    ledger: Ledger

    def return_post(self, order: Order) -> str:
        """Return where this mail goes if it is not taken: to its sender, or to the nearest mailroom if so set."""
        if order.return_post is not None:
            return order.return_post
        mailrooms = [post.name for post in self.ledger.campus.posts.values() if post.mailroom]
        if self.ledger.settings.undelivered_to == "sender" or not mailrooms:
            return order.from_post
        return min(mailrooms, key=lambda post: (shortest_route(self.ledger.campus, order.to_post, post).length_m, post))

    async def recall(self, session: AsyncSession, person: Person, order_id: str, if_match: str = "") -> OrderView:
        """Call the mail back, as sender or dispatcher. Raises UnknownOrder, OrderChanged, NotRecallable."""
        order, role = await self.ledger.visible_order(session, person, order_id, if_match)
        if role == "recipient":
            raise errors.NotRecallable("Only the sender can call the mail back. You can say that it does not suit now.")
        await self.call_back(session, order, Actor(By(role), person_id=person.id))
        return await self.ledger.view(session, order, role, person)

    async def call_back(self, session: AsyncSession, order: Order, actor: Actor) -> None:
        """Ask the robot to turn back, once. Raises NotRecallable."""
        if order.state in ENDED and (robot := await robot_with_mail(session, order)):
            if not await stops.stops_of_order(session, order.id, robot):
                await self.ask_back(session, order, actor)
            return
        if order.state not in CARRIED | TURNED_BACK:
            raise errors.NotRecallable(f"The order is {order.state}: there is no mail aboard that could turn back.")
        if order.state in CARRIED and order.return_requested_at is None:
            order.cancel_requested_at, order.cancel_requested_by = self.ledger.clock.utc(), actor.by
            await self.ask_back(session, order, actor)

    async def not_now(self, session: AsyncSession, person: Person, order_id: str, if_match: str = "") -> OrderView:
        """Send back mail that the recipient cannot take now. Raises UnknownOrder, OrderChanged, NotRecallable."""
        order, role = await self.ledger.visible_order(session, person, order_id, if_match)
        if role == "sender" or order.state not in CARRIED | TURNED_BACK:
            raise errors.NotRecallable(
                f"The order is {order.state}: its recipient says “not now” to mail that is aboard."
            )
        if order.state in CARRIED and order.return_requested_at is None:
            actor = Actor(By(role), person_id=person.id, reason="The recipient cannot take it now.")
            await self.ask_back(session, order, actor)
        return await self.ledger.view(session, order, role, person)

    async def ask_back(self, session: AsyncSession, order: Order, actor: Actor) -> None:
        """Give the robot the way back instead of the way to the recipient."""
        order.return_requested_at = self.ledger.clock.utc()
        await self.bring_back(session, order)
        await self.ledger.note(session, order.id, RETURN_REQUESTED, actor)

    async def bring_back(self, session: AsyncSession, order: Order) -> None:
        """Add the stop where this mail is given back to the mission of the robot that has it."""
        order.return_post = self.return_post(order)
        await self.send(session, order, StopAction.RETURN, order.return_post)

    async def send(self, session: AsyncSession, order: Order, action: StopAction, post: str) -> None:
        """Send the mail that is aboard to `post` now. Its codes are prolonged: the person there must be able to
        take it."""
        now, lifetime = self.ledger.clock.utc(), timedelta(seconds=self.ledger.settings.handover_code_lifetime_s)
        order.codes_expire_at = max(order.codes_expire_at, now + lifetime)
        await stops.bring(session, order, action, post, self.ledger.settings.wait_limit_s, now)
