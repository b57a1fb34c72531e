"""ETAs told to people in the simulation, and how true they were: by the service's own estimates, on the traffic's own
schedule. Corridors and hand-overs are learned from what robots tell."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from datetime import UTC
from random import Random
from typing import Protocol

from app.dispatch.forecasts import Stop
from benchmarks.fleet.campus_ground import ASSUMED_HANDOVER_S, ASSUMED_M_S, OFFICE_H, Ground
from benchmarks.fleet.campus_known import Known
from benchmarks.fleet.charging_world import BEGINS
from benchmarks.fleet.promises import Promises
from fleet.eta.arrivals import Ahead, Estimates
from fleet.eta.durations import Kind
from fleet.eta.forecast import forecast
from fleet.schedule.controller import TrafficController
from fleet.schedule.network import Lane
from maps.ways import Ways


class Ordered(Protocol):
    """An order with its posts."""

    start: int
    end: int

    @property
    def id(self) -> str: ...


@dataclass
class Told:
    """`promises`: all that was told, and what came of it."""

    ground: Ground
    rng: Random
    promises: Promises = field(init=False)

    def __post_init__(self) -> None:
        ways = Ways(self.ground.campus)
        estimates = Estimates(ways, ASSUMED_M_S, ASSUMED_HANDOVER_S, BEGINS.tzinfo or UTC, OFFICE_H)
        self.promises = Promises(self.ground.network, estimates, BEGINS)

    # What robots tell.

    def drove(self, lane: Lane, seconds: float) -> None:
        self.promises.drove(lane, seconds)

    def handed_over(self, kind: Kind, arrived_s: float, seconds: float) -> None:
        self.promises.handled(kind, arrived_s, seconds)

    def arrived(self, key: str) -> None:
        order, _, what = key.rpartition("-")
        if what == "load":
            self.promises.fetched(order, self._now_s)
        elif what == "receive":
            self.promises.came(order, self._now_s)

    # What is told.

    def placed(self, order: Ordered, ahead: Ahead) -> None:
        self.promises.estimates.ahead = ahead
        self.promises.placed(order.id, self._now_s, order.start, order.end)

    def under_way(
        self, orders: Iterable[Ordered], controller: TrafficController, robots: Iterable[Known], *, is_aboard: bool
    ) -> None:
        """By the schedule as it is now; an order that is in none of its robot's goals is told nothing yet."""
        now_s = self._now_s
        sees = self.promises.foresight({stop.id: stop for stop in _stops(robots)}, now_s, self.rng)
        tasks, journeys = controller.tasks(now_s), controller.journeys(now_s)
        foreseen = forecast(controller.network, tasks, journeys, now_s, sees.chance())
        for order in orders:
            raw = foreseen.get(f"{order.id}-receive")
            if raw is not None:
                self.promises.under_way(order.id, now_s, (order.start, order.end), raw, is_aboard=is_aboard)

    @property
    def _now_s(self) -> float:
        return self.ground.clock.now_s


def _stops(robots: Iterable[Known]) -> Iterator[Stop]:
    for known in robots:
        for stop in known.mission.stops if known.mission is not None else ():
            yield Stop(stop.id, stop.action, stop.post, stop.order_id, known.name, known.arrived.get(stop.id))
