"""People, robots and history, written straight into a fresh database before the service is started on it."""

import asyncio
import secrets
from collections.abc import Iterator, Sequence, Set
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from functools import cache
from hashlib import sha256
from pathlib import Path
from random import Random
from typing import Any, Final

from sqlalchemy import insert
from sqlmodel import SQLModel

from app.accounts.sign_in.service import make_person, set_roles
from app.core.database.database import Database
from app.core.database.schema_version import bring_to_head
from app.core.settings import Settings, make_data_folder
from app.models import (
    MissionRow,
    Order,
    OrderEvent,
    OrderState,
    Person,
    PersonSession,
    RobotRow,
    RobotToken,
    Role,
    StopRow,
)
from app.models.orders.order_events import MOVED
from app.robots.link.tokens import make_token
from benchmarks.service.servers import MAP
from maps import CampusMap, find_map

ROWS_AT_ONCE: Final = 5000
LIFE: Final = (
    (OrderState.QUEUED, "sender"),
    (OrderState.ASSIGNED, "dispatcher"),
    (OrderState.TO_SENDER, "robot"),
    (OrderState.AT_SENDER, "robot"),
    (OrderState.CARRYING, "robot"),
    (OrderState.AT_RECIPIENT, "robot"),
    (OrderState.DELIVERED, "robot"),
)
"""What an order of the history has been through."""


@dataclass(frozen=True)
class Account:
    """A person who is signed in: `cookie` is the secret of the session."""

    person: Person
    cookie: str


@dataclass(frozen=True)
class KnownRobot:
    """An enrolled robot. With a mission it is on its way with mail."""

    name: str
    token: str
    mission_id: str | None = None


def url_of(data: Path) -> str:
    return f"sqlite:///{(data / 'campus-mail.sqlite').resolve()}"


@cache
def campus() -> CampusMap:
    return find_map(MAP)


@cache
def _posts() -> tuple[str, ...]:
    return tuple(sorted(campus().posts))


class Filling:
    """Writes rows as the service would have written them."""

    def __init__(self, database: Database, random: Random) -> None:
        self._database, self._random = database, random
        self.now = datetime.now(UTC)

    async def _write(self, table: type[SQLModel], rows: Sequence[SQLModel]) -> None:
        await self._insert(table, [row.model_dump() for row in rows])

    async def _insert(self, table: type[SQLModel], values: Sequence[dict[str, Any]]) -> None:
        for first in range(0, len(values), ROWS_AT_ONCE):
            async with self._database.writing.begin() as connection:
                await connection.execute(insert(table), values[first : first + ROWS_AT_ONCE])

    async def people(self, number: int, word: str = "person", roles: Set[Role] = frozenset()) -> list[Account]:
        """Signed in, with a session of their own."""
        people = [make_person(f"{word}.{n}@campus.example", "en", self.now) for n in range(number)]
        for person in people:
            set_roles(person, set(roles), set())
        cookies = [secrets.token_urlsafe(32) for _ in people]
        await self._write(Person, people)
        sessions = [
            PersonSession(
                token_hash=sha256(cookie.encode()).hexdigest(),
                person_id=person.id,
                created_at=self.now,
                expires_at=self.now + timedelta(days=1),
            )
            for person, cookie in zip(people, cookies, strict=True)
        ]
        await self._insert(PersonSession, [row.model_dump(exclude={"id"}) for row in sessions])
        return [Account(person, cookie) for person, cookie in zip(people, cookies, strict=True)]

    async def robots(self, number: int) -> list[KnownRobot]:
        """Enrolled, never connected so far."""
        tokens = [make_token() for _ in range(number)]
        names = [f"r{n}" for n in range(number)]
        rows = [RobotRow(name=name, enrolled_at=self.now, server_journal=f"service-{name}") for name in names]
        await self._write(RobotRow, rows)
        kept = [
            RobotToken(prefix=token.prefix, secret_hash=token.secret_hash, robot=name, created_at=self.now)
            for token, name in zip(tokens, names, strict=True)
        ]
        await self._write(RobotToken, kept)
        return [KnownRobot(name, token.text) for token, name in zip(tokens, names, strict=True)]

    async def give_missions(self, robots: Sequence[KnownRobot], account: Account) -> list[KnownRobot]:
        """Each is on its way to the recipient, with the mail aboard."""
        orders = [self._order(account, account, OrderState.CARRYING, self.now, robot.name) for robot in robots]
        missions = [
            MissionRow(id=f"m-{robot.name}", robot=robot.name, told_update=1, accepted_update=1, created_at=self.now)
            for robot in robots
        ]
        stops = [
            StopRow(
                id=f"{mission.id}-{position}",
                mission_id=mission.id,
                position=position,
                post=post,
                action=action,
                order_id=order.id,
            )
            for mission, order in zip(missions, orders, strict=True)
            for position, (post, action) in enumerate(((order.from_post, "load"), (order.to_post, "receive")))
        ]
        await self._write(Order, orders)
        await self._insert(OrderEvent, [event for order in orders for event in self._events(order, 5)])
        await self._write(MissionRow, missions)
        await self._write(StopRow, stops)
        return [KnownRobot(robot.name, robot.token, f"m-{robot.name}") for robot in robots]

    async def history(self, people: Sequence[Account], number: int) -> None:
        """So many delivered orders of the past, each from one of these people to another."""
        robot = "r-history"
        if not await self._is_there(robot):
            await self._write(RobotRow, [RobotRow(name=robot, enrolled_at=self.now, server_journal=robot)])
        for first in range(0, number, ROWS_AT_ONCE):
            orders = [self._past_order(people, first + n, robot) for n in range(min(ROWS_AT_ONCE, number - first))]
            await self._write(Order, orders)
            await self._insert(OrderEvent, [event for order in orders for event in self._events(order, len(LIFE))])

    async def _is_there(self, robot: str) -> bool:
        async with self._database.reading() as session:
            return await session.get(RobotRow, robot) is not None

    def _past_order(self, people: Sequence[Account], number: int, robot: str) -> Order:
        sender, recipient = self._random.sample(people, 2)
        at = self.now - timedelta(minutes=5 + number)
        return self._order(sender, recipient, OrderState.DELIVERED, at, robot)

    def _order(self, sender: Account, recipient: Account, state: OrderState, at: datetime, robot: str) -> Order:
        from_post, to_post = self._random.sample(_posts(), 2)
        return Order(
            id=self._random.randbytes(8).hex(),
            state=state,
            sender_id=sender.person.id,
            recipient_id=recipient.person.id,
            from_post=from_post,
            to_post=to_post,
            created_at=at,
            updated_at=at,
            codes_expire_at=at + timedelta(days=7),
            window_from=at,
            window_to=at,
            robot=robot,
        )

    def _events(self, order: Order, number: int) -> Iterator[dict[str, Any]]:
        """As columns: hundreds of thousands of rows as objects would take minutes."""
        about = {"order_id": order.id, "kind": MOVED, "robot": order.robot}
        for seq, (state, by) in enumerate(LIFE[:number], 1):
            at = order.created_at + timedelta(seconds=20 * seq)
            yield {**about, "seq": seq, "state": state, "at": at, "by": by}


def fill(data: Path, work: Any, seed: int = 1) -> Any:
    """Make the database, let `work(filling)` write into it, and close it."""

    async def run() -> Any:
        make_data_folder(Settings(data=data))
        database = Database(url_of(data))
        try:
            await bring_to_head(database)
            return await work(Filling(database, Random(f"{seed}/filling")))
        finally:
            await database.close()

    return asyncio.run(run())
