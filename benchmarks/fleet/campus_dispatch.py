"""Dispatch on the simulated campus: the planner's decisions as missions, in the words of the protocol."""

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from random import Random
from typing import Final

from benchmarks.fleet.campus_charge import Charges
from benchmarks.fleet.campus_ground import ASSUMED_HANDOVER_S, Ground
from benchmarks.fleet.campus_known import Known
from benchmarks.fleet.campus_told import Told
from benchmarks.fleet.planned import so_many
from fleet.assignment.adopting import Able, adopt, problem_of
from fleet.assignment.deciding import decide
from fleet.assignment.improving import improved
from fleet.assignment.problem import AssignmentProblem, OpenOrder, Rules
from fleet.charging.acceptance import Answer
from fleet.eta.arrivals import Ahead
from fleet.schedule.controller import TrafficController
from fleet.schedule.journey import Goal
from protocol.parts import Stop, StopAction

AGE_LIMIT_S: Final = 6 * 3600.0
KEEPS_AFTER_S: Final = AGE_LIMIT_S / 3
ROUNDS: Final = 3
"""Of improvement, for each decision."""
ACTIONS: Final = {"load": StopAction.LOAD, "receive": StopAction.RECEIVE, "dock": StopAction.DOCK}


@dataclass
class Ordered:
    """One order and what became of it."""

    number: int
    start: int
    end: int
    placed_s: float
    taken_s: float | None = None
    robot: str | None = None
    loaded: bool = False
    delivered_s: float | None = None
    unplanned_charge: bool = False

    @property
    def id(self) -> str:
        return f"o{self.number}"

    def open(self) -> OpenOrder:
        load, receive = (Goal(post, ASSUMED_HANDOVER_S, key=key) for post, key in self._ends)
        return OpenOrder(self.id, load, receive, self.placed_s, loaded=self.loaded)

    @property
    def _ends(self) -> tuple[tuple[int, str], tuple[int, str]]:
        return (self.start, f"{self.id}-load"), (self.end, f"{self.id}-receive")


