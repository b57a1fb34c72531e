"""Statistics for a technician about the cable and the firmware at its other end."""

from dataclasses import dataclass

from robot.drivers.create2.firmware_text import BatteryText, battery_text, firmware_version

KEPT_LINES = 20


@dataclass
class LinkHealth:
    """Counts since the daemon started."""

    frames: int = 0
    corrupt: int = 0
    """Frames that were damaged on the way."""
    starts: int = 0
    reconnections: int = 0
    problem: str | None = None
    """Why the port cannot be used now."""
    silent_s: float = 0.0
    """Since the last frame of the base (or since the daemon started)."""
    down: bool = False
    """Silent for more than a minute, whatever was tried: a technician has to look. Nothing that the base said before
    holds any more, its charging least of all."""
    awoken_by: str | None = None
    """Which step of the start ladder ended the last silence."""
    spoke_at_baud: int | None = None
    """The base was found at another speed, and set back."""
    tells_mode: bool = True
    """False for old firmware without packet 35."""
    firmware: str | None = None
    """Its version, once it has printed it (after a reset)."""
    battery_text: BatteryText | None = None
    firmware_lines: tuple[str, ...] = ()
    """The last few lines that the firmware printed."""

    def take_lines(self, lines: list[str]) -> None:
        """Take in the lines that the firmware printed."""
        self.firmware_lines = (*self.firmware_lines, *lines)[-KEPT_LINES:]
        for line in lines:
            self.battery_text = battery_text(line) or self.battery_text
            self.firmware = firmware_version(line) or self.firmware
