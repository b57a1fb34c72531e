"""A stand-in for a robot: it speaks the real protocol on a real WebSocket, and for a drive it waits as long as one
takes. It hands over only for a code that a person shows.

It keeps to the robot's side of the bargain: what it has to say is numbered and said again until it is acknowledged,
what it is told is taken once. It is never killed, so that its memory is the record to compare the service's with.
"""

import asyncio
from collections.abc import Awaitable, Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from datetime import UTC, datetime
from random import Random
from typing import Any, Final

from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import InvalidHandshake, InvalidMessage, WebSocketException

from app.robots.progress.evidence import FASTEST_M_S
from maps.ways import Ways
from protocol.both_ways import Ack, Error
from protocol.envelope import DURABLE, TO_ROBOT, Envelope, parse, type_of
from protocol.parts import Activity, Battery, MissionHeld, Part, Position, Purpose, Received, Stop, StopAction
from protocol.proofs import ShownCode
from protocol.sequence import Reception, reception, resume
from protocol.to_robot import Cancel, Mission, Verifier, Verifiers, Welcome
from protocol.to_server import CommandAnswer, Event, HandoverReceipt, Hello, Progress, Snapshot, Step

AGAIN_AFTER_S: Final = 0.05
SHOWN_AGAIN_AFTER_S: Final = 0.2
PURPOSES: Final = {
    StopAction.LOAD: Purpose.LOAD,
    StopAction.RECEIVE: Purpose.RECEIVE,
    StopAction.RETURN: Purpose.RETURN,
}
BATTERY: Final = Battery(ratio=0.9)
Show = Callable[[str, Purpose], Awaitable[str | None]]
"""Asks the person at the robot for the code of an order."""


