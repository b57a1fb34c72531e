"""`calibrate`: measure this robot, and write what was found into its settings."""

import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from typing import Annotated, Any, NoReturn

import typer

from ..calibration.line import swing
from ..calibration.optics import field_of_view_deg
from ..calibration.rig import Rig
from ..calibration.wheels import CENTRE, mm_per_count, roll, spin, wheel_base_mm
from ..config import ConfigError, Settings
from ..control import SOCKET_NAME
from ..drivers.create2 import Create2
from ..drivers.interfaces import Camera, Frame
from ..errors import PortAbsent, PortBusy, RobotError
from ..hardware import pin_factory, real_camera, real_port
from ..json_socket import NobodyAnswers, ask
from ..line_pins import open_pins
from ..settings_file import write_settings
from .asking import INSTALLED, MISUSE, UNFINISHED, ConfigOption, refuse, settings_of, settings_path

FRAMES, FRAMES_WITHIN_S = 10, 10.0
YesOption = Annotated[bool, typer.Option("--yes", help="Write without asking.")]
Found = dict[str, Any]

cli = typer.Typer(
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode=None,
    help="Measure this robot, show old and new, and write the settings. End the daemon first; stay beside the robot. "
    "In this order: line, distance, turn, camera. Exit status 1: the measurement failed, nothing was written.",
)


@cli.command()
def distance(
    config: ConfigOption = None,
    length_mm: Annotated[float, typer.Option(help="How far to drive, about.")] = 1000.0,
    measured_mm: Annotated[float | None, typer.Option(help="How far it was; else you are asked.")] = None,
    yes: YesOption = False,
) -> None:
    """drive.mm_per_count: it drives straight on; you measure how far the axle has come.

    Mark the floor under a wheel's hub before and after, and measure between the marks to the millimetre.
    """

    def measure(rig: Rig, settings: Settings) -> Found:
        counts = roll(rig, length_mm, settings.drive.mm_per_count)
        mm = measured_mm if measured_mm is not None else typer.prompt("How far has it come, in mm", type=float)
        return {"drive.mm_per_count": round(mm_per_count(mm, counts), 5)}

    _with_wheels(config, yes, measure)


@cli.command()
def turn(
    config: ConfigOption = None,
    turns: Annotated[int, typer.Option(min=1, max=20, help="Full turns: more are more exact.")] = 3,
    yes: YesOption = False,
) -> None:
    """drive.wheel_base_mm: it turns on the spot over a straight piece of the line. Calibrate the distance first."""

    def measure(rig: Rig, settings: Settings) -> Found:
        with _pins(settings) as devices:
            counts = spin(rig, lambda: int(devices[CENTRE].value), turns)
        return {"drive.wheel_base_mm": round(wheel_base_mm(counts, turns, settings.drive.mm_per_count), 2)}

    _with_wheels(config, yes, measure)


@cli.command()
def line(config: ConfigOption = None, yes: YesOption = False) -> None:
    """line.line_is_low, and whether the pins of left and right are exchanged: it swings once over the line.

    Put it on a straight piece of the line, the diodes over the tape. A diode that sees nothing is named.
    """

    def measure(rig: Rig, settings: Settings) -> Found:
        with _pins(settings) as devices:
            found = swing(rig, lambda: [int(device.value) for device in devices])
        pins = (settings.line.left_pin, settings.line.right_pin)
        left, right = reversed(pins) if found.swapped else pins
        return {"line.line_is_low": found.line_is_low, "line.left_pin": left, "line.right_pin": right}

    _with_wheels(config, yes, measure)


@cli.command()
def camera(
    distance_mm: Annotated[float, typer.Argument(help="From the lens to the sheet, at right angles.")],
    config: ConfigOption = None,
    yes: YesOption = False,
) -> None:
    """camera.field_of_view_deg: from one printed marker, 80 mm wide, at a distance that you measured."""
    settings = _ready(config)
    try:
        with _opened(lambda: real_camera(settings)) as device:
            found = field_of_view_deg(list(_frames(device)), distance_mm)
    except RobotError as problem:
        _give_up(problem)
    _write(config, settings, {"camera.field_of_view_deg": round(found, 2)}, yes)


def _frames(device: Camera) -> Iterator[Frame]:
    until_s, count = time.monotonic() + FRAMES_WITHIN_S, 0
    while count < FRAMES and time.monotonic() < until_s:
        there_is_one, frame = device.read()
        if there_is_one and frame is not None:
            count += 1
            yield frame
        time.sleep(0.01)


def _with_wheels(config: Any, yes: bool, measure: Callable[[Rig, Settings], Found]) -> None:
    """Whatever becomes of it, the base stands afterwards, in Passive."""
    settings = _ready(config)
    typer.echo(
        "The wheels will turn. Make room, and stay beside it; Ctrl-C or a touch of the bumper stops it.", err=True
    )
    wake_up_line, open_port = real_port(settings)
    try:
        with _opened(lambda: Create2(open_port, wake_up_line)) as base:
            found = measure(Rig(base, _wait), settings)
    except (RobotError, ConfigError) as problem:
        _give_up(problem)
    _write(config, settings, found, yes)


def _wait(seconds: float) -> float:
    time.sleep(seconds)
    return time.monotonic()


@contextmanager
def _pins(settings: Settings) -> Iterator[Sequence[Any]]:
    devices = open_pins(settings.line, pin_factory())
    try:
        yield devices
    finally:
        for device in devices:
            device.close()


@contextmanager
def _opened(opening: Callable[[], Any]) -> Iterator[Any]:
    device = opening()
    try:
        yield device
    finally:
        device.close()


def _ready(config: Any) -> Settings:
    settings = settings_of(config)
    with suppress(NobodyAnswers):
        ask(settings.data / SOCKET_NAME, {"do": "status"})
        refuse("The daemon is running and holds the devices: sudo systemctl stop campus-mail-robot")
    return settings


def _give_up(problem: Exception) -> NoReturn:
    """What has to be put right first is told apart from a measurement that failed."""
    typer.echo(f"{problem}\nNothing was written.", err=True)
    raise typer.Exit(MISUSE if isinstance(problem, PortAbsent | PortBusy | ConfigError) else UNFINISHED)


def _write(config: Any, settings: Settings, found: Found, yes: bool) -> None:
    path = settings_path(config) or INSTALLED
    for key, new in found.items():
        section, _, name = key.partition(".")
        old = getattr(getattr(settings, section), name)
        print(f"{key:26} {old} → {new}{'' if old != new else '  (as it was)'}")
    if not yes and not typer.confirm(f"Write this into {path}?"):
        raise typer.Exit(UNFINISHED)
    try:
        write_settings(path, found)
    except ConfigError as problem:
        refuse(f"{problem} Nothing was written.")
