"""A simulated robot: it does what its mission says, claims corridors, hands mail over, charges, and tells all of it.

It knows what it was told by messages, its map and its own battery. Its own battery plan (as the robot's settings have
it) is the last word: below `OWN_LOW` it goes to the nearest dock, whatever it was about, and stays until it is full;
unless it is on its way to a dock already, as the service has told it.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from datetime import datetime, timedelta
from functools import partial
from typing import Final, Literal

from benchmarks.fleet.campus_ground import Ground
from benchmarks.fleet.campus_link import Link
from benchmarks.fleet.charging_world import BEGINS, EMPTY, OWN_BEGIN, OWN_FULL, OWN_LOW
from benchmarks.fleet.packs import Pack
from protocol.parts import Activity, Battery, Leg, MissionHeld, Part, Position, Purpose, Stop, StopAction
from protocol.to_robot import Deny, Detour, Grant, Mission
from protocol.to_server import Charge, Claim, Clear, Event, Fault, HandoverReceipt, Hello, Progress, Snapshot, Step

TICK_S: Final = 180.0
CRITICAL: Final = 0.10
AGAIN_S: Final = 60.0
PATIENCE_S: Final = 10.0
DRIVES_M_S: Final = 0.2
"""The rest of the time in a corridor it stands: at markers, at crossings, before people."""
UNDERSTANDS: Final = ("confirm", "watch", "open_way", "detour")
PURPOSES: Final = {StopAction.LOAD: Purpose.LOAD, StopAction.RECEIVE: Purpose.RECEIVE}


@dataclass(frozen=True)
class Target:
    """Where it goes next, and what for: a stop of its mission, or (None) for reasons of its own."""

    post: str
    stop: Stop | None = None


@dataclass
class Robot:
    """`granted`: corridors that it may enter, the one that it is in first. `recharging`: its own battery plan has it.
    `stranded`: so often its pack was empty away from a dock; `critical`: so often it came below what a real robot
    stops at to be carried (its reflex `battery_critical`), where this one still drives;
    `before_post`: so often it found a robot in its bay that was let go already."""

    name: str
    home: str
    ground: Ground
    link: Link
    pack: Pack
    post: str = ""
    activity: Activity = Activity.IDLE
    mission: Mission | None = None
    done: set[str] = field(default_factory=set)
    cargo: list[str] = field(default_factory=list)
    granted: list[Leg] = field(default_factory=list)
    claim: Claim | None = None
    docked: bool = False
    recharging: bool = False
    busy: bool = False
    is_dead: bool = False
    stranded: int = 0
    critical: int = 0
    deaths: int = 0
    stood: int = 0
    before_post: int = 0
    driven_m: float = 0.0
    _settled_s: float = 0.0
    _claims: int = 0
    on_death: Callable[["Robot"], None] = lambda _: None

    def __post_init__(self) -> None:
        self.post = self.home
        self.link.hello, self.link.on_robot.hear = self._hello, self._hear
        self.ground.at[self.name] = self.home

    def switch_on(self) -> None:
        self.link.connect()
        self._tick()

    @property
    def charges(self) -> bool:
        return self.docked and self.ground.chargers.get(self.post) == self.name

    # What it does next.

    def _go_on(self) -> None:
        if self.busy or self.is_dead or self.claim is not None:
            return
        self._settle()
        self._look_at_battery()
        target = self._target()
        if self._stays_docked(target):
            return
        if target.post == self.post:
            self._be_there(target)
        elif self.granted and self.granted[0].from_post == self.post:
            self._enter(self.granted[0])
        else:
            self._ask(target)

    def _target(self) -> Target:
        stop = next(iter(self._stops()), None)
        if self.recharging and (stop is None or _is_handing_over(stop)):
            return Target(self.ground.nearest_dock(self.post))
        return Target(self.home) if stop is None else Target(stop.post, stop)

    def _stops(self) -> Sequence[Stop]:
        return [stop for stop in self.mission.stops if stop.id not in self.done] if self.mission else ()

    def _stays_docked(self, target: Target) -> bool:
        """With too little it begins nothing in a dock; and there it rests."""
        if not self.charges:
            return False
        enough = OWN_FULL if self.recharging else OWN_BEGIN
        if self.pack.told < enough or (target.post == self.post and not _is_handing_over(target.stop)):
            return True
        self._leave_dock()
        return False

    def _be_there(self, target: Target) -> None:
        if _is_handing_over(target.stop):
            assert target.stop is not None
            self._begin(target.stop)
        elif not self.docked or not self.charges:
            self._dock()

    def _ask(self, target: Target) -> None:
        self._leave_dock()
        self._claims += 1
        legs = self.ground.way(self.post, target.post)
        self.claim = Claim(claim_id=f"{self.name}-{self._claims}", legs=legs, goal=target.post)
        self.link.to_server(self.claim)
        self._show(Activity.WAITING)

    # Corridors.

    def _enter(self, leg: Leg) -> None:
        self._settle()
        self.ground.enter(self.name, leg)
        self.busy = True
        self._tell_step(Step.DEPARTED)
        self._show(Activity.DRIVING)
        takes_s, chance, faults = self.ground.travel_s(leg), self.ground.rng.random(), self.ground.faults
        if chance < faults.dies:
            self._later(takes_s / 2, self._die)
        elif chance < faults.dies + faults.stands:
            self._later(takes_s / 2, partial(self._stand_still, takes_s))
        else:
            self._later(takes_s, partial(self._arrive, takes_s))

    def _arrive(self, takes_s: float) -> None:
        leg = self.granted[0]
        if not self.ground.has_bay(self.name, leg.to_post):
            self.before_post += 1  # it stands before the robot that is still there
            self._later(PATIENCE_S, partial(self._arrive, takes_s))
            return
        del self.granted[0]
        self._settle(min(takes_s, self.ground.length_m(leg) / DRIVES_M_S))
        self.ground.leave(self.name)
        self.driven_m += self.ground.length_m(leg)
        self.busy, self.post = False, leg.to_post
        self.link.to_server(Clear(leg=leg, post=leg.to_post))
        target = self._target()
        if target.stop is not None and target.post == self.post:
            self._tell_step(Step.ARRIVED, target.stop)
        else:
            self._tell_step(Step.PASSED)
        self._show(Activity.DRIVING)
        self._go_on()

    def _stand_still(self, takes_s: float) -> None:
        """Something is in its way; a person comes."""
        self.stood += 1
        self._tell(Fault(name="stands_still", happened_at=self._now(), reason="Something is on the line."))
        self._show(Activity.STOPPED)
        self._later(self.ground.repair_s(), partial(self._goes_again, takes_s))

    def _goes_again(self, takes_s: float) -> None:
        gone = Fault(name="stands_still", cleared=True, happened_at=self._now(), reason="The line is free.")
        self._tell(gone)
        self._show(Activity.DRIVING)
        self._later(takes_s / 2, partial(self._arrive, takes_s))

    def _die(self) -> None:
        self._settle()
        self.is_dead, self.deaths = True, self.deaths + 1
        self.link.disconnect()
        self.on_death(self)

    def is_brought_home(self) -> None:
        """A person has found it, carried it home and switched it on there; what it carried is still aboard."""
        self.ground.carry(self.name, self.home)
        self.granted, self.claim, self.busy, self.is_dead = [], None, False, False
        self.post, self.docked, self._settled_s = self.home, True, self.ground.clock.now_s
        self._plug_in()
        self.link.connect()
        self._go_on()

    # Stops.

    def _begin(self, stop: Stop) -> None:
        self.busy = True
        self._leave_dock()
        self._show(Activity.WAITING)
        self._later(self.ground.handling_s(PURPOSES[stop.action]), partial(self._handed_over, stop))

    def _handed_over(self, stop: Stop) -> None:
        order = stop.order_id or ""
        self._settle()
        (self.cargo.append if stop.action is StopAction.LOAD else self.cargo.remove)(order)
        self.done.add(stop.id)
        self.busy = False
        self._tell(
            HandoverReceipt(
                purpose=PURPOSES[stop.action],
                order_id=order,
                stop_id=stop.id,
                post=self.post,
                happened_at=self._now(),
                code_sha256=None,
                how="button",
            )
        )
        if not self._stops():
            self._tell_step(Step.DONE)
        self._show(Activity.IDLE)
        self._go_on()

    # Its charge.

    def _dock(self) -> None:
        """At its home place there is always room for it; the charger there may be taken, or kept for another."""
        has_charger = self._plug_in()
        self.docked = has_charger or self.post == self.home
        if has_charger:
            self._tell(Charge(step="charging", happened_at=self._now(), post=self.post, ratio=self.pack.told))
        self._show(Activity.CHARGING if has_charger else Activity.IDLE)

    def _plug_in(self) -> bool:
        ground = self.ground
        if self.post in ground.chargers and ground.has_room_at(self.post, self.name):
            ground.chargers[self.post] = self.name
            return True
        return False

    def makes_room(self) -> None:
        """It stands beside the charger from now on."""
        self._settle()
        if self.charges:
            self.ground.chargers[self.post] = None

    def _leave_dock(self) -> None:
        self.makes_room()
        self.docked = False

    def _look_at_battery(self) -> None:
        stop = next(iter(self._stops()), None)
        is_sent = stop is not None and stop.action is StopAction.DOCK
        if not self.recharging and not is_sent and not self.charges and self.pack.told < OWN_LOW:
            self.recharging = True
            self._tell(Charge(step="low", happened_at=self._now(), post=self.post, ratio=self.pack.told))
        elif self.recharging and self.charges and self.pack.told >= OWN_FULL:
            self.recharging = False
            self._tell(Charge(step="charged", happened_at=self._now(), post=self.post, ratio=self.pack.told))

    def _settle(self, drove_s: float = 0.0) -> None:
        """Its pack is brought up to date; of the time since so much was driven."""
        past_s, self._settled_s = self.ground.clock.now_s - self._settled_s, self.ground.clock.now_s
        if self.charges:
            self.pack.charge(past_s)
            return
        before = self.pack.told
        self.pack.stand(max(0.0, past_s - drove_s))
        self.pack.drive(drove_s)
        self.critical += before >= CRITICAL > self.pack.told
        if self.pack.ratio <= EMPTY and not self.is_dead:
            self.stranded += 1
            self.pack.ratio = 0.5  # a technician puts another pack in

    def _tick(self) -> None:
        self._later(TICK_S, self._tick)
        if self.is_dead:
            return
        if not self.busy:
            self._settle()
        self._look_at_battery()
        if self.claim is not None and self.claim.goal != self._target().post:
            self.claim = None  # it asks for another way now
        self._show(self.activity)
        self._go_on()

    # What it hears.

    def _hear(self, message: Part) -> None:
        match message:
            case Mission():
                self._take(message)
            case Grant() | Detour():
                self._may_enter(message)
            case Deny():
                self.claim = None
                self._later(AGAIN_S, self._go_on)

    def _take(self, mission: Mission) -> None:
        self.mission = mission
        self._tell_step(Step.ACCEPTED)
        if self.claim is not None and self.claim.goal != self._target().post:
            self.claim = None  # it asks for another way now
        self._go_on()

    def _may_enter(self, message: Grant | Detour) -> None:
        """Drive what is granted, even if it has asked for another way since: its bay here is another's by now."""
        self.claim = None
        self.granted += message.legs
        self._leave_dock()
        self._enter(self.granted[0])

    # What it says.

    def _hello(self) -> Hello:
        return Hello(
            position=self._position(),
            cargo=tuple(self.cargo),
            mission=self._held(),
            battery=self._battery(),
            software="simulated",
            map_version=self.ground.campus.version,
            understands=UNDERSTANDS,
            home=self.home,
        )

    def _show(self, activity: Activity) -> None:
        self.activity = activity
        its = Snapshot(
            position=self._position(),
            activity=activity,
            battery=self._battery(),
            cargo=tuple(self.cargo),
            mission=self._held(),
        )
        self.link.to_server(its)

    def _tell_step(self, step: Step, stop: Stop | None = None) -> None:
        if self.mission is not None:
            told = Progress(
                step=step,
                happened_at=self._now(),
                mission_id=self.mission.id,
                update=self.mission.update,
                stop_id=stop.id if stop else None,
                order_id=stop.order_id if stop else None,
                post=self.post,
            )
            self._tell(told)

    def _tell(self, happened: Progress | HandoverReceipt | Charge | Fault) -> None:
        self.link.to_server(Event(happened=happened))

    def _position(self) -> Position:
        towards = self.granted[0].to_post if self.granted and self.busy else None
        return Position(post=self.post, towards=towards, seen_at=self._now())

    def _battery(self) -> Battery:
        return Battery(ratio=self.pack.told, charging=self.charges, docked=self.docked)

    def _held(self) -> MissionHeld | None:
        if self.mission is None:
            return None
        stops = self.mission.stops
        at = next((number for number, stop in enumerate(stops) if stop.id not in self.done), len(stops))
        return MissionHeld(id=self.mission.id, update=self.mission.update, next_stop=at)

    def _now(self) -> datetime:
        return BEGINS + timedelta(seconds=self.ground.clock.now_s)

    def _later(self, after_s: float, action: Callable[[], None]) -> None:
        self.ground.clock.at(self.ground.clock.now_s + after_s, action)


def _is_handing_over(stop: Stop | None) -> bool:
    return stop is not None and stop.action in PURPOSES


ChargeStep = Literal["low", "charging", "charged"]
