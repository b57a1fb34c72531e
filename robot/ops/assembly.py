"""Puts a robot together from settings; for `__main__` alone. Problems are raised by name, before any wheel turns."""

import math
from contextlib import ExitStack
from dataclasses import dataclass, field, replace
from pathlib import Path

from bdi import Agent, Program, parse_program
from maps import CampusMap, find_map
from maps.tags import tag_numbers
from protocol.clock import Clock
from robot.agent.actions.actions import Actions, table_for
from robot.agent.actions.hands import Hands
from robot.agent.mind import Mind
from robot.agent.navigator import Navigator
from robot.core.config import ConfigError, PerceptMode, Settings, read_token
from robot.drive_loop import DriveLoop
from robot.drive_loop.black_box import BlackBox
from robot.drivers.camera.marker_pose import Optics
from robot.drivers.camera.marker_reader import MarkerReader, MarkerWatch
from robot.drivers.create2.create2 import Create2
from robot.drivers.create2.dock_infrared import DockInfrared
from robot.drivers.create2.serial_port import SerialPort, open_serial
from robot.drivers.interfaces import BodyShape, Camera, Host, LineSensor
from robot.drivers.port_thread import PortThread
from robot.link.link import Link
from robot.mission.latched_stop import FILE_NAME as STOPS
from robot.mission.latched_stop import LatchedStop
from robot.mission.memory import Memory
from robot.mission.mission import MissionManager
from robot.mission.outbox import Outbox
from robot.mission.signatures import signer
from robot.mission.store import Store
from robot.ops.daemon import BodyWatch, Daemon
from robot.ops.hardware import line_sensor, pin_factory, real_camera, real_port
from robot.ops.host import Computer, HostWatch
from robot.ops.simulated_world import SavedWorld
from robot.simulated import (
    Build,
    CameraMount,
    DiodeMount,
    Motion,
    Options,
    Pack,
    SharedWorld,
    SimulatedHost,
    SimulatedRobot,
    World,
)

OUR_PROGRAM = Path(__file__).parents[1] / "agent" / "main.asl"


@dataclass(frozen=True)
class Simulation:
    """Options of a simulated world. `start` as in `robot.simulated.start`; None: the dock."""

    start: str | None = None
    battery_ratio: float | None = None
    seed: int = 0
    in_memory: bool = False
    """The byte machine behind an object and not behind a pseudo-terminal: quicker, for stepped time."""
    world: World | None = None
    """A world with a map, people and other robots, to put this one into; None: one of its own."""
    shared: Path | None = None
    """The file of a world in which robots of other processes are, too."""
    motion: Motion = field(default_factory=Motion)
    """How well the wheels do what they are told."""


@dataclass
class Devices:
    """The body that the daemon drives, simulated or real."""

    base: Create2 | PortThread
    line_sensor: LineSensor
    camera: Camera
    host: Host
    robot: SimulatedRobot | None = None
    world: SavedWorld | None = None


@dataclass
class Parts:
    """A robot in one piece, and what the command line wants to know of it."""

    daemon: Daemon
    mind: Mind
    navigator: Navigator
    robot: SimulatedRobot | None
    link: Link | None = None


def shape_of(settings: Settings) -> BodyShape:
    return BodyShape(
        wheel_base_mm=settings.drive.wheel_base_mm,
        mm_per_count=settings.drive.mm_per_count,
        sensor_lead_mm=settings.line.lead_mm,
        diode_spacing_mm=settings.line.spacing_mm,
    )


def load_program(settings: Settings) -> Program:
    """Our agent program, or the one that is named. Raises ConfigError, and the parser's errors with line and column."""
    path = settings.mind.program or OUR_PROGRAM
    try:
        text = path.read_text("utf-8")
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", error)
        raise ConfigError(str(path), "mind.program", f"cannot be read: {reason}", "Give another --agent.") from None
    return parse_program(text, source=str(path))


def percept_mode(settings: Settings) -> PerceptMode:
    """Drain for a foreign program, as the paper's bridge did, unless the settings say otherwise."""
    return settings.mind.percepts or (PerceptMode.DRAIN if settings.mind.program else PerceptMode.LATEST)


