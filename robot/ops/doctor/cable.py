"""The cable to the base: port, timer, serial console, and what the base answers."""

import os
import stat
from collections.abc import Iterator
from contextlib import suppress
from grp import getgrgid
from pathlib import Path

from robot.core.errors import PortBusy, RobotError
from robot.drivers.create2.base_watch import BaseAnswer, watch_base
from robot.ops.doctor.findings import Finding, Subjects, fail, ok, skip, warn

SERIAL_PINS = {"BOARD8", "BOARD10", "GPIO14", "GPIO15", "BCM14", "BCM15"}
CONSOLES = ("console=serial0", "console=ttyS0", "console=ttyAMA0")
CMDLINES = ("boot/firmware/cmdline.txt", "boot/cmdline.txt", "proc/cmdline")
WATCH_S = 3.0
FEWEST_FRAMES_PER_S, MOST_CORRUPT_SHARE = 60.0, 0.01
LOW_MV = 13_200


def port(patient: Subjects) -> Finding:
    """Check whether the serial port is there, may be opened, and is not held by another process."""
    name = patient.settings.serial_port
    if "://" in name:
        return skip(f"{name} is no device of this computer")
    path = Path(name)
    if not path.exists():
        return fail(f"there is no {name}", f"Plug the cable in, or set serial_port. There are: {_ports(patient)}.")
    if not stat.S_ISCHR(path.stat().st_mode):
        return fail(f"{name} is no serial port", "Set serial_port.")
    if not os.access(path, os.R_OK | os.W_OK):
        return fail(f"you may not open {name}", _way_in(path))
    if patient.daemon is None and (holders := list(_holders(patient, path))):
        way_out = "Only one program may drive the base: end the other."
        return fail(f"{name} is held by {', '.join(holders)}", way_out)
    return ok(f"{name} may be opened")


def _ports(patient: Subjects) -> str:
    folder = patient.root / "dev"
    found = sorted(str(path) for kind in ("ttyUSB*", "ttyACM*", "ttyAMA*") for path in folder.glob(kind))
    return ", ".join(found) or "none"


def _way_in(path: Path) -> str:
    with suppress(KeyError):
        return f"sudo usermod -aG {getgrgid(path.stat().st_gid).gr_name} $USER, then log in again."
    return "Install deploy/99-campus-mail.rules, which gives it to the group dialout."


def _holders(patient: Subjects, path: Path) -> Iterator[str]:
    """Programs that have the device open, as far as we may look."""
    device, ourselves = path.resolve(), str(os.getpid())
    for folder in (patient.root / "proc").glob("[0-9]*"):
        with suppress(OSError):
            held = {link.readlink() for link in (folder / "fd").iterdir()}
            if folder.name != ourselves and device in held:
                yield f"{(folder / 'comm').read_text().strip()} (process {folder.name})"


def latency(patient: Subjects) -> Finding:
    """The FTDI chip hands its bytes over every 16 ms unless told 1: longer than the base's own 15."""
    name = Path(patient.settings.serial_port).resolve().name
    told = patient.text(f"sys/bus/usb-serial/devices/{name}/latency_timer")
    if told is None:
        return skip(f"{patient.settings.serial_port} has no latency timer")
    if told == "1":
        return ok("latency timer 1 ms")
    return fail(
        f"latency timer {told} ms: frames of the base arrive late and in lumps",
        "Install deploy/99-campus-mail.rules, then: udevadm control --reload && udevadm trigger",
    )


def console(patient: Subjects) -> Finding:
    """Two diodes of the paper's robot hang on GPIO14 and 15, where a Raspberry Pi puts its serial console."""
    if patient.equipment.simulated:
        return skip("simulated diodes hang on no pin of this computer")
    line = patient.settings.line
    ours = sorted({line.left_pin, line.centre_pin, line.right_pin} & SERIAL_PINS)
    if not ours:
        return skip("no diode is on GPIO14 or GPIO15")
    said = [word for word in (patient.text(*CMDLINES) or "").split() if word.startswith(CONSOLES)]
    wants = patient.root / "etc/systemd/system/getty.target.wants"
    said += sorted(path.name for path in wants.glob("serial-getty@*.service"))
    if said:
        way_out = "sudo raspi-config nonint do_serial_cons 1, then restart; or put the diodes on other pins."
        return fail(f"the serial console is on {', '.join(ours)}, where diodes are: {', '.join(said)}", way_out)
    return ok(f"no serial console on {', '.join(ours)}")


def base(patient: Subjects) -> Finding:
    """Three seconds of the stream: frames, damage, mode, voltage, charge, firmware."""
    if patient.daemon is not None:
        return _from_daemon(patient.daemon)
    try:
        answer = watch_base(patient.equipment.open_port, patient.equipment.wake_up_line, WATCH_S * patient.patience)
    except PortBusy as problem:
        return fail(str(problem), "End the other program.")
    except RobotError as problem:
        return fail(str(problem), "See the finding on the port.")
    return _judged(answer)


def _judged(answer: BaseAnswer) -> Finding:
    if answer.state is None:
        way_out = "Press Clean to wake it; is it switched on, is the plug in its Mini-DIN socket, TX to RX?"
        return fail("not one frame of its stream was heard", way_out)
    said = _words(answer)
    share = answer.corrupt / max(1, answer.frames + answer.corrupt)
    if share > MOST_CORRUPT_SHARE:
        return fail(said, "Shorten the cable, keep it away from the motors, check ground and level shifter.")
    if answer.frames_per_s < FEWEST_FRAMES_PER_S:
        return fail(said, "66 a second are due: see the latency timer.")
    if answer.state.voltage_mv < LOW_MV:
        return warn(said, "Charge it.")
    return ok(said)


def _words(answer: BaseAnswer) -> str:
    state = answer.state
    assert state is not None  # noqa: S101  # the caller has looked
    ratio = state.battery_ratio
    return (
        f"{answer.frames_per_s:.0f} frames/s, {answer.corrupt} damaged, {state.mode.name.lower()}, "
        f"{state.voltage_mv} mV, {'charge not known' if ratio is None else f'{ratio:.0%} charged'}, "
        f"{'on the dock' if state.docked else 'off the dock'}, "
        f"firmware {answer.firmware or 'not told (it says so only after a reset)'}"
    )


def _from_daemon(told: dict[str, object]) -> Finding:
    base_, battery = told.get("base"), told.get("battery")
    if not isinstance(base_, dict) or not isinstance(battery, dict) or base_.get("mode") is None:
        return fail(f"the running daemon has heard nothing of the base: {told.get('faults')}", "See `status`.")
    return ok(f"the daemon drives it: {base_['mode']}, {battery['voltage_mv']} mV, {base_.get('frames')} frames")


def wake_up(patient: Subjects) -> Finding:
    """Check whether a pulse on BRC can be sent. That it arrives shows only when a sleeping base wakes."""
    if patient.daemon is not None:
        return skip("the running daemon holds the port")
    if patient.settings.brc == "none":
        return warn("nothing is wired to BRC (setting brc)", "A base that falls asleep must be woken by hand.")
    line = patient.equipment.wake_up_line
    try:
        port = patient.equipment.open_port()  # RTS belongs to an open port
    except RobotError:
        return skip("the port cannot be opened")
    line.low(True)
    line.low(False)
    port.close()
    if not line.wired:
        way_out = "Wire BRC (docs/how-to/wire-a-robot.md), or set brc."
        return warn(f"no pulse can be sent over {patient.settings.brc}", way_out)
    return ok(f"over {patient.settings.brc}; let it sleep once (five minutes off the dock) to see that it wakes")
