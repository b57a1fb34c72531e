"""People at the robots: they come to where one stands for them, show their code, and put mail in or take it out."""

import math
from dataclasses import dataclass, field
from random import Random
from typing import Final

from sqlmodel import col, select

from app.models import Order, OrderState
from app.orders.custody.codes import code_text
from benchmarks.fleet_simulation.people import People
from benchmarks.stepped_fleet.robots import SteppedRobot
from maps import CampusMap
from protocol.parts import Purpose

COMES_AFTER_S: Final = (3.0, 20.0)
SHOWS_S: Final = 15.0
IN_BAY_M: Final = 0.3
IN_DOCK_M: Final = 0.8
PURPOSES: Final = {OrderState.AT_SENDER: Purpose.LOAD, OrderState.AT_RECIPIENT: Purpose.RECEIVE}
UNTOLD: Final = {OrderState.TO_SENDER: Purpose.LOAD, OrderState.CARRYING: Purpose.RECEIVE}
"""Where there is no network the service does not know that the robot has come, and people see it themselves."""


@dataclass
class Bystanders:
    """`tick` once a second. After `leave` they do not come any more."""

    people: People
    track: CampusMap
    rng: Random
    handed_over: int = 0
    _coming: dict[tuple[str, str], float] = field(default_factory=dict)
    _showing: dict[str, tuple[str, Purpose]] = field(default_factory=dict)
    _have_left: bool = False

    def leave(self) -> None:
        self._have_left = True

    async def tick(self, robots: list[SteppedRobot], now: float) -> None:
        for robot in robots:
            self._listen(robot)
        if self._have_left:
            return
        by_name = {robot.name: robot for robot in robots if robot.is_on}
        for order in await self._at_stops():
            robot = by_name.get(order.robot or "")
            is_told = order.state in PURPOSES
            purpose = (PURPOSES | UNTOLD)[OrderState(order.state)]
            post = order.from_post if purpose is Purpose.LOAD else order.to_post
            if is_told == self.track.post(post).network and robot is not None and self._stands_at(robot, post):
                self._attend(robot, order.id, purpose, now)

    async def _at_stops(self) -> list[Order]:
        async with self.people.parts.database.reading() as session:
            return list((await session.exec(select(Order).where(col(Order.state).in_([*PURPOSES, *UNTOLD])))).all())

    def _stands_at(self, robot: SteppedRobot, post: str) -> bool:
        pose = robot.body.pose
        reach_m = IN_DOCK_M if robot.body.docked else IN_BAY_M
        bays = self.track.bays_of(post)
        near = any(math.dist(bay.point, (pose.x_m, pose.y_m)) < reach_m for bay in bays)
        return near and robot.stands_since_s is not None

    def _attend(self, robot: SteppedRobot, order_id: str, purpose: Purpose, now: float) -> None:
        comes_s = self._coming.setdefault((robot.name, order_id + purpose), now + self.rng.uniform(*COMES_AFTER_S))
        if now >= comes_s and robot.body.camera.shown is None and robot.name not in self._showing:
            robot.body.show_code(code_text(self.people.parts.orders.key, order_id, purpose), SHOWS_S)
            self._showing[robot.name] = order_id, purpose

    def _listen(self, robot: SteppedRobot) -> None:
        """At the tune that says yes the letter changes hands, also if the robot was switched off right after it."""
        heard = list(robot.heard())
        if "accepted" in heard and robot.name in self._showing:
            self.people.show(robot.name, *self._showing.pop(robot.name))
            robot.body.hide_code()
            self.handed_over += 1
        elif robot.body.camera.shown is None:
            self._showing.pop(robot.name, None)