def assemble(settings: Settings, clock: Clock, simulation: Simulation | None) -> Parts:
    """The whole robot. What was opened before something failed is closed again."""
    with ExitStack() as closing:
        campus = simulation.world.campus if simulation and simulation.world else find_map(settings.map)
        token = read_token(_token_file(settings)) if settings.server else None
        program = load_program(settings)
        _make_folder(settings.data)
        store = Store(settings.data / "robot.db")
        closing.callback(store.close)
        devices = _devices(settings, campus, clock, simulation, closing)
        parts = join(settings, campus, clock, store, devices, program=program)
        _put_down(parts, devices, simulation)
        if settings.server and token:
            parts.link = _link(settings, settings.server, token, clock, parts)
        parts.daemon.close_devices = closing.pop_all().close
        return parts


def check_settings(settings: Settings) -> None:
    """Everything that can be judged without a robot. Raises what `assemble` would."""
    campus = find_map(settings.map)
    _home(settings, campus)
    _mailroom(settings, campus)
    load_program(settings)
    if settings.server:
        read_token(_token_file(settings))
    if settings.key_file:
        signer(settings.key_file, settings.name)


def _make_folder(path: Path) -> None:
    try:
        path.mkdir(mode=0o700, parents=True, exist_ok=True)  # codes and addresses of people lie there
    except OSError as error:
        raise ConfigError(str(path), "data", f"no folder can be made there: {error.strerror}", "Give --data.") from None


def _home(settings: Settings, campus: CampusMap) -> str | None:
    """The place on the track where it rests: a bay, or a post that has a dock. On a map with bays the service gives
    it."""
    home, track = campus.track.home_at(settings.home), campus.track
    if settings.home is None and settings.server and track.home_bays:
        return None
    if home is None and settings.home is not None:
        if settings.home not in track.posts:
            posts = ", ".join(campus.posts)
            raise ConfigError("settings", "home", f"map {campus.name} has no post {settings.home}", f"Posts: {posts}.")
        homes = ", ".join(place.name for place in track.homes) or "none"
        raise ConfigError("settings", "home", f"{settings.home} is no home on map {campus.name}", f"Homes: {homes}.")
    return home


def _mailroom(settings: Settings, campus: CampusMap) -> str | None:
    if settings.mailroom is not None and settings.mailroom not in campus.posts:
        posts = ", ".join(campus.posts)
        raise ConfigError(
            "settings", "mailroom", f"map {campus.name} has no post {settings.mailroom}", f"Posts: {posts}."
        )
    return settings.mailroom


def _token_file(settings: Settings) -> Path:
    if settings.token_file is None:
        raise ConfigError("settings", "token_file", "a server needs a token", "Give --token-file FILE.")
    return settings.token_file


def _devices(
    settings: Settings, campus: CampusMap, clock: Clock, simulation: Simulation | None, closing: ExitStack
) -> Devices:
    if simulation is None:
        return _real_devices(settings, clock, closing)
    shared = None
    if simulation.shared:
        shared = SharedWorld(campus, simulation.shared, settings.name, simulation.seed)
        closing.callback(shared.close)
        simulation = replace(simulation, world=shared)
    robot = simulated_robot(settings, campus, clock, simulation)
    closing.callback(robot.close)
    saved = SavedWorld(robot, settings.data / "world.json")
    closing.callback(saved.close)
    if shared and shared.left:
        saved.restore_place(shared.left)

    def open_port() -> SerialPort:
        return robot.memory_port() if simulation.in_memory else open_serial(robot.port_path)

    base = Create2(open_port, robot.brc, settings.drive.velocity_deadline_s)
    sensor = line_sensor(settings, robot.pin_factory)
    host = SimulatedHost(robot.faults, clock)
    return Devices(base, sensor, robot.camera, host, robot, saved)


