"""The robot's memory across a power cut: its mission, what it carries, how to check codes, where it may drive.

Everything is in the database of `robot/mission/store.py`. What belongs together is one transaction:

    with store.transaction():
        memory.load(order_id)
        memory.reach(next_stop=1)
        outbox.put(Event(happened=receipt))
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any, Final, TypeVar

from pydantic import TypeAdapter

from protocol import sequence
from protocol.envelope import TO_ROBOT, Envelope, type_of
from protocol.parts import Leg, MissionHeld, Part, Position, Purpose, Received
from protocol.sequence import Reception
from protocol.to_robot import Detour, Grant, Mission, Verifier, Verifiers
from robot.mission.loading import Loading
from robot.mission.mission_updates import MissionConflict, conflict, next_undone
from robot.mission.store import Store

KEPT_COMMANDS: Final = 200
KEPT_MISSIONS: Final = 10
"""The stops of so many that were dropped are known to be done."""
T = TypeVar("T")

_MISSION: Final = TypeAdapter[Mission | None](Mission | None)
_NUMBER: Final = TypeAdapter(int)
_IDS: Final = TypeAdapter(tuple[str, ...])
_VERIFIERS: Final = TypeAdapter(tuple[Verifier, ...])
_LEGS: Final = TypeAdapter(tuple[Leg, ...])
_POSITION: Final = TypeAdapter(Position)
_FLAG: Final = TypeAdapter(bool)
_NAMES: Final = TypeAdapter(frozenset[str])
_DONE_OF: Final = TypeAdapter(dict[str, frozenset[str]])
_TIMES: Final = TypeAdapter(dict[str, datetime])
_RECEIVED: Final = TypeAdapter(Received)
_WORD: Final = TypeAdapter[str | None](str | None)
_LEG: Final = TypeAdapter[Leg | None](Leg | None)
_LOADINGS: Final = TypeAdapter(dict[str, Loading])


@dataclass(frozen=True)
class Incoming:
    """A message from the server for the daemon to act on. `seq` is None for one that is not durable (an error)."""

    message: Part
    journal: str
    seq: int | None = None


@dataclass(frozen=True)
class ReceptionOutcome:
    """The outcome of a durable message: was it new, and if the robot could not do as told, why."""

    reception: Reception
    refusal: MissionConflict | None = None


class Memory:
    """Facts that survive a kill at any moment. Any thread may use it. Raises StorageFull or StorageFailed."""

    def __init__(self, store: Store) -> None:
        self._store = store

    # The mission and how far it has come.

    def mission(self) -> Mission | None:
        """The mission held, or None."""
        return self._read("mission", _MISSION, None)

    def next_stop(self) -> int:
        """Which stop of the mission comes next: 0 is the first, `len(stops)` means that all are done."""
        return next_undone(self.mission(), self._read("next_stop", _NUMBER, 0), self.done())

    def done(self) -> frozenset[str]:
        """The stops that were done before the last update; it may have put new ones before them."""
        return self._read("done", _NAMES, frozenset())

    def mission_held(self) -> MissionHeld | None:
        """The mission as `hello` and `snapshot` tell it."""
        with self._store.transaction():
            mission = self.mission()
            if mission is None:
                return None
            return MissionHeld(id=mission.id, update=mission.update, next_stop=self.next_stop())

    def hold(self, mission: Mission) -> bool:
        """Take a mission or an update of it; False if it is the one held, or older than that. Raises MissionConflict.

        Stops that were done stay done: the next stop is the first whose id has not been passed yet. So do those of a
        mission that was dropped: without network the service did not know that it was over, and it may have got an
        update. An order that was cancelled and is named again has been given anew: the server names none that is still
        to be dropped.
        """
        with self._store.transaction() as database:
            held = self.mission()
            if refusal := conflict(held, mission):
                raise refusal
            if held is not None and held.id == mission.id and mission.update <= held.update:
                return False
            is_update = held is not None and held.id == mission.id
            self._write("done", _NAMES, self._passed() if is_update else self._dropped().get(mission.id, frozenset()))
            self._write("cancelled", _NAMES, self.cancelled() - {stop.order_id for stop in mission.stops})
            self._write("next_stop", _NUMBER, 0)
            self._write("mission", _MISSION, mission)
            database.execute("DELETE FROM reported WHERE mission_id != ?", (mission.id,))
            return True

    def reach(self, next_stop: int) -> None:
        """The stops before `next_stop` are done."""
        self._write("next_stop", _NUMBER, next_stop)

    def pass_stop(self, stop_id: str) -> None:
        """The stop is done, or given up, and so are those before it; nothing if the mission held has none such."""
        with self._store.transaction():
            mission = self.mission()
            numbers = [number for number, stop in enumerate(mission.stops) if stop.id == stop_id] if mission else []
            for number in numbers:
                self.reach(max(self.next_stop(), number + 1))

    def drop_mission(self) -> None:
        """Nothing is to be done any more. Cargo, grants and verifiers stay what they are."""
        with self._store.transaction():
            if mission := self.mission():
                before = {one: done for one, done in self._dropped().items() if one != mission.id}
                newest = [*before.items(), (mission.id, self._passed())][-KEPT_MISSIONS:]
                self._write("dropped", _DONE_OF, dict(newest))
            self._write("mission", _MISSION, None)
            self._write("next_stop", _NUMBER, 0)
            self._write("done", _NAMES, frozenset())
            self._write("cancelled", _NAMES, frozenset())

    def _passed(self) -> frozenset[str]:
        mission = self.mission()
        return self.done() | {stop.id for stop in mission.stops[: self.next_stop()]} if mission else frozenset()

    def _dropped(self) -> dict[str, frozenset[str]]:
        return self._read("dropped", _DONE_OF, {})

    def first_time(self, mission_id: str, key: str) -> bool:
        """True once for each key of a mission, for ever: what was reported is not reported again after a restart.

        Call it in the transaction that puts the report into the outbox.
        """
        with self._store.transaction() as database:
            cursor = database.execute("INSERT OR IGNORE INTO reported VALUES (?, ?)", (mission_id, key))
            return cursor.rowcount == 1

    # What is aboard, and who may take it.

    def cargo(self) -> tuple[str, ...]:
        """The ids of the orders whose mail is aboard."""
        return self._read("cargo", _IDS, ())

    def loadings(self) -> dict[str, Loading]:
        """Where the mail that is aboard came from, by order."""
        return self._read("loadings", _LOADINGS, {})

    def load(self, order_id: str, loading: Loading | None = None) -> None:
        """The mail of this order came aboard."""
        with self._store.transaction():
            self._write("cargo", _IDS, (*_without(self.cargo(), order_id), order_id))
            if loading:
                self._write("loadings", _LOADINGS, {**self.loadings(), order_id: loading})

    def unload(self, order_id: str) -> None:
        """The mail of this order was taken out."""
        with self._store.transaction():
            self._write("cargo", _IDS, _without(self.cargo(), order_id))
            self._write("loadings", _LOADINGS, {one: at for one, at in self.loadings().items() if one != order_id})

    def verifiers(self) -> tuple[Verifier, ...]:
        """Return the verifiers of hand-over codes."""
        return self._read("verifiers", _VERIFIERS, ())

    def keep_verifiers(self, verifiers: Verifiers, at: datetime) -> None:
        """These take the place of all that were kept for the orders that they name.

        Those that have expired by then open nothing any more and are forgotten: they must not pile up for ever.
        """
        named = {one.order_id for one in verifiers.verifiers}
        with self._store.transaction():
            lasting = (one for one in self.verifiers() if at < one.expires_at and one.order_id not in named)
            self._write("verifiers", _VERIFIERS, (*lasting, *verifiers.verifiers))

    def forget_verifiers(self, order_id: str, purpose: Purpose | None = None) -> None:
        """The code of this order for `purpose` is used up; without a purpose, all of its codes."""
        with self._store.transaction():
            kept = tuple(
                one for one in self.verifiers() if one.order_id != order_id or purpose not in (None, one.purpose)
            )
            self._write("verifiers", _VERIFIERS, kept)

    # What it was told to leave undone, and what is wrong with it.

    def paused(self) -> bool:
        """Return whether it was asked to wait at the next post."""
        return self._read("paused", _FLAG, False)

    def pause(self, paused: bool) -> None:
        """Wait at the next post, or no longer."""
        self._write("paused", _FLAG, paused)

    def cancelled(self) -> frozenset[str]:
        """The orders of the mission held that are not to be served any more."""
        return self._read("cancelled", _NAMES, frozenset())

    def cancel(self, order_id: str) -> None:
        """This order of the mission held is not to be served; its codes open nothing any more."""
        with self._store.transaction():
            self._write("cancelled", _NAMES, self.cancelled() | {order_id})
            self.forget_verifiers(order_id)

    def charge(self) -> str | None:
        """Return how far the battery plan has come, as it was told last: low or charging; None when there is none."""
        return self._read("charge", _WORD, None)

    def note_charge(self, step: str | None) -> None:
        """Put the message into the outbox in the same transaction."""
        self._write("charge", _WORD, step)

    def faults(self) -> frozenset[str]:
        """The faults that were told and are not over."""
        return self._read("faults", _NAMES, frozenset())

    def keep_faults(self, faults: frozenset[str]) -> None:
        """These are told and not over. Put the message into the outbox in the same transaction."""
        self._write("faults", _NAMES, faults)

    def first_command(self, command_id: str) -> bool:
        """True once for each command, through restarts; only the newest are remembered."""
        with self._store.transaction():
            known = self._read("commands", _IDS, ())
            if command_id in known:
                return False
            self._write("commands", _IDS, (*known, command_id)[-KEPT_COMMANDS:])
            return True

    # Where it may drive and where it was seen.

    def grants(self) -> tuple[Leg, ...]:
        """The corridors that may be entered, in the order in which they were granted."""
        return self._read("grants", _LEGS, ())

    def grant(self, legs: Sequence[Leg]) -> None:
        """These may be entered from now on, until they are reported clear."""
        with self._store.transaction():
            self._write("grants", _LEGS, (*self.grants(), *(leg for leg in legs if leg not in self.grants())))

    def clear(self, leg: Leg) -> None:
        """The robot is out of this corridor. Put the `clear` message into the outbox in the same transaction."""
        with self._store.transaction():
            self._write("grants", _LEGS, tuple(one for one in self.grants() if one != leg))
            if self.detour() == leg:
                self._write("detour", _LEG, None)

    def revoke(self) -> None:
        """Drop every grant and the place: the robot's location is unknown."""
        with self._store.transaction():
            self._write("grants", _LEGS, ())
            self._write("detour", _LEG, None)
            self._write("position", _POSITION, Position())
            self._write("moment", _WORD, None)

    def detour(self) -> Leg | None:
        """The corridor that it takes first, until it has come through or gives it back: the service sends it there, or
        it goes there out of a hole in the network."""
        return self._read("detour", _LEG, None)

    def turn_aside(self, leg: Leg) -> None:
        """It takes this corridor first, which it holds."""
        self._write("detour", _LEG, leg)

    def position(self) -> Position:
        """Where the robot was last seen."""
        return self._read("position", _POSITION, Position())

    def see(self, post: str, at: datetime, towards: str | None = None, moment: str | None = None) -> Position:
        """The robot was seen at `post`; the post it was seen at before becomes `previous`."""
        with self._store.transaction():
            before = self.position()
            previous = before.previous if before.post == post else before.post
            if (detour := self.detour()) and detour.to_post == post:
                self._write("detour", _LEG, None)
            position = Position(post=post, previous=previous, towards=towards, seen_at=at)
            self._write("position", _POSITION, position)
            self._write("moment", _WORD, moment)
            return position

    def head(self, towards: str | None, moment: str | None = None) -> Position:
        """The robot is on its way to this post next, or to none."""
        with self._store.transaction():
            position = self.position().model_copy(update={"towards": towards})
            self._write("position", _POSITION, position)
            self._write("moment", _WORD, moment)
            return position

    def moment(self) -> str | None:
        """The action that leaves doubt of its place after a power cut (`localization.remembering.Moment`)."""
        return self._read("moment", _WORD, None)

    def note_moment(self, moment: str) -> None:
        """Until it is seen at a post, or heads for another one."""
        self._write("moment", _WORD, moment)

    def home(self) -> str | None:
        """The bay that the service has given it to rest in."""
        return self._read("home", _WORD, None)

    def keep_home(self, home: str) -> None:
        self._write("home", _WORD, home)

    def closed(self) -> dict[str, datetime]:
        """The corridors in which it turned back, by name, and when."""
        return self._read("closed", _TIMES, {})

    def keep_closed(self, closed: Mapping[str, datetime]) -> None:
        """These instead of those before."""
        self._write("closed", _TIMES, closed)

    # What came from the server.

    def received(self) -> Received:
        """The highest contiguous number that was taken from the server's journal."""
        return self._read("received", _RECEIVED, Received())

    def resume(self, journal: str, resume_from: int) -> int:
        """Take up the server's journal as its `welcome` says; returns how many of its messages are lost for ever."""
        with self._store.transaction():
            resumption = sequence.resume(self.received(), journal, resume_from)
            self._write("received", _RECEIVED, resumption.received)
            return resumption.lost

    def receive(self, envelope: Envelope) -> ReceptionOutcome:
        """Store a durable message and what follows from it; acknowledge it when this has returned.

        Missions, verifiers and grants take effect here and now; every new message also waits in `unhandled`.
        """
        assert envelope.seq is not None, "only durable messages are stored"  # noqa: S101
        with self._store.transaction() as database:
            judged = sequence.reception(self.received(), envelope.journal, envelope.seq)
            if judged is not Reception.NEW:
                return ReceptionOutcome(judged)
            self._write("received", _RECEIVED, Received(journal=envelope.journal, seq=envelope.seq))
            if isinstance(envelope.body, Mission) and (refusal := conflict(self.mission(), envelope.body)):
                return ReceptionOutcome(judged, refusal)
            self._apply(envelope.body, envelope.at)
            row = (envelope.journal, envelope.seq, type_of(envelope.body), envelope.body.model_dump_json())
            database.execute("INSERT INTO inbox VALUES (?, ?, ?, ?)", row)
            return ReceptionOutcome(judged)

    def _apply(self, message: Part, at: datetime) -> None:
        match message:
            case Mission():
                self.hold(message)
            case Verifiers():
                self.keep_verifiers(message, at)
            case Grant():
                self.grant(message.legs)
            case Detour():
                self.grant(message.legs)
                self.turn_aside(message.legs[-1])  # out of a bay the first leads onto the crossing alone
            case _:  # commands are for the daemon to carry out
                pass

    def unhandled(self) -> list[Incoming]:
        """Messages that were stored and not acted on yet, in order: after a restart, they come again."""
        with self._store.transaction() as database:
            rows = database.execute("SELECT journal, seq, type, body FROM inbox ORDER BY rowid").fetchall()
        return [Incoming(TO_ROBOT[name].model_validate_json(body), journal, seq) for journal, seq, name, body in rows]

    def handled(self, incoming: Incoming) -> None:
        """The daemon has acted on it. Call it in the transaction that keeps the result."""
        with self._store.transaction() as database:
            database.execute("DELETE FROM inbox WHERE journal = ? AND seq = ?", (incoming.journal, incoming.seq))

    def _read(self, name: str, kind: TypeAdapter[T], default: T) -> T:
        with self._store.transaction() as database:
            row = database.execute("SELECT value FROM facts WHERE name = ?", (name,)).fetchone()
        return kind.validate_json(row[0]) if row else default

    def _write(self, name: str, kind: TypeAdapter[Any], value: object) -> None:
        with self._store.transaction() as database:
            text = kind.dump_json(value).decode()
            database.execute("INSERT OR REPLACE INTO facts (name, value) VALUES (?, ?)", (name, text))


def _without(order_ids: Sequence[str], order_id: str) -> tuple[str, ...]:
    return tuple(one for one in order_ids if one != order_id)
