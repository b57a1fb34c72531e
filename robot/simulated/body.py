"""One robot's body in the world, moved on in fixed steps of 5 ms; every third one the firmware has its slot of 15 ms.

Everything random comes from seeded generators, one for each part, so that reading the camera more often does not move
the wheels.
"""

import math
from dataclasses import dataclass, field
from random import Random

from robot.simulated.base.activity import Activity, Hazards
from robot.simulated.base.battery import Battery, Pack
from robot.simulated.base.docking import Beside, SeekDock, Wheels, bearing_rad, ir_character
from robot.simulated.base.drive_base import DriveBase, Motion
from robot.simulated.base.open_interface import OpenInterface
from robot.simulated.base.packets import Readings
from robot.simulated.base.serial_line import SerialLine, spoiled, thinned
from robot.simulated.faults import Faults
from robot.simulated.obstacles import BUMPER_RADIUS_M, Contact, contact, light_signals
from robot.simulated.pins import DiodeMount, LinePins
from robot.simulated.true_poses import TruePose
from robot.simulated.world import World

STEP_S = 0.005
STEPS_PER_SLOT = 3
SLOT_S = STEP_S * STEPS_PER_SLOT
IDLE_MOTOR_MA, DRIVING_MOTOR_MA, BLOCKED_MOTOR_MA = 0, 300, 1200
OVER_CURRENT_AFTER_S = 1.0
TOUCH_M = 0.002
CLEANING_MM_S: Wheels = (120.0, 200.0)
CLIFF_SIGNAL, FLOOR_SIGNAL = 0, 2800
DAZZLED_SIGNAL = 1000
VIRTUAL_WALL_IR = 162
# The directional receivers see this far to their own side and a little across [A].
IR_SIDE_RAD, IR_ACROSS_RAD = math.radians(100), math.radians(15)
BOUNCE_SLOTS = 8
DISTANCE_BUG = 0.1  # before 3.3.0 millimetres were told wrong [S]; by how much is assumed [A]
ANGLE_BUG = 0.324056  # firmware up to 3.4.0 tells angles too small by this factor [F]


@dataclass(frozen=True)
class Build:
    """The construction of this robot."""

    motion: Motion = field(default_factory=Motion)
    pack: Pack = field(default_factory=Pack)
    diodes: DiodeMount = field(default_factory=DiodeMount)


