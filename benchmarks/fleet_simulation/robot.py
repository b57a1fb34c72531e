"""A simulated robot: real duties and a real link, a simulated body, and a mind that decides as `robot/agent/*.asl` do.

It knows its map, its missions, what it was granted and its battery. A mind does one step at a time and then decides
anew, so that whatever has come meanwhile counts; what it waits for ends with any news.
"""

import asyncio
from collections.abc import Awaitable, Callable, Mapping
from dataclasses import dataclass, field
from random import Random
from typing import ClassVar, Final

from benchmarks.fleet_simulation.body import Body
from benchmarks.fleet_simulation.network import Network
from benchmarks.fleet_simulation.people import People
from benchmarks.fleet_simulation.robot_link import RobotLink
from benchmarks.fleet_simulation.route import Crossing, Route
from benchmarks.fleet_simulation.telling import Telling
from maps import CampusMap, NoRoute
from protocol.clock import Clock
from protocol.parts import Activity, Leg, Purpose, Stop, StopAction
from protocol.to_server import Step
from robot.agent.perception.battery import BatteryLevel
from robot.localization.bays import places_to_stand
from robot.localization.docks import nearest_dock
from robot.mission.memory import Memory
from robot.mission.mission import MissionManager
from robot.mission.outbox import Outbox
from robot.mission.state import REVOKED
from robot.mission.store import Store

LOOKS_AT_BATTERY_S: Final = 60.0
DENIED_S: Final = 15.0
NO_WAY_S: Final = 30.0
NO_DOCK_OPEN: Final = "no_dock_open"
SILENCE_S: Final = 120.0
PURPOSES: Final = {
    StopAction.LOAD: Purpose.LOAD,
    StopAction.RECEIVE: Purpose.RECEIVE,
    StopAction.RETURN: Purpose.RETURN,
}
Purposeful = tuple[str, str]
"""What it is about: a word, and which stop, if any."""


