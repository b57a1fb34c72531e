"""The story of a demonstration: a letter is ordered, loaded, carried, received, and each person is notified once."""

import asyncio
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from app.handover.demo_camera import DoorClosed, knock
from demo.people import SimulatedPerson, Spool
from demo.settings import FROM_POST, LOW_RATIO, RECIPIENT, ROBOT, SENDER, TO_POST, Demo, DemoFailed
from protocol.clock import Clock

Order = dict[str, Any]

LOOK_EVERY_S = 0.15
ROBOT_LIMIT_S = 60.0
NOTICES_LIMIT_S = 10.0
SHOW_EVERY_S = 15.0
"""Of the demonstration's clock: the code stays before the camera a little longer than that."""
ENDED_OTHERWISE = {"expired", "cancelled", "attention", "returning", "returned", "held"}


@dataclass
class Story:
    """The course of one demonstration. `see` is told of the order whenever something about it is new."""

    demo: Demo
    clock: Clock
    spool: Spool
    see: Callable[[Order], None]
    began_s: float = field(default_factory=time.monotonic)
    _shown_at_s: float = float("-inf")
    _battery_is_low: bool = False
    _charges_before: int = 0

    def __post_init__(self) -> None:
        self.sender = SimulatedPerson(SENDER, self.demo)
        self.recipient = SimulatedPerson(RECIPIENT, self.demo)

    async def deliver(self) -> dict[str, Any]:
        """From signing in to the delivery; the summary. Raises DemoFailed."""
        await self.sender.sign_in()
        await self.recipient.sign_in()
        await self._robot_is_there()
        self._charges_before = (await self._robot_figures()).get("charges", 0)
        order = await self.sender.place_order(FROM_POST, TO_POST, RECIPIENT)
        order = await self._follow(str(order["id"]))
        return await self._summary(order)

    async def _robot_is_there(self) -> None:
        until_s = time.monotonic() + ROBOT_LIMIT_S
        while not any(robot["name"] == ROBOT and robot["online"] for robot in await self.sender.robots()):
            if time.monotonic() > until_s:
                raise DemoFailed(f"The robot {ROBOT} has not signed in within {ROBOT_LIMIT_S:.0f} s.")
            await asyncio.sleep(LOOK_EVERY_S)

    async def _follow(self, order_id: str) -> Order:
        """Look again and again, do what people do in each state; the delivered order."""
        while True:
            order = await self.sender.order(order_id)
            self.see(order)
            if order["state"] == "delivered":
                return order
            if order["state"] in ENDED_OTHERWISE:
                raise DemoFailed(f"The order ended {order['state']}: {order['why'] or order['events'][-1]['reason']}.")
            await self._act(order)
            await asyncio.sleep(LOOK_EVERY_S)

    async def _act(self, order: Order) -> None:
        if order["state"] == "carrying" and self.demo.low_battery and not self._battery_is_low:
            self._battery_is_low = True
            await self._knock({"do": "battery", "ratio": LOW_RATIO})
        person = {"at_sender": self.sender, "at_recipient": self.recipient}.get(order["state"])
        if person and not self.demo.hands_on and self.clock.now() - self._shown_at_s > SHOW_EVERY_S:
            self._shown_at_s = self.clock.now()
            await self._show(person, order)

    async def _show(self, person: SimulatedPerson, order: Order) -> None:
        try:
            await person.show_code(order["id"])
        except DemoFailed:
            # The robot may have taken the mail since we looked: then there is no code to show any more.
            if (await self.sender.order(order["id"]))["state"] == order["state"]:
                raise

    async def _summary(self, order: Order) -> dict[str, Any]:
        robot = await self._robot_figures()
        return {
            "ok": True,
            "order": order["id"],
            "states": [
                {key: event[key] for key in ("state", "at", "robot_at", "by", "post")} for event in order["events"]
            ],
            "notifications": await self._notifications(order["id"]),
            "robot": {"name": ROBOT, **robot, "charges": robot.get("charges", 0) - self._charges_before},
            "wall_s": round(time.monotonic() - self.began_s, 1),
        }

    async def _robot_figures(self) -> dict[str, Any]:
        """Read the figures that the robot's process gives of its run; it was docked before the order came."""
        figures: dict[str, Any] = (await self._knock({"do": "state"})).get("robot", {})
        return figures

    async def _notifications(self, order_id: str) -> dict[str, dict[str, int]]:
        """Per person and kind; the mails of the spool must be the notices of the inbox. Raises DemoFailed."""
        until_s = time.monotonic() + NOTICES_LIMIT_S
        while True:
            told = {person.email: dict(await person.notices(order_id)) for person in (self.sender, self.recipient)}
            inboxes = {(email, kind): n for email, kinds in told.items() for kind, n in kinds.items()}
            mails = dict(self.spool.notices(order_id))
            if mails == inboxes:
                return told
            if time.monotonic() > until_s:
                raise DemoFailed(f"Mails and inboxes differ: mailed {mails}, inboxes {inboxes}.")
            await asyncio.sleep(LOOK_EVERY_S)

    async def _knock(self, wish: dict[str, Any]) -> dict[str, Any]:
        try:
            return await knock(self.demo.door, wish)
        except DoorClosed as error:
            raise DemoFailed(error.sentence) from error

    async def close(self) -> None:
        await self.sender.close()
        await self.recipient.close()
