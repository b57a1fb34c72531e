"""The computer: packages, settings, disk, clock, supply."""

import importlib.util
import os
import shutil
import subprocess
import time
from contextlib import suppress
from statistics import median

from bdi import BdiError
from maps import CampusMapError
from robot.core.config import ConfigError
from robot.ops.assembly import check_settings
from robot.ops.doctor.findings import Finding, Subjects, fail, ok, skip, warn
from robot.ops.host import DISK_LOW_MB, THROTTLED_FILE

NEEDED = (
    "serial",
    "gpiozero",
    "numpy",
    "cv2",
    "websockets",
    "httpx",
    "pydantic",
    "cryptography",
    "segno",
    "structlog",
    "typer",
    "rich",
    "lark",
    "tomlkit",
)
BETTER = {"zxingcpp": "markers are then read by OpenCV, twenty times slower and less surely"}
ON_A_PI = "lgpio"
LITTLE_FREE_MB = 1000.0
SYNCS, SLOW_SYNC_MS = 5, 500.0
COMMAND_LIMIT_S = 3.0
MODEL = "proc/device-tree/model"
# get_throttled (Raspberry Pi documentation, "vcgencmd").
THROTTLED = {
    0: "too little voltage now",
    1: "slowed down now",
    2: "throttled now",
    3: "too hot now",
    16: "too little voltage since the start",
    17: "slowed down since the start",
    18: "throttled since the start",
    19: "too hot since the start",
}
NOW = 0b1111


def packages(patient: Subjects) -> Finding:
    """Check whether every Python package that the daemon needs can be found."""
    is_pi = "raspberry pi" in (patient.text(MODEL) or "").lower()
    needed = (*NEEDED, ON_A_PI) if is_pi and not patient.equipment.simulated else NEEDED
    if missing := [name for name in needed if importlib.util.find_spec(name) is None]:
        return fail(f"not installed: {', '.join(missing)}", "Run: make setup-robot")
    if worse := [f"{name} ({why})" for name, why in BETTER.items() if importlib.util.find_spec(name) is None]:
        return warn(f"not installed: {', '.join(worse)}", "Run: make setup-robot")
    return ok(f"all {len(needed) + len(BETTER)} there")


def settings(patient: Subjects) -> Finding:
    """Run `settings --check`, map, home dock, agent program and token file included."""
    try:
        check_settings(patient.settings)
    except (ConfigError, CampusMapError, BdiError) as problem:
        return fail(str(problem), "Correct it; `python -m robot settings` shows every key.")
    if patient.source is None:
        return warn("no file: every setting has its default", "Give --config FILE.")
    return ok(f"{patient.source}: robot {patient.settings.name} on map {patient.settings.map}")


def disk(patient: Subjects) -> Finding:
    """Room for the robot's memory, and whether what is written reaches the disk."""
    folder = patient.settings.data
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        free_mb = shutil.disk_usage(folder).free / 1e6
        sync_ms = _sync_ms(patient)
    except OSError as error:
        return fail(f"{folder} cannot be written: {error.strerror}", "Give it to the robot's user, or set data.")
    said = f"{free_mb:.0f} MB free at {folder}; a full sync takes {sync_ms:.0f} ms"
    if free_mb < DISK_LOW_MB:
        return fail(said, "Free some: the robot could not remember its mail.")
    if folder.stat().st_mode & 0o077:
        return warn(f"others may read {folder}, where codes and addresses of people lie", f"chmod 700 {folder}")
    if free_mb < LITTLE_FREE_MB:
        return warn(said, "Free some.")
    return warn(said, "The card is slow or worn: use another.") if sync_ms > SLOW_SYNC_MS else ok(said)


def _sync_ms(patient: Subjects) -> float:
    file = patient.settings.data / ".doctor"
    took_s = []
    try:
        for _ in range(SYNCS):
            began_s = time.perf_counter()
            with file.open("wb") as out:
                out.write(bytes(4096))
                out.flush()
                os.fsync(out.fileno())
            took_s.append(time.perf_counter() - began_s)
    finally:
        file.unlink(missing_ok=True)
    return 1000 * median(took_s)


def clock(patient: Subjects) -> Finding:
    """Codes expire and records are dated: the time of day must be right. A Pi has no clock that runs without power."""
    if (patient.root / "run/systemd/timesync/synchronized").exists():
        return ok("synchronised")
    told = _asked(patient, "timedatectl", "show", "--property=NTPSynchronized", "--value")
    if told == "yes":
        return ok("synchronised")
    way_out = "timedatectl set-ntp true, and let it reach a time server."
    if told == "no":
        return fail("the clock is not synchronised: codes may count as expired", way_out)
    return warn("nothing here says whether the clock is synchronised", way_out)


def supply(patient: Subjects) -> Finding:
    """Voltage and heat of the computer, now and since its start."""
    bits = _throttled(patient)
    if bits is None:
        return skip("this computer does not tell")
    said = ", ".join(words for bit, words in THROTTLED.items() if bits >> bit & 1)
    way_out = "Give the computer 5.1 V and 3 A of its own (docs/how-to/wire-a-robot.md), and air."
    if bits & NOW:
        return fail(said, way_out)
    return warn(said, way_out) if said else ok("never too little voltage, never too hot")


def _throttled(patient: Subjects) -> int | None:
    told = patient.text(str(THROTTLED_FILE.relative_to("/")))
    if told is None:
        answer = _asked(patient, "vcgencmd", "get_throttled")
        told = answer.partition("=")[2] if answer else None
    with suppress(ValueError):
        return int(told, 16) if told else None
    return None


def _asked(patient: Subjects, *command: str) -> str | None:
    """Return what a program of this system prints; None where there is none, or where the system is a made-up one."""
    if patient.root.resolve().parent != patient.root.resolve():
        return None
    try:
        asked = subprocess.run(command, capture_output=True, text=True, timeout=COMMAND_LIMIT_S, check=True)
    except (OSError, subprocess.SubprocessError):
        return None
    return asked.stdout.strip()
