"""The service of a simulated campus, without its database: messages in, messages out, and between them what it decides
with.

Claims go to the traffic controller, orders to the planner, charge to `fleet.charging`, what people are told to
`fleet.eta`. Nothing here decides who may enter a corridor, who carries what, or who has charge for it.
"""

from collections import Counter
from dataclasses import dataclass, field
from functools import partial
from random import Random
from typing import Final

from app.traffic.robot_locations import OF_ITS_OWN
from benchmarks.fleet.campus_charge import Charges
from benchmarks.fleet.campus_dispatch import Dispatch
from benchmarks.fleet.campus_ground import Ground
from benchmarks.fleet.campus_known import Known
from benchmarks.fleet.campus_told import Told
from benchmarks.fleet.world import CollisionError
from fleet.charging.curve import FULL
from fleet.eta.durations import Kind
from fleet.schedule.controller import CLAIMED, ComeIn, Denied, Granted, TrafficController, Waits
from fleet.schedule.journey import Goal
from fleet.schedule.network import Lane
from protocol.parts import Leg, Part, Purpose
from protocol.to_robot import Deny, Detour, Grant
from protocol.to_server import Charge, Claim, Clear, Event, HandoverReceipt, Hello, Progress, Snapshot, Step

GATHER_S: Final = 0.1
"""What comes in so short a time is looked at together."""
LOOKS_EVERY_S: Final = 300.0
VANISHED_S: Final = 900.0
STUCK_S: Final = 6 * 3600.0
UNLEARNED: Final = (Step.ACCEPTED, Step.DONE, Step.GAVE_UP)


class CustodyError(AssertionError):
    """Mail changed hands that the service had given to no robot, or to another."""


