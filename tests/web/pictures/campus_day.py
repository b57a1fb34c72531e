"""A Wednesday morning on the campus, written into the service's database: robots at work, letters old and new."""

import math
from collections.abc import Sequence
from datetime import timedelta
from typing import Any, Final

from sqlalchemy import update
from sqlmodel import col

from app.accounts.sign_in.service import find_person, set_roles
from app.models import BatterySample, GrantRow, Notification, OrderState, RobotRow, Role
from app.orders.service import Actor
from app.orders.transitions import By
from app.orders.views.schemas import NewOrder
from app.robots.service import enrol
from protocol.clock import SteppedClock
from tests.web.mailroom_scene import Scene
from tests.web.pictures.stage import CAMPUS, MOMENT, ZONE
from tests.web.service import Service

STEP_S: Final = 130.0
"""Between two things that happen to a letter."""
DAY_S: Final = 86_400.0
DELIVERED: Final = ("assigned", "to_sender", "at_sender", "carrying", "at_recipient", "delivered")
WAYS: Final[dict[str, Sequence[str]]] = {
    **{state: DELIVERED[: n + 1] for n, state in enumerate(DELIVERED)},
    "queued": (),
    "cancelled": ("cancelled",),
    "returning": (*DELIVERED[:5], "returning"),
}
ROBOTS: Final[dict[str, dict[str, Any]]] = {
    "r1": {"post": "azrieli", "previous": "library", "towards": "uc", "activity": "driving", "battery_ratio": 0.66},
    "r2": {"post": "library", "activity": "waiting", "battery_ratio": 0.64, "why": "waiting for the sender to load"},
    "r3": {"post": "canal", "activity": "charging", "battery_ratio": 0.27, "charging": True, "why": "Charging"},
    "r4": {"post": "steacie", "activity": "waiting", "battery_ratio": 0.46},
}
WHYS: Final = {"r1": "Driving towards uc", "r4": "waiting for the recipient"}
ORDERS: Final[dict[str, tuple[Any, ...]]] = {
    # name: state, robot, sender, recipient, from, to, what, and for how many seconds it has been in that state
    "week_1": ("delivered", "r1", "ada.lovelace", "bob.martin", "library", "nicol", "Signed forms", 1.1 * DAY_S),
    "week_2": ("delivered", "r2", "grace.hill", "ada.lovelace", "steacie", "library", "Lecture notes", 1.2 * DAY_S),
    "week_3": ("delivered", "r1", "ada.lovelace", "emmy.noether", "library", "mackenzie", "Exam papers", 3.1 * DAY_S),
    "week_4": ("delivered", "r3", "bob.martin", "ada.lovelace", "nicol", "library", None, 5.9 * DAY_S),
    "changed_mind": ("cancelled", None, "ada.lovelace", "alan.turing", "library", "loeb", "Keys", 2 * DAY_S + 90),
    "driving": ("carrying", "r1", "ada.lovelace", "bob.martin", "library", "nicol", "Signed forms", 150),
    "handover": ("at_sender", "r2", "ada.lovelace", "grace.hill", "library", "steacie", "Lecture notes", 95),
    "guest": ("at_recipient", "r4", "bob.martin", "carl.sagan", "nicol", "steacie", "A blue envelope", 60),
    "kept_waiting": ("queued", None, "bob.martin", "ada.lovelace", "nicol", "library", "A small parcel", 400),
    "placed": ("queued", None, "ada.lovelace", "emmy.noether", "library", "mackenzie", "Keys", 45),
    "fetched": ("to_sender", "r4", "emmy.noether", "alan.turing", "mackenzie", "loeb", None, 75),
    "comes_back": ("returning", "r1", "alan.turing", "emmy.noether", "loeb", "mackenzie", "Contract", 210),
    "low": ("queued", None, "grace.hill", "bob.martin", "steacie", "nicol", "Exam sheets", 1_260),
    "later": ("queued", None, "carl.sagan", "grace.hill", "commons", "richcraft", "Books", 1_800),
}
ROLES: Final = {"dana.desk": {Role.DISPATCHER}, "mira.klein": {Role.DISPATCHER, Role.MAINTAINER}}
GUEST: Final = "carl.sagan@campus.example"


