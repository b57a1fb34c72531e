"""Everybody who may knock at a route, each with a fresh way in, and an order that they knock about."""

from collections.abc import Awaitable, Callable, Iterable, Iterator
from dataclasses import dataclass, field
from datetime import timedelta
from typing import Any, Final

from fastapi import FastAPI
from sqlmodel import select
from sqlmodel.ext.asyncio.session import AsyncSession
from starlette.routing import BaseRoute, Mount

from app.accounts.scopes import Scope
from app.accounts.sessions.sessions import new_session
from app.accounts.sign_in.service import set_roles
from app.accounts.tokens import issue_token
from app.handover.schemas import NewDelegate
from app.models import Alarm, Notification, OrderState, OutgoingNotification, Person, PersonSession, Role
from app.notifications.preference_api.devices import add_device, set_webhook
from app.notifications.preference_api.schemas import NewDevice, SubscriptionKeys
from app.orders.service import Actor
from app.orders.transitions import By
from app.orders.views.schemas import NewOrder, NewStandingOrder
from app.robots.service import new_token
from tests.app.conftest import Mailroom
from tests.app.placed import placed

PEOPLE: Final = {
    # who: address, roles beyond member
    "member": ("stranger@campus.example", set[Role]()),
    "recipient": ("recipient@campus.example", set[Role]()),
    "sender": ("sender@campus.example", set[Role]()),
    "dispatcher": ("dispatcher@campus.example", {Role.DISPATCHER}),
    "maintainer": ("maintainer@campus.example", {Role.MAINTAINER}),
}
DELEGATE: Final = "delegate@campus.example"
"""Named by the sender of every order here, and signed in as anybody."""
GUEST: Final = "guest@campus.example"
EVERYTHING: Final = ("everything@campus.example", {Role.DISPATCHER, Role.MAINTAINER})
"""Whose scripts come with tokens: what they may not do is their scopes' doing."""


def routes_of(app: FastAPI) -> Iterator[tuple[str, str]]:
    """Method and path of every route, those that the API document leaves out too; a socket has no method."""
    for route, prefix in _flat(app.routes):
        path = prefix + getattr(route, "path", "")
        for method in getattr(route, "methods", None) or {"SOCKET"}:
            if method != "HEAD":
                yield method, path


def _flat(routes: list[BaseRoute], prefix: str = "") -> Iterator[tuple[BaseRoute, str]]:
    for route in routes:
        inner = getattr(route, "original_router", None)
        if inner is not None:
            yield from _flat(inner.routes, prefix + route.include_context.prefix)  # type: ignore[attr-defined]
        elif not isinstance(route, Mount):  # files
            yield route, prefix


@dataclass(frozen=True)
class Scene:
    """One request: the caller's headers, and the values for the gaps in paths."""

    headers: dict[str, str]
    places: dict[str, str]


