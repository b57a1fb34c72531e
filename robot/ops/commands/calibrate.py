"""`calibrate`: measure this robot, and write what was found into its settings."""

import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext, suppress
from typing import Annotated, Any, NoReturn

import typer

from robot.core.config import ConfigError, Settings
from robot.core.errors import PortAbsent, PortBusy, RobotError
from robot.core.json_socket import NoAnswer, ask
from robot.core.line_pins import open_pins
from robot.core.settings_file import write_settings
from robot.drivers.create2.create2 import Create2
from robot.drivers.interfaces import Camera, Frame
from robot.ops.calibration.line import swing
from robot.ops.calibration.optics import field_of_view_deg
from robot.ops.calibration.rig import Rig
from robot.ops.calibration.wheels import CENTRE, mm_per_count, roll, spin, wheel_base_mm
from robot.ops.commands.asking import (
    INSTALLED,
    MISUSE,
    UNFINISHED,
    ConfigOption,
    refuse,
    settings_of,
    settings_path,
    simulated_bench,
)
from robot.ops.control import SOCKET_NAME
from robot.ops.equipment import Equipment, real_equipment, stepped_equipment

FRAMES, FRAMES_WITHIN_S = 10, 10.0
YesOption = Annotated[bool, typer.Option("--yes", help="Write without asking.")]
SimulatedOption = Annotated[
    bool, typer.Option("--simulated", help="A simulated robot at its first post; nothing is written.")
]
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
    simulated: SimulatedOption = False,
    yes: YesOption = False,
) -> None:
    """drive.mm_per_count: it drives straight on; you measure how far the axle has come.

    Mark the floor under a wheel's hub before and after, and measure between the marks to the millimetre.
    """

    def measure(rig: Rig, settings: Settings, equipment: Equipment) -> Found:
        before_mm = equipment.robot.driven_mm if equipment.robot else 0.0
        counts = roll(rig, length_mm, settings.drive.mm_per_count)
        if measured_mm is not None:
            mm = measured_mm
        elif equipment.robot:
            mm = equipment.robot.driven_mm - before_mm
        else:
            mm = typer.prompt("How far has it come, in mm", type=float)
        return {"drive.mm_per_count": round(mm_per_count(mm, counts), 5)}

    _with_wheels(config, simulated, yes, measure)


@cli.command()
def turn(
    config: ConfigOption = None,
    turns: Annotated[int, typer.Option(min=1, max=20, help="Full turns: more are more exact.")] = 3,
    simulated: SimulatedOption = False,
    yes: YesOption = False,
) -> None:
    """drive.wheel_base_mm: it turns on the spot over a straight piece of the line. Calibrate the distance first."""

    def measure(rig: Rig, settings: Settings, equipment: Equipment) -> Found:
        with _pins(settings, equipment) as devices:
            counts = spin(rig, lambda: int(devices[CENTRE].value), turns)
        return {"drive.wheel_base_mm": round(wheel_base_mm(counts, turns, settings.drive.mm_per_count), 2)}

    _with_wheels(config, simulated, yes, measure)


@cli.command()
def line(config: ConfigOption = None, simulated: SimulatedOption = False, yes: YesOption = False) -> None:
    """line.line_is_low, and whether the pins of left and right are exchanged: it swings once over the line.

    Put it on a straight piece of the line, the diodes over the tape. A diode that sees nothing is named.
    """

    def measure(rig: Rig, settings: Settings, equipment: Equipment) -> Found:
        with _pins(settings, equipment) as devices:
            found = swing(rig, lambda: [int(device.value) for device in devices])
        pins = (settings.line.left_pin, settings.line.right_pin)
        left, right = reversed(pins) if found.swapped else pins
        return {"line.line_is_low": found.line_is_low, "line.left_pin": left, "line.right_pin": right}

    _with_wheels(config, simulated, yes, measure)