class CampusDay(Scene):
    """Its clock steps back and forth, so that each thing has happened when it should have."""

    def __init__(self, service: Service) -> None:
        self.time = SteppedClock(started_at=MOMENT)
        super().__init__(service, self.time, CAMPUS, ZONE)
        self.ids: dict[str, str] = {}
        self.links: dict[str, str] = {}

    async def begins(self) -> None:
        """Everything as it is at 10:24."""
        for who, roles in ROLES.items():
            await self.has_roles(f"{who}@campus.example", roles)
        await self._robots()
        for at_s, order, state in sorted(step for name in ORDERS for step in _steps(name)):
            self.time.now_s = at_s
            await self._happens(order, state)
        self.time.now_s = 0.0
        await self._link_for_the_guest()
        await self._old_notices_are_read()

    async def has_roles(self, email: str, roles: set[Role]) -> None:
        async with self.state.database.transaction() as session:
            set_roles(await self.state.sign_in_service.person(session, email, MOMENT), roles, set())

    async def _happens(self, name: str, state: str) -> None:
        """One step of one letter; its first one is that it is ordered."""
        _, robot, *wish, _ = ORDERS[name]
        if state == "ordered":
            self.ids[name] = await self.is_ordered(*wish)
            return
        async with self.state.database.transaction() as session:
            await self.state.orders.ledger.move(session, self.ids[name], OrderState(state), self._actor(state, robot))

    async def is_ordered(self, sender: str, recipient: str, from_post: str, to_post: str, what: str | None) -> str:
        """Its id."""
        wish = NewOrder(
            from_post=from_post,
            to_post=to_post,
            recipient=f"{recipient}@campus.example",
            description=what,
            not_before=MOMENT + timedelta(hours=2) if what == "Books" else None,
        )
        async with self.state.database.transaction() as session:
            person = await self.state.sign_in_service.person(session, f"{sender}@campus.example", MOMENT)
            draft = await self.state.orders.placing.draft(session, person, wish, {person.email: person})
            await self.state.orders.placing.write(session, [draft])
        return str(draft.facts.order.id)

    def _actor(self, state: str, robot: str | None) -> Actor:
        if state == "cancelled":
            return Actor(By.SENDER)
        return Actor(By.DISPATCHER if state == "assigned" else By.ROBOT, robot=robot, robot_at=self.time.utc())

    async def _robots(self) -> None:
        async with self.state.database.transaction() as session:
            for name, said in ROBOTS.items():
                seen_at = MOMENT - timedelta(seconds=40)
                known = {"online": True, "seen_at": seen_at, "heard_at": MOMENT, "why": WHYS.get(name), **said}
                known |= {"software": "0.1.0", "map_version": self.state.campus.version}
                known |= {"takes_confirm": True, "public_key": "A" * 44, "enrolled_at": MOMENT - timedelta(days=23)}
                session.add(RobotRow(name=name, server_journal=f"journal-{name}", **known))
            await session.flush()
            held = {"robot": "r1", "claim_id": "c1", "from_post": "azrieli", "to_post": "uc"}
            session.add(GrantRow(**held, corridor="azrieli-uc", granted_at=MOMENT - timedelta(seconds=55)))
            session.add_all(_charge_of_a_day("r1"))

    async def _link_for_the_guest(self) -> None:
        async with self.state.database.transaction() as session:
            guest = await find_person(session, GUEST)
        self.links["guest"] = await self.state.links.url_for(guest, self.ids["guest"])

    async def _old_notices_are_read(self) -> None:
        """And of today's all but the last minutes'."""
        async with self.state.database.transaction() as session:
            old = update(Notification).where(col(Notification.at) < MOMENT - timedelta(minutes=3))
            await session.exec(old.values(read_at=MOMENT, routed_at=MOMENT))

    async def trouble(self) -> None:
        """Something of each kind that can be wrong."""
        await self.everything_goes_wrong([self.ids["fetched"], self.ids["guest"]])

    async def new_robot(self, name: str) -> str:
        """Its token."""
        async with self.state.database.transaction() as session:
            return str(await enrol(session, self.time, name))


def _steps(name: str) -> list[tuple[float, str, str]]:
    """When it was ordered, and when each of its states began, in seconds from now."""
    state, *_, for_s = ORDERS[name]
    states = ("ordered", *WAYS[state])
    return [(-for_s - STEP_S * (len(states) - 1 - n), name, one) for n, one in enumerate(states)]


def _charge_of_a_day(robot: str) -> list[BatterySample]:
    """Down while it drives, up at the dock, twice; every five minutes."""
    samples = []
    for minutes in range(0, 24 * 60 + 1, 5):
        phase = ((minutes + 390) / 720) % 1
        charging = phase < 0.22
        ratio = 0.24 + 0.72 * phase / 0.22 if charging else 0.96 - 0.72 * (phase - 0.22) / 0.78
        ratio += 0.012 * math.sin(minutes / 23)
        at = MOMENT - timedelta(minutes=24 * 60 - minutes)
        samples.append(BatterySample(robot=robot, at=at, ratio=min(1.0, ratio), charging=charging))
    return samples
