"""Whether a robot has the charge to fetch an order and bring it: the map and the settings, put to `app.charging`.

Nobody sends robots to charge yet: those with a home charge there whenever they have nothing to do, the others when
their own battery plan says so. So what a robot is refused for must be something that will change by itself.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import isfinite
from typing import Final, Protocol

from app.charging.acceptance import Answer, Charge, Verdict, accepts
from app.charging.energy import Rates, Use
from app.charging.levels import Thresholds
from app.dispatch.choice import ENOUGH_CHARGE, IdleRobot, WaitingOrder
from app.fleet.spending import usual_rates
from app.settings import Settings
from maps.ways import Ways

THRESHOLDS: Final = Thresholds()
LONGEST_DRIVE_S: Final = 8 * 3600.0
CLOSE_ENOUGH_S: Final = 10.0
_LEAVES_DOCK: Final = THRESHOLDS.begin + THRESHOLDS.hysteresis


class Charged(Protocol):
    """What counts of a robot here. `home`: a post where it charges when it has nothing to do; `docked`: None if it does
    not tell."""

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
    """`rates`: what was learned of robots (`app.fleet.spending`); all others cost what is assumed."""

    ways: Ways
    settings: Settings
    rates: Mapping[str, Rates] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self._assumed = usual_rates(self.settings)
        self._docks = frozenset(post.name for post in self.ways.campus.docks())

    def may_take(self, robot: IdleRobot, order: WaitingOrder) -> bool:
        """Also what is more than one charge, once it is as full as it gets: it charges on the way then."""
        if robot.battery_ratio is None:
            return False
        verdict = self.verdict(robot, robot.battery_ratio, order)
        if verdict.answer is Answer.CHARGE_FIRST and not self._will_charge(robot):
            return robot.battery_ratio >= min(verdict.needed, THRESHOLDS.begin)
        return verdict.is_accepted

    def verdict(self, robot: IdleRobot, ratio: float, order: WaitingOrder) -> Verdict:
        """Ways that nobody knows cost nothing: they are not what keeps a robot from work."""
        charge = Charge(ratio, self.rates.get(robot.name, self._assumed), docked=bool(robot.docked or robot.charging))
        way_m = self._length_m(robot.post, order.from_post) + self._length_m(order.from_post, order.to_post)
        work, to_dock = self._use(way_m, handovers=2), self._use(self._to_dock_m(order.to_post))
        return accepts(charge, work, to_dock, THRESHOLDS)

    def drives_s(self, robot: Charged) -> float:
        """For how many seconds of driving, as the map has them, its charge lasts, with the way home and hand-overs."""
        ratio = robot.battery_ratio
        if ratio is None or ratio < ENOUGH_CHARGE or (robot.charging and ratio < _LEAVES_DOCK):
            return 0.0
        rates, spare = self.rates.get(robot.name, self._assumed), ratio - THRESHOLDS.low
        handovers = 2 * self.settings.robot_capacity
        low_s, high_s = 0.0, LONGEST_DRIVE_S
        while high_s - low_s > CLOSE_ENOUGH_S:
            middle_s = (low_s + high_s) / 2
            use = self._use(middle_s * self.settings.assumed_speed_m_s, handovers)
            low_s, high_s = (middle_s, high_s) if rates.at_most(use) <= spare else (low_s, middle_s)
        return low_s

    def goes_beyond(self, robot: Charged) -> bool:
        """Whether it is as full as it gets, so that it may be given what is more than one charge."""
        ratio = robot.battery_ratio or 0.0
        return ratio >= THRESHOLDS.full or (ratio >= THRESHOLDS.begin and not self._will_charge(robot))

    def _will_charge(self, robot: Charged) -> bool:
        """In a dock without charging its charger has ended: a worn pack is never fuller than that."""
        is_docked = robot.post == robot.home if robot.docked is None else robot.docked
        return robot.charging or (robot.home is not None and not is_docked)

    def _use(self, way_m: float, handovers: int = 0) -> Use:
        settings = self.settings
        return Use(way_m, way_m / settings.assumed_speed_m_s + handovers * settings.assumed_handover_s)

    def _to_dock_m(self, post: str) -> float:
        return min((self._length_m(post, dock) for dock in self._docks), default=0.0)

    def _length_m(self, from_post: str | None, to_post: str) -> float:
        length_m = self.ways.length_m(from_post, to_post)
        return length_m if isfinite(length_m) else 0.0
