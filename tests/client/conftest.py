"""A service on a real port, and programs that come with a token."""

from collections.abc import AsyncIterator
from dataclasses import dataclass
from datetime import timedelta

import pytest

from app.accounts.scopes import Scope
from app.accounts.tokens import issue_token
from app.core.settings import Settings
from app.models import OrderState, RobotRow
from app.orders.service import Actor
from app.orders.transitions import By
from campus_mail_client import AsyncCampusMail
from protocol.clock import SteppedClock
from tests.app.conftest import (  # noqa: F401  # fixtures
    anonymous,
    clock,
    database_url,
    mails,
    pages,
    postgresql,
    settings,
    sqlite_at_head,
)
from tests.app.robots.playing import Service, serving

SENDER, RECIPIENT = "sender@campus.example", "recipient@campus.example"


@dataclass
class Campus:
    """The running service, and what dispatch and a robot would do in it."""

    service: Service

    @property
    def url(self) -> str:
        return f"http://127.0.0.1:{self.service.port}"

    async def token(self, email: str = SENDER, scopes: set[Scope] | None = None) -> str:
        """Issue a token as a person does at a browser: `POST /tokens`."""
        state = self.service.app.state.parts
        async with state.database.transaction() as session:
            person = await state.sign_in_service.person(session, email, state.clock.utc())
            _, text = await issue_token(
                session, person, "script", scopes or set(Scope), timedelta(days=1), state.clock.utc()
            )
        return str(text)

    async def enrol(self, name: str = "r1") -> None:
        state = self.service.app.state.parts
        async with state.database.transaction() as session:
            session.add(RobotRow(name=name, enrolled_at=state.clock.utc(), server_journal="j1"))

    async def announce(self, name: str, online: bool) -> None:
        """As when its socket opens or closes."""
        state = self.service.app.state.parts
        async with state.database.transaction() as session:
            robot = await session.get_one(RobotRow, name)
            robot.online = online
            state.fleet.announce(session, robot)

    async def move(self, order_id: str, *states: str) -> None:
        state = self.service.app.state.parts
        for one in states:
            actor = Actor(By.DISPATCHER if one == "assigned" else By.ROBOT, robot="r1")
            async with state.database.transaction() as session:
                await state.orders.ledger.move(session, order_id, OrderState(one), actor)


@pytest.fixture
async def campus(settings: Settings, clock: SteppedClock) -> AsyncIterator[Campus]:  # noqa: F811
    async with serving(settings, clock) as service:
        yield Campus(service)


@pytest.fixture
async def mail(campus: Campus) -> AsyncIterator[AsyncCampusMail]:
    async with AsyncCampusMail(campus.url, await campus.token()) as mail:
        yield mail
