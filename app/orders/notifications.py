"""Notifications by state of an order: one table."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any, Final

from app.core.settings import Settings
from app.core.texts.times import as_fact
from app.models import NotificationKind, Order, OrderEvent, OrderState, Person
from app.models.orders.order_events import MOVED
from app.notifications.service import notice_row
from app.notifications.wording import TIMES
from app.orders.transitions import MAIL_ABOARD, By
from app.orders.views.estimate import expected_of
from maps import CampusMap

SENDER: Final = By.SENDER
RECIPIENT: Final = By.RECIPIENT


@dataclass(frozen=True)
class NotificationRule:
    """One notification to one person, if it concerns them; `when_near`: not before the robot is near."""

    who: By
    kind: NotificationKind
    concerns: Callable[[Order], bool] = lambda order: True
    when_near: bool = False


def _both(
    kind: NotificationKind, concerns: Callable[[Order], bool] = lambda order: True
) -> tuple[NotificationRule, NotificationRule]:
    return NotificationRule(SENDER, kind, concerns), NotificationRule(RECIPIENT, kind, concerns)


def _is_with_its_sender(order: Order) -> bool:
    return not order.is_passed_on


def _was_called_back(order: Order) -> bool:
    return order.cancel_requested_at is not None


def _was_not_taken(order: Order) -> bool:
    return not _was_called_back(order)


def _comes_to_the_sender(order: Order) -> bool:
    return return_post_of(order) == order.from_post


def _was_aboard(order: Order) -> bool:
    """Return whether the recipient was notified already of what could be late or go wrong."""
    return (order.state_before_attention or order.state) in MAIL_ABOARD


NOTIFICATION_RULES: Final[Mapping[OrderState, tuple[NotificationRule, ...]]] = {
    OrderState.QUEUED: (NotificationRule(SENDER, NotificationKind.ACCEPTED),),
    OrderState.TO_SENDER: (NotificationRule(SENDER, NotificationKind.ROBOT_NEAR, _is_with_its_sender, when_near=True),),
    OrderState.AT_SENDER: (NotificationRule(SENDER, NotificationKind.ROBOT_HERE, _is_with_its_sender),),
    OrderState.CARRYING: (NotificationRule(RECIPIENT, NotificationKind.ON_ITS_WAY),),
    OrderState.AT_RECIPIENT: (NotificationRule(RECIPIENT, NotificationKind.ROBOT_HERE_FOR_YOU),),
    OrderState.DELIVERED: _both(NotificationKind.DELIVERED),
    OrderState.RETURNING: (
        *_both(NotificationKind.NOT_TAKEN, _was_not_taken),
        *_both(NotificationKind.CALLED_BACK, _was_called_back),
    ),
    # In the mailroom its staff take it out.
    OrderState.AT_RETURN: (NotificationRule(SENDER, NotificationKind.AT_RETURN, _comes_to_the_sender),),
    OrderState.RETURNED: _both(NotificationKind.RETURNED),
    OrderState.HELD: _both(NotificationKind.HELD),
    OrderState.CANCELLED: (NotificationRule(SENDER, NotificationKind.CANCELLED),),
    OrderState.EXPIRED: (NotificationRule(SENDER, NotificationKind.EXPIRED),),
    OrderState.ATTENTION: (
        NotificationRule(SENDER, NotificationKind.ATTENTION),
        NotificationRule(RECIPIENT, NotificationKind.ATTENTION, _was_aboard),
    ),
}
LATE: Final = (
    NotificationRule(SENDER, NotificationKind.DELAYED),
    NotificationRule(RECIPIENT, NotificationKind.DELAYED, _was_aboard),
)

ONCE: Final = frozenset(
    {
        NotificationKind.ACCEPTED,
        NotificationKind.DELIVERED,
        NotificationKind.RETURNED,
        NotificationKind.HELD,
        NotificationKind.CANCELLED,
        NotificationKind.EXPIRED,
    }
)
"""What an order goes through once at most; everything else may happen again in a later round."""


def round_of(events: Sequence[OrderEvent]) -> int:
    """Return how often the order was queued or needed attention: after each, people are notified anew."""
    again = (OrderState.QUEUED, OrderState.ATTENTION)
    return sum(event.state in again and event.kind == MOVED for event in events)


def notices_about(
    order: Order,
    facts: Mapping[str, str],
    events: Sequence[OrderEvent],
    is_near: bool = False,
    now: datetime | None = None,
) -> list[dict[str, Any]]:
    """Return the notices of the state that `order` is in now; `events` are its history, `is_near`: its
    robot is near the sender. `now`: if that is not when the order changed."""
    rules = [one for one in NOTIFICATION_RULES.get(order.state, ()) if is_near or not one.when_near]
    return _notices(rules, order, facts, round_of(events), now or order.updated_at)


def notices_of_delay(order: Order, facts: Mapping[str, str], events: Sequence[OrderEvent]) -> list[dict[str, Any]]:
    """Return the notices of a window later than people were told; once in each round."""
    return _notices(LATE, order, facts, round_of(events), order.updated_at)


def _notices(
    rules: Sequence[NotificationRule], order: Order, facts: Mapping[str, str], round_: int, now: datetime
) -> list[dict[str, Any]]:
    ids = {SENDER: order.sender_id, RECIPIENT: order.recipient_id}
    notices = []
    for one in rules:
        if one.concerns(order):
            occasion = f".{round_}" if round_ > 1 and one.kind not in ONCE else ""
            key = f"{order.id}.{one.kind}{occasion}"
            notices.append(notice_row(ids[one.who], key, order.id, one.kind, facts, now))
    return notices


def facts_of(
    order: Order, people: Mapping[str, Person], campus: CampusMap, settings: Settings, now: datetime
) -> dict[str, str]:
    """Return what fills the gaps of a notice's text; never a code, and no times while none are known."""
    expected = expected_of(order, now)
    times = dict(zip(TIMES, expected, strict=True)) if expected else {}
    return {
        "sender": people[order.sender_id].name,
        "recipient": people[order.recipient_id].name,
        "from_post": title_of(order.from_post, campus),
        "to_post": title_of(order.to_post, campus),
        "return_post": title_of(return_post_of(order), campus),
        **{name: as_fact(at, settings.zone) for name, at in times.items()},
    }


def return_post_of(order: Order) -> str:
    """Where mail goes that was not taken."""
    return order.return_post or order.from_post


def title_of(post: str, campus: CampusMap) -> str:
    """The post as people call it; its plain name if the map has changed since."""
    return campus.posts[post].title if post in campus.posts else post
