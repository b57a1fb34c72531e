"""The speeds that are latched in the base: which are possible, how long they may stay, when the wheels stand."""

from robot.core.config import MAX_WHEEL_SPEED_MM_S
from robot.drivers.interfaces import STOP, BaseState, WheelSpeeds

SPEED_CAP_MM_S = MAX_WHEEL_SPEED_MM_S
SLOWEST_MM_S = 30.0
"""One encoder count in 15 ms; below it the base veers (field reports; the paper's prototype drove there)."""
DEADLINE_S = 0.4
REPEAT_S = 0.1
"""An unchanged speed is sent again this often: a byte may have been lost."""
STANDING_S = 0.3
"""Wheels that were told to turn and have not by then do not: their lag is 60 ms."""
RUNS_ON_S = 0.5
"""Wheels that were told to stand and still turn by then have not heard it."""
STILL_FRAMES = 3
"""So many frames with equal counts are a standstill: at 30 mm/s single frames show none either."""


RISKY_BYTES = frozenset((7, 129, 132, 133, 134, 135, 136, 143, 150, 173))
"""Reset, Baud, Full, Power, the cleaning cycles, Seek Dock, Pause, Stop: a drive command that loses its first byte must
not become one of these. A speed with such a low byte is sent a little slower."""


class LatchedSpeeds:
    """Drive commands latch in the base (it has no dead-man timer): what was sent stays until something else is."""

    def __init__(self, deadline_s: float = DEADLINE_S, speed_cap_mm_s: float = SPEED_CAP_MM_S) -> None:
        self._deadline_s, self._speed_cap_mm_s = deadline_s, speed_cap_mm_s
        self.sent, self._sent_s = STOP, 0.0
        self._until_s: float | None = None
        self._still_frames = STILL_FRAMES
        self._told_to_turn_s: float | None = None
        self._stopped_s: float | None = None

    @property
    def still(self) -> bool:
        """The encoders stand."""
        return self._still_frames >= STILL_FRAMES

    def heard(self, old: BaseState | None, new: BaseState) -> None:
        moved = old is not None and (old.left_count, old.right_count) != (new.left_count, new.right_count)
        self._still_frames = 0 if moved else self._still_frames + 1

    def stalled(self, now: float) -> bool:
        """The wheels stand although they were told to turn some time ago."""
        return self.still and self._told_to_turn_s is not None and now - self._told_to_turn_s >= STANDING_S

    def ask(self, wanted: WheelSpeeds, now: float) -> tuple[WheelSpeeds, bool]:
        """Return the speeds that can be driven, and whether they have to be sent now."""
        speeds = possible(wanted, self._speed_cap_mm_s)
        self._until_s = now + self._deadline_s
        settled = speeds == self.sent and (now - self._sent_s < REPEAT_S or (speeds.still and self.still))
        if not settled:
            self._note(speeds, now)
        return speeds, not settled

    def overdue(self, now: float) -> bool:
        """Past the deadline stop, and again until the encoders stand: one lost byte must not leave the base driving."""
        if self._until_s is None or now <= self._until_s:
            return False
        if self.sent.still and self.still:
            self._until_s = None
            return False
        if self.sent.still and now - self._sent_s < REPEAT_S:
            return False
        self._note(STOP, now)
        return True

    def runs_on(self, now: float) -> bool:
        """The wheels turn although they were told to stand; says so once every while."""
        if self._stopped_s is None or self.still or now - self._stopped_s < RUNS_ON_S:
            return False
        self._stopped_s = now
        return True

    def hand_over(self) -> None:
        """Another controller drives, or the base has been stopped by other means."""
        self.started_anew()
        self._until_s = None

    def started_anew(self) -> None:
        """Start has stopped the wheels; a speed that is still wanted will be asked for again."""
        self.sent, self._told_to_turn_s, self._stopped_s = STOP, None, None

    def _note(self, speeds: WheelSpeeds, now: float) -> None:
        if speeds.still or self.sent.still:
            self._told_to_turn_s = None if speeds.still else now
        if not speeds.still or self._stopped_s is None:
            self._stopped_s = now if speeds.still else None
        self.sent, self._sent_s = speeds, now


def possible(wanted: WheelSpeeds, cap_mm_s: float = SPEED_CAP_MM_S) -> WheelSpeeds:
    """The nearest speeds that the base does well: whole mm/s, none between 0 and 30, none above the cap.

    Too fast a pair is scaled as one, so that the curve stays the same.
    """
    fastest = max(abs(wanted.left_mm_s), abs(wanted.right_mm_s))
    share = min(1.0, cap_mm_s / fastest) if fastest else 1.0
    return WheelSpeeds(_possible(wanted.left_mm_s * share), _possible(wanted.right_mm_s * share))


def _possible(speed_mm_s: float) -> int:
    size = abs(speed_mm_s)
    if size < SLOWEST_MM_S / 2:
        return 0
    whole = round(max(size, SLOWEST_MM_S))
    sign = 1 if speed_mm_s > 0 else -1
    while sign * whole & 0xFF in RISKY_BYTES:
        whole -= 1
    return sign * whole
