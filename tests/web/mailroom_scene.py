"""A campus at work, written into the database of a running service, without driving."""

from collections.abc import Sequence
from datetime import timedelta
from typing import Any, Final

from sqlmodel import col, select

from app.accounts.sign_in.service import set_roles
from app.composition import create_app
from app.core.settings import Settings
from app.models import Alarm, DigitLock, Notification, Order, OrderState, OutgoingNotification, Priority, RobotRow, Role
from app.orders.service import Actor
from app.orders.transitions import By
from app.orders.views.schemas import NewOrder
from protocol.clock import Clock, RealClock
from tests.plain_maps import PLAIN_TRACK
from tests.web.service import Service
from tests.web.visitor import Visit, Visitor

WAY: Final = ("assigned", "to_sender", "at_sender", "carrying", "at_recipient", "returning", "at_return")
ROBOTS: Final = (
    # name, and what it says of itself
    ("r1", {"post": "post2", "previous": "post1", "towards": "post4", "activity": "driving", "battery_ratio": 0.81}),
    (
        "r2",
        {"post": "post4", "activity": "waiting", "battery_ratio": 0.55, "why": "Waiting for the recipient at post4"},
    ),
    (
        "r3",
        {"post": "post5", "activity": "charging", "battery_ratio": 0.18, "charging": True, "why": "Charging at post5"},
    ),
    ("r4", {"post": "post3", "activity": "waiting", "battery_ratio": 0.4, "online": False}),
)
ORDERS: Final = (
    # state, robot, sender, recipient, from, to, what
    ("carrying", "r1", "ada.lovelace", "bob.martin", "post1", "post4", "Signed forms"),
    ("at_recipient", "r2", "grace.hill", "carl.sagan", "post3", "post4", "Lecture notes in a blue envelope"),
    ("assigned", "r2", "emmy.noether", "alan.turing", "post4", "post1", None),
    ("to_sender", "r1", "alan.turing", "ada.lovelace", "post4", "post2", "Keys"),
    ("returning", "r2", "carl.sagan", "emmy.noether", "post2", "post3", None),
    ("queued", None, "bob.martin", "grace.hill", "post1", "post3", "A small parcel"),
    ("queued", None, "ada.lovelace", "carl.sagan", "post2", "post4", None),
    ("queued", None, "emmy.noether", "bob.martin", "post3", "post1", "Exam sheets"),
    ("queued", None, "alan.turing", "grace.hill", "post4", "post1", None),
    ("queued", None, "carl.sagan", "ada.lovelace", "post1", "post2", "Books"),
    ("carrying", "r4", "grace.hill", "emmy.noether", "post3", "post1", "Samples"),
    ("at_sender", "r1", "bob.martin", "alan.turing", "post2", "post4", "Contract"),
)


