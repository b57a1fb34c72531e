"""The service without its sockets, and robots without their bodies, so that whole lives of orders pass in no time.

Everything that decides is the real thing: orders, dispatch, timer, the intake of robots' messages, the database; and at
the other end the robot's own memory, outbox and duties. Played are only people, the agent's luck and the network.
"""

import asyncio
import shutil
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from random import Random
from typing import Any

from sqlmodel import SQLModel, col, select

from app.accounts.sign_in.service import SignInService, set_roles
from app.core.database.database import Database
from app.core.mail import open_mailer
from app.core.server_key import ServerKey
from app.core.settings import Settings
from app.dispatch.fleet_planner import FleetPlanner
from app.dispatch.planner_process import PlannerProcess
from app.dispatch.service import Dispatcher
from app.models import MessageToRobot, Order, OrderState, Person, RobotRow, Role
from app.orders.custody.codes import Holder, codes_of
from app.orders.ledger import Ledger
from app.orders.service import Orders
from app.orders.standing.standing import StandingOrders
from app.orders.timer import Timer
from app.orders.views.schemas import NewOrder
from app.realtime.feed import LocalFeed
from app.robots.commands import ask, new_command_id
from app.robots.conversation.intake import Intake
from app.robots.link import inbox, outbox
from app.robots.service import Fleet, enrol
from app.traffic.service import TrafficService
from fleet.assignment.deciding import Decision
from fleet.assignment.improving import improved
from maps import CampusMap
from maps.ways import Ways
from protocol.both_ways import Error
from protocol.clock import SteppedClock
from protocol.envelope import TO_ROBOT, Envelope, type_of
from protocol.parts import Purpose, StopAction
from protocol.proofs import ShownCode
from protocol.to_robot import Recall
from protocol.to_server import Event, Step
from robot.mission.memory import Incoming, Memory
from robot.mission.mission import MissionManager
from robot.mission.outbox import Outbox
from robot.mission.store import Store
from tests.app.placed import placed
from tests.plain_maps import PLAIN_TRACK, plain_map

TRACK = plain_map("test_track")
WAYS = Ways(TRACK)
DRIVES_M_S = 0.2
"""As fast as our robots are let drive."""


@dataclass(eq=False)
class PlayedRobot:
    """Real memory, outbox and duties; `server` is what has come through the network."""

    name: str
    token_prefix: str
    clock: SteppedClock
    online: bool = True
    acknowledged: int = 0
    stands_at: str | None = None
    heard_seq: int = 0
    journal: str = ""
    said: list[Event] = field(default_factory=list)
    refused: list[Error] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.robot = self.name
        store = Store(None)
        self.memory, self.outbox = Memory(store), Outbox(store)
        self.missions = MissionManager(store, self.memory, self.outbox, self.clock.utc, self)
        self.taken_up_to = 0
        self._done = asyncio.Event()

    def still_to_do(self) -> set[str]:
        """The stops before it at which there is something to load or to give."""
        held = self.missions.held
        ahead = held.mission.stops[held.next_stop :] if held.mission else ()
        sensible, aboard, over = set(), set(held.cargo), self.memory.done()
        for stop in ahead:
            if (
                stop.id not in over
                and stop.order_id not in held.cancelled
                and (stop.order_id in aboard) != (stop.action is StopAction.LOAD)
            ):
                sensible.add(stop.id)
                aboard ^= {stop.order_id}
        return sensible

    # The link as the duties see it.

    def incoming(self) -> list[Incoming]:
        return self.memory.unhandled()

    def wake(self) -> None:
        pass

    # The connection as the intake sees it.

    def taken(self, envelope: Envelope, problem: Error | None) -> None:
        self.taken_up_to = max(self.taken_up_to, envelope.seq or 0)
        if problem is not None:
            self.refused.append(problem)
        self._done.set()

    def failed(self, error: Exception) -> None:
        self.refused.append(Error(code=getattr(error, "code", "failed"), message=str(error)[:400]))
        self._done.set()

    async def say(self, intake: Intake, seq: int, message: Any) -> None:
        self._done.clear()
        envelope = Envelope(
            type=type_of(message),
            robot=self.name,
            journal=self.outbox.journal,
            seq=seq,
            ack=self.heard_seq,
            at=self.clock.utc(),
            body=message,
        )
        intake.hear(self, envelope)
        async with asyncio.timeout(60):  # real seconds, on a machine that may be busy with other things
            await self._done.wait()


