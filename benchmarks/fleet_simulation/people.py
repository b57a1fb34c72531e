"""People: they order, stand at robots, close corridors, look for robots; and where each letter truly is."""

from collections import Counter
from dataclasses import dataclass, field
from random import Random
from typing import Final

from sqlmodel import col, func, select

from app.accounts.sign_in.service import look_up_people, set_roles
from app.composition.parts import Parts
from app.models import Handover, Order, OrderState, Person, Role
from app.orders.custody.codes import code_text
from app.orders.views.schemas import NewOrder
from app.robots.service import known_robot
from app.traffic.closing import close, open_again
from app.traffic.out_of_service import take_out
from benchmarks.fleet_simulation.durations import Taking
from protocol.parts import Purpose
from protocol.proofs import ShownCode

SENDER, RECIPIENT, DISPATCHER = (f"{name}@campus.example" for name in ("sender", "recipient", "dispatcher"))
NOT_FETCHED: Final = (OrderState.QUEUED, OrderState.ASSIGNED, OrderState.TO_SENDER, OrderState.AT_SENDER)
WITH_SENDER, WITH_RECIPIENT = "sender", "recipient"


@dataclass
class People:
    """`letters`: where the mail of each order truly is: with its sender or recipient, or in a robot, by its name."""

    parts: Parts
    taking: Taking
    rng: Random
    letters: dict[str, str] = field(default_factory=dict)
    loaded_s: dict[str, float] = field(default_factory=dict)
    ended_s: dict[str, float] = field(default_factory=dict)
    placed_s: dict[str, float] = field(default_factory=dict)
    _sender: Person | None = None
    _dispatcher: Person | None = None

    @property
    def now_s(self) -> float:
        return self.parts.clock.now()

    async def begin(self) -> None:
        async with self.parts.database.transaction() as session:
            now = self.parts.clock.utc()
            sign_in = self.parts.sign_in_service
            self._sender = await sign_in.person(session, SENDER, now)
            await sign_in.person(session, RECIPIENT, now)
            self._dispatcher = await sign_in.person(session, DISPATCHER, now)
            set_roles(self._dispatcher, {Role.DISPATCHER}, set())

    # Orders.

    async def order(self, from_post: str, to_post: str) -> None:
        assert self._sender is not None
        request = NewOrder(from_post=from_post, to_post=to_post, recipient=RECIPIENT)
        placing = self.parts.orders.placing
        async with self.parts.database.transaction() as session:
            known = await look_up_people(session, request.addresses)
            draft = await placing.draft(session, self._sender, request, known)
            await placing.write(session, [draft])
        order_id = draft.facts.order.id
        self.letters[order_id], self.placed_s[order_id] = WITH_SENDER, self.now_s

    async def not_fetched(self) -> int:
        """How many orders no robot has loaded yet."""
        async with self.parts.database.asking() as connection:
            counted = select(func.count()).select_from(Order).where(col(Order.state).in_(NOT_FETCHED))
            return int((await connection.execute(counted)).scalar_one())

    # At the robot.

    def come_after_s(self, purpose: Purpose) -> float:
        return self.taking.person_s(purpose, self.now_s, self.rng)

    def show(self, robot: str, order_id: str, purpose: Purpose) -> ShownCode:
        """The code that opens. The letter changes hands then, whatever is said of it."""
        before = self.letters[order_id]
        if purpose is Purpose.LOAD:
            assert before == WITH_SENDER, f"{robot} is given {order_id}, which is in {before}"
            self.letters[order_id] = robot
            self.loaded_s.setdefault(order_id, self.now_s)
        else:
            assert before == robot, f"{robot} gives {order_id}, which is in {before}"
            self.letters[order_id] = WITH_RECIPIENT if purpose is Purpose.RECEIVE else WITH_SENDER
            self.ended_s[order_id] = self.now_s
        return ShownCode.of(code_text(self.parts.orders.key, order_id, purpose))

    # Dispatchers.

    async def close(self, corridor: str) -> None:
        assert self._dispatcher is not None
        async with self.parts.database.transaction() as session:
            await close(session, self.parts.fleet, corridor, "A wet floor.", self._dispatcher)

    async def open_again(self, corridor: str) -> None:
        assert self._dispatcher is not None
        async with self.parts.database.transaction() as session:
            await open_again(session, self.parts.fleet, corridor, self._dispatcher)

    async def take_out(self, robot: str) -> None:
        """The person has carried it out of the way before."""
        assert self._dispatcher is not None
        async with self.parts.database.transaction() as session:
            row = await known_robot(session, robot, to_change=True)
            await take_out(session, self.parts.fleet, row, "It was dead, and was carried home.", self._dispatcher)

    # In the end.

    async def astray(self, still_to_tell: frozenset[str]) -> list[str]:
        """The orders of which the service believes something else than what is true, in words. A robot that has still
        something to tell is not contradicted yet."""
        async with self.parts.database.reading() as session:
            orders = (await session.exec(select(Order))).all()
            handovers = (await session.exec(select(Handover).order_by(col(Handover.id)))).all()
        last = {one.order_id: one for one in handovers}
        missing = [f"{one} was never stored" for one in self.letters.keys() - {order.id for order in orders}]
        return missing + [
            f"{order.id} is {order.state} and with {believed}, and truly with {self.letters[order.id]}"
            for order in orders
            if (believed := _believed(last.get(order.id))) != self.letters[order.id]
            and self.letters[order.id] not in still_to_tell
            and believed not in still_to_tell
        ]

    async def states(self) -> Counter[str]:
        async with self.parts.database.reading() as session:
            return Counter(str(state) for state in (await session.exec(select(Order.state))).all())


def _believed(last: Handover | None) -> str:
    if last is None or last.purpose == Purpose.RETURN:
        return WITH_SENDER
    return last.robot if last.purpose == Purpose.LOAD else WITH_RECIPIENT
