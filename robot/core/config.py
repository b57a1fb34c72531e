"""Every setting of a robot: one TOML file, checked key by key; what the command line says wins over the file.

    name = "r1"
    map = "carleton"
    [battery]
    low_ratio = 0.30

The identity is a token in a file of its own, readable by its owner alone.
"""

import stat
import tomllib
from collections.abc import Mapping, Sequence
from difflib import get_close_matches
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any, Self, get_args

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, ValidationError, model_validator
from pydantic_core import ErrorDetails

Ratio = Annotated[float, Field(ge=0.0, le=1.0)]
Pin = Annotated[str, Field(pattern=r"^(BOARD|GPIO|BCM)\d{1,2}$")]
Rate = Annotated[float, Field(ge=0.1, le=1000.0)]
MAX_WHEEL_SPEED_MM_S = 200.0
"""A dead computer leaves the base driving (the Open Interface has no dead-man timer): this caps what that can do."""


class ConfigError(Exception):
    """A setting that cannot be used: where it stands, what is wrong, and what to do about it."""

    def __init__(
        self, source: str, key: str, message: str, way_out: str = "", more: "Sequence[ConfigError]" = ()
    ) -> None:
        """`more`: what else is wrong there, each on a line of its own."""
        self.source, self.key, self.message, self.way_out = source, key, message, way_out
        super().__init__("\n".join([f"{source}: {key}: {message}. {way_out}".strip(), *map(str, more)]))


class Section(BaseModel):
    """Frozen and exact: an undeclared key is an error, never ignored."""

    model_config = ConfigDict(frozen=True, extra="forbid")


class PerceptMode(StrEnum):
    """The way percepts reach the mind: the newest value of each, or only what arrived since the last cycle."""

    LATEST = "latest"
    DRAIN = "drain"


class LineSettings(Section):
    """The three diodes of the line sensor (BOARD pins of the paper's robot)."""

    left_pin: Pin = Field(default="BOARD12", description="pin of the left diode, as gpiozero spells it")
    centre_pin: Pin = Field(default="BOARD10", description="pin of the centre diode")
    right_pin: Pin = Field(default="BOARD8", description="pin of the right diode")
    line_is_low: bool = Field(default=True, description="whether a diode over the line reads low")
    spacing_mm: Annotated[float, Field(ge=5.0, le=60.0)] = Field(
        default=18.0, description="distance between neighbouring diodes, mm"
    )
    lead_mm: Annotated[float, Field(ge=0.0, le=200.0)] = Field(
        default=60.0, description="how far the diodes are ahead of the wheel axle, mm (40 to 80 follows best)"
    )

    @model_validator(mode="after")
    def three_pins(self) -> Self:
        """Two diodes on one pin would vote as one."""
        if len({self.left_pin, self.centre_pin, self.right_pin}) < 3:
            raise ValueError(
                f"three different pins are needed, not {self.left_pin}, {self.centre_pin}, {self.right_pin}"
            )
        return self


class CameraSettings(Section):
    """The camera on the left side."""

    device: int = Field(default=0, ge=0, le=63, description="number of the video device")
    width_px: int = Field(default=640, ge=160, le=1920, description="width of a frame, pixels")
    height_px: int = Field(default=480, ge=120, le=1080, description="height of a frame, pixels")
    exposure_ms: Annotated[float, Field(ge=0.1, le=100.0)] = Field(
        default=15.0, description="longest exposure, ms: more blurs a marker in passing"
    )
    field_of_view_deg: Annotated[float, Field(gt=10.0, lt=170.0)] = Field(
        default=60.0, description="horizontal field of view, degrees"
    )
    april_tags: bool = Field(default=False, description="the sheets have AprilTags, read where a code is torn")


