"""The mission and its state: its orders, the mail aboard, the corridors it holds, and the reports on all that.

Every change is one transaction on the disk: what was done, what is remembered and what is told to the server either all
happened or not at all. A report is made once for each step of a stop, however often the agent asks for it: a mission
may be interrupted and begun again at its present stop at any time.
"""

from collections.abc import Callable, Mapping
from datetime import datetime, timedelta
from typing import Final, Literal

from protocol.parts import Part, Purpose, Stop, StopAction
from protocol.proofs import ShownCode
from protocol.to_robot import (
    Cancel,
    Confirm,
    Deny,
    Detour,
    EmergencyStop,
    Grant,
    Mission,
    OpenWay,
    Pause,
    Recall,
    Resume,
    Revoke,
    Verifiers,
)
from protocol.to_server import (
    Charge,
    CommandAnswer,
    Event,
    Evidence,
    Fault,
    HandoverReceipt,
    Progress,
    Step,
    Where,
)
from robot.core.errors import RobotError
from robot.localization.counted_turn import NOT_TURNED, Turned
from robot.mission.custody import Custody, Proof, Sign, opening
from robot.mission.memory import Memory
from robot.mission.occupancy import OccupancyReports
from robot.mission.outbox import Outbox
from robot.mission.reservations import Claims
from robot.mission.returns import is_own, return_mission
from robot.mission.service_link import Server
from robot.mission.state import REVOKED, Held
from robot.mission.store import Store
from robot.mission.turn_record import TurnRecord

ChargeStep = Literal["low", "charging", "charged"]
MAIL_ABOARD: Final = "mail_aboard"
"""The fault of mail that could not be handed over, not even where it came from."""


class NoSuchStop(RobotError):
    """A report names a stop that the mission held does not have."""


