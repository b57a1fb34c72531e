"""Text that the firmware prints among the packets: the battery while it charges, its version when it boots."""

import re
from dataclasses import dataclass

_BATTERY = re.compile(r"^bat:\s.*\bmV (?P<mv>-?\d+)\s+mA (?P<ma>-?\d+)\b.*\bmAH (?P<mah>\d+)\b")
_VERSION = re.compile(r"release-(?:stm32-)?(\d+)\.(\d+)\.(\d+)")


@dataclass(frozen=True, slots=True)
class BatteryText:
    """The content of a `bat:` line, printed every second while the base charges and the interface is off."""

    voltage_mv: int
    current_ma: int
    charge_mah: int


def battery_text(line: str) -> BatteryText | None:
    """The figures of a `bat:` line, None for any other."""
    found = _BATTERY.match(line)
    return BatteryText(int(found["mv"]), int(found["ma"]), int(found["mah"])) if found else None


def firmware_version(line: str) -> str | None:
    """`3.7.7` out of `r3-robot/tags/release-stm32-3.7.7:6913 CLEAN`, None out of any other line."""
    found = _VERSION.search(line)
    return ".".join(found.groups()) if found else None
