"""The fifty-times-a-second loop that keeps the wheels, in four parts: `loop` joins `sensing`, `jobs` and `wheels`."""

from robot.drive_loop.loop import DriveLoop

__all__ = ["DriveLoop"]