@cli.command()
def camera(
    distance_mm: Annotated[float, typer.Argument(help="From the lens to the sheet, at right angles.")],
    config: ConfigOption = None,
    simulated: SimulatedOption = False,
    yes: YesOption = False,
) -> None:
    """camera.field_of_view_deg: from one printed marker, 80 mm wide, at a distance that you measured."""
    settings = _ready(config, simulated)
    try:
        with _equipment(settings, simulated) as equipment:
            equipment.hold_before_marker(distance_mm)
            with _opened(equipment.open_camera) as device:
                found = field_of_view_deg(list(_frames(device)), distance_mm)
    except RobotError as problem:
        _give_up(problem)
    _write(config, settings, {"camera.field_of_view_deg": round(found, 2)}, simulated, yes)


def _frames(device: Camera) -> Iterator[Frame]:
    until_s, count = time.monotonic() + FRAMES_WITHIN_S, 0
    while count < FRAMES and time.monotonic() < until_s:
        there_is_one, frame = device.read()
        if there_is_one and frame is not None:
            count += 1
            yield frame
        time.sleep(0.01)


def _with_wheels(config: Any, simulated: bool, yes: bool, measure: Callable[[Rig, Settings, Equipment], Found]) -> None:
    """The base stands afterwards, in Passive, also after a failure."""
    settings = _ready(config, simulated)
    if not simulated:
        typer.echo(
            "The wheels will turn. Make room, and stay beside it; Ctrl-C or a touch of the bumper stops it.", err=True
        )
    try:
        with (
            _equipment(settings, simulated) as equipment,
            _opened(lambda: Create2(equipment.open_port, equipment.wake_up_line)) as base,
        ):
            found = measure(Rig(base, _let_pass(equipment)), settings, equipment)
    except (RobotError, ConfigError) as problem:
        _give_up(problem)
    _write(config, settings, found, simulated, yes)


def _equipment(settings: Settings, simulated: bool) -> AbstractContextManager[Equipment]:
    return simulated_bench(stepped_equipment(settings)) if simulated else nullcontext(real_equipment(settings))


def _let_pass(equipment: Equipment) -> Callable[[float], float]:
    """Wait, or step the simulated world; both say what time it is then."""
    robot = equipment.robot
    if robot is None:
        return _wait

    def step(seconds: float) -> float:
        robot.step_until(robot.now + seconds)
        return robot.now

    return step


def _wait(seconds: float) -> float:
    time.sleep(seconds)
    return time.monotonic()


@contextmanager
def _pins(settings: Settings, equipment: Equipment) -> Iterator[Sequence[Any]]:
    devices = open_pins(settings.line, equipment.pin_factory())
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


def _ready(config: Any, simulated: bool) -> Settings:
    settings = settings_of(config)
    if simulated:
        return settings
    with suppress(NoAnswer):
        ask(settings.data / SOCKET_NAME, {"do": "status"})
        refuse("The daemon is running and holds the devices: sudo systemctl stop campus-mail-robot")
    return settings


def _give_up(problem: Exception) -> NoReturn:
    """Exit: a problem to solve first is told apart from a measurement that failed."""
    typer.echo(f"{problem}\nNothing was written.", err=True)
    raise typer.Exit(MISUSE if isinstance(problem, PortAbsent | PortBusy | ConfigError) else UNFINISHED)


def _write(config: Any, settings: Settings, found: Found, simulated: bool, yes: bool) -> None:
    """Write the result, but never a simulated robot's values into a real one's settings."""
    path = settings_path(config) or INSTALLED
    for key, new in found.items():
        section, _, name = key.partition(".")
        old = getattr(getattr(settings, section), name)
        print(f"{key:26} {old} → {new}{'' if old != new else '  (as it was)'}")
    if simulated:
        return
    if not yes and not typer.confirm(f"Write this into {path}?"):
        raise typer.Exit(UNFINISHED)
    try:
        write_settings(path, found)
    except ConfigError as problem:
        refuse(f"{problem} Nothing was written.")