class MissionManager:
    """The mind's side of memory and outbox. `server` None: the robot works alone and grants itself everything."""

    def __init__(
        self,
        store: Store,
        memory: Memory,
        outbox: Outbox,
        utc: Callable[[], datetime],
        server: Server | None = None,
        mailroom: str | None = None,
        sign: Sign | None = None,
    ) -> None:
        self._store, self.memory, self.outbox, self.utc = store, memory, outbox, utc
        self._server, self._mailroom = server, mailroom
        self.custody = Custody(memory, outbox, utc, sign)
        self.occupancy = OccupancyReports(store, outbox, utc)
        self.turns = TurnRecord(store)
        self.rearm_asked = False
        """A dispatcher has looked, and lets a stopped robot go again; the mind passes it on."""
        self.stop_asked = False
        """The service wants it to stand still at once; the mind passes it on, if the link has not yet."""
        self.open_way: Callable[[OpenWay, float], str | None] = lambda _, __: "This robot has no map yet."
        """Takes a corridor for open again, which a person has looked at so many seconds ago; why not, or None. The
        navigator knows the corridors."""
        self.forget_place_asked = False
        """A person has taken it away, or will: its last believed place does not count; for the navigator."""
        self.revision = 0
        """Goes up with every change of what is held."""
        self.held = Held()
        self.claims = Claims(store, memory, outbox, lambda: self.held, self._told, alone=server is None)
        self._changed()

    def join(self, server: Server) -> None:
        """The link is made after this, since it asks for what is held: from now on there is a server."""
        self._server, self.claims.alone = server, False

    @property
    def online(self) -> bool:
        """Return whether the server can be reached now; a robot that works alone counts as online."""
        return self._server is None or self._server.online

    def _changed(self) -> None:
        with self._store.transaction():
            self.held = Held(
                self.memory.mission(),
                self.memory.next_stop(),
                self.memory.cargo(),
                self.memory.grants(),
                self.memory.verifiers(),
                self.memory.position(),
                self.memory.paused(),
                self.memory.cancelled(),
                self.memory.faults(),
                self.memory.charge() is not None,
                self.memory.loadings(),
                self.memory.moment(),
                self.memory.home(),
                self.memory.detour(),
            )
        self.revision += 1

    def _told(self) -> None:
        self._changed()
        if self._server:
            self._server.wake()

    # From the server.

    def take_messages(self) -> None:
        """Act on everything that came from the server since the last call; each message is done with on the disk."""
        messages = self._server.incoming() if self._server else ()
        for incoming in messages:
            with self._store.transaction():
                if self._is_new(incoming.message):
                    self._take(incoming.message)
                if incoming.seq is not None:
                    self.memory.handled(incoming)
        if messages:
            self._told()
            self._tell_taken(self.held.position.post)

    def _is_new(self, message: Part) -> bool:
        """A command that comes again changes nothing: what it asked for may be over by now."""
        command_id = getattr(message, "command_id", None)
        return command_id is None or self.memory.first_command(command_id)

    def give(self, mission: Mission) -> None:
        """A mission given on the spot, without a server. Raises MissionConflict."""
        with self._store.transaction():
            self.memory.hold(mission)
            self._accepted(mission)
        self._told()

    def _take(self, message: Part) -> None:
        match message:
            case Mission():
                # Held since it came; but a recall that came before it, and is carried out only now, has dropped it.
                self.memory.hold(message)
                self._accepted(message)
            case Grant() | Detour() | Deny():
                self.claims.hear(message)
            case Cancel():
                self._answer(message.command_id, self._cancel(message))
            case Confirm():
                self._confirm(message)
            case Pause():
                self.memory.pause(True)
                self._answer(message.command_id, None)
            case Resume():
                self.memory.pause(False)
                self.rearm_asked, self.stop_asked = True, False
                self._answer(message.command_id, None)
            case EmergencyStop():
                self.rearm_asked, self.stop_asked = False, True
                self._answer(message.command_id, None)
            case Revoke():
                self._revoke(message)
            case Recall():
                self._recall()
                self._answer(message.command_id, None)
            case OpenWay():
                looked_s_ago = (self.utc() - message.looked_at).total_seconds()
                self._answer(message.command_id, self.open_way(message, looked_s_ago))
            case Verifiers():
                pass  # memory has taken them already

    def _revoke(self, wish: Revoke) -> None:
        self.memory.revoke()
        self.occupancy.forget()
        self.claims.void()
        self.rearm_asked, self.stop_asked, self.forget_place_asked = False, True, True
        self._begin_fault(
            REVOKED, "Its corridors were given to others. It stands until it is put down at a post.", None
        )
        self._answer(wish.command_id, None)

    def _begin_fault(self, name: str, reason: str, post: str | None) -> None:
        self.memory.keep_faults(self.memory.faults() | {name})
        self._tell(Fault(name=name, happened_at=self.utc(), post=post, reason=reason))

    def _accepted(self, mission: Mission) -> None:
        if self.memory.first_time(mission.id, f"{Step.ACCEPTED}:{mission.update}"):
            self._tell(self._progress(Step.ACCEPTED, mission, None, None))

    def _answer(self, command_id: str, refusal: str | None) -> None:
        accepted = refusal is None
        answer = CommandAnswer(command_id=command_id, accepted=accepted, happened_at=self.utc(), reason=refusal)
        self._tell(answer)

    def _confirm(self, wish: Confirm) -> None:
        """Done, the receipt is the answer."""
        refusal = self.custody.confirm(wish)
        if refusal is not None:
            self._answer(wish.command_id, refusal)

    def _cancel(self, wish: Cancel) -> str | None:
        """Why not, or None."""
        if wish.order_id in self.memory.cargo() and not wish.by_hand:
            return "The mail is aboard."
        self.memory.unload(wish.order_id)
        mission = self.memory.mission()
        ahead = mission.stops[self.memory.next_stop() :] if mission else ()
        self.memory.cancel(wish.order_id)
        if all(stop.order_id in (wish.order_id, None) for stop in ahead):
            self.memory.drop_mission()
        return None

    def _recall(self) -> None:
        """Return the mail aboard to where it came from; without any, it is free."""
        before = self.memory.mission()
        self.memory.drop_mission()
        self._bring_back(before)

    def _bring_back(self, before: Mission | None) -> None:
        mission = return_mission(self.memory.cargo(), self.memory.loadings(), self._mailroom, before)
        if mission:
            self.memory.hold(mission)
            self._accepted(mission)

    def _tell(self, happened: Progress | HandoverReceipt | Charge | Fault | CommandAnswer) -> None:
        self.outbox.put(Event(happened=happened))

    # From the agent.

    def report(self, step: Step, stop_id: str, post: str | None, reason: str | None = None) -> None:
        """Tell how far the mission has come; once for each step of a stop (`passed`: once for each post on the way)."""
        mission, stop = self._stop(stop_id)
        key = f"{step}:{stop_id}:{post}" if step is Step.PASSED else f"{step}:{stop_id}"
        with self._store.transaction():
            if self.memory.first_time(mission.id, key):
                self._tell(self._progress(step, mission, stop, post, reason))
        self._told()

    def _progress(
        self, step: Step, mission: Mission, stop: Stop | None, post: str | None, reason: str | None = None
    ) -> Progress:
        return Progress(
            step=step,
            happened_at=self.utc(),
            mission_id=mission.id,
            update=mission.update,
            stop_id=stop and stop.id,
            order_id=stop and stop.order_id,
            post=post,
            reason=reason,
        )

    def _stop(self, stop_id: str) -> tuple[Mission, Stop]:
        mission = self.held.mission
        for stop in mission.stops if mission else ():
            if mission and stop.id == stop_id:
                return mission, stop
        raise NoSuchStop(f"stop {stop_id} is not one of mission {mission.id if mission else '(none)'}")

    def finish_stop(self, stop_id: str) -> None:
        """The stop is done, or given up: the next one comes."""
        self._stop(stop_id)
        with self._store.transaction():
            self.memory.pass_stop(stop_id)
        self._changed()

    def finish_mission(self, mission_id: str, post: str | None) -> None:
        """End the mission: say so once, and be free for the next one. Mail that no recipient took is brought back."""
        mission = self.held.mission
        if mission is None or mission.id != mission_id:
            return
        with self._store.transaction():
            # Once for each update: one that came after the mission was done makes it a mission again.
            if self.memory.first_time(mission.id, f"{Step.DONE}:{mission.update}"):
                self._tell(self._progress(Step.DONE, mission, None, post))
            self.memory.drop_mission()
            if is_own(mission):
                self._tell_not_taken(post)
            else:
                self._bring_back(mission)
        self._told()

    def _tell_not_taken(self, post: str | None) -> None:
        """Report mail that was not taken back either: which mail it is, and that it is still aboard."""
        left = self.memory.cargo()
        if left and MAIL_ABOARD not in self.memory.faults():
            reason = (
                f"Nobody took the mail of {', '.join(left)}, at its sender's post or the mailroom. It is still aboard."
            )
            self._begin_fault(MAIL_ABOARD, reason, post)

    def codes(self, order_id: str, purpose: Purpose) -> tuple[str, ...]:
        """Return the accepted codes of this hand-over, as SHA-256. For any thread, and without a look at the disk."""
        return opening(self.held.verifiers, self.held.loadings, order_id, purpose, self.utc())

    def at_stop(self, stop_id: str) -> tuple[Mission, Stop]:
        """A stop of the mission held, with its mission. Raises NoSuchStop."""
        return self._stop(stop_id)

    def loads_nothing_else(self, order_id: str, post: str) -> bool:
        """Return whether no other order is still to be loaded at this post. Its sender may stand there and press a
        button that does not say whose mail it means."""
        stops = self.held.mission.stops[self.held.next_stop :] if self.held.mission else ()
        loaded = {one.order_id for one in stops if one.action is StopAction.LOAD and one.post == post}
        return not loaded - {order_id} - self.held.cancelled

    def handed_over(self, place: tuple[Mission, Stop], purpose: Purpose, post: str, shown: ShownCode | None) -> None:
        """Mail changed hands at a stop. What is aboard, how far the mission is and the receipt: all or nothing.

        `place` is the stop as it was when the robot began to wait: mail that was taken aboard is aboard, even if the
        mission was dropped in the same moment.
        """
        with self._store.transaction():
            if not self.custody.hand_over(place, purpose, post, Proof.seen(shown)):
                return
            if purpose is Purpose.LOAD and self.memory.mission() is None:
                self._bring_back(place[0])  # dropped while the sender loaded it: it is given back where it stands
        self._told()
        self._tell_taken(post)

    def _tell_taken(self, post: str | None) -> None:
        if not self.held.cargo:
            self.report_fault(MAIL_ABOARD, "It was taken.", post, cleared=True)

    def report_charge(self, step: ChargeStep, post: str | None, ratio: float) -> None:
        """The battery plan took over, charges, or has ended: each told once, however often it is begun again."""
        remembered = None if step == "charged" else step
        with self._store.transaction():
            if self.memory.charge() == remembered:
                return
            self.memory.note_charge(remembered)
            self._tell(Charge(step=step, happened_at=self.utc(), post=post, ratio=ratio))
        self._told()

    def report_fault(self, name: str, reason: str, post: str | None, cleared: bool = False) -> None:
        """A fault begins or is over; said once until it changes."""
        if cleared == (name in self.held.faults):
            self.report_one_fault(name, reason, post, cleared, lasts=not cleared)

    def report_one_fault(self, name: str, reason: str, post: str | None, cleared: bool, lasts: bool) -> None:
        """Of several under one name, each with its own reason; `lasts`: whether any is left after this."""
        with self._store.transaction():
            self.memory.keep_faults(self.held.faults | {name} if lasts else self.held.faults - {name})
            self._tell(Fault(name=name, cleared=cleared, happened_at=self.utc(), post=post, reason=reason))
        self._told()

    # Where it was seen.

    def seen(self, post: str, moment: str | None = None, turned: Turned = NOT_TURNED) -> None:
        """The robot stands at a marker: remembered at once, since after a power cut nothing else tells where it is."""
        with self._store.transaction():
            self.turns.keep(turned)
            self.memory.see(post, self.utc(), moment=moment)
        self._changed()

    def occupies(self, where: Where, post: str, towards: str | None, evidence: Evidence, way_mm: int | None) -> None:
        """The robot is wholly there: others may have what it was in before."""
        if self.occupancy.report(where, post, towards, evidence, way_mm):
            self._told()

    def closed_ages_s(self) -> dict[str, float]:
        """The corridors in which it turned back, by name, and how long ago; just now if the clock was put back."""
        now = self.utc()
        return {name: max(0.0, (now - at).total_seconds()) for name, at in self.memory.closed().items()}

    def keep_closed(self, ages_s: Mapping[str, float]) -> None:
        """These instead of those that were kept."""
        now = self.utc()
        self.memory.keep_closed({name: now - timedelta(seconds=age_s) for name, age_s in ages_s.items()})

    def heading_for(self, towards: str | None, moment: str | None = None, turned: Turned = NOT_TURNED) -> None:
        with self._store.transaction():
            self.turns.keep(turned)
            self.memory.head(towards, moment)
        self._changed()

    def note_moment(self, moment: str) -> None:
        """Remembered at once: a power cut now leaves doubt of its place."""
        self.memory.note_moment(moment)
        self._changed()