@dataclass
class Mind:
    """One life of the daemon, from its start to its end. What it knows at first is what its store remembers.

    `first_home`: of its settings, until the service gives it one. `unasked`: as for `Route`. `_asides`: where the
    service has sent it first.
    """

    name: str
    first_home: str
    track: CampusMap
    clock: Clock
    body: Body
    network: Network
    people: People
    store: Store
    rng: Random
    unasked: bool = False
    link: RobotLink = field(init=False)
    missions: MissionManager = field(init=False)
    telling: Telling = field(init=False)
    route: Route = field(init=False)
    _news: asyncio.Event = field(default_factory=asyncio.Event)
    _asks_for: Purposeful | None = None
    _asides: list[str] = field(default_factory=list)
    _is_about: Purposeful | None = None
    _silent_since_s: float | None = None
    _came_by: Leg | None = None

    def __post_init__(self) -> None:
        memory, outbox = Memory(self.store), Outbox(self.store)
        self.missions = MissionManager(self.store, memory, outbox, self.clock.utc)
        self.telling = Telling(self.first_home, self.track.version, self.body, self.missions)
        self.link = RobotLink(self.name, self.network, self.clock, outbox, memory, self.telling.hello, self.rng)
        self.missions.join(self.link)
        self.route = Route(self.track, self.body, self.missions, self.unasked)
        self.link.on_news = self._hears

    async def run(self) -> None:
        """Until cancelled: which is what a kill is."""
        self.body.on_battery.append(self._tells)
        try:
            async with asyncio.TaskGroup() as group:
                group.create_task(self.link.run())
                group.create_task(self._live())
                group.create_task(self._look_at_battery())
        finally:
            self.body.on_battery.remove(self._tells)
            self.network.hang_up()
            self.body.judge.goes_on(self.name)

    @property
    def home(self) -> str:
        return self.missions.held.home or self.first_home

    # What it hears and tells.

    def _hears(self) -> None:
        self.missions.take_messages()
        self._silent_since_s = None if self.link.online else self._silent_since_s or self.clock.now()
        self._tells()
        self._news.set()

    def was_moved(self) -> None:
        """A person has put it down, in a bay, and it has read the marker there."""
        self.route.was_moved(self.body.post)
        self._news.set()

    async def _look_at_battery(self) -> None:
        while True:
            word, weak = self.body.word, self.body.weak
            self.body.look_at_battery()
            if (word, weak) != (self.body.word, self.body.weak) or self.body.docked:
                self._news.set()
            await asyncio.sleep(LOOKS_AT_BATTERY_S)

    def _tells(self) -> None:
        self.link.snapshot(self.telling.snapshot())

    def _shows(self, activity: Activity) -> None:
        self.telling.activity = activity
        self._tells()

    # What it does.

    def purpose(self) -> Purposeful:
        """The first that holds: `purpose` in robot/agent/main.asl."""
        held, body = self.missions.held, self.body
        if held.revoked or body.in_hands:
            return "stand_still", ""
        if body.word is BatteryLevel.LOW or held.recharging:
            return "charge", ""
        if body.docked and body.weak and not held.cargo:
            return "idle", ""
        if held.paused:
            return "hold", ""
        if held.mission is not None:
            return ("stop", held.stop.id) if held.stop else ("finish", held.mission.id)
        return ("go_home", "") if not self._is_home else ("idle", "")

    @property
    def _is_home(self) -> bool:
        return self.body.at == self.home and (self.body.docked or not self._has_dock(self.home))

    def _has_dock(self, place: str) -> bool:
        return self.track.post(place).dock is not None

    async def _live(self) -> None:
        if self.body.at is not None:
            self.missions.seen(self.body.post)
        while True:
            self._news.clear()
            self.missions.take_messages()
            self.route.give_back_crossed()
            if not self.missions.held.revoked:
                self.route.tells_place()
            purpose = self.purpose()
            if purpose != self._is_about:
                self._is_about, self._asides = purpose, []
            if self._asks_for not in (None, purpose):
                self.missions.claims.withdraw()
                self._asks_for = None
                self.body.judge.goes_on(self.name)
            await self._steps[purpose[0]](self)

    async def _news_comes(self, activity: Activity, at_most_s: float | None = None) -> None:
        self._shows(activity)
        try:
            async with asyncio.timeout(at_most_s):
                await self._news.wait()
        except TimeoutError:
            pass

    async def _stand_still(self) -> None:
        await self._news_comes(Activity.STOPPED)

    def is_let_go(self) -> None:
        """A person has put it down after its corridors were given to others: it knows where it is again."""
        self.missions.stop_asked = self.missions.forget_place_asked = False
        self.route.was_moved(self.body.post)
        self.missions.report_fault(REVOKED, "It knows where it is again.", self.body.post, cleared=True)
        self._news.set()

    async def _idle(self) -> None:
        """Nowhere on the lines, where others drive."""
        inside = self.body.lane or self.body.at
        post = inside.to_post if isinstance(inside, Leg) else inside or self.home
        if await self._is_at(self.track.address_of(post)):
            self.route.release()
            await self._news_comes(self._resting)

    @property
    def _resting(self) -> Activity:
        return Activity.CHARGING if self.body.charging else Activity.IDLE

    async def _go_home(self) -> None:
        if await self._is_at(self.home) and self._has_dock(self.home):
            await self._dock()

    async def _charge(self) -> None:
        body = self.body
        if not self.missions.held.recharging:
            self.missions.report_charge("low", body.at, body.ratio)
        if not body.docked:
            near = nearest_dock(self.track, body.post, self.home, frozenset())
            self.missions.report_fault(NO_DOCK_OPEN, "No way leads to a dock.", body.at, cleared=near is not None)
            if near is None:
                await self._idle()  # a person has to bring it, and until then it blocks no other
            elif await self._is_at(near):
                await self._dock()
            return
        self.route.release()
        self.missions.report_charge("charging", body.at, body.ratio)
        if body.word is BatteryLevel.FULL:
            self.missions.report_charge("charged", body.at, body.ratio)
        else:
            await self._news_comes(Activity.CHARGING)

    async def _dock(self) -> None:
        self._shows(Activity.DRIVING)
        await self.body.dock()
        self._shows(self._resting)

    # From bay to bay.

    async def _is_at(self, goal: str) -> bool:
        """Whether it stands in a bay there; else it comes nearer by one part of the way, or waits."""
        goal = self._asides[-1] if self._asides else goal
        if self.body.at in places_to_stand(self.track, goal):
            self._goes_on()
            if not self._asides:
                return True
            self._asides.pop()
            return False
        try:
            await (self._drive(goal) if self.body.lane is not None else self._leave(goal))
        except NoRoute:
            self.route.asks_anywhere()
            await self._news_comes(Activity.WAITING, NO_WAY_S)
            if self.body.at is not None and not self.route.is_in_bay and goal != self.home:
                self._asides.append(self.home)
        return False

    async def _leave(self, goal: str) -> None:
        """Out of a bay or off a crossing, when it may."""
        leg = self.route.next_leg(goal)
        if leg is None:
            await self._wait_for_leave()
            return
        aside = self.route.stops_aside
        if aside is not None and aside != goal:
            self._asides.append(aside)
            return
        self._goes_on()
        self._shows(Activity.DRIVING)
        if self.body.docked:
            await self.body.undock()
        self.missions.heading_for(leg.to_post)
        await self.body.turn_to(leg, self._came_by)
        await self._drive(goal)

    async def _drive(self, goal: str) -> None:
        """On through its spur or corridor; before a crossing it waits until it may."""
        body, leg = self.body, self.body.lane
        assert leg is not None
        if body.is_before_crossing:
            match self.route.waits_to_cross(goal):
                case Crossing.WAITS:
                    await self._wait_for_leave()
                    return
                case Crossing.TURNS_BACK:
                    body.turn_back()
                    self.missions.heading_for(leg.from_post)
                    return
        elif body.nears_crossing:
            self.route.ask_ahead(goal)
        self._goes_on()
        self._shows(Activity.DRIVING)
        turned = body.turned
        await body.drive()
        if body.lane is None:
            self._came_through(leg, turned=turned)
        else:
            self.route.tells_place()

    def _goes_on(self) -> None:
        self._asks_for = None
        self.body.judge.goes_on(self.name)

    async def _wait_for_leave(self) -> None:
        if self.body.at is not None and self.route.is_denied():
            await self._news_comes(Activity.WAITING, DENIED_S)
            return
        self._asks_for = self.purpose()
        self.body.judge.waits(self.name)
        await self._news_comes(Activity.WAITING if not self.body.docked else self._resting, self._patience_s)
        if self._silent_since_s is not None and self.clock.now() - self._silent_since_s >= SILENCE_S:
            self.route.out_of_silence()

    @property
    def _patience_s(self) -> float | None:
        return None if self._silent_since_s is None else SILENCE_S

    def _came_through(self, leg: Leg, *, turned: bool) -> None:
        self._came_by = leg
        self.route.came_through(leg, turned=turned)
        stop = self.missions.held.stop
        if stop is not None and stop.post != self.track.address_of(leg.to_post):
            self.missions.report(Step.PASSED, stop.id, leg.to_post)
        self._tells()

    # Stops.

    async def _finish(self) -> None:
        mission = self.missions.held.mission
        assert mission is not None
        self.missions.finish_mission(mission.id, self.body.at)

    async def _stop(self) -> None:
        stop = self.missions.held.stop
        assert stop is not None
        if self._is_over(stop):
            self.missions.finish_stop(stop.id)
            return
        self.missions.report(Step.DEPARTED, stop.id, self.body.at)
        if stop.post not in self.track.posts:
            self._gives_up(stop, "unknown_post")
        elif await self._is_at(self._place_for(stop)):
            self.missions.report(Step.ARRIVED, stop.id, stop.post)
            await (self._fill_up(stop) if stop.action is StopAction.DOCK else self._attend(stop))

    def _place_for(self, stop: Stop) -> str:
        if stop.action is not StopAction.DOCK:
            return stop.post
        return next((bay.name for bay in self.track.bays_of(stop.post) if bay.dock), stop.post)

    def _is_over(self, stop: Stop) -> bool:
        held = self.missions.held
        if stop.order_id in held.cancelled and stop.order_id is not None:
            return True
        is_aboard = stop.order_id in held.cargo
        takes_out = stop.action in (StopAction.RECEIVE, StopAction.RETURN)
        return (stop.action is StopAction.LOAD and is_aboard) or (takes_out and not is_aboard)

    def _gives_up(self, stop: Stop, why: str) -> None:
        self.missions.report(Step.GAVE_UP, stop.id, self.body.at, why)
        self.missions.finish_stop(stop.id)

    async def _fill_up(self, stop: Stop) -> None:
        if not self.body.docked:
            await self._dock()
        if stop.until_ratio is None or self.body.has(stop.until_ratio):
            self._is_done(stop)
            return
        self.route.release()
        await self._news_comes(self._resting)

    def _is_done(self, stop: Stop) -> None:
        self.missions.report(Step.DONE, stop.id, self.body.at)
        self.missions.finish_stop(stop.id)

    async def _attend(self, stop: Stop) -> None:
        purpose = PURPOSES.get(stop.action)
        if purpose is None:  # it parks
            self._is_done(stop)
            return
        if self.body.docked:
            await self.body.undock()
        self._shows(Activity.WAITING)
        comes_s = self.people.come_after_s(purpose)
        await asyncio.sleep(min(comes_s, stop.wait_limit_s))
        if self.missions.held.stop != stop:
            return  # it was taken back meanwhile
        if comes_s > stop.wait_limit_s:
            self._gives_up(stop, "no_one_came")
            return
        shown = self.people.show(self.name, stop.order_id or "", purpose)
        self.missions.handed_over(self.missions.at_stop(stop.id), purpose, stop.post, shown)
        await asyncio.sleep(self.body.taking.table.reached_in_s)

    _steps: ClassVar[Mapping[str, Callable[["Mind"], Awaitable[None]]]] = {
        "stand_still": _stand_still,
        "charge": _charge,
        "idle": _idle,
        "hold": _idle,
        "stop": _stop,
        "finish": _finish,
        "go_home": _go_home,
    }


MakeMind = Callable[[], Mind]
"""One life after the other, with the same store and the same body."""
