"""How far the charge of a robot takes it: as map and settings say, and never so that one waits for ever."""

from itertools import pairwise
from typing import Any

from app.core.settings import Settings
from app.dispatch.charge_limits import Charges
from app.dispatch.open_work import RobotNow
from maps.ways import Ways
from tests.plain_maps import plain_map

WAYS = Ways(plain_map("carleton"))
SETTINGS = Settings()
CHARGES = Charges(WAYS, SETTINGS)
SHORT, LONG = ("canal", "nicol"), ("loeb", "robertson")


def robot(ratio: float | None, **more: Any) -> RobotNow:
    usual = RobotNow(
        *("r1", "canal", ratio, False, False, "canal"),
        is_there=True,
        takes_work=True,
        gives_away=False,
        has_stopped=False,
        held_up=None,
    )
    return usual._replace(**more)


def drives_s(*way: str) -> float:
    """From the canal along these posts and back."""
    posts = ("canal", *way, "canal")
    length_m = sum(WAYS.length_m(one, other) for one, other in pairwise(posts))
    return length_m / SETTINGS.assumed_speed_m_s


def test_a_robot_that_is_half_full_takes_the_short_way_and_not_the_long_one() -> None:
    assert drives_s(*SHORT) <= CHARGES.drives_s(robot(0.5)) < drives_s(*LONG)


def test_a_fuller_one_drives_farther_and_one_that_has_not_said_or_has_little_not_at_all() -> None:
    assert CHARGES.drives_s(robot(0.5)) < CHARGES.drives_s(robot(0.9))
    assert CHARGES.drives_s(robot(None)) == CHARGES.drives_s(robot(0.29)) == 0.0


def test_in_the_dock_nothing_is_begun_that_the_robot_itself_would_not_begin() -> None:
    assert CHARGES.drives_s(robot(0.5, docked=True, charging=True)) == 0.0
    assert CHARGES.drives_s(robot(0.55, docked=True, charging=True)) >= drives_s(*SHORT)


def test_what_is_more_than_one_charge_goes_with_a_robot_that_is_full() -> None:
    assert not CHARGES.goes_beyond(robot(0.9, docked=True, charging=True))
    assert CHARGES.goes_beyond(robot(0.96, docked=True, charging=True))


def test_no_robot_waits_for_charge_that_will_not_come() -> None:
    """A worn pack whose charger has ended; a robot that has no home to charge at."""
    assert CHARGES.goes_beyond(robot(0.9, docked=True))
    homeless = robot(0.7, docked=None, home=None)
    assert CHARGES.goes_beyond(homeless)
    assert not CHARGES.goes_beyond(homeless._replace(battery_ratio=0.4)), "its own battery plan takes it to a dock soon"


def test_where_nothing_is_known_of_a_way_the_charge_is_no_obstacle() -> None:
    assert CHARGES.needed(robot(0.9, post=None), ["nowhere"]) <= 0.3