class DriveSettings(Section):
    """Settings of the base's movement."""

    cruise_mm_s: Annotated[float, Field(ge=30.0, le=MAX_WHEEL_SPEED_MM_S)] = Field(
        default=200.0, description="speed on a straight line, mm/s (never below 30: the base misbehaves there)"
    )
    turn_mm_s: Annotated[float, Field(ge=30.0, le=MAX_WHEEL_SPEED_MM_S)] = Field(
        default=200.0, description="speed of each wheel when turning on the spot, mm/s"
    )
    velocity_deadline_s: Annotated[float, Field(ge=0.1, le=1.0)] = Field(
        default=0.4, description="a speed that is not renewed for so long stops, s"
    )
    mm_per_count: Annotated[float, Field(ge=0.35, le=0.55)] = Field(
        default=0.44456,
        description="way of a wheel for each count of its encoder, mm; `calibrate distance` measures it",
    )
    wheel_base_mm: Annotated[float, Field(ge=200.0, le=270.0)] = Field(
        default=235.0, description="distance between the wheels as turns show it, mm; `calibrate turn` measures it"
    )


class BatterySettings(Section):
    """When a battery is low, and when it is full again."""

    low_ratio: Ratio = Field(default=0.25, description="below this charge the battery is low")
    hysteresis_ratio: Ratio = Field(default=0.03, description="it counts as low until this much above low_ratio")
    start_ratio: Ratio = Field(default=0.5, description="with less charge no work is begun in a dock")
    full_ratio: Ratio = Field(default=0.99, description="from this charge on the battery is full")
    full_after_s: Annotated[float, Field(ge=1.0, le=86400.0)] = Field(
        default=60.0, description="on the dock in charging state 3 or 4 for so long is full too, s"
    )
    simulated_capacity_mah: Annotated[float, Field(ge=100.0, le=20_000.0)] = Field(
        default=2696.0, description="capacity of the simulated pack, mAh (NiMH pack of a Create 2)"
    )
    simulated_charger_ma: Annotated[float, Field(ge=10.0, le=200_000.0)] = Field(
        default=1250.0, description="current of the simulated dock, mA"
    )

    @model_validator(mode="after")
    def low_before_full(self) -> Self:
        """A battery that is low and full at once would charge for ever."""
        if max(self.low_ratio, self.start_ratio) + self.hysteresis_ratio >= self.full_ratio:
            raise ValueError("low_ratio and start_ratio, each plus hysteresis_ratio, must be below full_ratio")
        return self


class RateSettings(Section):
    """Rates of the daemon's loops, per second of its clock."""

    base_hz: Rate = Field(default=50.0, description="simulated world and bytes of the base")
    drive_hz: Rate = Field(default=50.0, description="reflexes and skills")
    line_hz: Rate = Field(default=200.0, description="samples of the line sensor (majority vote per drive tick)")
    camera_hz: Rate = Field(default=10.0, description="frames looked at")
    mind_hz: Rate = Field(default=10.0, description="perception and reasoning (the paper's cycle is 100 ms)")
    snapshot_hz: Rate = Field(default=1.0, description="state sent to the server")


class MindSettings(Section):
    """The agent program and how it perceives."""

    program: Path | None = Field(default=None, description="agent program; without one, our own")
    percepts: PerceptMode | None = Field(
        default=None, description="latest or drain; without it: latest for our program, drain for any other"
    )
    steps_per_tick: int = Field(default=8, ge=1, le=100, description="reasoning cycles per tick in latest mode")
    age_limit_s: Annotated[float, Field(ge=0.1, le=60.0)] = Field(
        default=2.0, description="a percept that is not renewed for so long is forgotten, s"
    )


def _loopback_or_encrypted(url: str | None) -> str | None:
    plain_elsewhere = url is not None and not url.startswith(
        ("wss://", "ws://127.0.0.1", "ws://localhost", "ws://[::1]")
    )
    if plain_elsewhere:
        raise ValueError("only wss:// is used outside this machine (ws:// to 127.0.0.1, localhost or [::1])")
    return url


