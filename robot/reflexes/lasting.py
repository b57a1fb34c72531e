"""Senses that need time: wheels that stand, wheels that slip, diodes that never change."""

from dataclasses import dataclass

from robot.drivers.interfaces import NOTHING_SEEN, STOP, BaseState, LineReading, WheelSpeeds

STRAIGHT = 0.8
"""Slower over faster wheel from which on it drives straight: in a turn the caster's bit is always 0 (packet 58)."""
PROGRESS = 0b01
"""Bit 0 of packet 58: the caster turns. Bit 1: its sensor is dirty, and slipping cannot be told."""


def impossible(reading: LineReading) -> bool:
    """Both outer diodes over the line and the centre not: one tape cannot, and a fork only for a moment."""
    return reading.left and reading.right and not reading.centre


@dataclass(slots=True)
class Lasting:
    """Stepped once a tick with what was sent at the tick before; its fields go into `Senses` as they are."""

    standing: bool = False
    slipping_s: float = 0.0
    constant_mm: float = 0.0
    impossible_mm: float = 0.0
    impossible_reads: int = 0
    """The number of times so far, for the technician who looks after the sensor."""
    _reading: LineReading = NOTHING_SEEN
    _travelled_mm: float = 0.0
    _caster_works: bool = False
    """Its bit was seen set since the start: on some bases it never is."""
    _seen: object = None

    def feel(self, old: BaseState, new: BaseState, sent: WheelSpeeds) -> None:
        """One new frame of the base, and what it was told to do meanwhile."""
        left_stands, right_stands = old.left_count == new.left_count, old.right_count == new.right_count
        self.standing = (sent.left_mm_s != 0 and left_stands) or (sent.right_mm_s != 0 and right_stands)
        if new.stasis & PROGRESS:
            self._caster_works = True
        if new.stasis or sent.still or not self._caster_works:
            self.slipping_s = 0.0
        elif _straight_ahead(sent) and not (left_stands or right_stands):
            self.slipping_s += new.at_s - old.at_s

    def look(self, reading: LineReading, travelled_mm: float, marker: object, driven: bool = True) -> None:
        """Take in what the diodes and the camera saw last, and the way so far by the encoders.

        `driven`: by us. A person who pushes the robot across a hall says nothing about its diodes.
        """
        way_mm = travelled_mm - self._travelled_mm if driven else 0.0
        self._travelled_mm = travelled_mm
        if reading != self._reading or marker is not self._seen:
            self._seen = marker
            self.slipping_s = 0.0
        if reading != self._reading:
            self._reading = reading
            self.constant_mm = 0.0
        else:
            self.constant_mm += way_mm
        if not impossible(reading):
            self.impossible_mm = 0.0
            return
        self.impossible_reads += 1
        self.impossible_mm += way_mm

    def start_again(self) -> None:
        """A person has looked and re-armed the robot: what was noticed before does not count any more."""
        self.standing, self.slipping_s = False, 0.0
        self.constant_mm = self.impossible_mm = 0.0


def _straight_ahead(sent: WheelSpeeds) -> bool:
    slower, faster = sorted(sent)
    return slower > STOP.left_mm_s and slower >= STRAIGHT * faster
