"""Charge limits of robots for their work: the map and the settings, put to `fleet.charging`.

What a robot is refused for must be something that will change by itself: those with a home charge there whenever they
have nothing to do, others are sent to a dock (`app.charging`).
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from math import isfinite
from typing import Final, Protocol

from app.core.settings import Settings
from app.robots.energy_use import usual_rates
from fleet.charging.docks import Need
from fleet.charging.energy import Rates, Use
from fleet.charging.going_on import Charge, goes_on
from fleet.charging.levels import Thresholds
from fleet.charging.top_ups import nearest
from maps.ways import Ways

THRESHOLDS: Final = Thresholds()
ENOUGH_CHARGE: Final = 0.30
"""Not for any order: above the ratio at which a robot's own battery plan would take it back to the dock at once (0.25
and hysteresis)."""
LONGEST_DRIVE_S: Final = 8 * 3600.0
CLOSE_ENOUGH_S: Final = 10.0
LEAVES_DOCK: Final = THRESHOLDS.begin + THRESHOLDS.hysteresis
"""With less a robot in a dock begins nothing."""


class Charged(Protocol):
    """The facts about a robot that count here. `home`: a post where it charges when it has nothing to do; `docked`:
    None if it does not tell."""

    @property
    def name(self) -> str: ...
    @property
    def post(self) -> str | None: ...
    @property
    def battery_ratio(self) -> float | None: ...
    @property
    def charging(self) -> bool: ...
    @property
    def docked(self) -> bool | None: ...
    @property
    def home(self) -> str | None: ...


@dataclass
class Charges:
    """`rates`: what was learned of robots (`app.robots.energy_use`); all others cost what is assumed."""

    ways: Ways
    settings: Settings
    rates: Mapping[str, Rates] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self._assumed = usual_rates()
        self._docks = frozenset(post.name for post in self.ways.campus.docks())
        self._shared = frozenset(self.ways.campus.docks_to_share())

    def drives_s(self, robot: Charged) -> float:
        """For how many seconds of driving, as the map has them, its charge lasts, with the way home and hand-overs."""
        ratio = robot.battery_ratio
        if ratio is None or ratio < ENOUGH_CHARGE or (robot.charging and ratio < LEAVES_DOCK):
            return 0.0
        rates, spare = self.rates.get(robot.name, self._assumed), ratio - THRESHOLDS.low
        handovers = 2 * self.settings.robot_capacity
        low_s, high_s = 0.0, LONGEST_DRIVE_S
        while high_s - low_s > CLOSE_ENOUGH_S:
            middle_s = (low_s + high_s) / 2
            use = self._use(middle_s * self.settings.assumed_speed_m_s, handovers)
            low_s, high_s = (middle_s, high_s) if rates.at_most(use) <= spare else (low_s, middle_s)
        return low_s

    def goes_on(self, robot: Charged, way: Sequence[str]) -> bool:
        """Tell if it has the charge for these corridors, from post to post, and to a dock after them."""
        ratio, rates = robot.battery_ratio, self.rates.get(robot.name, self._assumed)
        if ratio is None or robot.docked or ratio >= THRESHOLDS.full - THRESHOLDS.hysteresis:
            return True  # there is no more to be had, or nothing known
        leg, to_dock = self._way(way), self._use(self._to_dock_m(way[-1], robot))
        return goes_on(Charge(ratio, rates), leg, to_dock, THRESHOLDS)

    def needed(self, robot: Charged, posts: Sequence[str]) -> float:
        """For stops at these posts one after the other, and to a dock after them: no more than there is in a pack. Out
        of a dock it begins nothing with less than `Thresholds.begin`."""
        rates = self.rates.get(robot.name, self._assumed)
        work = self._way((robot.post, *posts)) + self._use(self._to_dock_m(posts[-1], robot), len(posts))
        least = LEAVES_DOCK if robot.docked else 0.0
        return min(THRESHOLDS.full, max(least, THRESHOLDS.low + rates.at_most(work)))

    def nearest_dock(self, robot: Charged, free: Iterable[str]) -> str | None:
        """Of these the one that it gets to with a reserve, and with least."""
        rates, ratio = self.rates.get(robot.name, self._assumed), robot.battery_ratio or 0.0
        ways = {dock: self.ways.length_m(robot.post, dock) for dock in free}
        uses = {dock: self._use(way_m) for dock, way_m in ways.items() if isfinite(way_m)}
        return nearest(Need(robot.name, Charge(ratio, rates), 0.0, uses), list(uses), THRESHOLDS)

    def goes_beyond(self, robot: Charged) -> bool:
        """Tell if it is as full as it gets, so that it may be given what is more than one charge."""
        ratio = robot.battery_ratio or 0.0
        return ratio >= THRESHOLDS.full or (ratio >= THRESHOLDS.begin and not self._will_charge(robot))

    def _will_charge(self, robot: Charged) -> bool:
        """In a dock without charging its charger has ended: a worn pack is never fuller than that."""
        is_docked = robot.post == robot.home if robot.docked is None else robot.docked
        return robot.charging or (robot.home is not None and not is_docked)

    def _way(self, posts: Sequence[str | None]) -> Use:
        return self._use(sum(self._length_m(a, b) for a, b in pairwise(posts) if b is not None))

    def _use(self, way_m: float, handovers: int = 0) -> Use:
        settings = self.settings
        return Use(way_m, way_m / settings.assumed_speed_m_s + handovers * settings.assumed_handover_s)

    def _to_dock_m(self, post: str, robot: Charged) -> float:
        its_own = self._docks & {robot.home}
        return min((self._length_m(post, dock) for dock in self._shared | its_own), default=0.0)

    def _length_m(self, from_post: str | None, to_post: str) -> float:
        length_m = self.ways.length_m(from_post, to_post)
        return length_m if isfinite(length_m) else 0.0