class PlansHere(PlannerProcess):
    """The planner's process in this one, in so many rounds that the same comes out each time."""

    async def improved(self, decision: Decision, budget_s: float) -> Decision | None:
        left = iter(range(40))
        return improved(decision, Random(0), lambda: next(left, None) is not None)


class World:
    """A campus in which nothing happens by itself."""

    def __init__(self, template: Path, folder: Path, campus: CampusMap = TRACK, **settings: Any) -> None:
        self.folder, self.campus = folder, campus
        folder.mkdir(parents=True)
        shutil.copy(template, folder / "campus-mail.sqlite")
        self.settings = Settings(data=folder, map=str(PLAIN_TRACK), time_zone="UTC", **settings)
        self.clock = SteppedClock()
        self.where: dict[str, str] = {}
        """Where the mail of each order really is: sender, recipient, mailroom, or a robot's name."""
        self.people: dict[str, Person] = {}
        self.robots: dict[str, PlayedRobot] = {}

    async def begin(self) -> None:
        self.start_service()
        async with self.database.transaction() as session:
            for name in ("sender", "recipient", "dispatcher"):
                person = await self.sign_in.person(session, f"{name}@campus.example", self.clock.utc())
                self.people[name] = person
            set_roles(self.people["dispatcher"], {Role.DISPATCHER}, set())
            for name, post in (("r1", "post5"), ("r2", "post2")):
                token = await enrol(session, self.clock, name)
                self.robots[name] = PlayedRobot(name, token.split("_")[1], self.clock)
                row = await session.get_one(RobotRow, name)
                row.online, row.post, row.home, row.battery_ratio = True, post, post, 0.9
        for robot in self.robots.values():
            await self._greet(robot)

    async def _greet(self, robot: PlayedRobot) -> None:
        """Both sides know each other's journals from the first hello on."""
        async with self.database.transaction() as session:
            robot.journal = (await session.get_one(RobotRow, robot.name)).server_journal
            await inbox.resume(session, robot.name, robot.outbox.journal, 1, self.clock.utc())
        robot.memory.resume(robot.journal, 1)

    def start_service(self) -> None:
        """Start the service, which may happen at any time: all that it knows is in the database."""
        key = ServerKey(b"k" * 32)
        self.database = Database(self.settings.url_of_database)
        feed = LocalFeed()
        self.sign_in = SignInService(self.settings, key, open_mailer(self.settings))
        self.orders = Orders.of(Ledger(self.campus, self.settings, self.clock, feed), key, self.sign_in)
        self.fleet = Fleet(self.database, self.campus, self.settings, self.clock, feed, self.orders)
        self.intake = Intake(self.fleet)
        self.desk = TrafficService(self.fleet)
        self.planner = FleetPlanner(self.fleet, self.desk, PlansHere())
        self.dispatcher = Dispatcher(self.fleet, self.planner)
        self.timer = Timer(self.database, self.orders, StandingOrders(self.orders.placing, self.clock))
        self.orders.ledger.on_change.append(self.dispatcher.wake)
        self.fleet.on_change.append(self.dispatcher.wake_for_robot)
        self.orders.ledger.on_change.append(self.desk.wake)
        self.fleet.on_change.append(self.desk.wake)
        self.desk.on_poll.append(self.planner.notice)

    async def restart(self) -> None:
        await self.database.close()
        self.start_service()

    async def end(self) -> None:
        await self.database.close()

    # What people and time do.

    async def place(self, from_post: str, to_post: str) -> str:
        wish = NewOrder(from_post=from_post, to_post=to_post, recipient="recipient@campus.example")
        async with self.database.transaction() as session:
            order_id = await placed(self.orders, session, self.people["sender"], wish)
        self.where[order_id] = "sender"
        return order_id

    async def change(self, what: Callable[..., Any], who: str, order_id: str, *arguments: Any) -> None:
        """One request of one person. Raises what it is refused by."""
        async with self.database.transaction() as session:
            await what(session, self.people[who], order_id, *arguments)

    async def recall(self, robot: str) -> None:
        async with self.database.transaction() as session:
            row = await session.get_one(RobotRow, robot, with_for_update=True)
            await ask(session, self.fleet, row, Recall(command_id=new_command_id("recall"), reason="come home"))

    async def dispatch(self) -> None:
        await self.desk.poll()
        await self.dispatcher.poll()
        if await self.planner.improve():
            await self.dispatcher.poll()

    async def set_online(self, name: str, online: bool) -> None:
        self.robots[name].online = online
        async with self.database.transaction() as session:
            (await session.get_one(RobotRow, name)).online = online

    # The network.

    async def hear(self, name: str, count: int = 100) -> None:
        """The robot is told the next messages that wait for it."""
        robot = self.robots[name]
        waiting = await self._waiting_for(robot, count)
        for row in waiting:
            message = TO_ROBOT[row.type].model_validate_json(row.body)
            facts = {"type": row.type, "robot": name, "journal": robot.journal, "seq": row.seq, "body": message}
            robot.memory.receive(Envelope(**facts, at=self.clock.utc()))
            robot.heard_seq = row.seq
        robot.missions.take_messages()

    async def _waiting_for(self, robot: PlayedRobot, count: int) -> list[Any]:
        async with self.database.reading() as session:
            return list(await outbox.pending(session, robot.name, robot.token_prefix, robot.heard_seq, count))

    async def speak(self, name: str, count: int = 100, is_heard: bool = True) -> None:
        """The robot sends what it has to say; `is_heard`: the acknowledgement reaches it, else it says it again."""
        robot = self.robots[name]
        for kept in robot.outbox.pending(limit=count):
            if kept.seq > robot.taken_up_to and isinstance(kept.message, Event):
                robot.said.append(kept.message)
            await robot.say(self.intake, kept.seq, kept.message)
        if is_heard:
            robot.outbox.acknowledged(robot.taken_up_to)
            robot.acknowledged = robot.heard_seq

    async def say_again(self, name: str, number: int) -> None:
        """Something that was said before, in a message of its own, as the paper's prototype does."""
        robot = self.robots[name]
        await self.speak(name)
        if robot.said:
            again = robot.said[-1 - number % len(robot.said)]
            seq = robot.outbox.put(again)
            await robot.say(self.intake, seq, again)
            robot.outbox.acknowledged(seq)

    async def goes_on(self, name: str, *luck: str) -> None:
        """With a network and after a look of dispatch: the robot hears, does and tells."""
        await self.dispatch()
        await self.hear(name)
        for one in luck:
            self.act(name, one)
        await self.speak(name)

    # What the agent does, with a body that always gets there unless `luck` has it otherwise.

    def act(self, name: str, luck: str) -> None:
        """One step of what the robot's program does with its next stop."""
        robot = self.robots[name]
        missions, held = robot.missions, robot.missions.held
        if held.mission is None:
            return
        stop = held.stop
        if stop is None:
            missions.finish_mission(held.mission.id, None)
        elif stop.order_id in held.cancelled or self._is_pointless(stop, held.cargo):
            missions.finish_stop(stop.id)
        else:
            self._serve(robot, stop, luck)

    def _is_pointless(self, stop: Any, cargo: tuple[str, ...]) -> bool:
        is_aboard = stop.order_id in cargo
        return is_aboard if stop.action is StopAction.LOAD else not is_aboard

    def _serve(self, robot: PlayedRobot, stop: Any, luck: str) -> None:
        missions = robot.missions
        missions.report(Step.DEPARTED, stop.id, "post3")
        if luck == "sets out":
            return
        if luck == "no way":
            missions.report(Step.GAVE_UP, stop.id, "post3", "no_route")
            missions.finish_stop(stop.id)
            return
        self._drive(robot, stop.post)
        missions.report(Step.ARRIVED, stop.id, stop.post)
        if luck == "arrives":
            return
        if luck == "no person comes" or not self._changes_hands(robot, stop, luck):
            missions.report(Step.GAVE_UP, stop.id, stop.post, "no_one_came")
            missions.finish_stop(stop.id)

    def _drive(self, robot: PlayedRobot, post: str) -> None:
        """Drive there, which takes time."""
        way_m = WAYS.length_m(robot.stands_at or post, post)
        self.clock.advance(way_m / DRIVES_M_S)
        robot.stands_at = post

    def _changes_hands(self, robot: PlayedRobot, stop: Any, luck: str) -> bool:
        """Only what is there can change hands, and only for a person with the code."""
        purpose, order_id = Purpose(stop.action.value), stop.order_id
        is_passed_on = self.where[order_id] == "mailroom"
        giver = ("mailroom" if is_passed_on else "sender") if purpose is Purpose.LOAD else robot.name
        codes = robot.missions.codes(order_id, purpose)
        wanted = {"mailroom": Holder.MAILROOM, "recipient": Holder.RECIPIENT}.get(luck, Holder.SENDER)
        loads = Holder.MAILROOM if is_passed_on else Holder.SENDER
        holder = {Purpose.LOAD: loads, Purpose.RECEIVE: Holder.RECIPIENT}.get(purpose, wanted)
        known = codes_of(self._order(order_id, stop.post if is_passed_on else None))
        code = next(one for one in known if one.holder is holder and _fits(one.purpose, purpose))
        shown = ShownCode.of(code.text(self.orders.key))
        if self.where[order_id] != giver or shown.sha256 not in codes:
            return False
        robot.missions.handed_over(robot.missions.at_stop(stop.id), purpose, stop.post, shown)
        self.where[order_id] = robot.name if purpose is Purpose.LOAD else str(holder)
        return True

    def _order(self, order_id: str, passed_on_at: str | None) -> Order:
        """As far as codes depend on it."""
        now = self.clock.utc()
        return Order(
            id=order_id,
            sender_id="",
            recipient_id="",
            from_post="",
            to_post="",
            created_at=now,
            codes_expire_at=now,
            passed_on_at_post=passed_on_at,
        )

    # What is known.

    async def rows(self, table: type[SQLModel], **wanted: object) -> list[Any]:
        async with self.database.reading() as session:
            return list((await session.exec(select(table).filter_by(**wanted))).all())

    async def state(self, order_id: str) -> OrderState:
        return OrderState((await self.rows(Order, id=order_id))[0].state)

    def aboard(self, robot: str) -> set[str]:
        """Return the orders whose mail really is in this robot."""
        return {order_id for order_id, place in self.where.items() if place == robot}

    async def everything(self, *tables: type[SQLModel]) -> dict[str, list[str]]:
        """Return every row, to compare."""
        async with self.database.reading() as session:
            rows = {table.__name__: (await session.exec(select(table))).all() for table in tables}
        return {name: sorted(repr(row.model_dump()) for row in some) for name, some in rows.items()}

    async def unheard(self, robot: PlayedRobot) -> int:
        waiting = select(MessageToRobot.seq).where(
            MessageToRobot.robot == robot.name, col(MessageToRobot.seq) > robot.heard_seq
        )
        async with self.database.reading() as session:
            return len((await session.exec(waiting)).all())


def _fits(of_code: Purpose, purpose: Purpose) -> bool:
    return of_code is purpose or (purpose is Purpose.RETURN and of_code is Purpose.RECEIVE)
