"""The keys of a scenario file, each with its meaning; docs/reference/scenario-keys.md is made of it.

Times are seconds since the start, lengths metres in the map's frame. What `after_post` names counts from the moment in
which the robot first stands at that post: then `at_s` is so long after it.
"""

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

Share = Annotated[float, Field(ge=0.0, le=1.0)]
Seconds = Annotated[float, Field(ge=0.0)]
Metres = Annotated[float, Field(gt=0.0)]
Name = Annotated[str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9_-]*$", max_length=64)]
Spot = tuple[float, float]


class Table(BaseModel):
    """Frozen and exact: an undeclared key is an error, never ignored."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class MapChoice(Table):
    """Which campus, and how large."""

    name: str = Field(default="test_track", description="a built-in map by name, or a map file beside the scenario")
    scale: Metres | None = Field(default=None, description="every corridor so many times as long")
    corridors_m: tuple[Metres, Metres] | None = Field(
        default=None, description="shortest and longest corridor wanted: the scale that fits is found"
    )


class RobotRow(Table):
    """A robot, all of its daemon included."""

    name: Name = Field(description="the robot's name")
    start: str = Field(default="dock", description="dock, dock:POST, a post, or POST:TOWARDS")
    home: str | None = Field(default=None, description="post of its own dock; without it, the first dock of the map")
    battery: Share = Field(default=1.0, description="charge at the start, as a share")
    capacity_mah: Metres = Field(default=2696.0, description="capacity of its pack, mAh: a small one runs low soon")
    charger_ma: Metres = Field(
        default=1250.0, description="charging current of docks, mA: a strong one shortens the run"
    )
    settings: dict[str, bool | int | float | str] = Field(
        default_factory=dict, description='settings of the daemon by dotted key, as `"drive.cruise_mm_s" = 150`'
    )


class Noise(Table):
    """Imperfections of floor, diodes and wheels."""

    flip: Share = Field(default=0.0, description="chance that one look of a diode reads the opposite")
    edge_mm: Annotated[float, Field(ge=0, le=10)] = Field(
        default=0.0, description="width of the tape's bright edge, mm"
    )
    gap_mm: Annotated[float, Field(ge=0, le=200)] = Field(
        default=0.0, description="length of the holes in worn tape, one every 0.6 to 1.4 m, mm"
    )
    ripple_mm_s: Annotated[float, Field(ge=0, le=50)] = Field(default=10.0, description="ripple of the wheels, mm/s")
    wheel_error: Annotated[float, Field(ge=0, le=0.1)] = Field(
        default=0.02, description="standard deviation of each wheel's size, as a share"
    )


class Place(Table):
    """A circle, or a whole corridor; everywhere without either."""

    at: Spot | None = Field(default=None, description="middle of a circle, [x, y]")
    radius_m: Metres = Field(default=1.0, description="radius of the circle")
    corridor: str | None = Field(default=None, description="a whole corridor by name, as post2-post3")


class Dark(Place):
    """Where there is little light."""

    darkness: Share = Field(default=0.7, description="share of the light that is missing")


class NoNetwork(Place):
    """Where there is no network."""

    from_s: Seconds = Field(default=0.0, description="since when")
    until_s: Seconds | None = Field(default=None, description="until when; without it, for ever")


class Walker(Table):
    """A person who walks along a path and then is gone; stands where a robot is in the way."""

    path: tuple[Spot, ...] = Field(min_length=2, description="corners of the way, [[x, y], …]")
    at_s: Seconds = Field(default=0.0, description="when the walk begins")
    speed_m_s: Metres = Field(default=1.0, description="how fast")
    radius_m: Metres = Field(default=0.2, description="as wide as this")


class Stander(Table):
    """A person (or thing) in the way."""

    at: Spot | None = Field(default=None, description="where, [x, y]")
    corridor: str | None = Field(default=None, description="or on the tape of this corridor, as post2-post3")
    along: Share = Field(default=0.5, description="how far along that corridor, as a share from the first-named post")
    from_s: Seconds = Field(default=0.0, description="since when")
    until_s: Seconds | None = Field(default=None, description="until when")
    leaves_after_s: Seconds | None = Field(
        default=None, description="goes away so long after a robot has stopped in front"
    )
    radius_m: Metres = Field(default=0.2, description="as wide as this")


class PersonAtPost(Table):
    """The sender or the recipient of an order."""

    comes: Literal["in_time", "late", "never"] = Field(default="in_time", description="in_time, late or never")
    late_s: Seconds = Field(default=30.0, description="so long after the robot has arrived, if late")
    shows: Literal["code", "wrong_first", "wrong", "spot"] = Field(
        default="code", description="code; wrong_first (another's, then their own); wrong; spot (the button, twice)"
    )


class OrderRow(Table):
    """A letter that a sender wants carried."""

    id: Name = Field(description="name of the order")
    origin: str = Field(alias="from", description="post of the sender")
    destination: str = Field(alias="to", description="post of the recipient")
    at_s: Seconds = Field(default=0.0, description="when it is ordered")
    robot: str | None = Field(default=None, description="who carries it; without it, the first robot that is free")
    together: str | None = Field(default=None, description="orders with the same word here are one mission")
    wait_limit_s: Metres = Field(default=120.0, description="how long the robot waits for each of the two people")
    sender: PersonAtPost = PersonAtPost()
    recipient: PersonAtPost = PersonAtPost()


class Timed(Table):
    """Something that happens at a moment."""

    at_s: Seconds = Field(default=0.0, description="when")
    after_post: str | None = Field(default=None, description="counted from when the robot first stands at this post")
    robot: str | None = Field(default=None, description="to whom; without it, to every robot")


class FaultRow(Timed):
    """A switch of the simulated world (`python -m robot.simulated --list-faults`)."""

    switch: str = Field(description="which one")
    value: bool | int | float = Field(default=True, description="its position")
    for_s: Seconds | None = Field(default=None, description="how long; without it, for the rest")


class Deed(Timed):
    """One thing that a person does to a robot."""

    do: Literal[
        "bump",
        "lift",
        "put_down",
        "carry",
        "push",
        "sag",
        "spot",
        "clean",
        "show_code",
        "unplug",
        "plug_in",
        "reset_base",
        "stop",
    ] = Field(
        description="bump, lift, put_down, carry (to `to`), push, sag (to `ratio`), spot or clean (buttons), show_code "
        "(`text`), unplug or plug_in (the cable to the base), reset_base, stop (python -m robot stop)"
    )
    to: str | None = Field(default=None, description="where it is carried, as in a robot's start")
    ratio: Share = Field(default=0.2, description="charge after a sag")
    ahead_mm: float = Field(default=100.0, description="how far it is pushed, mm")
    text: str = Field(default="", description="what is shown to the camera as a QR code: a post's name, or anything")
    for_s: Seconds = Field(default=0.5, description="how long a bump presses, or a code is shown")


class MessageRow(Timed):
    """One message from the service to a robot."""

    say: Literal["pause", "resume", "cancel", "recall", "emergency_stop"] = Field(
        description="pause, resume, cancel, recall or emergency_stop"
    )
    order: str | None = Field(default=None, description="the order that is cancelled")


class Expectation(Table):
    """One condition that must hold at the end. Without a list, every order must have been delivered."""

    delivered: tuple[str, ...] | None = Field(default=None, description="orders whose mail the recipient must have")
    handed_over: tuple[str, ...] = Field(
        default=(), description="orders that must have ended honestly with a person instead"
    )
    bumps_at_most: int | None = Field(default=None, ge=0, description="bumps of all robots")
    searches_at_most: int | None = Field(default=None, ge=0, description="times that the line was looked for")
    home: bool = Field(default=True, description="every robot must be in a dock")
    told: tuple[str, ...] = Field(
        default=(), description='what must have been told, as "charge low", "fault way_blocked", "progress gave_up"'
    )
    posts: tuple[str, ...] | None = Field(
        default=None, description="posts that the first robot must pass, in this order"
    )


class Scenario(Table):
    """A world, who is in it, and what happens."""

    title: str = Field(default="", description="one line for people")
    about: str = Field(default="", description="what it shows")
    seed: int = Field(default=1, description="same seed, same run")
    limit_s: Metres = Field(default=1800.0, description="the run ends then at the latest")
    map: MapChoice = MapChoice()
    robot: tuple[RobotRow, ...] = Field(default=(RobotRow(name="r1"),), min_length=1)
    noise: Noise = Noise()
    dirt: dict[str, Share] = Field(default_factory=dict, description="post → share of its markers under dirt")
    dark: tuple[Dark, ...] = ()
    no_network: tuple[NoNetwork, ...] = ()
    walker: tuple[Walker, ...] = ()
    stander: tuple[Stander, ...] = ()
    order: tuple[OrderRow, ...] = ()
    fault: tuple[FaultRow, ...] = ()
    deed: tuple[Deed, ...] = ()
    message: tuple[MessageRow, ...] = ()
    expect: Expectation = Expectation()
