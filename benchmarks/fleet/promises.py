"""ETAs told to people in a simulation, and what came of them: by the service's own estimates (`fleet.eta`), fed and
asked as `app/eta/learning.py` and `app/dispatch/eta_updates.py` do it."""

from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import datetime, timedelta
from random import Random
from typing import NamedTuple

from app.dispatch.forecasts import Foresight, Stop
from fleet.eta.arrivals import Estimates
from fleet.eta.calibration import Basis
from fleet.eta.durations import Kind, Thing
from fleet.eta.intervals import Interval
from fleet.eta.score import Truth
from fleet.schedule.network import Lane, Network


class Promise(NamedTuple):
    """`told_s`: when it was told."""

    told_s: float
    basis: Basis
    raw: Interval
    told: Interval
    by_map: Interval


@dataclass
class Promises:
    """`begins`: when the simulation does. `scored`: each truth that came, beside what was told of it; `raw`: beside
    what was worked out."""

    network: Network
    estimates: Estimates
    begins: datetime
    scored: dict[Basis, list[Truth]] = field(default_factory=lambda: {basis: [] for basis in Basis})
    raw: dict[Basis, list[Truth]] = field(default_factory=lambda: {basis: [] for basis in Basis})
    _open: dict[str, list[Promise]] = field(default_factory=lambda: defaultdict(list))
    _fetches: dict[str, tuple[float, Thing]] = field(default_factory=dict)

    def local(self, now_s: float) -> datetime:
        return self.begins + timedelta(seconds=now_s)

    # What robots do.

    def drove(self, lane: Lane, seconds: float) -> None:
        self.estimates.durations.observe(self.corridor(lane), seconds)

    def handled(self, kind: Kind, arrived_s: float, seconds: float) -> None:
        self.estimates.durations.observe(self.estimates.stop(kind, self.local(arrived_s)), seconds)

    def fetched(self, order: str, now_s: float) -> None:
        """A robot is at its sender's."""
        placed_s, fetch = self._fetches.pop(order, (0.0, None))
        if fetch is not None:
            self.estimates.durations.observe(fetch, now_s - placed_s)

    def came(self, order: str, now_s: float) -> None:
        """A robot is at its recipient's with this mail."""
        for one in self._open.pop(order, ()):
            truth_s = now_s - one.told_s
            self.estimates.told[one.basis].arrived(one.raw, one.told, one.by_map, truth_s)
            self.scored[one.basis].append(Truth(one.told, one.by_map, truth_s))
            self.raw[one.basis].append(Truth(one.raw, one.by_map, truth_s))

    # What is told.

    def placed(self, order: str, now_s: float, start: int, end: int) -> None:
        """With a new order."""
        posts = self.network.posts
        its = self.estimates.promise(posts[start], posts[end], self.local(now_s))
        self._fetches[order] = now_s, its.fetch
        self._open[order].append(Promise(now_s, Basis.PLACED, its.raw, its.told, its.by_map))

    def under_way(
        self, order: str, now_s: float, ends: tuple[int, int], raw: Interval, *, is_aboard: bool = False
    ) -> None:
        """First of an order that a robot has, or first after its mail was loaded. `ends`: from which post to which."""
        start, end = (self.network.posts[post] for post in ends)
        by_map = self.estimates.by_map_under_way(start, end, is_aboard=is_aboard)
        told = self.estimates.told[Basis.UNDER_WAY].corrected(raw)
        self._open[order].append(Promise(now_s, Basis.UNDER_WAY, raw, told, by_map))

    def foresight(self, stops: Mapping[str, Stop], now_s: float, rng: Random) -> Foresight:
        """Return what the service draws for a forecast of its schedule."""
        return Foresight(self.estimates, self.network, stops, self.local(now_s), now_s, rng)

    def corridor(self, lane: Lane) -> Thing:
        posts = self.network.posts
        thing = self.estimates.corridor(posts[lane.start], posts[lane.end])
        assert thing is not None, "the network is made from the map"
        return thing
