"""Forecasts of all stops that robots have before them, by the schedule."""

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from random import Random
from typing import Final, NamedTuple

from fleet.eta.arrivals import Estimates
from fleet.eta.durations import Kind
from fleet.eta.forecast import Chance
from fleet.schedule.journey import Goal
from fleet.schedule.network import Lane, Network
from protocol.parts import StopAction

KIND_OF: Final[Mapping[str, Kind]] = {
    StopAction.LOAD: Kind.LOAD,
    StopAction.RECEIVE: Kind.RECEIVE,
    StopAction.RETURN: Kind.RECEIVE,
}


class Stop(NamedTuple):
    """A stop that is not over, of a mission that is not over; a robot's in their order."""

    id: str
    action: str
    post: str
    order_id: str | None
    robot: str
    arrived_at: datetime | None


@dataclass(frozen=True)
class Foresight:
    """The random draws for each goal and corridor of the schedule, as it stands at one moment."""

    estimates: Estimates
    network: Network
    stops: Mapping[str, Stop]
    now: datetime
    now_s: float
    rng: Random

    def chance(self) -> Chance:
        return Chance(self._travel_s, self._handling_s, self._arrives_s)

    def _travel_s(self, _robot: str, lane: Lane) -> float:
        return self._draw_s(lane, 0.0)

    def _arrives_s(self, _robot: str, lane: Lane, entered_s: float) -> float:
        return entered_s + self._draw_s(lane, max(0.0, self.now_s - entered_s))

    def _draw_s(self, lane: Lane, over_s: float) -> float:
        posts = self.network.posts
        thing = self.estimates.corridor(posts[lane.start], posts[lane.end])
        return lane.travel_s if thing is None else self.estimates.durations.draw_s(thing, self.rng, over_s)

    def _handling_s(self, goal: Goal) -> float:
        stop = self.stops.get(goal.key)
        kind = KIND_OF.get(stop.action) if stop is not None else None
        if stop is None or kind is None:
            return goal.handling_s
        thing = self.estimates.stop(kind, stop.arrived_at or self.now)
        over_s = max(0.0, (self.now - stop.arrived_at).total_seconds()) if stop.arrived_at else 0.0
        return self.estimates.durations.draw_s(thing, self.rng, over_s) - over_s
