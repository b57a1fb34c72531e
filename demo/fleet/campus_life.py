"""Simulated people of a fleet: they order, come to the robot with their code, or do not come."""

import asyncio
import time
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from datetime import datetime, timedelta
from random import Random
from typing import Any

from demo.fleet.errands import Errand, address, errands, first_errands
from demo.fleet.settings import FleetDemo
from demo.people import NoCameraError, SimulatedPerson
from demo.settings import MAILROOM, DemoFailed
from protocol.clock import Clock

Order = dict[str, Any]

LOOK_EVERY_S = 0.3
ALARMS_EVERY_S = 2.0
ROBOTS_LIMIT_S, FOR_EACH_ROBOT_S = 60.0, 5.0
COMES_WITHIN_S = (3.0, 20.0)
SHOW_AGAIN_S = 15.0
"""Of the demonstration's clock: the code stays before the camera a little longer than that."""
MOST_OPEN_PER_ROBOT = 2
WHOSE_TURN = {"at_sender": "sender", "at_recipient": "recipient", "at_return": "sender"}


@dataclass
class CampusLife:
    """Simulated people of one demonstration. `say` gets a line for whatever happens."""

    demo: FleetDemo
    clock: Clock
    say: Callable[[str], None]
    orders: dict[str, Order] = field(default_factory=dict)
    """Those that go on, as they were seen last."""
    robots: list[dict[str, Any]] = field(default_factory=list)
    ended: Counter[str] = field(default_factory=Counter)
    delivered_by: Counter[str] = field(default_factory=Counter)
    placed: int = 0
    _errands: dict[str, Errand] = field(default_factory=dict)
    _comes_at_s: dict[tuple[str, str], float] = field(default_factory=dict)
    _alarms: set[int] = field(default_factory=set)

    def __post_init__(self) -> None:
        self._people = {name: SimulatedPerson(address(name), self.demo) for name in self.demo.campus.offices}
        self._mailroom = SimulatedPerson(MAILROOM, self.demo)
        self._draw = Random(f"{self.demo.seed}/people")
        self._stream = errands(self.demo.seed, self._people)

    async def begin(self) -> None:
        """Everybody signs in, the robots are there. Raises DemoFailed."""
        everybody = [self._mailroom, *self._people.values()]
        await asyncio.gather(*(person.sign_in() for person in everybody))
        limit_s = ROBOTS_LIMIT_S + FOR_EACH_ROBOT_S * len(self.demo.homes)
        until_s = time.monotonic() + limit_s
        while missing := await self._missing():
            if time.monotonic() > until_s:
                raise DemoFailed(f"{', '.join(missing)} did not sign in within {limit_s:.0f} s.")
            await asyncio.sleep(LOOK_EVERY_S)

    async def _missing(self) -> list[str]:
        self.robots = await self._mailroom.robots()
        there = {robot["name"] for robot in self.robots if robot["online"] and robot["last_seen"]}
        return sorted(self.demo.homes.keys() - there)

    async def once(self) -> None:
        """One order for every robot; until all of them have ended."""
        for errand in first_errands(self.demo.campus):
            await self._order(errand)
        while self.orders:
            await self._look()

    async def go_on(self) -> None:
        """Ever more orders, as many at a time as the robots get done."""
        for errand in first_errands(self.demo.campus):
            await self._order(errand)
        next_s = self.clock.now() + self.demo.interval_s
        while True:
            if self.clock.now() > next_s and len(self.orders) < MOST_OPEN_PER_ROBOT * len(self.demo.homes) + 2:
                await self._order(next(self._stream))
                next_s = self.clock.now() + self._draw.expovariate(1 / self.demo.interval_s)
            await self._look()

    @property
    def alarms(self) -> int:
        """Return the number of alarms."""
        return len(self._alarms)

    async def watch_alarms(self) -> None:
        """Say aloud what rings in the mailroom."""
        while True:
            for alarm in reversed(await self._mailroom.alarms()):
                if alarm["id"] not in self._alarms:
                    self._alarms.add(alarm["id"])
                    self.say(f"ALARM {alarm['robot']}: {alarm['name']}, {alarm['reason']}")
            await asyncio.sleep(ALARMS_EVERY_S)

    async def _order(self, errand: Errand) -> None:
        from_post, to_post = (self.demo.campus.offices[name] for name in (errand.sender, errand.recipient))
        sender, more = self._people[errand.sender], {"priority": errand.priority}
        if errand.priority == "high":
            sender, more = self._mailroom, {**more, "on_behalf_of": address(errand.sender)}
        if errand.later_s is not None:
            more["not_before"] = (self.clock.utc() + timedelta(seconds=errand.later_s)).isoformat()
        order = await sender.place_order(from_post, to_post, address(errand.recipient), **more)
        self.placed += 1
        self._errands[order["id"]], self.orders[order["id"]] = errand, order
        kind = f", {errand.priority} priority" if errand.priority != "normal" else ""
        later = f", in {errand.later_s / 60:.0f} min" if errand.later_s is not None else ""
        self.say(f"{errand.sender} at {from_post} sends to {errand.recipient} at {to_post}{kind}{later}")

    async def _look(self) -> None:
        """Read the state of the orders; people come where a robot waits for them."""
        now = {order["id"]: order for order in await self._mailroom.open_orders() if order["id"] in self._errands}
        self.robots = await self._mailroom.robots()
        for order_id in self.orders.keys() - now.keys():
            self._has_ended(await self._mailroom.order(order_id))
        for order in now.values():
            if _what_is_said(order) != _what_is_said(self.orders[order["id"]]):
                self.say(self._sentence(order))
        self.orders = now
        for person, order in list(self._who_comes()):
            await self._show(person, order)
        await asyncio.sleep(LOOK_EVERY_S)

    def _has_ended(self, order: Order) -> None:
        self.ended[order["state"]] += 1
        if order["state"] == "delivered":
            self.delivered_by[_robot_of(order)] += 1
        self.say(self._sentence(order))

    def _sentence(self, order: Order) -> str:
        errand, robot = self._errands[order["id"]], _robot_of(order)
        by = f" ({robot})" if robot else ""
        why = f": {order['why']}" if order["state"] in {"attention", "expired", "held"} and order["why"] else ""
        return f"{errand.sender} → {errand.recipient}: {order['state'].replace('_', ' ')}{by}{why}"

    def _who_comes(self) -> Iterator[tuple[SimulatedPerson, Order]]:
        """Everybody for whom a robot has waited as long as it takes them to come, or to try again."""
        now_s = self.clock.now()
        for order in self.orders.values():
            errand, state = self._errands[order["id"]], order["state"]
            whose = WHOSE_TURN.get(state)
            if whose is None or (whose == "recipient" and errand.absent):
                continue
            key = (order["id"], state)
            comes_at_s = self._comes_at_s.setdefault(key, now_s + self._draw.uniform(*COMES_WITHIN_S))
            if now_s >= comes_at_s:
                self._comes_at_s[key] = now_s + SHOW_AGAIN_S
                yield self._people[errand.sender if whose == "sender" else errand.recipient], order

    async def _show(self, person: SimulatedPerson, order: Order) -> None:
        try:
            await person.show_code(order["id"])
        except NoCameraError:
            return  # they come again
        except DemoFailed:
            # The robot may have taken the mail since we looked: then there is no code to show any more.
            if (await self._mailroom.order(order["id"]))["state"] == order["state"]:
                raise

    def is_there_work(self) -> bool:
        """Tell if there is an order that may be fetched or carried now."""
        later = (order["not_before"] for order in self.orders.values())
        return any(moment is None or datetime.fromisoformat(moment) <= self.clock.utc() for moment in later)

    async def close(self) -> None:
        for person in (self._mailroom, *self._people.values()):
            await person.close()


def _what_is_said(order: Order) -> tuple[str, str]:
    """An order that goes from one robot to another may be in the same state as before."""
    return order["state"], _robot_of(order)


def _robot_of(order: Order) -> str:
    """The robot that has it, or had it last."""
    named = [event["robot"] for event in order["events"] if event["robot"]]
    return str(order["robot"]["name"] if order["robot"] else named[-1] if named else "")