@dataclass
class Dispatch:
    """`orders`: all there were; `open`: those that are not delivered. Goals of the traffic have the ids of stops."""

    ground: Ground
    robots: dict[str, Known]
    capacity: int
    rng: Random
    controller: TrafficController
    charges: Charges
    told: Told
    counts: Counter[str]
    orders: dict[str, Ordered] = field(default_factory=dict)
    open: dict[str, Ordered] = field(default_factory=dict)
    _foreseen: set[str] = field(default_factory=set)

    @property
    def now_s(self) -> float:
        return self.ground.clock.now_s

    def place(self, start: int, end: int) -> None:
        order = Ordered(len(self.orders), start, end, self.now_s)
        self.orders[order.id] = self.open[order.id] = order
        self.charges.ordered(self.ground.clock.local)
        self.told.placed(order, self._ahead())
        self.decide()

    # What is decided.

    def decide(self) -> None:
        if not self.open:
            return
        problem = self.problem()
        decision = decide(problem)
        if decision is not None:
            decision = improved(decision, self.rng, so_many(ROUNDS)())
        self.counts["decisions"] += 1
        if decision is None or not adopt(self.controller, decision, self.robots, self.now_s):
            self.counts["refused"] += 1
            return
        self.tell_missions(self.robots)
        self._foresee()

    def _foresee(self) -> None:
        """Record what is told first of orders that have a robot now."""
        new = [one for one in self.open.values() if one.robot is not None and one.id not in self._foreseen]
        if new:
            self.told.under_way(new, self.controller, self.robots.values(), is_aboard=False)
            self._foreseen.update(one.id for one in new)

    def is_loaded(self, order: Ordered) -> None:
        """Record what is told first after the mail is aboard."""
        self.told.under_way([order], self.controller, self.robots.values(), is_aboard=True)

    def problem(self) -> AssignmentProblem:
        able = {name: self._able(known) for name, known in self.robots.items()}
        kept_for = self._kept_for_long_waiting()
        orders = {one.id: self._with_avoided(one, kept_for) for one in self.open.values()}
        return problem_of(self.controller, able, orders, self.now_s, Rules(age_limit_s=AGE_LIMIT_S))

    def _ahead(self) -> Ahead:
        """Orders not fetched yet, but for the one just placed, for how many robots."""
        waiting = sum(1 for one in self.open.values() if not one.loaded) - 1
        return Ahead(waiting, sum(1 for known in self.robots.values() if known.is_heard))

    def goals(self, name: str) -> tuple[Goal, ...]:
        """Of its mission: without what it does for reasons of its own."""
        return tuple(goal for goal in self.controller.goals(name) if goal.key.rpartition("-")[2] in ACTIONS)

    def charge_goal(self, known: Known) -> Goal | None:
        return next((goal for goal in self.controller.goals(known.name) if goal.key.endswith("-dock")), None)

    # What robots are told.

    def tell_missions(self, names: Iterable[str]) -> None:
        carried: dict[str, str] = {}
        for name in names:
            known, goals = self.robots[name], self.goals(name)
            stops = tuple(self._stop(goal) for goal in goals)
            if known.tell_mission(stops):
                self.forget_claim(known, stops[0].post if stops else known.home)
            carried |= {goal.key.partition("-")[0]: name for goal in goals}
        for order in self.open.values():
            robot = carried.get(order.id)
            if robot is not None:
                self._note_taken(order, robot)
            elif order.robot in names and not order.loaded:
                order.robot = None

    def forget_claim(self, known: Known, goal: str) -> None:
        """A robot that is to go elsewhere now asks for another way once it knows."""
        if known.claim is not None and known.claim.goal != goal and not known.recharging:
            known.claim = known.lane = None
            self.controller.gives_up_claim(known.name)

    def _note_taken(self, order: Ordered, robot: str) -> None:
        if order.robot == robot:
            return
        known = self.robots[robot]
        load, give = order.open().load, order.open().give
        if self.charges.verdict(known, (), (load, give)).answer is Answer.ON_THE_WAY:
            known.planned.add(order.id)
        order.robot = robot
        order.taken_s = self.now_s if order.taken_s is None else order.taken_s

    def _stop(self, goal: Goal) -> Stop:
        order, _, what = goal.key.rpartition("-")
        action = ACTIONS[what]
        return Stop(
            id=goal.key,
            post=self.ground.network.posts[goal.post],
            action=action,
            order_id=None if action is StopAction.DOCK else order,
        )

    # How it is done.

    def _able(self, known: Known) -> Able:
        accepts = known.is_heard and not known.frozen and not known.recharging
        if self.charge_goal(known) is not None:
            return Able(self.capacity, self._begun(known), accepts)  # what is more than one charge goes, too
        is_full = known.ratio >= self.charges.thresholds.full
        return Able(self.capacity, self._begun(known), accepts, self.charges.drives_s(known), is_full)

    def _begun(self, known: Known) -> int:
        """Goals at the post that it is at, or is in the last corridor to; and a charge comes first."""
        task = self.controller.tasks(self.now_s).get(known.name)
        begun = 0
        for goal in self.controller.goals(known.name) if task else ():
            if goal.key.endswith("-dock"):
                return begun + 1
            if task is None or goal.post != task.start.post:
                break
            begun += 1
        return begun

    def _kept_for_long_waiting(self) -> dict[str, str]:
        """Robots that charge until they are full for an order that is more than one charge: else there would always be
        a shorter one that they have enough for."""
        kept: dict[str, str] = {}
        for order in self.open.values():
            if order.robot is not None or self.now_s - order.placed_s < KEEPS_AFTER_S:
                continue
            able = [one for name, one in self.robots.items() if name not in kept and self._may_be_kept(one, order)]
            if able:
                kept[max(able, key=lambda one: (one.ratio, one.name)).name] = order.id
        return kept

    def _may_be_kept(self, known: Known, order: Ordered) -> bool:
        goals = order.open().load, order.open().give
        is_resting = known.charging and not any(one.robot == known.name for one in self.open.values())
        return is_resting and self.charges.verdict(known, (), goals).answer is not Answer.TOO_FAR

    def _with_avoided(self, order: Ordered, kept_for: Mapping[str, str]) -> OpenOrder:
        """Not with robots that have no charge for it, or are kept for another; nor, where one has it, with those that
        would charge on the way."""
        if order.loaded:
            return order.open()
        load, give = order.open().load, order.open().give
        answers = {}
        for name, known in self.robots.items():
            if order.robot != name:
                answers[name] = self.charges.verdict(known, self.goals(name), (load, give)).answer
        best = Answer.YES if Answer.YES in answers.values() or order.robot else Answer.ON_THE_WAY
        kept = {name for name, its in kept_for.items() if its != order.id and name != order.robot}
        avoided = kept.union(name for name, answer in answers.items() if answer is not best)
        return replace(order.open(), avoided=frozenset(avoided))
