"""The service's part in a scenario: missions for orders, codes, grants, and a record of everything that robots tell.

It speaks the product's protocol, message by message as text; it plans nothing and decides next to nothing.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from datetime import timedelta
from typing import Final

from maps import CampusMap
from protocol import sequence
from protocol.both_ways import Ack, Error
from protocol.clock import Clock
from protocol.envelope import TO_SERVER, Envelope, parse, type_of
from protocol.parts import Activity, Part, Purpose, Received, Stop, StopAction
from protocol.proofs import ShownCode
from protocol.sequence import Reception
from protocol.to_robot import Grant, Mission, Verifier, Verifiers, Welcome
from protocol.to_server import (
    Charge,
    Claim,
    Clear,
    CommandAnswer,
    Event,
    Fault,
    HandoverReceipt,
    Hello,
    Occupancy,
    Progress,
    Snapshot,
    Step,
    Why,
)
from robot.scenarios.actors.interlocking import Claimed, Interlocking
from robot.scenarios.actors.mail import Letter, Receipt, fingerprint

VALID_FOR: Final = timedelta(days=2)


@dataclass
class Told:
    """Something that a robot told, in words: `progress arrived post1`, `fault way_blocked` …"""

    at_s: float
    robot: str
    text: str


@dataclass
class Session:
    """One robot as the service knows it."""

    robot: str
    journal: str
    sent: list[Part] = field(default_factory=list)
    """Every durable message so far: its number is its place, from 1."""
    received: Received = field(default_factory=Received)
    send: Callable[[str], None] | None = None
    greeted: bool = False
    mission: Mission | None = None
    missions: int = 0
    snapshot: Snapshot | None = None
    why: Why | None = None
    commands: dict[str, str] = field(default_factory=dict)
    """What was asked with which command id."""
    faults: dict[str, str] = field(default_factory=dict)
    """Told and not over, with their reasons."""
    errors: list[str] = field(default_factory=list)
    occupies: Occupancy | None = None
    """Its last word on the bay, crossing or corridor that it is wholly in."""


class StandIn:
    """`tick` once in a while; everything else is called by the robots' links (`stepped_link.Far`)."""

    def __init__(
        self, campus: CampusMap, clock: Clock, letters: dict[str, Letter], homes: dict[str, str | None]
    ) -> None:
        self._campus, self._clock, self.letters = campus, clock, letters
        self.sessions = {robot: Session(robot, f"service-{robot}") for robot in homes}
        self.interlocking = Interlocking(campus, homes)
        self.told: list[Told] = []
        self._waiting = list(letters.values())
        self._commands = 0

    # Orders become missions.

    def tick(self, now: float) -> None:
        due = [letter for letter in self._waiting if letter.order.at_s <= now and not letter.cancelled]
        for letter in due:
            if letter in self._waiting and (session := self._free(letter)):
                together = [one for one in due if one is letter or _go_together(one, letter)]
                self._waiting = [one for one in self._waiting if one not in together]
                self._assign(session, together)
        for claim in self.interlocking.grants():
            self.push(claim.robot, Grant(claim_id=claim.claim_id, legs=claim.legs))

    def _free(self, letter: Letter) -> Session | None:
        wanted = letter.order.robot
        return next(
            (
                one
                for name, one in self.sessions.items()
                if wanted in (None, name) and one.greeted and _is_free(one) and not self._said_aboard(name)
            ),
            None,
        )

    def _said_aboard(self, robot: str) -> list[Letter]:
        """By the receipts that the robot has told."""
        return [one for one in self.letters.values() if one.said_to_be_in == robot]

    def _assign(self, session: Session, letters: list[Letter]) -> None:
        for letter in letters:
            letter.robot = session.robot
        loads = [_stop(letter, StopAction.LOAD, letter.order.origin) for letter in letters]
        receives = [_stop(letter, StopAction.RECEIVE, letter.order.destination) for letter in letters]
        verifiers = [
            self._verifier(letter, purpose, code)
            for letter in letters
            for purpose, code in ((Purpose.LOAD, letter.load_code), (Purpose.RECEIVE, letter.receive_code))
        ]
        session.missions += 1
        session.mission = Mission(id=f"m-{session.robot}-{session.missions}", update=1, stops=(*loads, *receives))
        self.push(session.robot, Verifiers(verifiers=tuple(verifiers)))
        self.push(session.robot, session.mission)

    def _verifier(self, letter: Letter, purpose: Purpose, code: str) -> Verifier:
        expires_at = self._clock.utc() + VALID_FOR
        return Verifier(order_id=letter.order.id, purpose=purpose, sha256=fingerprint(code), expires_at=expires_at)

    # What is said to robots.

    def push(self, robot: str, message: Part) -> None:
        """A durable message: it is sent now, and again after every greeting until the robot has it."""
        session = self.sessions[robot]
        session.sent.append(message)
        self._send(session, message, len(session.sent))

    def command_id(self, robot: str, asked: str) -> str:
        """`asked`: pause, resume, recall …, or cancel and the order."""
        self._commands += 1
        self.sessions[robot].commands[f"c{self._commands}"] = asked
        return f"c{self._commands}"

    def _send(self, session: Session, message: Part, seq: int | None = None) -> None:
        if session.send is None or (seq is not None and not session.greeted):
            return
        envelope = Envelope(
            type=type_of(message),
            robot=session.robot,
            journal=session.journal,
            seq=seq,
            ack=session.received.seq,
            at=self._clock.utc(),
            body=message,
        )
        session.send(envelope.to_text())

    # What robots say (stepped_link.Far).

    def opened(self, robot: str, send: Callable[[str], None]) -> None:
        self.sessions[robot].send, self.sessions[robot].greeted = send, False

    def closed(self, robot: str) -> None:
        self.sessions[robot].send = None

    def hear(self, robot: str, text: str) -> None:
        session, envelope = self.sessions[robot], parse(text, TO_SERVER)
        if isinstance(envelope.body, Hello):
            self._greet(session, envelope, envelope.body)
        elif envelope.seq is None:
            self._take(session, envelope.body)
        else:
            judged = sequence.reception(session.received, envelope.journal, envelope.seq)
            if judged is Reception.GAP:
                session.errors.append(f"message {envelope.seq} came after {session.received.seq}")
                return
            if judged is Reception.NEW:
                self._take(session, envelope.body)
                session.received = Received(journal=envelope.journal, seq=envelope.seq)
            self._send(session, Ack())

    def _greet(self, session: Session, envelope: Envelope, hello: Hello) -> None:
        session.received = sequence.resume(session.received, envelope.journal, hello.resume_from).received
        self._send(session, Welcome(received=session.received, server="stand-in", at=self._clock.utc()))
        session.greeted = True
        had = hello.received.seq if hello.received.journal == session.journal else 0
        for seq in range(had + 1, len(session.sent) + 1):
            self._send(session, session.sent[seq - 1], seq)

    def _take(self, session: Session, message: Part) -> None:
        match message:
            case Snapshot():
                session.snapshot = message
                if message.activity is Activity.CHARGING or self._rests_at_home(session, message):
                    self.interlocking.in_dock(session.robot)
            case Why():
                session.why = message
            case Error():
                session.errors.append(f"{message.code}: {message.message}")
            case Claim():
                self.interlocking.claim(Claimed(session.robot, message.claim_id, message.legs))
            case Clear():
                self.interlocking.clear(session.robot, message.leg)
            case Occupancy():
                session.occupies = message
            case Event():
                self._happened(session, message)

    def _rests_at_home(self, session: Session, snapshot: Snapshot) -> bool:
        home = self.interlocking.homes.get(session.robot)
        return snapshot.activity is Activity.IDLE and home is not None and snapshot.position.post == home

    def _happened(self, session: Session, event: Event) -> None:
        happened = event.happened
        match happened:
            case Progress():
                self._note(session, f"progress {happened.step} {happened.post or ''}".strip())
                self._progress(session, happened)
            case HandoverReceipt():
                self._note(session, f"handover {happened.purpose} {happened.order_id}")
                self._receipt(session, happened)
            case Charge():
                self._note(session, f"charge {happened.step}")
            case Fault():
                self._note(session, f"fault {happened.name}" + (" over" if happened.cleared else ""))
                if happened.cleared:
                    session.faults.pop(happened.name, None)
                else:
                    session.faults[happened.name] = happened.reason
            case CommandAnswer():
                words = "accepted" if happened.accepted else f"refused: {happened.reason}"
                asked = session.commands.get(happened.command_id, "?")
                self._note(session, f"answer {asked} {words}")
                if happened.accepted:
                    self._end_mission(session, asked)

    def _end_mission(self, session: Session, asked: str) -> None:
        """A recall ends the mission, and so does a cancellation of all that was left of it."""
        stops = session.mission.stops if session.mission else ()
        left = {stop.order_id for stop in stops if not self.letters[stop.order_id or ""].cancelled}
        if asked == "recall" or (asked.startswith("cancel") and not left):
            session.mission = None

    def _note(self, session: Session, text: str) -> None:
        self.told.append(Told(self._clock.now(), session.robot, text))

    def _progress(self, session: Session, progress: Progress) -> None:
        letter = self.letters.get(progress.order_id or "")
        if letter and progress.step is Step.GAVE_UP:
            letter.gave_up.append(progress.reason or "")
            letter.returning = letter.said_to_be_in is not None  # its sender is told that it comes back
        if progress.step is Step.DONE and session.mission and progress.mission_id == session.mission.id:
            session.mission = None

    def _receipt(self, session: Session, receipt: HandoverReceipt) -> None:
        letter = self.letters.get(receipt.order_id)
        if letter is None:
            session.errors.append(f"a receipt for {receipt.order_id}, which was not ordered")
        elif receipt.how == "code" and not _proves(receipt, letter):
            session.errors.append(f"a receipt for {receipt.order_id} that no code of it proves")
        else:
            letter.receipts.append(Receipt(self._clock.now(), session.robot, receipt.purpose, receipt.post))

    @property
    def is_done(self) -> bool:
        """Nothing is left to be done for anybody."""
        return not self._waiting and all(_is_free(session) for session in self.sessions.values())


def _is_free(session: Session) -> bool:
    """By our record and by its own word: mail that was not taken is brought back by a mission of its own."""
    return session.mission is None and (session.snapshot is None or session.snapshot.mission is None)


def _proves(receipt: HandoverReceipt, letter: Letter) -> bool:
    keys = [ShownCode.of(code).key for code in (letter.load_code, letter.receive_code)]
    return receipt.proof in [receipt.proved_with(key) for key in keys]


def _go_together(one: Letter, other: Letter) -> bool:
    return one.order.together is not None and one.order.together == other.order.together


def _stop(letter: Letter, action: StopAction, post: str) -> Stop:
    return Stop(
        id=f"{action.value}-{letter.order.id}",
        post=post,
        action=action,
        order_id=letter.order.id,
        wait_limit_s=letter.order.wait_limit_s,
    )
