"""The real devices of a robot, from its settings: for the daemon, and for commands that look at them without it.

Not tried on hardware yet: what is here is what the data sheets and the libraries' manuals say.
"""

import os
import tempfile
from collections.abc import Callable
from typing import Any

from robot.core.config import ConfigError, Settings
from robot.drivers.camera.camera import GrabbingCamera
from robot.drivers.create2.serial_port import SerialPort, open_serial
from robot.drivers.create2.wake_up import GpioWakeUpLine, NoWakeUpLine, SerialRts, WakeUpLine
from robot.drivers.line_sensor import ThreeDiodes


def pin_factory() -> Any:
    """The pins of a Raspberry Pi. Raises ConfigError elsewhere, and where lgpio or the permission is missing."""
    # lgpio makes a pipe in the working directory unless it is told another, and that one may be read-only.
    os.environ.setdefault("LG_WD", tempfile.gettempdir())
    try:
        from gpiozero.pins.lgpio import LGPIOFactory

        return LGPIOFactory()
    except Exception as error:  # lgpio has errors of its own, and is not there to name them
        way_out = "On a Raspberry Pi: make setup-robot, and join the group gpio; elsewhere: --simulated."
        raise ConfigError("this computer", "line", f"its pins cannot be used: {error}", way_out) from None


def line_sensor(settings: Settings, factory: Any) -> ThreeDiodes:
    """Three diodes on the pins of the settings."""
    line = settings.line
    return ThreeDiodes(line.left_pin, line.centre_pin, line.right_pin, factory, line.line_is_low)


def real_port(settings: Settings) -> tuple[WakeUpLine, Callable[[], SerialPort]]:
    """Return the line that pulls BRC, and how to open the port; RTS belongs to the port, so that one opens it
    itself."""
    if settings.brc == "rts":
        rts = SerialRts(settings.serial_port)
        return rts, rts.open
    return _wake_up_line(settings), lambda: open_serial(settings.serial_port)


def _wake_up_line(settings: Settings) -> WakeUpLine:
    if settings.brc == "none":
        return NoWakeUpLine()
    from gpiozero import DigitalOutputDevice

    # BRC is pulled low through a transistor or an open drain: the pin high is BRC low.
    return GpioWakeUpLine(DigitalOutputDevice(settings.brc, initial_value=False, pin_factory=pin_factory()))


def real_camera(settings: Settings) -> GrabbingCamera:
    """Raises CameraAbsent."""
    camera = settings.camera
    return GrabbingCamera(camera.device, camera.width_px, camera.height_px, camera.exposure_ms)
