"""The ledger of orders, the only place that changes their state: each change is recorded once, then published.

A change is one transaction: row, event, notices; published after the commit. An order's version is the number of its
newest event.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from datetime import datetime
from functools import cached_property, partial
from typing import Any, Final

from sqlalchemy import insert
from sqlmodel.ext.asyncio.session import AsyncSession

from app.core.database.database import after_commit, connection_of
from app.core.settings import Settings
from app.models import Order, OrderEvent, OrderState, Person, Role
from app.models.orders.order_events import MOVED
from app.notifications.service import tell_all
from app.orders import errors
from app.orders.nearness import is_near
from app.orders.notifications import NOTIFICATION_RULES, facts_of, notices_about
from app.orders.transitions import NEVER_LEFT_ITS_SENDER, By, is_allowed, is_old_news
from app.orders.views.schemas import OrderView
from app.orders.views.views import MyRole, OrderFacts, load_facts, order_view, role_in
from app.realtime.feed import Feed, FeedEvent
from fleet.eta.arrivals import Estimates
from maps import CampusMap
from maps.ways import Ways
from protocol.clock import Clock

Expected = tuple[datetime, datetime]
"""From the earliest to the latest arrival."""


@dataclass(frozen=True)
class Actor:
    """The origin of a change, and what is known of it: `robot_at` is the robot's own time of it."""

    by: By
    person_id: str | None = None
    robot: str | None = None
    robot_at: datetime | None = None
    post: str | None = None
    reason: str | None = None


