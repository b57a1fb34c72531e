"""Promised arrivals on one basis: corrected by what came, and scored."""

from dataclasses import dataclass, field

from fleet.eta.calibration import Calibration
from fleet.eta.intervals import Interval
from fleet.eta.score import Score, ScoreBoard, Truth


@dataclass
class Told:
    """One for each `Basis`. How far off an order comes that has its place in the schedule says nothing of one that no
    robot has yet. Put right together, the one kind is told much too widely and the other too narrowly, and four of five
    is true of neither."""

    calibration: Calibration = field(default_factory=Calibration)
    board: ScoreBoard = field(default_factory=ScoreBoard)

    def corrected(self, raw: Interval) -> Interval:
        """Return the interval to tell for this one."""
        return self.calibration.corrected(raw)

    def arrived(self, raw: Interval, told: Interval, by_map: Interval, took_s: float) -> None:
        """An order's robot came to its recipient, so many seconds after this was told."""
        self.calibration.learn(raw, told, took_s)
        self.board.add(Truth(told, by_map, took_s))

    def score(self) -> Score | None:
        """Return the latest score; None as long as nothing has come."""
        return self.board.score()
