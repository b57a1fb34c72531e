"""A robot as people see it: *seen* at posts, not tracked; expected at the next one in an interval."""

from datetime import datetime, timedelta

from pydantic import BaseModel, ConfigDict, Field

from app.core.settings import Settings
from app.core.texts.reasons import Words, words_of
from app.models import RobotRow
from fleet.charging.curve import ASSUMED
from fleet.charging.levels import Thresholds
from maps import CampusMap, CampusMapError
from protocol.parts import Activity

SPREAD = 2.0


class LastSeen(BaseModel):
    """The post it was last seen at, the one before, and when."""

    post: str
    previous: str | None
    at: datetime


class Expected(BaseModel):
    """Where it should be seen next, and between which times; never times that are over."""

    post: str
    from_: datetime = Field(alias="from")
    to: datetime

    model_config = ConfigDict(validate_by_name=True, validate_by_alias=True, serialize_by_alias=True)


class ChargedView(BaseModel):
    """The charge that a charging robot is expected to have at about this time. How fast chargers are is assumed."""

    ratio: float
    at: datetime


class BatteryView(BaseModel):
    """Charge as a ratio of capacity. `charges_to`: with that it leaves its dock to others; null if it has it."""

    ratio: float
    charging: bool
    charges_to: ChargedView | None


class WaitsFor(BaseModel):
    """The corridor that a robot waits to enter, the robots that have to go on before, and until about when.

    `closed`: by a person, until a person opens it.
    """

    from_post: str
    to_post: str
    robots: list[str]
    until: datetime | None
    closed: bool


class RobotView(BaseModel):
    """One robot. `online` is its own axis: an offline robot goes on with what it is doing.

    `why` is its own sentence, in English, or the service's while it waits for others; `why_words` the same as a text of
    the catalogue, if it is one. `waits_for`: the facts of that. `taken_out_at`: a person has given its corridors to
    others, and it has not heard so yet.
    """

    name: str
    online: bool
    last_seen: LastSeen | None
    towards: str | None
    expected: Expected | None
    activity: Activity
    battery: BatteryView | None
    why: str | None
    why_words: Words | None
    waits_for: WaitsFor | None
    taken_out_at: datetime | None
    heard_at: datetime | None


def why_of_robot(robot: RobotRow) -> str | None:
    """Its own sentence, unless the service knows better for what it waits."""
    if robot.taken_out_at:
        return "Its corridors were given to others; it takes part again when it stands at a post"
    waits = WaitsFor.model_validate(robot.waits_for) if robot.waits_for else None
    if waits and waits.closed:
        return f"Waiting at {waits.from_post}: the mailroom closed the corridor to {waits.to_post}"
    if waits and waits.robots:
        return f"Waiting at {waits.from_post} for the corridor to {waits.to_post}, after {', '.join(waits.robots)}"
    return robot.why


def _activity(robot: RobotRow) -> Activity:
    """Return its own report, but that one in its dock that has somewhere to go is not free: it waits to be let out."""
    held_up = robot.activity == Activity.IDLE and robot.waits_for is not None
    return Activity.WAITING if held_up else Activity(robot.activity)


def robot_view(robot: RobotRow, campus: CampusMap, settings: Settings, now: datetime) -> RobotView:
    """Return a robot as people see it."""
    why = why_of_robot(robot)
    return RobotView(
        name=robot.name,
        online=robot.online,
        last_seen=_last_seen(robot),
        towards=robot.towards,
        expected=_expected(robot, campus, settings, now),
        activity=_activity(robot),
        battery=_battery(robot),
        why=why,
        why_words=words_of(why) if why else None,
        waits_for=WaitsFor.model_validate(robot.waits_for) if robot.waits_for else None,
        taken_out_at=robot.taken_out_at,
        heard_at=robot.heard_at,
    )


def _last_seen(robot: RobotRow) -> LastSeen | None:
    if robot.post is None or robot.seen_at is None:
        return None
    return LastSeen(post=robot.post, previous=robot.previous, at=robot.seen_at)


def _battery(robot: RobotRow) -> BatteryView | None:
    if robot.battery_ratio is None:
        return None
    return BatteryView(ratio=robot.battery_ratio, charging=robot.charging, charges_to=_charges_to(robot))


def _charges_to(robot: RobotRow) -> ChargedView | None:
    ratio, enough = robot.battery_ratio, Thresholds().sufficient
    if not robot.charging or ratio is None or ratio >= enough or robot.heard_at is None:
        return None
    return ChargedView(ratio=enough, at=robot.heard_at + timedelta(seconds=ASSUMED.time_s(ratio, enough)))


def _expected(robot: RobotRow, campus: CampusMap, settings: Settings, now: datetime) -> Expected | None:
    """From the length of the corridor it is in; the speed is assumed. None once that time is over."""
    if robot.post is None or robot.towards is None or robot.seen_at is None:
        return None
    try:
        length_m = campus.corridor(robot.post, robot.towards).length_m
    except CampusMapError:  # a robot with another map than ours: say nothing rather than something wrong
        return None
    drive_s = length_m / settings.assumed_speed_m_s
    first, last = (robot.seen_at + timedelta(seconds=drive_s * factor) for factor in (1.0, SPREAD))
    return Expected(post=robot.towards, from_=first, to=last) if last > now else None