class Settings(Section):
    """One robot."""

    name: Annotated[str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9_-]*$", max_length=64)] = Field(
        default="r1", description="the robot's name, as the service knows it"
    )
    map: str = Field(default="test_track", description="a built-in map by name, or a map file")
    home: str | None = Field(default=None, description="post of its own dock; without it, the first dock of the map")
    mailroom: str | None = Field(
        default=None, description="post that takes back mail that was not taken; without it, its sender's post"
    )
    server: Annotated[str | None, AfterValidator(_loopback_or_encrypted)] = Field(
        default=None, description="address of the service's robot link (wss, or ws to this machine); none: alone"
    )
    token_file: Path | None = Field(default=None, description="file with the robot's token, mode 0600")
    key_file: Path | None = Field(
        default=None, description="file with the key that signs receipts, mode 0600; without it they are unsigned"
    )
    data: Path = Field(default=Path("var/robot"), description="folder of the robot's memory and outbox")
    serial_port: str = Field(default="/dev/ttyUSB0", min_length=1, description="port of the base, any pyserial URL")
    brc: Annotated[str, Field(pattern=r"^(rts|none|(BOARD|GPIO|BCM)\d{1,2})$")] = Field(
        default="rts", description="what pulls the base's BRC line low: rts (the USB cable), a pin, or none"
    )
    log_file: Path | None = Field(
        default=None,
        description="log into this file, 5 of 1 MB in turn; none: to stderr, which systemd's journal keeps",
    )
    line: LineSettings = LineSettings()
    camera: CameraSettings = CameraSettings()
    drive: DriveSettings = DriveSettings()
    battery: BatterySettings = BatterySettings()
    rates: RateSettings = RateSettings()
    mind: MindSettings = MindSettings()


def load_settings(path: Path | None, overrides: Mapping[str, Any]) -> Settings:
    """The settings of a file (defaults without one) under what the command line says; None there says nothing.

    Raises ConfigError: the file cannot be read, a key is unknown (with the nearest one), a value is not possible.
    """
    source = str(path) if path else "command line"
    raw = _read(path) if path else {}
    for dotted, value in overrides.items():
        if value is not None:
            _put(raw, dotted.split("."), value)
    try:
        return Settings.model_validate(raw)
    except ValidationError as error:
        raise _named(source, error) from None


def _read(path: Path) -> dict[str, Any]:
    try:
        return tomllib.loads(path.read_text("utf-8"))
    except OSError as error:
        raise ConfigError(str(path), "file", f"cannot be read: {error.strerror}", "Give another --config.") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise ConfigError(str(path), "file", f"is not TOML: {error}") from None


def _put(raw: dict[str, Any], path: list[str], value: object) -> None:
    *sections, key = path
    for section in sections:
        raw = raw.setdefault(section, {})
    raw[key] = value


def _named(source: str, error: ValidationError) -> ConfigError:
    """Everything that is wrong, so that a file is put right in one go."""
    first, *others = (_wording(problem) for problem in error.errors())
    return ConfigError(source, *first, more=[ConfigError(source, *other) for other in others])


def _wording(problem: ErrorDetails) -> tuple[str, str, str]:
    """Key, what is wrong with it, way out."""
    key = ".".join(str(part) for part in problem["loc"])
    if problem["type"] != "extra_forbidden":
        given = problem["input"]
        it_is = f" (it is {given!r})" if isinstance(given, str | int | float) else ""
        return key, problem["msg"].removeprefix("Value error, ") + it_is, ""
    nearest = get_close_matches(key, sorted(keys()), n=1, cutoff=0.4)
    return key, "there is no such setting", f"Did you mean {nearest[0]!r}?" if nearest else ""


def keys(section: type[Section] = Settings, prefix: str = "") -> dict[str, str]:
    """Every setting by its dotted key, with its description: what the manual has to name."""
    found: dict[str, str] = {}
    for name, field in section.model_fields.items():
        kinds = [kind for kind in (field.annotation, *get_args(field.annotation)) if isinstance(kind, type)]
        inner = next((kind for kind in kinds if issubclass(kind, Section)), None)
        found |= keys(inner, f"{prefix}{name}.") if inner else {prefix + name: field.description or ""}
    return found


def read_token(path: Path) -> str:
    """The robot's token. Raises ConfigError when the file is absent, empty, or open to others."""
    try:
        mode = stat.S_IMODE(path.stat().st_mode)
        token = path.read_text("ascii").strip()
    except (OSError, UnicodeDecodeError) as error:
        way_out = "`python -m app robots enrol NAME` at the service prints a code for `robot enrol`."
        raise ConfigError(
            str(path), "token_file", f"cannot be read: {getattr(error, 'strerror', error)}", way_out
        ) from None
    if mode & 0o077:
        raise ConfigError(str(path), "token_file", f"others may read it (mode {mode:04o})", f"Run: chmod 600 {path}")
    if not token:
        raise ConfigError(str(path), "token_file", "is empty", "Put the token there that enrolment printed.")
    return token
