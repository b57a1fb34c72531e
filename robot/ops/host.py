"""The computer's own faults: too little voltage, a clock that jumps, a disk that fills up.

Looked at by a loop of its own, since a question to the firmware may take a while; the drive loop gets
the answer as a `HostReport`.
"""

import shutil
import subprocess
from contextlib import suppress
from pathlib import Path

from protocol.clock import Clock
from robot.drivers.interfaces import Host, HostReport

UNDER_VOLTAGE_NOW = 1 << 0
"""Bit of get_throttled (Raspberry Pi documentation, "vcgencmd"): below 4.63 V now; bit 16 is "since the start"."""
THROTTLED_FILE = Path("/sys/devices/platform/soc/soc:firmware/get_throttled")
ALARM_FILES = "hwmon*/in0_lcrit_alarm"
"""What newer kernels offer instead (driver raspberrypi-hwmon, named rpi_volt)."""
HWMON = Path("/sys/class/hwmon")
COMMAND = "vcgencmd"
COMMAND_LIMIT_S = 1.0
JUMP_S = 2.0
"""A clock that is kept by NTP is slewed; a step of so much is unexpected."""
DISK_LOW_MB = 100.0


class Computer:
    """See `interfaces.Host`: the machine that this runs on. What it does not tell counts as well."""

    def __init__(self, folder: Path, clock: Clock, system: Path = Path("/")) -> None:
        """`folder`: where the robot keeps its memory; `system`: another root of /sys, for a test with real files."""
        self._folder, self._clock = folder, clock
        self._throttled = system / THROTTLED_FILE.relative_to("/")
        self._alarms = sorted((system / HWMON.relative_to("/")).glob(ALARM_FILES))
        self._command = shutil.which(COMMAND) if system == Path("/") else None

    def under_voltage(self) -> bool:
        """See `interfaces.Host.under_voltage`."""
        with suppress(OSError, ValueError):
            return bool(int(self._throttled.read_text(), 16) & UNDER_VOLTAGE_NOW)
        for alarm in self._alarms:
            with suppress(OSError, ValueError):
                if (alarm.parent / "name").read_text().strip() == "rpi_volt":
                    return bool(int(alarm.read_text()))
        return self._command is not None and bool(self._asked(self._command) & UNDER_VOLTAGE_NOW)

    def _asked(self, command: str) -> int:
        """Prints `throttled=0x50005`."""
        with suppress(OSError, ValueError, subprocess.SubprocessError):
            answer = subprocess.run(
                [command, "get_throttled"], capture_output=True, text=True, timeout=COMMAND_LIMIT_S, check=True
            )
            return int(answer.stdout.partition("=")[2], 16)
        return 0

    def clock_ahead_s(self) -> float:
        """See `interfaces.Host.clock_ahead_s`."""
        return self._clock.utc().timestamp() - self._clock.now()

    def disk_free_mb(self) -> float:
        """See `interfaces.Host.disk_free_mb`."""
        return shutil.disk_usage(self._folder).free / 1e6


class HostWatch:
    """Looks again and again; a jump of the clock shows only between two looks."""

    def __init__(self, host: Host) -> None:
        self._host = host
        self._ahead_s: float | None = None
        """Of the clock before time, at the last look."""

    def tick(self, _: float) -> HostReport:
        """One look. What cannot be asked is no fault: a robot must not stand because a file of the system is gone.

        The time of the tick is not asked for: a loop that is late would see a jump in it.
        """
        ahead_s = self._host.clock_ahead_s()
        jumped = self._ahead_s is not None and abs(ahead_s - self._ahead_s) > JUMP_S
        self._ahead_s = ahead_s
        return HostReport(self._host.under_voltage(), jumped, self._disk_low())

    def _disk_low(self) -> bool:
        try:
            return self._host.disk_free_mb() < DISK_LOW_MB
        except OSError:
            return False