class Scene:
    """Writes to the service's database as its own parts would."""

    def __init__(
        self, service: Service, clock: Clock | None = None, campus: str = str(PLAIN_TRACK), zone: str = ""
    ) -> None:
        settings = Settings(
            data=service.folder, public_url=service.url, pages=service.folder / "none", map=campus, time_zone=zone
        )
        self.clock = clock or RealClock()
        self.state = create_app(settings, self.clock).state.parts

    async def make_dispatcher(self, email: str) -> None:
        """For tests of what dispatchers see; a maintainer would do it over HTTP."""
        async with self.state.database.transaction() as session:
            person = await self.state.sign_in_service.person(session, email, self.clock.utc())
            set_roles(person, {Role.DISPATCHER}, set())

    async def is_busy(self) -> list[str]:
        """Twelve orders and four robots, and nothing that anybody has to see to. The orders' ids."""
        now = self.clock.utc()
        async with self.state.database.transaction() as session:
            for name, said in ROBOTS:
                known = {"online": True, "seen_at": now - timedelta(seconds=40), "heard_at": now, **said}
                session.add(RobotRow(name=name, enrolled_at=now, server_journal=f"journal-{name}", **known))
        return [await self.order(*facts, waits_s=60 * n) for n, facts in enumerate(ORDERS)]

    async def order(self, *facts: Any, waits_s: float = 0.0) -> str:
        to, robot, sender, recipient, from_post, to_post, what = facts
        async with self.state.database.transaction() as session:
            person = await self.state.sign_in_service.person(session, f"{sender}@campus.example", self.clock.utc())
            wish = NewOrder(
                from_post=from_post,
                to_post=to_post,
                recipient=f"{recipient}@campus.example",
                description=what,
                not_before=self.clock.utc() + timedelta(hours=2) if what == "Books" else None,
                priority=Priority.LOW if what == "Exam sheets" else Priority.NORMAL,
            )
            draft = await self.state.orders.placing.draft(session, person, wish, {person.email: person})
            await self.state.orders.placing.write(session, [draft])
            order_id = draft.facts.order.id
            await self._go(session, order_id, robot, _way_to(to))
            order = await session.get_one(Order, order_id)
            order.created_at -= timedelta(seconds=waits_s)
        return str(order_id)

    async def is_ordered_for_later(self, count: int) -> list[str]:
        """So many orders that no robot fetches today. Their ids."""
        later = self.clock.utc() + timedelta(days=1)
        async with self.state.database.transaction() as session:
            person = await self.state.sign_in_service.person(session, "ada.lovelace@campus.example", self.clock.utc())
            known = {person.email: person}
            wish = NewOrder(from_post="post1", to_post="post4", recipient=person.email, not_before=later)
            drafts = [await self.state.orders.placing.draft(session, person, wish, known) for _ in range(count)]
            await self.state.orders.placing.write(session, drafts)
        return [draft.facts.order.id for draft in drafts]

    async def lets_wait(self, robot: str, from_post: str, to_post: str, for_robot: str, minutes: float) -> None:
        """As the schedule would have it."""
        until = self.clock.utc() + timedelta(minutes=minutes)
        async with self.state.database.transaction() as session:
            row = await session.get_one(RobotRow, robot)
            row.why = f"Waiting at {from_post} for permission to drive on"
            way = {"from_post": from_post, "to_post": to_post, "robots": [for_robot], "closed": False}
            row.waits_for = {**way, "until": until.isoformat()}

    async def _go(self, session: Any, order_id: str, robot: str | None, way: Sequence[str]) -> None:
        for state in way:
            by = By.DISPATCHER if state == "assigned" else By.ROBOT
            await self.state.orders.ledger.move(
                session, order_id, OrderState(state), Actor(by, robot=robot, robot_at=self.clock.utc())
            )

    async def everything_goes_wrong(self, ids: Sequence[str]) -> None:
        """Something of each kind."""
        now = self.clock.utc()
        async with self.state.database.transaction() as session:
            reason = "The lid does not close."
            await self.state.orders.ledger.move(
                session, ids[0], OrderState.ATTENTION, Actor(By.ROBOT, robot="r1", reason=reason)
            )
            await self.state.orders.ledger.note(session, ids[1], "digits_locked", Actor(By.RECIPIENT))
            session.add(DigitLock(order_id=ids[1], wrong_tries=5, locked_at=now))
            at_post = (await session.get_one(RobotRow, "r1")).post
            session.add(Alarm(robot="r1", name="stall", reason=reason, post=at_post, at=now - timedelta(minutes=3)))
            stopped = await session.get_one(RobotRow, "r2")
            stopped.activity, stopped.why = "stopped", "Something stands in the robot's way."
            silent = await session.get_one(RobotRow, "r4")
            silent.heard_at = now - timedelta(minutes=12)  # not so long that others go round it
            notice = (await session.exec(select(Notification).order_by(col(Notification.id)).limit(1))).one()
            given_up = {"tries": 9, "gave_up_at": now - timedelta(hours=1), "problem": "The mail server said no (550)."}
            session.add(
                OutgoingNotification(key="given-up", channel="mail", notice_id=notice.id, created_at=now, **given_up)
            )


class Campus:
    """A service and what has been written into it."""

    def __init__(self, service: Service) -> None:
        self.service, self.scene = service, Scene(service)
        self.orders: list[str] = []

    async def dispatcher(self, visit: Visit, **options: Any) -> Visitor:
        dana = await visit("dana.desk", at=self.service, **options)
        await self.scene.make_dispatcher(dana.email)
        return dana


def _way_to(state: str) -> Sequence[str]:
    if state == "queued":
        return ()
    way = WAY[: WAY.index(state) + 1]
    return [one for one in way if one != "at_recipient" or state == one] if state != "at_return" else way
