"""Who is told what, at which state of an order."""

from collections.abc import Mapping
from typing import Final

from sqlmodel.ext.asyncio.session import AsyncSession

from app.live.feed import Feed
from app.notify.service import tell
from app.orders.transitions import By
from app.settings import Settings
from app.tables import NoticeKind, Order, OrderState, Person
from maps import CampusMap

TOLD: Final[Mapping[OrderState, tuple[tuple[By, NoticeKind], ...]]] = {
    OrderState.QUEUED: ((By.SENDER, NoticeKind.ACCEPTED),),
    OrderState.TO_SENDER: ((By.SENDER, NoticeKind.ROBOT_NEAR),),
    OrderState.AT_SENDER: ((By.SENDER, NoticeKind.ROBOT_HERE),),
    OrderState.CARRYING: ((By.RECIPIENT, NoticeKind.ON_ITS_WAY),),
    OrderState.AT_RECIPIENT: ((By.RECIPIENT, NoticeKind.ROBOT_HERE_FOR_YOU),),
    OrderState.DELIVERED: ((By.SENDER, NoticeKind.DELIVERED), (By.RECIPIENT, NoticeKind.DELIVERED)),
    OrderState.CANCELLED: ((By.SENDER, NoticeKind.CANCELLED),),
    OrderState.EXPIRED: ((By.SENDER, NoticeKind.EXPIRED),),
}
"""Thin: "near" is told when the robot sets out for the sender; returned, delayed and attention are later issues."""


async def tell_about(
    session: AsyncSession, feed: Feed, order: Order, people: Mapping[str, Person], facts: Mapping[str, str]
) -> None:
    """Tell whoever is to be told of the state that `order` is in now."""
    ids = {By.SENDER: order.sender_id, By.RECIPIENT: order.recipient_id}
    for who, kind in TOLD.get(order.state, ()):
        person = people[ids[who]]
        await tell(session, feed, person=person, order_id=order.id, kind=kind, facts=facts, now=order.updated_at)


def facts_of(order: Order, people: Mapping[str, Person], campus: CampusMap, settings: Settings) -> dict[str, str]:
    """What fills the gaps of a notice's text; never a code."""
    times = {"window_from": order.window_from, "window_to": order.window_to}
    return {
        "sender": people[order.sender_id].name,
        "recipient": people[order.recipient_id].name,
        "from_post": title_of(order.from_post, campus),
        "to_post": title_of(order.to_post, campus),
        **{name: at.astimezone(settings.zone).strftime("%H:%M") if at else "?" for name, at in times.items()},
    }


def title_of(post: str, campus: CampusMap) -> str:
    """The post as people call it; its plain name if the map has changed since."""
    return campus.posts[post].title if post in campus.posts else post
