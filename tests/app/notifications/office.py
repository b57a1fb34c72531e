"""The whole service with its worker, in the event loop of the test, and orders that give it something to tell."""

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import dataclass
from typing import Any

from fastapi import FastAPI
from sqlmodel import col, select

from app.composition import create_app
from app.core.http_client import HttpClient
from app.core.settings import Settings
from app.models import OrderState, OutgoingNotification, Person, RobotRow
from app.orders.service import Actor
from app.orders.transitions import By
from app.orders.views.schemas import NewOrder
from protocol.clock import SteppedClock
from tests.app.conftest import RECIPIENT, SENDER
from tests.app.placed import placed


@dataclass(frozen=True)
class Office:
    """One running service."""

    app: FastAPI
    clock: SteppedClock

    @property
    def state(self) -> Any:
        return self.app.state.parts

    async def person(self, email: str, **known: Any) -> Person:
        async with self.state.database.transaction() as session:
            person: Person = await self.state.sign_in_service.person(session, email, self.clock.utc())
            for name, value in known.items():
                setattr(person, name, value)
            return person

    async def add(self, *rows: Any) -> None:
        async with self.state.database.transaction() as session:
            session.add_all(rows)

    async def order(self) -> str:
        """The sender is told that it is accepted."""
        sender = await self.person(SENDER)
        async with self.state.database.transaction() as session:
            wish = NewOrder(from_post="post1", to_post="post4", recipient=RECIPIENT)
            return await placed(self.state.orders, session, sender, wish)

    async def move(self, order_id: str, *states: str) -> None:
        for state in states:
            async with self.state.database.transaction() as session:
                if await session.get(RobotRow, "r1") is None:
                    session.add(RobotRow(name="r1", enrolled_at=self.clock.utc(), server_journal="j1", post="post5"))
                    await session.flush()
                by = By.DISPATCHER if state == "assigned" else By.ROBOT
                await self.state.orders.ledger.move(session, order_id, OrderState(state), Actor(by, robot="r1"))

    async def settle(self) -> None:
        """Let the worker do everything that is due."""
        self.state.outbox_worker.wake()
        async with asyncio.timeout(20):
            while await self.state.outbox_worker.has_work():  # noqa: ASYNC110  # the worker rings no bell of ours
                await asyncio.sleep(0.01)

    async def sendings(self, channel: str) -> list[OutgoingNotification]:
        async with self.state.database.reading() as session:
            rows = (
                select(OutgoingNotification)
                .where(OutgoingNotification.channel == channel)
                .order_by(col(OutgoingNotification.id))
            )
            return list((await session.exec(rows)).all())

    async def sending(self, channel: str) -> OutgoingNotification:
        (one,) = await self.sendings(channel)
        return one


@asynccontextmanager
async def running(
    settings: Settings, clock: SteppedClock, http_client: HttpClient | None = None
) -> AsyncIterator[Office]:
    """From start to stop; again with the same settings, it is a restart."""
    app = create_app(settings, clock, http_client)
    async with app.router.lifespan_context(app):
        yield Office(app, clock)
