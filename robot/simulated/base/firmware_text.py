"""The text that the firmware prints on the same line as the packets, as field reports have it ([F])."""

from robot.simulated.base.packets import Readings

SOFT_RESET = b"Soft reset!\n"
# (seconds after the Reset command, bytes). The robot hears nothing until the last of them.
BOOT = (
    (0.015, SOFT_RESET),
    (1.0, b"\xfe"),
    (3.0, b"Roomba by iRobot!\r\nstm32\r\n2018-07-19-1005-L   \r\nbattery-current-zero 253\r\n"),
    (
        4.0,
        b"\r\n2018-07-19-1005-L   \r\nr3-robot/tags/release-stm32-3.7.7:6913 CLEAN\r\n\r\nbootloader id: #x47135160\r\n"
        b"assembly: 3.5-lite-batt\r\nrevision: 8\r\nflash version: 10\r\nflash info crc passed: 1\r\n\r\n"
        b"battery-current-zero 254\r\ninitial-lithium-battery-capacity: set to 2068 mAH\r\n",
    ),
)
CHARGE_BEGINS = b"Performing charger self-test\r\ndo-charging-full @ min 0\r\n"
BEGINS_AFTER_S = 1.5
SLEEP = b"processor-sleep\r\n"
FAULT = b"ERROR: language set error type 2\r\n"
CHARGER_WAKEUP = "charger-wakeup"
KEY_WAKEUP = "key-wakeup"


def wakeup(cause: str, slept_s: float) -> bytes:
    minutes, seconds = divmod(int(slept_s), 60)
    return f"{cause}\r\nslept for {minutes} minutes {seconds} seconds\r\n".encode()


class BatteryLines:
    """Lines that a charging robot prints before the interface is started."""

    def __init__(self) -> None:
        self._last_s: float | None = None

    def due(self, told: Readings, charging_s: float, now: float) -> bytes:
        """A line a second, and before the first of them that the charge begins."""
        last_s = self._last_s
        if last_s is not None and now - last_s < 1.0:
            return b""
        self._last_s = now
        begins = last_s is None or now - last_s > BEGINS_AFTER_S
        return (CHARGE_BEGINS if begins else b"") + battery_line(told, charging_s)


def battery_line(told: Readings, charging_s: float) -> bytes:
    minutes, seconds = divmod(int(charging_s), 60)
    return (
        f"bat:   min {minutes}  sec {seconds}  mV {told.voltage_mv}  mA {told.current_ma}  "
        f"tenths-deg-C {round(told.temperature_c * 10)}  mAH {told.charge_mah}  state 8  mode 7\r\n"
    ).encode()
