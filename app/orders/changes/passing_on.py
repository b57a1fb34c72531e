"""Mail that changes robots half way: one order, two legs, and the mailroom's hands between them.

A robot that can carry its mail no further (flat, jammed, cut off from the recipient) is relieved of it at a post. From
there another robot carries it on: the same order, with the same codes, and one more link in its chain of custody.
"""

from dataclasses import dataclass

from sqlmodel.ext.asyncio.session import AsyncSession

from app.models import OrderState, Person, RobotRow
from app.orders import errors
from app.orders.custody.by_hand import taken_out_by_hand
from app.orders.custody.unproven import settle_as_aboard
from app.orders.ledger import Actor, Ledger
from app.orders.transitions import CARRIED, By
from app.orders.views.schemas import OrderView
from app.orders.window import arrival_window, promise


@dataclass(frozen=True)
class PassingOn:
    """Pass mail on to another robot, on a dispatcher's request. The routes check the role."""

    ledger: Ledger

    async def pass_on(
        self,
        session: AsyncSession,
        person: Person,
        order_id: str,
        post: str | None,
        reason: str | None,
        if_match: str = "",
    ) -> OrderView:
        """Record that the mailroom took the mail out at this post (None: where its robot was seen last); another
        robot fetches it there. Raises UnknownOrder, OrderChanged, NothingToPassOn, UnknownPost, SamePost."""
        order, _ = await self.ledger.visible_order(session, person, order_id, if_match)
        if (order.state_before_attention or order.state) not in CARRIED or order.robot is None:
            raise errors.NothingToPassOn(f"The order is {order.state}: no robot is bringing its mail to the recipient.")
        post = self._known(post or await self._seen_at(session, order.robot), order.robot)
        if post == order.to_post:
            raise errors.SamePost("The mail is at its recipient's post: there is no way left to carry it.")
        actor = Actor(By.DISPATCHER, person_id=person.id, post=post, reason=reason)
        now = self.ledger.clock.utc()
        await settle_as_aboard(session, order.id, now)
        session.add(taken_out_by_hand(order, f"passed-on-{order.version}-{order.id}", post, person.id, now))
        order.passed_on_at_post = post
        promise(order, arrival_window(self.ledger.estimates, post, order.to_post, now), now)
        order.let_go_by = order.avoided_robot = order.robot
        order.wanted_robot = None
        await self.ledger.move(session, order.id, OrderState.QUEUED, actor)
        return await self.ledger.view(session, order, "dispatcher", person)

    async def _seen_at(self, session: AsyncSession, robot: str) -> str | None:
        row = await session.get(RobotRow, robot)
        return row.post if row else None

    def _known(self, post: str | None, robot: str) -> str:
        if post is None:
            raise errors.UnknownPost(f"Robot {robot} has been seen nowhere yet: say at which post the mail is.")
        if post not in self.ledger.campus.posts:
            raise errors.UnknownPost(f"There is no post {post!r} on this campus.")
        return post