def simulated_robot(settings: Settings, campus: CampusMap, clock: Clock, simulation: Simulation) -> SimulatedRobot:
    """A robot built as the settings say. Raises UnknownStart."""
    options = Options(
        build=Build(
            diodes=DiodeMount(lead_mm=settings.line.lead_mm, spacing_mm=settings.line.spacing_mm),
            pack=Pack(charger_ma=settings.battery.simulated_charger_ma),
            motion=simulation.motion,
        ),
        camera=_camera_mount(settings),
    )
    return SimulatedRobot(
        campus,
        clock.now(),
        simulation.start or "dock",
        simulation.seed,
        in_memory=simulation.in_memory,
        options=options,
        battery_ratio=simulation.battery_ratio,
        capacity_mah=settings.battery.simulated_capacity_mah,
        world=simulation.world,
    )


def _camera_mount(settings: Settings) -> CameraMount:
    """The simulated camera of these settings. Grey is all that the decoder looks at."""
    camera = settings.camera
    return CameraMount(
        across_rad=math.radians(camera.field_of_view_deg),
        colour=False,
        april_tags=camera.april_tags,
        width_px=camera.width_px,
        height_px=camera.height_px,
    )


def _real_devices(settings: Settings, clock: Clock, closing: ExitStack) -> Devices:
    """Each is closed again if a later one cannot be opened."""
    wake_up_line, open_port = real_port(settings)
    base = PortThread(Create2(open_port, wake_up_line, settings.drive.velocity_deadline_s), clock.now)
    closing.callback(base.close)
    sensor = line_sensor(settings, pin_factory())
    closing.callback(sensor.close)
    frames = real_camera(settings)
    closing.callback(frames.close)
    base.start()
    return Devices(base, sensor, frames, Computer(settings.data, clock))


def join(
    settings: Settings, campus: CampusMap, clock: Clock, store: Store, devices: Devices, *, program: Program
) -> Parts:
    """Devices, body, duties, navigator, agent: each knows only those before it."""
    shape, now = shape_of(settings), clock.now()
    sign = signer(settings.key_file, settings.name) if settings.key_file else None
    missions = MissionManager(
        store, Memory(store), Outbox(store), clock.utc, mailroom=_mailroom(settings, campus), sign=sign
    )
    black_box = BlackBox(settings.data / "black_box", clock.utc)
    devices.base.listen_in(black_box.heard, black_box.sent)
    stops = LatchedStop(settings.data / STOPS)
    drive = DriveLoop(
        devices.base,
        devices.line_sensor,
        shape,
        now,
        missions.held.faults | stops.read(),
        1 / settings.rates.drive_hz,
        black_box,
        (DockInfrared(devices.base),),
    )
    track = campus.track
    navigator = Navigator(track, _home(settings, campus), missions, now, shape)
    hands = Hands(drive, navigator, missions, settings.drive.cruise_mm_s, settings.drive.turn_mm_s, shape)
    mode = percept_mode(settings)
    mind = Mind(Agent(program, name=settings.name), Actions(hands, table_for(mode)), hands, settings, mode)
    mind.note = black_box.note
    tags = tag_numbers(campus) if settings.camera.april_tags else None
    reader = MarkerReader(track.posts, Optics(settings.camera.field_of_view_deg), shape, tags=tags)
    watch = MarkerWatch(devices.camera, reader, now)
    body = BodyWatch(HostWatch(devices.host), stops, black_box)
    daemon = Daemon(devices.base, drive, watch, mind, settings.rates, body, devices.world)
    if isinstance(devices.base, PortThread):
        daemon.urgent = devices.base.urgent
    return Parts(daemon, mind, navigator, devices.robot)


def _put_down(parts: Parts, devices: Devices, simulation: Simulation | None) -> None:
    """Tell a robot that is put down at POST:TOWARDS its place; one that goes on from a saved world knows by itself."""
    if simulation and simulation.start and devices.world and not devices.world.restored:
        post, _, towards = simulation.start.partition(":")
        if towards and post != "dock":
            parts.navigator.place(post, towards)


def _link(settings: Settings, url: str, token: str, clock: Clock, parts: Parts) -> Link:
    missions = parts.mind.hands.missions
    link = Link(
        url=url,
        token=token,
        robot=settings.name,
        clock=clock,
        outbox=missions.outbox,
        memory=missions.memory,
        hello_source=parts.daemon.hello,
        stop_at_once=parts.daemon.drive.emergency_stop,
    )
    missions.join(link)
    parts.mind.said = link.say
    parts.daemon.server = link
    return link
