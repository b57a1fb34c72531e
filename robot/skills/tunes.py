"""Tunes of the robot's speaker. MIDI notes and seconds."""

from robot.drivers.interfaces import Note

ARRIVED: tuple[Note, ...] = ((72, 0.15), (76, 0.15), (79, 0.3))
ACCEPTED: tuple[Note, ...] = ((79, 0.12), (84, 0.3))
REFUSED: tuple[Note, ...] = ((55, 0.2), (50, 0.4))
BUMPED: tuple[Note, ...] = ((60, 0.1), (60, 0.1))
TUNES = {"arrived": ARRIVED, "accepted": ACCEPTED, "refused": REFUSED, "bumped": BUMPED}