class Body:
    """Wheels, bumper, battery, pins and byte machine of one robot; `step` moves all of them on together."""

    def __init__(self, world: World, build: Build, line: SerialLine, *, faults: Faults, seed: int, now: float) -> None:
        self.world = world
        self.faults = faults
        self.readings = Readings()
        self.base = DriveBase(build.motion, STEP_S, Random(f"{seed}/wheels"))
        self.battery = Battery(build.pack)
        self.pins = LinePins(world.floor, build.diodes, faults, Random(f"{seed}/floor"))
        self.interface = OpenInterface(self.readings, faults, now)
        self.line = line
        self.bumped_until_s = {"left": now, "right": now}
        self.docked = False
        self.handled = 0
        """How often a person has carried or pushed the robot."""
        self._seek: SeekDock | None = None
        self._line_random = Random(f"{seed}/line")
        self._slot_random = Random(f"{seed}/contacts")
        self._blocked_s = 0.0
        self._contacts: list[Contact] = []
        self._dock: Beside | None = None
        self._started_s = now
        self._steps = 0
        world.robots.append(self)

    @property
    def now(self) -> float:
        """Seconds of the world's clock."""
        return self._started_s + self._steps * STEP_S

    def nearest(self, x_m: float, y_m: float) -> tuple[float, float, float]:
        """As other robots run into it: see `obstacles.Obstacle`."""
        return self.base.x_m, self.base.y_m, BUMPER_RADIUS_M

    @property
    def true_pose(self) -> TruePose:
        base = self.base
        return TruePose(self.now, base.x_m, base.y_m, base.heading_rad, self.handled)

    def place(self, x_m: float, y_m: float, heading_rad: float) -> None:
        """The robot stands here from now on."""
        self.base.place(x_m, y_m, heading_rad)
        self._look_around()
        self._slot()
        self.pins.drive(x_m, y_m, heading_rad)

    def step_until(self, now: float) -> None:
        """As many steps as fit; what is left over comes with the next call."""
        while self.now + STEP_S <= now + 1e-9:
            self.step()

    def step(self) -> None:
        self._steps += 1
        now = self.now
        received = self.line.receive(self.interface.baud)
        if received:
            self.interface.receive(thinned(received, self.faults, self._line_random), now)
        moved = self._move(now)
        if self._steps % STEPS_PER_SLOT == 0:
            self._slot()
        if moved or self.faults.floor_flip or self.faults.floor_edge_mm:
            self.pins.drive(self.base.x_m, self.base.y_m, self.base.heading_rad)
        if self.interface.has_more:
            self.line.send(spoiled(self.interface.take(), self.faults, self._line_random), self.interface.baud)
        self.world.moved(self)

    # Movement ----------------------------------------------------------------------------------------------------

    def _move(self, now: float) -> bool:
        left, right = self._wanted(now)
        base = self.base
        if not (left or right or base.moving):
            self._blocked_s = 0.0
            return False
        if self.faults.wheels_jammed:
            base.jam()
            self._blocked_s += STEP_S
            return False
        grip = 1.0 - self.faults.slip
        ahead_mm, turn_rad = (way * grip for way in base.roll(left, right))
        if self.faults.stuck or self.faults.slipping:
            self._blocked_s = self._blocked_s + STEP_S if self.faults.stuck else 0.0
            return False
        x_m, y_m = base.ahead(ahead_mm, turn_rad)
        held = bool(ahead_mm) and self._held(x_m, y_m, ahead_mm)
        self._blocked_s = self._blocked_s + STEP_S if held else 0.0
        if held:
            # The wheels slip: they turn and count, the body does not go on.
            base.move(base.x_m, base.y_m, 0.0, turn_rad)
        else:
            base.move(x_m, y_m, ahead_mm, turn_rad)
        self._look_around()
        return True

    def _wanted(self, now: float) -> Wheels:
        """Return the speeds that the host wants, or the firmware when it drives by itself."""
        interface = self.interface
        if interface.activity is Activity.NONE:
            self._seek = None
            return interface.actuators.left_mm_s, interface.actuators.right_mm_s
        if interface.activity is Activity.CLEANING:
            return CLEANING_MM_S
        return self._dock_wheels(now)

    def _dock_wheels(self, now: float) -> Wheels:
        self._seek = self._seek or SeekDock(now)
        place = None if self.faults.dock_beams_off else self._dock
        wheels = None if self.docked else self._seek.wheels(place, now)
        if wheels is None:
            self.interface.finish_activity()
            return 0.0, 0.0
        return wheels

    def _held(self, x_m: float, y_m: float, ahead_mm: float) -> bool:
        """Return whether something keeps the body from moving there: only what it would move into, so it can back
        off."""
        heading = self.base.heading_rad
        dock = self._dock
        if dock and dock.held and ahead_mm * math.cos(dock.turned_rad) > 0:
            return True
        if not self._contacts:
            return False
        for near in self._contacts:
            there = contact(near.obstacle, x_m, y_m, heading)
            if there.gap_m < 0 and there.gap_m < contact(near.obstacle, self.base.x_m, self.base.y_m, heading).gap_m:
                return True
        return False

    def _look_around(self) -> None:
        pose = (self.base.x_m, self.base.y_m, self.base.heading_rad)
        self._contacts = self.world.contacts(self, *pose)
        self._dock = self.world.dock_beside(*pose) if self.world.docks else None

    # The firmware's slot -----------------------------------------------------------------------------------------

    def _slot(self) -> None:
        now = self.now
        self._look_around()
        self.docked = self._touches_charger()
        self._tell_touch(now)
        self._tell_wheels()
        self._tell_dock()
        self._charge()
        told = self.readings
        cliff = told.cliff_left or told.cliff_front_left or told.cliff_front_right or told.cliff_right
        self.interface.guard(Hazards(bool(cliff), told.bumps_wheel_drops > 3, self.docked))
        self.interface.tick(now, self.docked)

    def _touches_charger(self) -> bool:
        if not self._dock or not self._dock.touching or self.faults.dock_unpowered:
            return False
        if self.faults.contact_bounce:
            return bool(self._steps // (STEPS_PER_SLOT * BOUNCE_SLOTS) % 2) and self._slot_random.random() < 0.9
        return True

    def _tell_touch(self, now: float) -> None:
        faults, told = self.faults, self.readings
        left = faults.bump_left or now < self.bumped_until_s["left"]
        right = faults.bump_right or now < self.bumped_until_s["right"]
        for one in self._contacts:
            if one.gap_m < TOUCH_M:
                left, right = left or one.pressed[0], right or one.pressed[1]
        if self._dock and self._dock.held and not self._dock.aligned:
            left = right = True
        told.bumps_wheel_drops = right + 2 * left + 4 * faults.wheel_drop_right + 8 * faults.wheel_drop_left
        for side in ("left", "front_left", "front_right", "right"):
            over_edge = getattr(faults, f"cliff_{side}")
            setattr(told, f"cliff_{side}", int(over_edge))
            setattr(told, f"cliff_{side}_signal", CLIFF_SIGNAL if over_edge else FLOOR_SIGNAL)
        told.virtual_wall = int(faults.virtual_wall)
        self._tell_lights()

    def _tell_lights(self) -> None:
        told, base = self.readings, self.base
        signals = light_signals(self._contacts, base.x_m, base.y_m, base.heading_rad)
        if self.faults.lights_blind or self.faults.lights_dazzled:
            signals = (DAZZLED_SIGNAL * self.faults.lights_dazzled,) * 6
        told.light_left, told.light_front_left, told.light_centre_left = signals[:3]
        told.light_centre_right, told.light_front_right, told.light_right = signals[3:]
        told.light_bumper = sum(1 << bit for bit, signal in enumerate(signals) if signal)
        told.wall, told.wall_signal = int(signals[5] > 0), min(signals[5], 1023)

    def _tell_wheels(self) -> None:
        base, told = self.base, self.readings
        offset = self.faults.encoder_offset
        told.left_encoder = (base.left.encoder + offset) & 0xFFFF
        told.right_encoder = (base.right.encoder + offset) & 0xFFFF
        told.left_motor_ma = self._motor_ma(base.left.speed_mm_s)
        told.right_motor_ma = self._motor_ma(base.right.speed_mm_s)
        blocked = self._blocked_s >= OVER_CURRENT_AFTER_S or self.faults.over_current
        told.over_currents = 0b11000 if blocked else 0
        left, right = base.left.speed_mm_s, base.right.speed_mm_s
        told.stasis = int(left > 5 and right > 5 and not (self._blocked_s or self.faults.slipping))
        way_bug = DISTANCE_BUG if self.faults.distance_bug else 1.0
        told.distance_mm, rest_mm = _told(told.distance_mm, base.untold_mm * way_bug)
        base.untold_mm = rest_mm / way_bug
        turned_deg = base.untold_deg * (ANGLE_BUG if self.faults.angle_bug else 1.0)
        told.angle_deg, rest_deg = _told(told.angle_deg, turned_deg)
        base.untold_deg = rest_deg / (ANGLE_BUG if self.faults.angle_bug else 1.0)

    def _motor_ma(self, speed_mm_s: float) -> int:
        if not speed_mm_s:
            return IDLE_MOTOR_MA
        return BLOCKED_MOTOR_MA if self._blocked_s or self.faults.over_current else DRIVING_MOTOR_MA

    def _tell_dock(self) -> None:
        told, place = self.readings, self._dock
        told.charger_available = 2 if self.docked else 0
        seen = 0 if self.faults.dock_beams_off or place is None else ir_character(place)
        bearing = bearing_rad(place) if place and seen else 0.0
        told.ir_omni = seen or (VIRTUAL_WALL_IR if self.faults.virtual_wall else 0)
        told.ir_left = seen if -IR_ACROSS_RAD < bearing < IR_SIDE_RAD else 0
        told.ir_right = seen if -IR_SIDE_RAD < bearing < IR_ACROSS_RAD else 0

    def _charge(self) -> None:
        told, battery = self.readings, self.battery
        may_charge = self.interface.mode < 2
        battery.step(
            SLOT_S, told.left_motor_ma + told.right_motor_ma, self.docked, may_charge, self.faults.charge_fault
        )
        told.charging_state, told.voltage_mv = int(battery.state), battery.voltage_mv
        told.current_ma, told.temperature_c = clipped(battery.current_ma, -32768, 32767), round(battery.temperature_c)
        told.charge_mah = clipped(battery.charge_mah, 0, 65535)
        told.capacity_mah = clipped(battery.pack.capacity_mah, 0, 65535)
        self.interface.charging_s = battery.charging_s
        if not battery.charge_mah and not self.docked:
            self.interface.lose_power()


def _told(so_far: int, more: float) -> tuple[int, float]:
    """Packets 19 and 20 are whole numbers, clipped; the fraction waits for the next time."""
    whole = int(more)
    return clipped(so_far + whole, -32768, 32767), more - whole


def clipped(value: float, low: int, high: int) -> int:
    """Clip to the packet's range: a value that does not fit stays at its end."""
    return min(max(round(value), low), high)
