"""The real service on a real port, a robot that the test plays, and people with a browser each."""

from collections.abc import AsyncIterator
from contextlib import AsyncExitStack
from typing import Any

import httpx
import pytest

from app.accounts.sessions.sessions import new_session
from app.accounts.sign_in.service import set_roles
from app.core.settings import Settings
from app.models import OrderEvent, Role
from protocol.clock import SteppedClock
from protocol.parts import Stop
from protocol.to_robot import Mission
from protocol.to_server import Step
from tests.app.robots.playing import PlayedRobot, Service, serving


class Campus:
    """A service, a robot with one letter from post1 to post4, and the people of its order."""

    def __init__(self, service: Service, robot: PlayedRobot, stack: AsyncExitStack) -> None:
        self.service, self.robot, self._stack = service, robot, stack
        self.order_id = ""
        self.token = ""
        self.mission: Mission | None = None

    @property
    def load(self) -> Stop:
        assert self.mission
        return self.mission.stops[0]

    @property
    def receive(self) -> Stop:
        assert self.mission
        return self.mission.stops[1]

    async def browser(self, name: str, *roles: Role) -> httpx.AsyncClient:
        """A person of the campus, signed in."""
        state = self.service.app.state.parts
        async with state.database.transaction() as session:
            person = await state.sign_in_service.person(session, f"{name}@campus.example", state.clock.utc())
            set_roles(person, set(roles), set())
            row, cookie = new_session(person, "", 3600, state.clock.utc())
            session.add(row)
        headers = {"Cookie": f"session={cookie}", "Sec-Fetch-Site": "same-origin"}
        url = f"http://127.0.0.1:{self.service.port}/api/v1"
        here = httpx.AsyncClient(base_url=url, headers=headers, timeout=20, verify=False)  # noqa: S501  # no https
        return await self._stack.enter_async_context(here)

    async def connect(self, **facts: Any) -> None:
        """The robot comes, and gets the letter."""
        self.token = self.token or await self.service.enrol("r1")
        self.order_id = self.order_id or await self.service.order()
        await self._stack.enter_async_context(self.robot.connected(self.service.url, self.token))
        await self.robot.greet(**{"understands": ("confirm",), **facts})

    async def waits_for_load(self) -> None:
        await self.connect()
        self.mission = await self.robot.mission()
        await self.robot.ends(await self.robot.report(self.mission, Step.ARRIVED, self.load))

    async def waits_for_recipient(self) -> None:
        await self.waits_for_load()
        assert self.mission
        await self.robot.say(self.robot.receipt(self.load))
        await self.robot.ends(await self.robot.report(self.mission, Step.ARRIVED, self.receive))

    @property
    def path(self) -> str:
        return f"/orders/{self.order_id}"

    async def state(self) -> str:
        return (await self.service.states(self.order_id))[-1]

    async def kinds(self) -> list[str]:
        """Return the kinds of the order's events other than moves."""

        events = await self.service.rows(OrderEvent, order_id=self.order_id)
        return [event.kind for event in sorted(events, key=lambda one: one.seq) if event.kind != "moved"]


@pytest.fixture
async def campus(settings: Settings, clock: SteppedClock) -> AsyncIterator[Campus]:
    async with serving(settings, clock) as service, AsyncExitStack() as stack:
        yield Campus(service, PlayedRobot(clock), stack)