@dataclass
class Everybody:
    """Sets scenes in transactions of the running service. The order is assigned: it waits for its sender's mail."""

    app: FastAPI
    mailroom: Mailroom
    _headers_of: dict[str, dict[str, str]] = field(default_factory=dict)
    _places: dict[str, str] = field(default_factory=lambda: dict(FIXED))

    def scene(self, who: str, gaps: Iterable[str] = ("order_id",), anew: bool = False) -> Scene:
        """Return a caller's headers and paths. Gaps are filled when first asked for, `anew` if they may change."""
        known = who in self._headers_of and self._places.keys() >= set(gaps)
        if anew or not known:
            self.mailroom.call(self._set, who, list(gaps), anew)
        headers = self._headers_of.pop(who) if anew else self._headers_of[who]
        return Scene(headers, dict(self._places))

    def fresh_scene(self, who: str) -> Scene:
        """Return a scene with credentials that no other scene uses."""
        return self.scene(who, (), anew=True)

    async def _set(self, who: str, gaps: list[str], anew: bool) -> None:
        async with self.app.state.parts.database.transaction() as session:
            people = {name: await self._person(session, *known) for name, known in PEOPLE.items()}
            self._places["person_id"] = people["member"].id
            for gap in gaps:
                if gap in MAKERS and (anew or gap not in self._places):
                    self._places[gap] = await MAKERS[gap](self, session, people["sender"])
            if anew or who not in self._headers_of:
                self._headers_of[who] = await self._headers(session, who, people)
        if "link" in gaps and "link" not in self._places:
            self._places["link"] = await self._mailed_link()

    async def _mailed_link(self) -> str:
        """Return the part behind the # of an order's link, from the mail to its recipient without account."""
        async with self.app.state.parts.database.transaction() as session:
            sender, guest = [await self._person(session, email, set()) for email in (PEOPLE["sender"][0], GUEST)]
            order_id = await self._order(session, sender, GUEST)
        url = await self.app.state.parts.links.url_for(guest, order_id)
        assert url
        return str(url.partition("#")[2])

    async def _headers(self, session: AsyncSession, who: str, people: dict[str, Person]) -> dict[str, str]:
        if who == "stranger":
            return {}
        if who == "robot":
            return {"Authorization": f"Bearer {await new_token(session, self.app.state.parts.clock, 'r1')}"}
        if who == "delegate":
            people = {**people, who: await self._person(session, DELEGATE, set())}
        if who in people:
            _, cookie = await self._signed_in(session, people[who])
            return {"Cookie": f"session={cookie}", "Sec-Fetch-Site": "same-origin"}
        _, text = await self._token(session, await self._person(session, *EVERYTHING), who.split())
        return {"Authorization": f"Bearer {text}"}

    async def a_session(self, session: AsyncSession, sender: Person) -> str:
        return str((await self._signed_in(session, sender))[0].id)

    async def a_token(self, session: AsyncSession, sender: Person) -> str:
        return (await self._token(session, sender, [Scope.ORDERS_READ]))[0]

    async def a_robots_token(self, session: AsyncSession, sender: Person) -> str:
        return (await new_token(session, self.app.state.parts.clock, "r1")).split("_")[1]

    async def a_device(self, session: AsyncSession, sender: Person) -> str:
        """A browser of the sender's, and a webhook."""
        now = self.app.state.parts.clock.utc()
        await set_webhook(session, sender, "https://hook.example/sender", now)
        keys = NewDevice(endpoint="https://push.example/sender", keys=SubscriptionKeys(p256dh="AA", auth="AA"))
        return (await add_device(session, sender, keys, now)).id

    async def a_sending(self, session: AsyncSession, sender: Person) -> str:
        """A sending that no channel takes."""
        now, order_id = self.app.state.parts.clock.utc(), await self._order(session, sender, PEOPLE["recipient"][0])
        notice = (await session.exec(select(Notification.id).where(Notification.order_id == order_id))).one()
        sending = OutgoingNotification(key=order_id, channel="none", notice_id=notice, created_at=now)
        session.add(sending)
        await session.flush()
        return str(sending.id)

    async def an_alarm(self, session: AsyncSession, sender: Person) -> str:
        alarm = Alarm(robot="r1", name="blocked", reason="A box.", at=self.app.state.parts.clock.utc())
        session.add(alarm)
        await session.flush()
        return str(alarm.id)

    async def a_delegate(self, session: AsyncSession, sender: Person) -> str:
        delegating, wish = self.app.state.parts.delegating, NewDelegate(name="The porter")
        return str((await delegating.name(session, sender, self._places["order_id"], wish)).id)

    async def a_standing_order(self, session: AsyncSession, sender: Person) -> str:
        order = {"from_post": "post1", "to_post": "post4", "recipient": PEOPLE["recipient"][0]}
        wish = NewStandingOrder(**order, weekdays=[0], at="09:30", zone="America/Toronto")
        return str((await self.app.state.parts.standing_orders.create(session, sender, wish)).id)

    async def an_order(self, session: AsyncSession, sender: Person) -> str:
        order_id = await self._order(session, sender, PEOPLE["recipient"][0])
        await self.app.state.parts.delegating.name(session, sender, order_id, NewDelegate(name="Dee", email=DELEGATE))
        return order_id

    async def _person(self, session: AsyncSession, email: str, roles: set[Role]) -> Person:
        parts = self.app.state.parts
        person: Person = await parts.sign_in_service.person(session, email, parts.clock.utc())
        set_roles(person, roles, set(Role) - roles)
        return person

    async def _signed_in(self, session: AsyncSession, person: Person) -> tuple[PersonSession, str]:
        row, cookie = new_session(person, "", 3600, self.app.state.parts.clock.utc())
        session.add(row)
        await session.flush()
        return row, cookie

    async def _token(self, session: AsyncSession, person: Person, scopes: Any) -> tuple[str, str]:
        now = self.app.state.parts.clock.utc()
        row, text = await issue_token(session, person, "script", scopes, timedelta(days=1), now)
        return row.prefix, text

    async def _order(self, session: AsyncSession, sender: Person, recipient: str) -> str:
        orders = self.app.state.parts.orders
        wish = NewOrder(from_post="post1", to_post="post4", recipient=recipient)
        order_id = await placed(orders, session, sender, wish)
        await orders.ledger.move(session, order_id, OrderState.ASSIGNED, Actor(By.DISPATCHER, robot="r1"))
        return order_id


FIXED: Final = {
    "name": "r1",
    "corridor": "post2-post3",
    "role": "dispatcher",
    "email": "somebody@campus.example",
    "file": "none.eml",
    "post": "post1",
}
MAKERS: Final[dict[str, Callable[[Everybody, AsyncSession, Person], Awaitable[str]]]] = {
    # what fills a gap of a path or body, all of it the sender's; what another one needs stands before it
    "order_id": Everybody.an_order,
    "standing_order_id": Everybody.a_standing_order,
    "session_id": Everybody.a_session,
    "prefix": Everybody.a_token,
    "alarm_id": Everybody.an_alarm,
    "delegate_id": Everybody.a_delegate,
    "token_prefix": Everybody.a_robots_token,
    "device_id": Everybody.a_device,
    "sending_id": Everybody.a_sending,
}
