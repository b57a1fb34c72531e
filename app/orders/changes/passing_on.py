"""Mail that changes robots half way: one order, two legs, and the mailroom's hands between them.

A robot that can carry its mail no further (flat, jammed, cut off from the recipient) is relieved of it at a post. From
there another robot carries it on: the same order, with the same codes, and one more link in its chain of custody.
"""

from sqlmodel.ext.asyncio.session import AsyncSession

from app.models import Evidence, Handover, Order, OrderState, Person, RobotRow
from app.orders import errors
from app.orders.changes.intervening import BY_HAND, Intervening
from app.orders.custody.unproven import was_aboard
from app.orders.ledger import Word
from app.orders.transitions import CARRIED, By
from app.orders.views.schemas import OrderView
from app.orders.window import arrival_window, promise
from protocol.parts import Purpose


class PassingOn(Intervening):
    """On a dispatcher's word. The routes let nobody else in."""

    async def pass_on(
        self,
        session: AsyncSession,
        person: Person,
        order_id: str,
        post: str | None,
        reason: str | None,
        if_match: str = "",
    ) -> OrderView:
        """Somebody of the mailroom has taken the mail out at this post (None: where its robot was seen last); another
        robot fetches it there. Raises UnknownOrder, OrderChanged, NothingToPassOn, UnknownPost, SamePost."""
        order = await self._theirs(session, person, order_id, if_match)
        if (order.state_before_attention or order.state) not in CARRIED or order.robot is None:
            raise errors.NothingToPassOn(f"The order is {order.state}: no robot is bringing its mail to the recipient.")
        post = self._known(post or await self._seen_at(session, order.robot), order.robot)
        if post == order.to_post:
            raise errors.SamePost("The mail is at its recipient's post: there is no way left to carry it.")
        word = Word(By.DISPATCHER, person_id=person.id, post=post, reason=reason)
        await was_aboard(session, order.id, self.clock.utc())
        session.add(self._taken_out(order, post, word))
        order.passed_on_at_post = post
        promise(order, arrival_window(self.estimates, post, order.to_post, self.clock.utc()), self.clock.utc())
        order.let_go_by = order.avoided_robot = order.robot
        order.wanted_robot = None
        await self.move(session, order.id, OrderState.QUEUED, word)
        return await self._shown(session, order, person)

    async def _seen_at(self, session: AsyncSession, robot: str) -> str | None:
        row = await session.get(RobotRow, robot)
        return row.post if row else None

    def _known(self, post: str | None, robot: str) -> str:
        if post is None:
            raise errors.UnknownPost(f"Robot {robot} has been seen nowhere yet: say at which post the mail is.")
        if post not in self.campus.posts:
            raise errors.UnknownPost(f"There is no post {post!r} on this campus.")
        return post

    def _taken_out(self, order: Order, post: str, word: Word) -> Handover:
        """From here on the mailroom answers for it, on the dispatcher's word."""
        now = self.clock.utc()
        return Handover(
            order_id=order.id,
            stop_id=f"passed-on-{order.version}-{order.id}"[:64],
            purpose=Purpose.RETURN,
            robot=order.robot or "",
            post=post,
            how=BY_HAND,
            evidence=Evidence.DISPATCHER,
            holder="mailroom",
            person_id=word.person_id,
            robot_at=now,
            at=now,
        )
