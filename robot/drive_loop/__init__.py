"""The drive loop: read, decide speeds, apply reflexes, write.

May use drivers, reflexes and skills.
Start at `loop.py`.
"""

from robot.drive_loop.loop import DriveLoop

__all__ = ["DriveLoop"]