@dataclass
class StandIn:
    """`said` is everything durable that it ever said, by number; `errors` what the service called wrong."""

    name: str
    token: str
    url: str
    post: str
    ways: Ways
    random: Random
    show: Show
    step_s: float = 0.02
    journal: str = "stand-in"
    said: dict[int, Part] = field(default_factory=dict)
    errors: list[str] = field(default_factory=list)
    connections: int = 0
    _acknowledged: int = 0
    _received: Received = field(default_factory=Received)
    _codes: dict[str, Sequence[Verifier]] = field(default_factory=dict)
    _receipts: int = 0
    _mission: Mission | None = None
    _over: set[str] = field(default_factory=set)
    _cancelled: set[str] = field(default_factory=set)
    _cargo: list[str] = field(default_factory=list)
    _socket: ClientConnection | None = None
    _work: asyncio.Event = field(default_factory=asyncio.Event)

    @property
    def is_idle(self) -> bool:
        """Nothing to do, and all it said was heard."""
        return self._next_stop() is None and self._acknowledged == len(self.said)

    async def run(self) -> None:
        """Until cancelled."""
        async with asyncio.TaskGroup() as group:
            group.create_task(self._stay_connected())
            group.create_task(self._do_missions())

    # The link.

    async def _stay_connected(self) -> None:
        headers = {"Authorization": f"Bearer {self.token}"}
        while True:
            with suppress(OSError, WebSocketException, InvalidHandshake, InvalidMessage, EOFError, TimeoutError):
                async with connect(self.url, additional_headers=headers, proxy=None, ping_interval=None) as socket:
                    await self._talk(socket)
            self._socket = None
            await asyncio.sleep(AGAIN_AFTER_S)

    async def _talk(self, socket: ClientConnection) -> None:
        await socket.send(self._text(self._hello()))
        async for text in socket:
            envelope = parse(text, TO_ROBOT)
            if isinstance(envelope.body, Welcome):
                self._resume(envelope, envelope.body)
                self._socket = socket
                self.connections += 1
                for seq in range(self._acknowledged + 1, len(self.said) + 1):
                    await socket.send(self._text(self.said[seq], seq, replay=True))
                await socket.send(self._text(self._snapshot()))
            else:
                await self._hear(socket, envelope)

    def _hello(self) -> Hello:
        return Hello(
            received=self._received,
            resume_from=self._acknowledged + 1,
            position=Position(post=self.post),
            cargo=tuple(self._cargo),
            mission=self._held(),
            battery=BATTERY,
            software="stand-in",
            map_version=self.ways.campus.version,
            understands=("proof",),
        )

    def _snapshot(self) -> Snapshot:
        activity = Activity.IDLE if self._next_stop() is None else Activity.DRIVING
        return Snapshot(
            position=Position(post=self.post),
            activity=activity,
            battery=BATTERY,
            cargo=tuple(self._cargo),
            mission=self._held(),
        )

    def _held(self) -> MissionHeld | None:
        mission, stop = self._mission, self._next_stop()
        if mission is None or stop is None:
            return None
        return MissionHeld(id=mission.id, update=mission.update, next_stop=mission.stops.index(stop))

    def _resume(self, envelope: Envelope, welcome: Welcome) -> None:
        self._received = resume(self._received, envelope.journal, welcome.resume_from).received
        if welcome.received.journal == self.journal:
            self._acknowledged = max(self._acknowledged, welcome.received.seq)

    async def _hear(self, socket: ClientConnection, envelope: Envelope) -> None:
        self._acknowledged = max(self._acknowledged, envelope.ack)
        if isinstance(envelope.body, Error):
            self.errors.append(f"{envelope.body.code}: {envelope.body.message}")
        if envelope.seq is None:
            return
        judged = reception(self._received, envelope.journal, envelope.seq)
        if judged is Reception.GAP:
            await socket.close()
            return
        if judged is Reception.NEW:
            self._received = Received(journal=envelope.journal, seq=envelope.seq)
            await self._take(envelope.body)
        await socket.send(self._text(Ack()))

    async def _take(self, message: Part) -> None:
        match message:
            case Verifiers(verifiers=verifiers):
                for order_id in {one.order_id for one in verifiers}:
                    self._codes[order_id] = [one for one in verifiers if one.order_id == order_id]
            case Mission():
                self._mission = message
                self._cancelled -= {stop.order_id for stop in message.stops if stop.order_id}  # given anew
                await self._report(Step.ACCEPTED)
                self._work.set()
            case Cancel():
                await self._let_go(message)
            case _:
                self.errors.append(f"was told {type_of(message)}, which was never asked for")

    async def _let_go(self, wish: Cancel) -> None:
        """The planner gives the order to another robot, unless its mail is aboard by now."""
        refusal = "the mail is aboard" if wish.order_id in self._cargo else None
        if refusal is None:
            self._cancelled.add(wish.order_id)
        answer = CommandAnswer(
            command_id=wish.command_id, accepted=refusal is None, happened_at=datetime.now(UTC), reason=refusal
        )
        await self.say(Event(happened=answer))

    def _text(self, message: Part, seq: int | None = None, replay: bool = False) -> str:
        return Envelope(
            type=type_of(message),
            robot=self.name,
            journal=self.journal,
            seq=seq,
            ack=self._received.seq,
            at=datetime.now(UTC),
            replay=replay,
            body=message,
        ).to_text()

    async def say(self, message: Part) -> None:
        """Number and remember what is durable; send it if there is a connection, else at the next one."""
        seq = None
        if type_of(message) in DURABLE:
            seq = len(self.said) + 1
            self.said[seq] = message
        if self._socket is not None:
            with suppress(OSError, WebSocketException):
                await self._socket.send(self._text(message, seq))

    # The missions.

    def _next_stop(self) -> Stop | None:
        return next(iter(self._left()), None)

    def _left(self) -> list[Stop]:
        stops = self._mission.stops if self._mission else ()
        return [stop for stop in stops if stop.id not in self._over and stop.order_id not in self._cancelled]

    async def _do_missions(self) -> None:
        while True:
            self._work.clear()
            while (stop := self._next_stop()) is not None:
                await self._do(stop)
            await self._work.wait()

    async def _do(self, stop: Stop) -> None:
        await self._report(Step.DEPARTED, stop)
        await self._a_moment()
        await asyncio.sleep(self.ways.length_m(self.post, stop.post) / FASTEST_M_S)
        if stop not in self._left():
            return
        self.post = stop.post
        await self._report(Step.ARRIVED, stop)
        await self.say(self._snapshot())
        await self._a_moment()
        if stop not in self._left():
            return
        if stop.order_id is not None and stop.action in PURPOSES:
            shown = await self._is_shown(stop, stop.order_id, PURPOSES[stop.action])
            if shown is None:
                return
            await self._hand_over(stop, stop.order_id, PURPOSES[stop.action], shown)
        self._over.add(stop.id)
        await self._report(Step.DONE, stop)
        if self._next_stop() is None:
            await self._report(Step.DONE)

    async def _is_shown(self, stop: Stop, order_id: str, purpose: Purpose) -> ShownCode | None:
        """Wait for a code that opens; None: it is not to be handed over any more."""
        while stop in self._left():
            text = await self.show(order_id, purpose)
            shown = ShownCode.of(text or "")
            opens = {one.sha256 for one in self._codes[order_id] if one.purpose is purpose}
            if stop in self._left() and shown.sha256 in opens:
                return shown
            await asyncio.sleep(SHOWN_AGAIN_AFTER_S)
        return None

    async def _hand_over(self, stop: Stop, order_id: str, purpose: Purpose, shown: ShownCode) -> None:
        if purpose is Purpose.LOAD:
            self._cargo.append(order_id)
        else:
            self._cargo.remove(order_id)
        assert self._mission is not None
        self._receipts += 1
        receipt = HandoverReceipt(
            purpose=purpose,
            order_id=order_id,
            stop_id=stop.id,
            post=stop.post,
            happened_at=datetime.now(UTC),
            code_sha256=shown.sha256,
            mission_id=self._mission.id,
            number=self._receipts,
        )
        await self.say(Event(happened=receipt.model_copy(update={"proof": receipt.proved_with(shown.key)})))

    async def _report(self, step: Step, stop: Stop | None = None) -> None:
        assert self._mission is not None
        place: dict[str, Any] = {}
        if stop is not None:
            place = {"stop_id": stop.id, "order_id": stop.order_id, "post": stop.post}
        await self.say(
            Event(
                happened=Progress(
                    step=step,
                    happened_at=datetime.now(UTC),
                    mission_id=self._mission.id,
                    update=self._mission.update,
                    **place,
                )
            )
        )

    async def _a_moment(self) -> None:
        await asyncio.sleep(self.random.uniform(0.5, 1.5) * self.step_s)
