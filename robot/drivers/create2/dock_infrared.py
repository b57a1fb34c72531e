"""The dock's infrared as a position source: on which side of the dock's middle line the robot stands, and how near.

A dock sends two beams that overlap on its middle line, and a force field of about half a metre round itself. A robot
that approaches has the green beam on the left and the red one on the right. Characters: the table of IR characters of
the Create 2 notes; two families of docks send the same in different bits.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from enum import IntEnum

from robot.drivers.interfaces import Base, BaseState, Fix


class Side(IntEnum):
    """Where the robot stands, as it looks at the dock. The number is the sign of how far left it is."""

    LEFT = 1
    ON_AXIS = 0
    RIGHT = -1


@dataclass(frozen=True, slots=True)
class DockSight:
    """The meaning of one character, or of several at once. `side` None: the force field alone."""

    side: Side | None
    near: bool
    """Within the force field, about 0.5 m."""


@dataclass(frozen=True, slots=True)
class _Family:
    """The bits of one family of docks."""

    base: int
    field: int
    green: int
    red: int

    def bits(self, character: int) -> tuple[bool, bool, bool]:
        """(force field, green, red); nothing for what another thing sends."""
        own = character - self.base
        if own < 0 or own & ~(self.field | self.green | self.red):
            return False, False, False
        return bool(own & self.field), bool(own & self.green), bool(own & self.red)


FAMILIES = (_Family(160, 1, 4, 8), _Family(240, 2, 4, 8))
"""The drive-on dock of the 600 series, and the Discovery dock."""

NEAR_MM, FAR_MM = 350.0, 1300.0
"""Middle of what the force field covers, and of what lies between it and the end of the beams (2 to 2.5 m)."""
NEAR_ACCURACY_MM, FAR_ACCURACY_MM = 150.0, 500.0
SIDE_SHARE = 0.25
"""How far beside the axis, of the distance: the middle of a beam that is 25 degrees wide."""
SAME_FOR_S = 1.0
"""An unchanged sight is told again after so long."""


def dock_sight(characters: Iterable[int]) -> DockSight | None:
    """Combine what the receivers see; None where none sees a dock: remotes and virtual walls are none."""
    bits = [family.bits(character) for character in characters for family in FAMILIES]
    field, green, red = (any(bit) for bit in zip(*bits, strict=True)) if bits else (False, False, False)
    if not (field or green or red):
        return None
    return DockSight(Side(green - red) if green or red else None, field)


def sight_of(state: BaseState) -> DockSight | None:
    """By the receiver on top: it sees all round. The two in front see the same light and would count a beam twice."""
    return dock_sight((state.ir_omni,))


def dock_fix(sight: DockSight, at_s: float) -> Fix:
    """Which way the dock lies is not known, only how far, and on which side of its axis the robot is.

    `left_mm` is where the axis is for a robot that looks at the dock.
    """
    away_mm = NEAR_MM if sight.near else FAR_MM
    accuracy_mm = NEAR_ACCURACY_MM if sight.near else FAR_ACCURACY_MM
    aside_mm = 0.0 if sight.side is None else -sight.side * SIDE_SHARE * away_mm
    return Fix("dock", None, at_s, away_mm, aside_mm, None, accuracy_mm)


class DockInfrared:
    """A position source: one fix when what is seen changes, and one a second while it does not."""

    def __init__(self, base: Base) -> None:
        self._base = base
        self._told: DockSight | None = None
        self._told_s = 0.0

    def fixes(self, now: float) -> tuple[Fix, ...]:
        """See `interfaces.PositionSource`; called by the thread that polls the base."""
        state = self._base.state
        sight = sight_of(state) if state else None
        changed, again = sight != self._told, now - self._told_s >= SAME_FOR_S
        if not changed and not again:
            return ()
        self._told, self._told_s = sight, now
        return (dock_fix(sight, state.at_s),) if sight and state else ()