@dataclass
class Core:
    """`lasts`: so many times as long as usual a pack is assumed to last. `counts`: of what was done, by its name."""

    ground: Ground
    robots: dict[str, Known]
    capacity: int
    rng: Random
    lasts: float = 1.0
    closed: set[str] = field(default_factory=set)
    counts: Counter[str] = field(default_factory=Counter)
    controller: TrafficController = field(init=False)
    charges: Charges = field(init=False)
    dispatch: Dispatch = field(init=False)
    _looks: bool = False
    _decides: bool = False
    _charge_goals: int = 0

    def __post_init__(self) -> None:
        self.charges = Charges(self.ground, self.robots, lambda: self.controller.network, self.lasts)
        told = Told(self.ground, Random(self.rng.random()))
        self.controller = TrafficController(self.ground.network, Random(self.rng.random()))
        self.dispatch = Dispatch(
            self.ground, self.robots, self.capacity, self.rng, self.controller, self.charges, told, self.counts
        )
        for name, known in self.robots.items():
            known.link.on_server.hear = partial(self._hear, known)
            self.controller.joins(name, post=known.post, home=known.home, at_home=True, now_s=self.now_s)
        self._look_now_and_then()

    @property
    def now_s(self) -> float:
        return self.ground.clock.now_s

    # What people do.

    def place(self, start: int, end: int) -> None:
        """A sender sends mail from the one post to the other."""
        self.dispatch.place(start, end)

    def close(self, corridor: str) -> None:
        self.counts["closed"] += 1
        self.closed.add(corridor)
        self.controller.close(corridor, self.now_s)
        self._wake(decide=True)

    def reopen(self, corridor: str) -> None:
        self.closed.discard(corridor)
        self.controller.open(corridor, self.now_s)
        self._wake(decide=True)

    def has_been_looked_for(self, name: str) -> None:
        """A person has found a silent robot and carried it home: no robot is in its corridor any more."""
        known = self.robots[name]
        known.held, known.claim, known.lane, known.post, known.passed = {}, None, None, known.home, None
        known.docked, known.frozen, known.stopped = True, False, False
        self.controller.joins(name, post=known.home, home=known.home, at_home=True, now_s=self.now_s)
        self._wake(decide=True)

    # What robots say.

    def _hear(self, known: Known, message: Part) -> None:
        known.heard_s = self.now_s
        match message:
            case Hello():
                known.note(message.position, message.battery)
                self._wake(decide=True)
            case Snapshot():
                self._note_snapshot(known, message)
            case Event():
                self._note_event(known, message)
            case Claim():
                known.asked_s = self.now_s if known.claim is None and known.moved_s >= known.asked_s else known.asked_s
                known.claim, known.lane = message, None
                goals = self.dispatch.goals(known.name)
                self.dispatch.forget_claim(known, self.ground.network.posts[goals[0].post] if goals else known.home)
                self._wake()
            case Clear():
                self._cleared(known, message)

    def _note_snapshot(self, known: Known, message: Snapshot) -> None:
        known.note(message.position, message.battery, message.activity)
        self.charges.told(known.name, self.ground.clock.local, known.ratio, charging=known.charging)
        if known.docked and known.post == known.home and not known.held:
            self.controller.docked(known.name)
            self._forget_own_goal(known)
        if known.frozen != self._is_frozen(known):
            self._wake(decide=True)
        if known.charging:
            known.asked_s = known.moved_s  # it waits for no corridor, whatever it asked for before
        self._see_if_charged(known)

    def _note_event(self, known: Known, message: Event) -> None:
        match message.happened:
            case Progress() as progress:
                self._note_progress(known, progress)
            case HandoverReceipt() as receipt:
                self._handed_over(known, receipt)
            case Charge() as charge:
                known.recharging = charge.step == "low" or (known.recharging and charge.step == "charging")
                if charge.step == "low" and known.bound_for is None:
                    self._breaks_off(known)
                    self._send_to_dock(known, self.charges.dock_for(known))

    def _note_progress(self, known: Known, told: Progress) -> None:
        """A corridor was driven between two posts, by the robot's own clock, from when it was let in."""
        if told.post is None or told.step in UNLEARNED:
            return
        before, known.passed = known.passed, (told.post, told.happened_at)
        if told.step is not Step.DEPARTED and before is not None and before[0] != told.post:
            number = self.ground.network.number_of
            lane = self.ground.network.lane(number(before[0]), number(told.post))
            self.dispatch.told.drove(lane, (told.happened_at - before[1]).total_seconds())
        if told.step is Step.ARRIVED and told.stop_id is not None:
            known.arrived[told.stop_id] = told.happened_at
            self.dispatch.told.arrived(told.stop_id)

    def _handed_over(self, known: Known, receipt: HandoverReceipt) -> None:
        order = self.dispatch.open.get(receipt.order_id)
        if order is None or order.robot != known.name or order.loaded == (receipt.purpose is Purpose.LOAD):
            raise CustodyError(f"{known.name} tells of {receipt.stop_id}, which is not its own")
        arrived_at = known.arrived.pop(receipt.stop_id, None)
        if arrived_at is not None:
            kind = Kind.LOAD if receipt.purpose is Purpose.LOAD else Kind.RECEIVE
            since_s = self.now_s - (receipt.happened_at - arrived_at).total_seconds()
            self.dispatch.told.handed_over(kind, since_s, (receipt.happened_at - arrived_at).total_seconds())
        if receipt.purpose is Purpose.LOAD:
            order.loaded = True
        else:
            self.dispatch.told.arrived(receipt.stop_id)  # it was there already
            order.delivered_s = self.now_s
            del self.dispatch.open[order.id]
        known.without_stop(receipt.stop_id)
        self.controller.served(known.name, receipt.stop_id, self.now_s)
        if order.loaded and receipt.purpose is Purpose.LOAD:
            self.dispatch.is_loaded(order)
        self._wake(decide=True)

    def _cleared(self, known: Known, message: Clear) -> None:
        leg = message.leg
        if known.held.pop(leg, None) is None:
            raise CustodyError(f"{known.name} has left a corridor that it did not have")
        known.post = leg.to_post
        self.charges.left_corridor(known.name, self.ground.clock.local, self.ground.length_m(leg))
        self.controller.cleared(known.name, leg.from_post, leg.to_post, self.now_s)
        own = Goal(self.ground.network.number_of(known.post), 0.0, key=OF_ITS_OWN)
        if own in self.controller.goals(known.name):
            self._forget_own_goal(known)
        self._wake()

    # What follows.

    def _wake(self, *, decide: bool = False) -> None:
        self._decides |= decide
        if not self._looks:
            self._looks = True
            self.ground.clock.at(self.now_s + GATHER_S, self._look)

    def _look_now_and_then(self) -> None:
        self.ground.clock.at(self.now_s + LOOKS_EVERY_S, self._look_now_and_then)
        self._time_charges()
        for known in self.robots.values():
            self._look_for_charger(known)
        self._top_up()
        self._look_for_stuck()
        self._wake(decide=any(order.robot is None for order in self.dispatch.open.values()))

    def _look_for_stuck(self) -> None:
        for known in self.robots.values():
            if known.claim is None or known.frozen:
                continue
            if self.now_s - max(known.moved_s, known.asked_s) > STUCK_S:
                self.counts["stuck"] += 1
                known.asked_s = self.now_s

    def _look(self) -> None:
        self._looks = False
        self._follow_standing()
        if self._decides:
            self._decides = False
            self.dispatch.decide()
        for known in self.robots.values():
            if known.claim is not None and not known.held and not known.frozen:
                self._answer(known, known.claim)

    def _is_frozen(self, known: Known) -> bool:
        is_away = bool(known.held) or not (known.docked and known.post == known.home)
        is_silent = not known.is_heard and is_away and self.now_s - known.heard_s > VANISHED_S
        return known.stopped or is_silent

    def _follow_standing(self) -> None:
        for known in self.robots.values():
            if known.frozen != self._is_frozen(known):
                known.frozen = not known.frozen
                self.counts["frozen"] += known.frozen
                (self.controller.freeze if known.frozen else self.controller.unfreeze)(known.name, self.now_s)
                self._decides = True

    # Corridors.

    def _answer(self, known: Known, claim: Claim) -> None:
        self._follow_own_goal(known, claim)
        if isinstance(self.controller.next_move(known.name, self.now_s), ComeIn):
            self.controller.comes_in(known.name, known.post, self.now_s)  # home places here are nowhere on the floor
        wanted: Lane | None = known.lane or self._lane(claim.legs[0])
        while wanted is not None:
            leads = self.controller.leads(known.name)
            if not self._goes_on(known, wanted if leads is None else leads):
                return
            answer = self.controller.claims(known.name, *self._ends(wanted), self.now_s)
            wanted = answer.instead if isinstance(answer, Denied) else None
        match answer:
            case Granted(lane):
                self._grant(known, claim, lane)
            case Waits(lane):
                known.lane = lane if lane != self._lane(claim.legs[0]) else None
                self.counts["waited"] += 1
            case Denied():
                known.claim = known.lane = None
                self.controller.gives_up_claim(known.name)
                known.link.to_robot(Deny(claim_id=claim.claim_id, avoid=claim.legs[:1], reason="No way is open."))

    def _follow_own_goal(self, known: Known, claim: Claim) -> None:
        """Where it goes for reasons of its own, as the service has it from claims: it may know of no closed corridor,
        and is led another way there. What it has claimed so before, and has not gone to, no robot is to wait for."""
        if self.dispatch.goals(known.name) or claim.goal is None:
            self._forget_own_goal(known)
            return
        goal = Goal(self.ground.network.number_of(claim.goal), 0.0, key=OF_ITS_OWN)
        if self.controller.goals(known.name) != (goal,):
            self.controller.give(known.name, (goal,), self.now_s, rounds=0)

    def _forget_own_goal(self, known: Known) -> None:
        for key in {goal.key for goal in self.controller.goals(known.name)} & {CLAIMED, OF_ITS_OWN}:
            self.controller.served(known.name, key, self.now_s)

    def _grant(self, known: Known, claim: Claim, lane: Lane) -> None:
        start, end = self._ends(lane)
        leg = Leg(from_post=start, to_post=end)
        known.claim = known.lane = None
        known.held[leg] = known.moved_s = self.now_s
        self._look_for_bays(lane.end)
        if leg == claim.legs[0]:
            known.link.to_robot(Grant(claim_id=claim.claim_id, legs=(leg,)))
        else:
            self.counts["detours"] += 1
            known.link.to_robot(Detour(claim_id=claim.claim_id, legs=(leg,), reason="Others have to pass."))

    def _look_for_bays(self, post: int) -> None:
        """Independently of the code that has granted it."""
        starts = [task.start for task in self.controller.tasks(self.now_s).values()]
        taken = sum(start.post == post and not start.at_home for start in starts)
        if taken > self.ground.network.bays[post]:
            raise CollisionError(f"{taken} robots for the bays of {self.ground.network.posts[post]}")

    def _lane(self, leg: Leg) -> Lane:
        network = self.ground.network
        return network.lane(network.number_of(leg.from_post), network.number_of(leg.to_post))

    def _ends(self, lane: Lane) -> tuple[str, str]:
        posts = self.ground.network.posts
        return posts[lane.start], posts[lane.end]

    # Charge.

    def _look_for_charger(self, known: Known) -> None:
        """One that made room for another in the dock that it was sent to goes to another dock, or about its work while
        it still comes to one: others have to pass where it would wait. With less it waits."""
        others = (one for one in self.robots.values() if one is not known)
        is_taken = any(one.charging and one.post == known.post for one in others)
        if known.bound_for != known.post or known.held or known.charging or not is_taken:
            return
        known.bound_for = None
        dock = self.charges.dock_for(known)
        if dock != known.post and self.charges.instead_of(known, dock) is None and self._send_to_dock(known, dock):
            return
        known.bound_for = known.post
        if self.charges.comes_to_another_dock(known):
            self._ends_charge(known)

    def _goes_on(self, known: Known, lane: Lane) -> bool:
        """Before each leg: whether it has the charge for it. Else it is sent to a dock first."""
        here = self.ground.network.posts[lane.start]
        if known.bound_for not in (None, here) and not known.recharging and self.charges.is_free(here, known):
            self._send_to_dock(known, here)  # others may have led it here, away from the one that it was sent to
            return False
        nearer = (
            None if known.bound_for is None or known.recharging else self.charges.instead_of(known, known.bound_for)
        )
        if nearer is not None and self._send_to_dock(known, nearer):
            return False
        if known.bound_for is not None:
            return not self.charges.waits_for_way(known, lane, known.bound_for)
        if not self.charges.goes_on(known, lane):
            self._breaks_off(known)
            self._send_to_dock(known, self.charges.dock_for(known))
            return False
        if known.planned.isdisjoint(self.dispatch.open) or self.charges.passes_dock(
            known, lane, self.dispatch.goals(known.name)
        ):
            return True
        self._breaks_off(known)
        self._send_to_dock(known, here)
        return False

    def _breaks_off(self, known: Known) -> None:
        """Mark its orders as delayed by an unplanned charge, unless it was known to be more than one charge."""
        self.counts["charges_on_the_way"] += 1
        for order in self.dispatch.open.values():
            if order.robot == known.name and order.id not in known.planned:
                order.unplanned_charge = True

    def _send_to_dock(self, known: Known, dock: str) -> bool:
        self._charge_goals += 1
        charge_s = self.charges.charging_s(known, self.charges.thresholds.sufficient)
        goal = Goal(self.ground.network.number_of(dock), charge_s, key=f"c{self._charge_goals}-dock")
        others = [one for one in self.controller.goals(known.name) if not one.key.endswith("-dock")]
        if not self.controller.give(known.name, (goal, *others), self.now_s):
            return False
        known.bound_for = dock
        self.dispatch.tell_missions((known.name,))
        return True

    def _see_if_charged(self, known: Known) -> None:
        """A robot that was sent to a dock is let go when it has enough for what it is to do."""
        charge = self.dispatch.charge_goal(known)
        if charge is None or not known.charging or known.recharging:
            return
        others = [goal for goal in self.dispatch.goals(known.name) if goal is not charge]
        if self.charges.has_enough(known, others):
            self._ends_charge(known)

    def _ends_charge(self, known: Known) -> None:
        known.bound_for = None
        charge = self.dispatch.charge_goal(known)
        if charge is not None:
            self.controller.served(known.name, charge.key, self.now_s)
        self.dispatch.tell_missions((known.name,))
        self._wake(decide=True)

    def _time_charges(self) -> None:
        """A charge that has begun takes only what is left of it."""
        for known in self.robots.values():
            charge = self.dispatch.charge_goal(known)
            if charge is not None and known.charging and not known.frozen:
                left_s = self.charges.charging_s(
                    known, FULL if known.recharging else self.charges.thresholds.sufficient
                )
                goals = (charge._replace(handling_s=left_s), *self.controller.goals(known.name)[1:])
                self.controller.give(known.name, goals, self.now_s, rounds=0)

    def _top_up(self) -> None:
        """Charge idle robots, lowest first, where a dock is free or another robot makes room."""
        robots = self.robots.values()
        resting = [one for one in robots if not self.dispatch.goals(one.name) and not one.held and one.is_heard]
        standing = {one.post: one.name if one in resting else None for one in robots if one.charging}
        taken = {**standing, **{one.bound_for: None for one in robots if one.bound_for}}
        for move in self.charges.moves([one for one in resting if not one.recharging], taken, self.ground.clock.local):
            self.counts["top_ups"] += self._send_to_dock(self.robots[move.robot], move.dock)