@dataclass(frozen=True)
class Ledger:
    """States and events of the orders of one campus. Each kind of change (`changes/`) has it as a part.

    `on_change` is called with an order's id after the commit of each change.
    """

    campus: CampusMap
    settings: Settings
    clock: Clock
    feed: Feed
    on_change: list[Callable[[str], None]] = field(default_factory=list)

    @cached_property
    def ways(self) -> Ways:
        """Return the distances on this campus."""
        return Ways(self.campus)

    @cached_property
    def estimates(self) -> Estimates:
        """Return the learned durations of this campus."""
        settings = self.settings
        speed_m_s, handover_s = settings.assumed_speed_m_s, settings.assumed_handover_s
        return Estimates(self.ways, speed_m_s, handover_s, settings.zone, settings.hours_of_offices)

    async def order(self, session: AsyncSession, order_id: str) -> Order:
        """Return the row. Raises UnknownOrder."""
        order = await session.get(Order, order_id)  # not locked: writers take turns, and readers change nothing
        if order is None:
            raise unknown(order_id)
        return order

    async def visible_order(
        self, session: AsyncSession, person: Person, order_id: str, if_match: str = ""
    ) -> tuple[Order, MyRole]:
        """Return an order that this person may see, and their role in it. Raises UnknownOrder, OrderChanged."""
        order = await self.order(session, order_id)
        role = role_in(order, person)
        if role is None:
            raise unknown(order_id)
        if if_match and not _matches(if_match, order.version):
            raise errors.OrderChanged(f"The order is at version {order.version} now. Read it again first.")
        return order, role

    async def move(
        self,
        session: AsyncSession,
        order_id: str,
        to: OrderState,
        actor: Actor,
        wait_until: datetime | None = None,
        *,
        quietly: bool = False,
    ) -> bool:
        """Take an order to its next state; False if this has happened before and nothing changes.

        A robot repeats itself after a lost acknowledgement, and may tell late what others told already: what lies
        behind the order is no news from a robot. `wait_until` is how long the robot waits there; `quietly`: no person
        gets a notice of it, since more follows at once. Raises UnknownOrder, TransitionRefused.
        """
        order = await self.order(session, order_id)
        if order.is_passed_on and to in NEVER_LEFT_ITS_SENDER:
            to = OrderState.HELD  # by the mailroom, which has it
        if order.state is to or (actor.by is By.ROBOT and is_old_news(order.state, to, order.state_before_attention)):
            return False
        before = order.state_before_attention
        if not is_allowed(order.state, to, actor.by, before, is_passed_on=order.is_passed_on):
            raise errors.TransitionRefused(f"Order {order.id} is {order.state}: {actor.by} cannot make it {to}.")
        order.state_before_attention = order.state if to is OrderState.ATTENTION else None
        order.state = to
        order.robot = actor.robot or order.robot
        order.why = actor.reason if to is OrderState.ATTENTION else None
        order.wait_until = wait_until
        if to is OrderState.QUEUED:
            _reset_requests(order)
        await self._write(session, order, MOVED, actor, quietly=quietly)
        return True

    async def note(self, session: AsyncSession, order_id: str, kind: str, actor: Actor) -> None:
        """Write down what happened to an order without changing its state, such as `wait_extended`, and publish it.

        Raises UnknownOrder.
        """
        await self._write(session, await self.order(session, order_id), kind, actor)

    async def explain(self, session: AsyncSession, order: Order, why: str, expected: Expected | None) -> None:
        """Say in words why an order waits, and with it when it is expected. Changes nothing else."""
        order.why = why
        await self.expect(session, order, expected)

    async def expect(self, session: AsyncSession, order: Order, expected: Expected | None) -> None:
        """Say when the robot should be at the recipient's, as it is foreseen now, or that no time is known."""
        order.estimated_at = self.clock.utc()
        order.expected_from, order.expected_to = expected or (None, None)
        if expected is not None:
            order.window_assumed = self.estimates.is_assumed
            if order.window_to is None:  # nothing could be promised when it was placed
                order.window_from, order.window_to = expected
        await self.show(session, order)

    async def show(self, session: AsyncSession, order: Order) -> None:
        """Publish to pages alone, without calling `on_change`."""
        if self.feed.is_heard:
            self._publish_views(session, (await load_facts(session, [order]))[0])
        else:
            after_commit(session, self.feed.pass_over)

    async def _write(
        self, session: AsyncSession, order: Order, kind: str, actor: Actor, *, quietly: bool = False
    ) -> None:
        order.version += 1
        order.updated_at = self.clock.utc()
        await (await connection_of(session)).execute(_NEW_EVENT, event_row(order, kind, actor))
        is_told = kind == MOVED and order.state in NOTIFICATION_RULES and not quietly
        if not is_told and not self.feed.is_heard:  # nothing is loaded without a reader
            after_commit(session, self.feed.pass_over)
            after_commit(session, partial(self.changed, order.id))
            return
        facts = (await load_facts(session, [order]))[0]
        if is_told:
            await self._tell(session, facts, actor.post)
        self.publish(session, facts)

    async def notify_when_near(self, session: AsyncSession, order_id: str, post: str | None) -> None:
        """Notify the sender once the robot, which passes a post, is near. Raises UnknownOrder."""
        order = await self.order(session, order_id)
        if self._is_robot_near(order, post):
            await self._tell(session, (await load_facts(session, [order]))[0], post)
            after_commit(session, partial(self.changed, order_id))

    async def _tell(self, session: AsyncSession, facts: OrderFacts, robot_at: str | None = None) -> None:
        await tell_all(session, self.notices(facts, robot_at))

    def notices(self, facts: OrderFacts, robot_at: str | None = None) -> list[dict[str, Any]]:
        """Return the notices for sender and recipient of the order's present state."""
        order = facts.order
        robot_at = robot_at or (facts.robot.post if facts.robot else None)
        nearby = self._is_robot_near(order, robot_at)
        gaps = facts_of(order, facts.people, self.campus, self.settings, self.clock.utc())
        return notices_about(order, gaps, facts.events, nearby, self.clock.utc())

    def _is_robot_near(self, order: Order, robot_at: str | None) -> bool:
        return order.state is OrderState.TO_SENDER and is_near(
            self.ways, robot_at, order.load_post, self.settings.assumed_speed_m_s
        )

    def publish(self, session: AsyncSession, facts: OrderFacts) -> None:
        """Publish to sender, recipient and dispatchers, each as they may see it, and call `on_change`."""
        self._publish_views(session, facts)
        after_commit(session, partial(self.changed, facts.order.id))

    def _publish_views(self, session: AsyncSession, facts: OrderFacts) -> None:
        mine: dict[str, MyRole] = {facts.recipient.id: "recipient", facts.sender.id: "sender"}
        for person_id, role in mine.items():
            self._publish_view(session, partial(self.view_of, facts, role, person_id), person_id)
        for_all = partial(self.view_of, facts, "dispatcher", "")
        self._publish_view(session, for_all, role=Role.DISPATCHER, except_for=frozenset(mine))

    def view_of(self, facts: OrderFacts, role: MyRole, person_id: str) -> OrderView:
        """Return the order as it is now, for one person in one role."""
        return order_view(facts, role, person_id, self.campus, self.settings, self.clock.utc())

    async def view(self, session: AsyncSession, order: Order, role: MyRole, person: Person) -> OrderView:
        """Return the order with its rows as they are now, for one person in one role."""
        return self.view_of((await load_facts(session, [order]))[0], role, person.id)

    def changed(self, order_id: str) -> None:
        """Call `on_change`. After the commit."""
        for call in self.on_change:
            call(order_id)

    def _publish_view(
        self,
        session: AsyncSession,
        view: Callable[[], OrderView],
        person_id: str | None = None,
        role: Role | None = None,
        except_for: frozenset[str] = frozenset(),
    ) -> None:
        happening = FeedEvent("order", view, person_id, role, except_for)
        after_commit(session, lambda: self.feed.publish(happening))


def _reset_requests(order: Order) -> None:
    """Clear the requests to the robot that it had: it is back in the queue."""
    order.robot = None
    order.cancel_requested_at = order.cancel_requested_by = None
    order.return_requested_at = order.reassign_requested_at = None


_NEW_EVENT: Final = insert(OrderEvent)


def event_row(order: Order, kind: str, actor: Actor) -> dict[str, Any]:
    """Return the event of what has just happened to `order`."""
    return {
        "order_id": order.id,
        "seq": order.version,
        "state": order.state,
        "kind": kind,
        "at": order.updated_at,
        "by": actor.by,
        "person_id": actor.person_id,
        "robot": actor.robot,
        "robot_at": actor.robot_at,
        "post": actor.post,
        "reason": actor.reason,
    }


def unknown(order_id: str) -> errors.UnknownOrder:
    """Return the same error for a missing order and for an order of others."""
    return errors.UnknownOrder(f"There is no order {order_id} among yours.")


def _matches(if_match: str, version: int) -> bool:
    """The version is all that counts of a tag such as `"7-…"` (see `app.http.etags`)."""
    tags = [tag.strip() for tag in if_match.split(",")]
    return any(tag in {"*", f'"{version}"'} or tag.startswith(f'"{version}-') for tag in tags)
