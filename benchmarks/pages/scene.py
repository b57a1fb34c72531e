"""Contents of the visited pages: a sender's letters, and a mailroom at work."""

from dataclasses import dataclass
from pathlib import Path
from typing import Final

from app.models import Role
from app.orders.views.schemas import NewOrder
from benchmarks.service.filling import Account, Filling, campus, fill
from benchmarks.service.servers import Server
from benchmarks.service.web_client import Visitor

EARLIER_ORDERS: Final = 40
ROBOTS: Final = 4
WAITING: Final = 7
"""Orders in the queue beside those that the robots carry and the one that is followed: twelve in all."""


@dataclass(frozen=True)
class Scene:
    """The visitors: `sender` has earlier orders and one under way, `dispatcher` sees everybody's."""

    sender: Account
    colleague: Account
    dispatcher: Account


def make_scene(folder: Path) -> Scene:
    """Write people, robots with mail aboard and the orders of the past into a new database."""

    async def write(filling: Filling) -> Scene:
        sender, colleague, *others = await filling.people(3)
        (dispatcher,) = await filling.people(1, "dispatcher", {Role.DISPATCHER})
        await filling.history([sender, colleague, *others], EARLIER_ORDERS)
        await filling.give_missions(await filling.robots(ROBOTS), colleague)
        return Scene(sender, colleague, dispatcher)

    made: Scene = fill(folder, write)
    return made


async def order_all(server: Server, scene: Scene) -> str:
    """Order what waits in the queue; the id of the order that its sender follows."""
    for number in range(WAITING):
        await _order(server, scene.colleague, f"waits-{number}")
    return await _order(server, scene.sender, "followed")


async def _order(server: Server, account: Account, key: str) -> str:
    client = Visitor(server.port, account.cookie)
    posts = list(campus().posts)
    wish = NewOrder(from_post=posts[0], to_post=posts[-1], recipient="person.1@campus.example")
    body = wish.model_dump(mode="json", exclude_unset=True)
    answer = await client.post("/api/v1/orders", body, f"Idempotency-Key: {key}\r\n")
    client.close()
    return str(answer.json()["id"])
