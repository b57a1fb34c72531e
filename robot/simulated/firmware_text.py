"""The text that the firmware prints on the same line as the packets, as field reports have it ([F])."""

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
        b"battery-current-zero 254\r\n",
    ),
)
SLEEP = b"processor-sleep\r\n"
FAULT = b"ERROR: language set error type 2\r\n"
CHARGER_WAKEUP = "charger-wakeup"
KEY_WAKEUP = "key-wakeup"


def wakeup(cause: str, slept_s: float) -> bytes:
    minutes, seconds = divmod(int(slept_s), 60)
    return f"{cause}\r\nslept for {minutes} minutes {seconds} seconds\r\n".encode()


def battery_line(charging_s: float, voltage_mv: int, current_ma: int, temperature_c: float, charge_mah: int) -> bytes:
    """What a charging robot prints once a second while nobody has started the interface."""
    minutes, seconds = divmod(int(charging_s), 60)
    return (
        f"bat:   min {minutes}  sec {seconds}  mV {voltage_mv}  mA {current_ma}  "
        f"tenths-deg-C {round(temperature_c * 10)}  mAH {charge_mah}  state 8  mode 7\r\n"
    ).encode()
