"""A campus with something of everything, also with something wrong of each kind, and people who may see all of it."""

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

from app.accounts.sign_in.service import find_person, set_roles
from app.models import Role
from tests.web.mailroom_scene import Scene
from tests.web.service import Service
from tests.web.visitor import Visit, Visitor


class Campus:
    """A service, and what has been written into it."""

    def __init__(self, service: Service) -> None:
        self.service, self.scene = service, Scene(service)
        self.orders: list[str] = []

    async def staff(self, visit: Visit, **options: Any) -> Visitor:
        """A visitor with all roles."""
        person: Visitor = await visit("dana.desk", at=self.service, reduced_motion="reduce", **options)
        async with self.scene.state.database.transaction() as session:
            known = await find_person(session, person.email)
            assert known is not None
            set_roles(known, {Role.DISPATCHER, Role.MAINTAINER}, set())
        return person

    async def order_of(self, sender: str, recipient: str, state: str) -> str:
        """By the names in their addresses."""
        return await self.scene.order(state, "r1", sender, recipient, "post1", "post4", "Forms, signed")


@asynccontextmanager
async def full_campus(folder: Path) -> AsyncIterator[Campus]:
    with Service(folder) as service:
        campus = Campus(service)
        campus.orders = await campus.scene.is_busy()
        await campus.scene.everything_goes_wrong(campus.orders)
        yield campus
