"""The loop around the agent: what is seen becomes percepts, what it decides actions, and the body hears a heartbeat.

A tick of the mind is one reasoning cycle in drain mode (the paper's 100 ms) and several in latest mode, so that a plan
of short steps does not take a second. It knows no thread and no clock: `tick(now)` is all there is.
"""

from collections import deque
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from typing import Final

import structlog

from bdi import Agent, Finished, Message
from maps import CampusMapError
from protocol.parts import Activity, Battery
from protocol.to_server import Snapshot, Why
from robot.agent.actions.actions import Actions
from robot.agent.actions.corridors import WAY_BLOCKED, tried_again
from robot.agent.actions.hands import PLACE_UNKNOWN, Hands
from robot.agent.perception.battery import BatteryLevel, BatterySense
from robot.agent.perception.percepts import perceive
from robot.agent.perception.seen import MapPosition, Seen
from robot.agent.reasons import LONG_AWAY, reason
from robot.core.config import PerceptMode, Settings
from robot.mission.offline_timeout import OfflineTimeout
from robot.mission.state import REVOKED
from robot.reflexes import HALTING, LATCHED, TOLD
from robot.skills.interfaces import View

log = structlog.get_logger("robot.agent.mind")

WATCH_S: Final = 30.0
Ended = tuple[int, str | None]
"""The id of an action that has ended, and the atom that says why if it failed."""
KEPT_FAILURES: Final = 1000


