"""The link of one simulated robot: the messages of the protocol as text, both ways, numbered, kept and sent again.

Every message is built, written, read and checked by `protocol`, as it is between a robot and the service. Only the
socket is missing: what is said arrives a moment later, unless the robot is away; then what is durable waits.
"""

from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from datetime import timedelta
from functools import partial
from typing import Final

from benchmarks.fleet.charging_world import BEGINS, Clockwork
from protocol.both_ways import Ack
from protocol.envelope import DURABLE, TO_ROBOT, TO_SERVER, Envelope, parse, type_of
from protocol.parts import Part, Received
from protocol.sequence import Reception, reception, resume
from protocol.to_robot import Welcome
from protocol.to_server import Hello

LATENCY_S: Final = 0.2
ACK_AFTER_S: Final = 1.0


class LostMessageError(AssertionError):
    """A durable message did not come, or came twice."""


@dataclass
class End:
    """One end's storage: its journal with what was not acknowledged, and what it has had of the other's."""

    journal: str
    accepted: Mapping[str, type[Part]]
    hear: Callable[[Part], None]
    said: int = 0
    backlog: dict[int, Part] = field(default_factory=dict)
    received: Received = field(default_factory=Received)
    owes_ack: bool = False

    @property
    def resume_from(self) -> int:
        return min(self.backlog, default=self.said + 1)


class Link:
    """`hello` says what the robot tells when it connects. `sent` counts messages by their names."""

    def __init__(self, robot: str, clock: Clockwork, sent: Counter[str]) -> None:
        self.robot, self.clock, self.sent = robot, clock, sent
        self.up = False
        self.hello: Callable[[], Hello] = lambda: _nothing(robot)
        self._turn = 0
        self.on_robot = End(f"{robot}-journal", TO_ROBOT, lambda _: None)
        self.on_server = End("service-journal", TO_SERVER, lambda _: None)

    def connect(self) -> None:
        """The robot greets; the answer says what has come, and both sides send again what has not."""
        if self.up:
            return
        self.up = True
        self._turn += 1
        robot, server = self.on_robot, self.on_server
        hello = self.hello().model_copy(update={"received": robot.received, "resume_from": robot.resume_from})
        server.received = resume(server.received, robot.journal, hello.resume_from).received
        robot.received = resume(robot.received, server.journal, server.resume_from).received
        self._send(robot, hello)
        welcome = Welcome(
            received=server.received, resume_from=server.resume_from, server="Simulated", at=self.clock.local
        )
        self._send(server, welcome)
        for end, had in ((robot, server.received.seq), (server, robot.received.seq)):
            self._forget(end, had)
            for seq, body in list(end.backlog.items()):
                self._send(end, body, seq, replay=True)

    def disconnect(self) -> None:
        """Drop the connection: what is on its way is lost."""
        self.up = False
        self._turn += 1

    def to_server(self, body: Part) -> None:
        self._say(self.on_robot, body)

    def to_robot(self, body: Part) -> None:
        self._say(self.on_server, body)

    def _say(self, end: End, body: Part) -> None:
        seq = None
        if type_of(body) in DURABLE:
            end.said += 1
            seq = end.said
            end.backlog[seq] = body
        if self.up:
            self._send(end, body, seq)

    def _send(self, end: End, body: Part, seq: int | None = None, *, replay: bool = False) -> None:
        end.owes_ack = False
        text = Envelope(
            type=type_of(body),
            robot=self.robot,
            journal=end.journal,
            seq=seq,
            ack=end.received.seq,
            at=BEGINS + timedelta(seconds=self.clock.now_s),
            replay=replay,
            body=body,
        ).to_text()
        self.sent[type_of(body)] += 1
        to = self.on_server if end is self.on_robot else self.on_robot
        self.clock.at(self.clock.now_s + LATENCY_S, partial(self._arrives, to, text, self._turn))

    def _arrives(self, end: End, text: str, turn: int) -> None:
        if turn != self._turn:
            return
        envelope = parse(text, end.accepted)
        self._forget(end, envelope.ack)
        if envelope.seq is not None:
            found = reception(end.received, envelope.journal, envelope.seq)
            if found is Reception.GAP:
                raise LostMessageError(f"{self.robot}: {envelope.type} {envelope.seq} after {end.received.seq}")
            if found is Reception.REPEATED:
                return
            end.received = Received(journal=envelope.journal, seq=envelope.seq)
            self._owe_ack(end)
        end.hear(envelope.body)

    def _owe_ack(self, end: End) -> None:
        if not end.owes_ack:
            end.owes_ack = True
            self.clock.at(self.clock.now_s + ACK_AFTER_S, partial(self._acknowledge, end))

    def _acknowledge(self, end: End) -> None:
        """Unless something else has carried it."""
        if end.owes_ack and self.up:
            self._send(end, Ack())
        end.owes_ack = False

    def _forget(self, end: End, had: int) -> None:
        for seq in [seq for seq in end.backlog if seq <= had]:
            del end.backlog[seq]


def _nothing(robot: str) -> Hello:
    raise LookupError(f"{robot} has nothing to say yet")
