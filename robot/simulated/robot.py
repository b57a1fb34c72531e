"""A simulated robot as the daemon meets it: serial port, pins, camera, in a world that moves when it is stepped."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from random import Random
from typing import Any

from gpiozero.pins.mock import MockFactory

from maps import CampusMap
from maps.tags import tag_numbers
from robot.simulated.base import firmware_text
from robot.simulated.base.battery import CURRENT_MA, Battery
from robot.simulated.base.serial_line import MemoryLine, MemoryPort, PtyLine
from robot.simulated.body import Body, Build
from robot.simulated.camera import SHOWN_FOR_S, SimulatedCamera
from robot.simulated.errors import WrongValue
from robot.simulated.faults import Faults
from robot.simulated.frames import CameraMount, Renderer, View
from robot.simulated.obstacles import Obstacle
from robot.simulated.start import Pose, start_pose
from robot.simulated.world import World

BUMP_S = 0.5
FAULT_TEXT = firmware_text.FAULT.decode()
SIDES = {"left": ("left",), "right": ("right",), "both": ("left", "right")}
BUTTONS = {"clean": 1, "spot": 2, "dock": 4}  # packet 18


@dataclass(frozen=True)
class Options:
    """The construction of the robot and its surroundings. `gap_m` > 0 leaves holes of that length in the tape."""

    build: Build = field(default_factory=Build)
    camera: CameraMount = field(default_factory=CameraMount)
    obstacles: tuple[Obstacle, ...] = ()
    gap_m: float = 0.0


class SimulatedRobot:
    """One robot in a world of its own, or in `world` together with others.

    `clock_now` is the present time of the caller of `step_until`. The serial port is a pseudo-terminal
    (`port_path`, optionally linked from `link`), or with `in_memory` an object (`memory_port()`) for stepped time.
    Same seed, same steps and same inputs give the same outputs. Raises UnknownStart.
    """

    def __init__(
        self,
        campus: CampusMap,
        clock_now: float,
        start: str = "dock",
        seed: int = 0,
        *,
        in_memory: bool = False,
        options: Options | None = None,
        battery_ratio: float | None = None,
        capacity_mah: float | None = None,
        world: World | None = None,
        link: Path | None = None,
    ) -> None:
        options = options or Options()
        pose = start_pose(campus, start)
        self.world = world or World(campus, options.obstacles, options.gap_m, seed)
        self.faults = Faults()
        line_random = Random(f"{seed}/baud")
        self._line = MemoryLine(line_random) if in_memory else PtyLine(line_random, link)
        build = _with_pack(options.build, battery_ratio, capacity_mah)
        self._body = Body(self.world, build, self._line, faults=self.faults, seed=seed, now=clock_now)
        self._body.place(pose.x_m, pose.y_m, pose.heading_rad)
        renderer = Renderer(
            self.world.markers,
            options.camera,
            self.faults,
            seed,
            {post: tag for tag, post in tag_numbers(campus).items()} if options.camera.april_tags else None,
            lambda: self.world.obstacles,
            lambda: self.world.others(self._body),
        )
        self._renderer = renderer
        self.camera = SimulatedCamera(renderer, self._view, lambda: self._body.now, self.faults)
        self.brc = BrcPin(self._body)
        # Called at the beginning of every `step_until`: how the door gets its word in between two steps.
        self.before_steps: list[Callable[[], None]] = []

    # What the daemon holds ---------------------------------------------------------------------------------------

    @property
    def port_path(self) -> str:
        """The path to give to pyserial."""
        if isinstance(self._line, MemoryLine):
            raise WrongValue("port_path", "in_memory", "a robot with a pseudo-terminal; use memory_port()")
        return self._line.path

    def memory_port(self) -> MemoryPort:
        """The host's end of the cable in stepped time."""
        if isinstance(self._line, PtyLine):
            raise WrongValue("memory_port", self._line.path, "a robot made with in_memory=True; use port_path")
        return self._line.port

    @property
    def pin_factory(self) -> MockFactory:
        """For every gpiozero device: `DigitalInputDevice(14, pin_factory=robot.pin_factory)`."""
        return self._body.pins.factory

    def step_until(self, now: float) -> None:
        """Let the world go on to this time, in steps of 5 ms."""
        for word in self.before_steps:
            word()
        self._body.step_until(now)

    @property
    def now(self) -> float:
        """The time the world has reached."""
        return self._body.now

    def unplug(self) -> None:
        """Pull the serial cable."""
        self._line.close()

    def plug_in(self) -> None:
        """Put the serial cable in again; `port_path` or `memory_port()` is a new one."""
        self._line.plug_in()

    def reset_base(self) -> None:
        """The firmware starts anew, as after a moment without power."""
        self._body.interface.reset(b"")

    def close(self) -> None:
        self.world.robots.remove(self._body)
        self._line.close()
        self.camera.release()
        self._body.pins.close()

    # What the world does to it -----------------------------------------------------------------------------------

    @property
    def battery(self) -> Battery:
        return self._body.battery

    @property
    def body(self) -> Body:
        """The inside, for tests and viewers."""
        return self._body

    def set_fault(self, name: object, value: object) -> None:
        """Turn a switch of `faults.SWITCHES`. Raises UnknownSwitch, WrongValue."""
        self.faults.set(name, value)
        if name == "dirt":
            self._renderer.forget_sheets()

    def bump(self, side: str, for_s: float = BUMP_S) -> None:
        """Press the bumper at `left`, `right` or `both`, for so long."""
        if side not in SIDES:
            raise WrongValue("side", side, "left, right or both")
        for one in SIDES[side]:
            self._body.bumped_until_s[one] = self.now + for_s

    def press(self, button: str) -> None:
        """Press `clean`, `spot` or `dock`, as a finger does."""
        if button not in BUTTONS:
            raise WrongValue("button", button, "clean, spot or dock")
        self._body.interface.press_buttons(bytes((BUTTONS[button],)))

    def soil(self, shares: Mapping[str, float]) -> None:
        """Cover the markers of each of these posts with dirt, to this share."""
        self._renderer.dirt = dict(shares)
        self._renderer.forget_sheets()

    def lift(self, on: bool) -> None:
        """Both wheels hang down, as when a person picks the robot up."""
        self.set_fault("wheel_drop_left", on)
        self.set_fault("wheel_drop_right", on)

    def cliff(self, on: bool) -> None:
        """Both front cliff sensors see no floor."""
        self.set_fault("cliff_front_left", on)
        self.set_fault("cliff_front_right", on)

    def sag(self, ratio: float) -> None:
        """The battery suddenly holds this share of its capacity."""
        self.battery.sag(ratio)

    def place(self, pose: Pose) -> None:
        """A person carries the robot somewhere else."""
        self._body.handled += 1
        self._body.place(pose.x_m, pose.y_m, pose.heading_rad)

    def push(self, ahead_mm: float) -> None:
        """Shove the robot along its heading; its encoders count up, whichever way."""
        self._body.handled += 1
        self._body.base.push(ahead_mm)
        self._body.place(self._body.base.x_m, self._body.base.y_m, self._body.base.heading_rad)

    def print_text(self, text: str = FAULT_TEXT) -> None:
        """The firmware prints a line of its own between two packets."""
        self._body.interface.print_text(text.encode())

    def show_code(self, text: str, for_s: float = SHOWN_FOR_S) -> None:
        """A person holds the text up to the camera as a QR code."""
        self.camera.show(text, for_s)

    def hide_code(self) -> None:
        self.camera.hide()

    # What can be seen from outside -------------------------------------------------------------------------------

    @property
    def pose(self) -> Pose:
        base = self._body.base
        return Pose(base.x_m, base.y_m, base.heading_rad)

    @property
    def driven_mm(self) -> float:
        """The way over the floor so far, forward and backward."""
        return self._body.base.driven_mm

    @property
    def docked(self) -> bool:
        return self._body.docked

    def tunes_since(self, number: int) -> tuple[int, list[tuple[int, ...]]]:
        """Return what its speaker has played since the `number` that the last call gave (0 at first), as MIDI
        numbers."""
        book = self._body.interface.actuators.songs
        number = min(number, len(book.played))  # a reset forgets all songs
        notes = [tuple(note for note, _ in book.songs.get(song, ())) for song in book.played[number:]]
        return len(book.played), notes

    def state(self) -> dict[str, Any]:
        """Everything about the robot, ready for JSON."""
        body, pose = self._body, self.pose
        return {
            "time_s": self.now,
            "pose": {"x_m": pose.x_m, "y_m": pose.y_m, "heading_rad": pose.heading_rad},
            "distance_m": self.driven_mm / 1000,
            "battery": {
                "ratio": self.battery.ratio,
                "charging": self.battery.state in CURRENT_MA,
                "charging_state": int(self.battery.state),
                "voltage_mv": self.battery.voltage_mv,
            },
            "docked": body.docked,
            "mode": body.interface.mode.name.lower(),
            "asleep": body.interface.asleep,
            "wheels_mm_s": [body.base.left.speed_mm_s, body.base.right.speed_mm_s],
            "faults": self.faults.on(),
            "shown_code": self.camera.shown,
        }

    def _view(self) -> View:
        base = self._body.base
        left, right = base.left.speed_mm_s, base.right.speed_mm_s
        return View(base.x_m, base.y_m, base.heading_rad, (left + right) / 2000, (right - left) / 235)


class BrcPin:
    """The BRC line of the serial plug, held low or let go, as an object that can be handed to a driver."""

    wired = True

    def __init__(self, body: Body) -> None:
        self._body = body

    def low(self, on: bool) -> None:
        """A low of 50 ms or more wakes the robot when it ends."""
        self._body.interface.brc(on, self._body.now)


def _with_pack(build: Build, ratio: float | None, capacity_mah: float | None) -> Build:
    given: dict[str, float] = {} if ratio is None else {"ratio": ratio}
    if capacity_mah is not None:
        given["capacity_mah"] = capacity_mah
    return replace(build, pack=replace(build.pack, **given))
