"""The paper's own actions, so that its program runs: `drive` is a pulse, `turn` ends on the line or fails in 10 s."""

from robot.core.errors import UnknownSkill
from robot.drivers.interfaces import STOP, BodyShape, WheelSpeeds
from robot.skills.interfaces import Done, Step, View
from robot.skills.turn import Turn

PULSE_S = 0.2
"""The prototype's driver stopped the wheels so long after the last command."""
TURN_LIMIT_S = 10.0

PULSES = {
    "forward": WheelSpeeds(50, 50),
    "left": WheelSpeeds(30, 60),
    "right": WheelSpeeds(60, 30),
    "stop": STOP,
    "spiral": WheelSpeeds(0, 60),
}
"""The prototype drove 50 mm/s, corrected at 10 mm/s ± 6 mm/s, and veered: no wheel goes below 30 here."""


class DrivePulse:
    """Done at once; the wheels go on for 0.2 s, or until the next motion."""

    name = "drive"
    moves = True
    limit_s = 1.0
    on_timeout = "timeout"

    def __init__(self, way: str) -> None:
        """`way` is one of PULSES; UnknownSkill otherwise."""
        if way not in PULSES:
            raise UnknownSkill(way, tuple(PULSES))
        self._wheels = PULSES[way]

    def start(self, view: View, now: float) -> None:
        """Nothing to prepare."""

    def step(self, view: View, now: float) -> Step:
        """See `interfaces.Done.pulse`."""
        return Done(pulse=self._wheels, pulse_s=PULSE_S)


class PaperTurn(Turn):
    """The paper's `turn`: the angle the map gives (behind 180°, without a destination ±90°), 10 s at most."""

    def __init__(self, angle_rad: float, shape: BodyShape | None = None) -> None:
        super().__init__(angle_rad, shape, limit_s=TURN_LIMIT_S)