@dataclass
class Mind:
    """Perceives, reasons and acts. `said` is told what the agent does and waits for, when that changes."""

    agent: Agent
    actions: Actions
    hands: Hands
    settings: Settings
    mode: PerceptMode
    said: Callable[[Why], None] = lambda _: None
    inbox: deque[Message] = field(default_factory=deque)
    """Messages to the agent: one is read in each cycle."""
    battery: BatterySense = field(default_factory=BatterySense)
    silence: OfflineTimeout = field(default_factory=OfflineTimeout)
    cycles: int = 0
    failures: list[str] = field(default_factory=list)
    """Goals that failed without a recovery plan, in words; the newest."""
    note: Callable[[str, float, object], None] = lambda kind, at_s, data: None
    """The black box: what changes in the percepts, and each action."""
    _perceived: frozenset[str] = frozenset()
    _why: Why | None = None

    def tick(self, now: float) -> None:
        """Once every 100 ms or so. An error of the map stops the wheels, and ends no loop."""
        try:
            self._look_and_act(now)
        except CampusMapError as error:
            log.error("map_error", error=repr(error), exc_info=error)
            self.actions.fail_all(PLACE_UNKNOWN)
            self.hands.lose_place(error)
            self.hands.body.heartbeat(now)

    def _look_and_act(self, now: float) -> None:
        view = self.hands.view = self.hands.body.view
        self.hands.navigator.look(view)
        ended = self.actions.finished(now)  # before what the server wants: mail that came aboard cannot be cancelled
        self.hands.missions.take_messages()
        if view.base:
            self.battery = self.battery.seen(view.base, self.settings.battery, now)
        self.hands.body.link(self.hands.missions.online)
        self._tell_faults(view.faults)
        self._tell_open_way()
        self._follow_revocation(view)
        self.silence.look(self.hands.missions.held, self.hands.missions.utc(), self.hands.missions.online, now)
        self._stop_or_rearm(view)
        self._reason(now, ended)
        self.hands.body.heartbeat(now)
        self._tell_why()

    def _reason(self, now: float, ended: Sequence[Ended]) -> None:
        """One cycle, or in latest mode as many as there is something to think about."""
        self._cycle(self._percepts(now), now, ended)
        shown = self._world_known
        for _ in range(self.settings.mind.steps_per_tick - 1 if self.mode is PerceptMode.LATEST else 0):
            finished = self.actions.finished(now)
            if not (finished or self.inbox or self.agent.events or self.agent.running):
                return
            # An action that has ended may have changed what holds (the destination, the next stop).
            changed = finished or shown != self._world_known
            shown = self._world_known
            self._cycle(self._percepts(now) if changed else None, now, finished)

    @property
    def _world_known(self) -> tuple[int, str | None]:
        return self.hands.missions.revision, self.hands.navigator.destination

    def _percepts(self, now: float) -> frozenset[str]:
        percepts = perceive(self.seen(now), self.mode, self.settings.mind.age_limit_s)
        if percepts != self._perceived:
            came, went = percepts - self._perceived, self._perceived - percepts
            self.note("percepts", now, (*(f"+{one}" for one in came), *(f"-{one}" for one in went)))
            self._perceived = percepts
        return percepts

    def _cycle(self, percepts: frozenset[str] | None, now: float, ended: Sequence[Ended]) -> None:
        messages = [self.inbox.popleft()] if self.inbox else []
        outcome = self.agent.cycle(percepts, messages, [Finished(id_, failure) for id_, failure in ended], now)
        self.actions.cancel(outcome.cancelled)
        for action in outcome.actions:
            self.note("action", now, str(action.term))
            self.actions.begin(action.id, action.term, now)
        self.failures = [*self.failures, *map(str, outcome.failures)][-KEPT_FAILURES:]
        for line in outcome.printed:
            self.hands.noted(line)
        for message in outcome.messages:
            # A robot's agent has no other agent to write to: people are told by actions (decision 0016).
            told = f"{message.performative} {message.content} to {message.receiver}"
            self.hands.noted(f"{told} reaches no agent: a robot's agent tells people by actions (report, raise_fault)")
            log.warning(
                "agent_message_undelivered",
                receiver=message.receiver,
                performative=message.performative,
                content=str(message.content),
            )
        self.cycles += 1

    @property
    def is_quiet(self) -> bool:
        """The agent has nothing at all to do, and nothing that it waits for either."""
        return not self.inbox and self.agent.idle and not self.agent.intentions

    def seen(self, now: float) -> Seen:
        """The moment as perception is shown it."""
        hands, navigator = self.hands, self.hands.navigator
        crossing, at = navigator.crossing, navigator.at
        where = MapPosition(
            None if crossing else at,
            hands.missions.held.position.previous,
            navigator.destination,
            navigator.way(),
            navigator.rests_at,
            navigator.moved,
            navigator.astray,
            navigator.doubted,
            navigator.beside_dock,
            navigator.closed.names,
            navigator.stops_aside,
            navigator.campus.post(at).bay_of if at else None,
            crossing,
        )
        return Seen(
            at_s=now,
            view=hands.view,
            battery=self.battery,
            where=where,
            held=hands.missions.held,
            halting=hands.view.faults & HALTING,
            home=navigator.home,
            dockless=navigator.home is not None and navigator.campus.post(navigator.home).dock is None,
            dock_bays=navigator.campus.dock_bays,
            nearest_dock=navigator.nearest_dock(),
            watch=int(now // WATCH_S),
            unsure=self.silence.lasts is True,
            handing_over=hands.missions.custody.handing_over,
        )

    def _tell_faults(self, faults: frozenset[str]) -> None:
        """Those that a restart ended are told to be over, too."""
        missions = self.hands.missions
        for name in sorted(faults ^ (missions.held.faults & TOLD.keys())):
            missions.report_fault(name, TOLD[name], self.hands.place, cleared=name not in faults)

    def _tell_open_way(self) -> None:
        """A closed corridor is over when its time is, or when a person reports it open: then it is tried again."""
        missions, closed = self.hands.missions, self.hands.navigator.closed
        for name in sorted(closed.over):
            reason, lasts = tried_again(name), bool(closed.names)
            missions.report_one_fault(WAY_BLOCKED, reason, self.hands.place, cleared=True, lasts=lasts)
        closed.note_told()
        if WAY_BLOCKED in missions.held.faults and not closed.names:  # it was killed before it could tell of each
            missions.report_fault(WAY_BLOCKED, "The robot tries that way again.", self.hands.place, cleared=True)

    def _follow_revocation(self, view: View) -> None:
        """Its corridors were given to others: it stands until it has found out where it is."""
        missions, navigator = self.hands.missions, self.hands.navigator
        if missions.forget_place_asked:
            missions.forget_place_asked = False
            navigator.lose_place(view)
        elif missions.held.revoked and navigator.is_known:
            missions.report_fault(REVOKED, "It knows where it is again.", navigator.at, cleared=True)
        if navigator.is_known and not navigator.doubted:
            missions.report_fault(PLACE_UNKNOWN, "It knows where it is again.", navigator.at, cleared=True)

    def _stop_or_rearm(self, view: View) -> None:
        """Stop or re-arm as the server asked. (The Spot button re-arms in the body itself.)"""
        missions, body = self.hands.missions, self.hands.body
        if missions.stop_asked:
            body.emergency_stop()
        if view.faults & LATCHED and missions.rearm_asked:
            body.rearm()
        missions.stop_asked = missions.rearm_asked = False

    def _tell_why(self) -> None:
        why = (
            LONG_AWAY
            if self.silence.lasts
            else reason(
                self.actions.under_way, self.hands.view, self.hands.navigator, self.hands.missions, self._is_charging
            )
        )
        if why != self._why:
            self._why = why
            self.said(why)

    @property
    def _is_charging(self) -> bool:
        """In the dock and not full: the trickle that keeps a full battery full is no charging to wait for."""
        base = self.hands.view.heard_base
        return base is not None and base.charging and self.battery.word is not BatteryLevel.FULL

    @property
    def _is_docked(self) -> bool:
        base = self.hands.view.heard_base
        return base is not None and base.docked

    @property
    def why(self) -> Why | None:
        """Return the robot's activity and what it waits for."""
        return self._why

    def snapshot(self) -> Snapshot:
        """The state as the server is told it."""
        held = self.hands.missions.held
        return Snapshot(
            position=held.position,
            activity=self.activity(),
            battery=Battery(ratio=self.battery.ratio or 0.0, charging=self._is_charging, docked=self._is_docked),
            cargo=held.cargo,
            mission=held.mission_held,
        )

    def activity(self) -> Activity:
        """In one word."""
        view = self.hands.view
        if view.faults & HALTING or self.hands.missions.held.revoked:
            return Activity.STOPPED
        if view.heard_base and view.heard_base.docked and view.motion is None:
            return Activity.CHARGING if self._is_charging else Activity.IDLE
        if view.motion:
            return Activity.DRIVING
        return Activity.WAITING if self.actions.under_way else Activity.IDLE


def messages_from_person(tell: Iterable[str], achieve: Iterable[str]) -> list[Message]:
    """Return the messages that the command line gives to the agent."""
    return [*(Message("user", "tell", text) for text in tell), *(Message("user", "achieve", text) for text in achieve)]
